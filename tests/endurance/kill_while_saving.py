"""Kill a program that does nothing but save, at random moments: the file must be the old or the new one, whole.

python tests/endurance/kill_while_saving.py [RUNS]
"""

import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from films import many_vertices, numbered

from core.io.project import encode, load, save
from core.io.storage import backup_of

VERTICES = 20_000


def child(path):
    """Save version after version, and say each before and after."""
    document = many_vertices(VERTICES)
    number = 0
    while True:
        number += 1
        version = numbered(document, number)
        sys.stdout.write(f"begin {number}\n")
        sys.stdout.flush()
        save(version, path, backup=True)
        sys.stdout.write(f"end {number}\n")
        sys.stdout.flush()


def run(seed, path, document):
    """Return what the file was after the kill: "old" or "new"; raises if it was neither."""
    with subprocess.Popen([sys.executable, __file__, "child", str(path)], stdout=subprocess.PIPE, text=True) as it:
        assert it.stdout.readline() == "begin 1\n"
        time.sleep(random.Random(seed).uniform(0.0, 0.2))
        it.kill()
        said = ["begin 1", *it.stdout.read().split("\n")[:-1]]
        it.wait()
    ended = max((int(x[4:]) for x in said if x.startswith("end ")), default=0)
    begun = max(int(x[6:]) for x in said if x.startswith("begin "))
    content = path.read_bytes()
    for number, name in ((begun, "new"), (ended, "old")):
        if content == encode(numbered(document, number) if number else document):
            load(path)
            if backup_of(path).exists():
                load(backup_of(path))
            return name
    raise AssertionError(f"run {seed}: the file is neither version {ended} nor {begun}")


def main():
    if sys.argv[1:2] == ["child"]:
        child(Path(sys.argv[2]))
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    document = many_vertices(VERTICES)
    results = []
    for seed in range(runs):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "film.inkb"
            save(document, path)
            results.append(run(seed, path, document))
    print(
        f"{len(results)} of {runs} files whole: {results.count('old')} the old one, {results.count('new')} the new"
    )


if __name__ == "__main__":
    main()

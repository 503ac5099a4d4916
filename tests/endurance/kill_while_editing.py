"""Kill the program at random moments of its work, and find that work again.

    python tests/endurance/kill_while_editing.py [RUNS] [AT ONCE]

Each run starts a real process with a window that nobody sees, lets it edit, drag and save, kills it (SIGKILL) at
a random moment, and looks with the program's own code for what is left. It prints how many seconds of edits were
lost.
"""

import os
import random
import subprocess
import sys
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from editing import FILM, STATE
from films import number_of

from app.recovery import find
from app.safekeeping import FOLDER
from core.errors import InkbetweenError
from core.io.project import load
from core.io.storage import backup_of

LONGEST_S = 6.0
ALLOWED_S = 5.0


@dataclass(frozen=True)
class Run:
    """How many edits were made, and for how long the oldest one that is lost had been there."""

    edits: int
    seconds: float


def run(seed, folder):
    """Kill one program and find its work; raises if anything cannot be read."""
    environment = os.environ | {"QT_QPA_PLATFORM": "offscreen"}
    command = [sys.executable, str(Path(__file__).with_name("editing.py")), str(folder), str(seed)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as child:
        assert child.stdout.readline() == "ready\n"
        times = {}
        reader = threading.Thread(target=_read, args=(child.stdout, times))
        reader.start()
        time.sleep(random.Random(seed).uniform(0, LONGEST_S))
        killed = time.monotonic()
        child.kill()
        child.wait()
        reader.join()
    return Run(len(times), lost(folder, times, killed))


def _read(stream, times):
    for line in stream:
        if line.endswith("\n"):
            number, moment = line.split()
            times[int(number)] = float(moment)


def lost(folder, times, killed):
    """Return for how long the oldest edit that is gone had been there."""
    found, problems = find(folder / STATE / FOLDER)
    assert problems == [], problems
    numbers = [number_of(x.recovery.document) for x in found]
    for file in (folder / FILM, backup_of(folder / FILM)):
        if file.exists():
            numbers.append(number_of(load(file)))
    for each in found:
        each.place.release()
    best = max(numbers, default=0)
    gone = [moment for number, moment in times.items() if number > best]
    return max(0.0, killed - min(gone)) if gone else 0.0


def attempt(seed):
    """Return the seconds lost, or the sentence that says what went wrong."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            return run(seed, Path(folder))
        except (AssertionError, InkbetweenError, OSError) as e:
            return f"run {seed}: {e!r}"


def main():
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    at_once = int(sys.argv[2]) if len(sys.argv) > 2 else 2
    with ThreadPoolExecutor(at_once) as pool:
        results = list(pool.map(attempt, range(runs)))
    failed = [r for r in results if isinstance(r, str)]
    seconds = sorted(r.seconds for r in results if not isinstance(r, str))
    edits = sorted(r.edits for r in results if not isinstance(r, str))
    for sentence in failed:
        print(sentence)
    print(f"{len(seconds)} of {runs} recovered; seconds of edits lost: ", end="")
    print(f"median {seconds[len(seconds) // 2]:.2f}, most {seconds[-1]:.2f}" if seconds else "all")
    print(f"edits made: {edits[0]} to {edits[-1]} a run, {sum(edits)} in all" if edits else "")
    return bool(failed) or not seconds or seconds[-1] > ALLOWED_S


if __name__ == "__main__":
    sys.exit(main())

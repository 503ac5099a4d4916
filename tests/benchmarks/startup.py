"""The time to the first word of the command line, as a ratio to an empty Python; and to the painted window.

Run from the root: python tests/benchmarks/startup.py
"""

import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).parents[2]


def milliseconds(words, repeats=21):
    """Return the median of runs of Python with these words."""
    times = []
    for _ in range(repeats):
        began = time.perf_counter()
        subprocess.run([sys.executable, *words], stdout=subprocess.DEVNULL, cwd=ROOT, check=True)
        times.append(1000 * (time.perf_counter() - began))
    return statistics.median(times)


WINDOW = """
import resources
from app.bootstrap import Editor, make_application
app = make_application()
editor = Editor()
editor.files.open_sample(resources.samples()[0])
editor.window.show()
app.processEvents()
editor.window.canvas.viewport().repaint()
editor.preview.stop()
editor.ranked.stop()
"""


def main():
    """Print every figure."""
    empty = milliseconds(["-c", "pass"])
    console_script = "import sys; from app.cli import main; sys.exit(main(['--help']))"
    print(f"python -c pass: {empty:.1f} ms")
    for name, words in (
        ("inkbetween --help", ["-c", console_script]),
        ("python -m app --help", ["-m", "app", "--help"]),
    ):
        took = milliseconds(words)
        print(f"{name}: {took:.1f} ms, {took / empty:.2f} times (goal under 3)")
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    print(f"the window with a sample, painted: {milliseconds(['-c', WINDOW], 5):.0f} ms (goal under 2500)")


if __name__ == "__main__":
    main()

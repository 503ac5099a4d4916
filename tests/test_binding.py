"""The Qt binding itself: one release lost a reference to None at most void calls and aborted after some thousands.

A short test does not notice, a day of drawing does; so the calls are made here, in a process that may die.
"""

import re
import subprocess
import sys
import tomllib
from importlib.metadata import version
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
CALLS = 20_000
SCRIPT = """
import sys
from PySide6.QtCore import QObject
from PySide6.QtGui import QImage, QPainter, QPolygonF, QTransform

calls = int(sys.argv[1])
thing, image, polygon = QObject(), QImage(8, 8, QImage.Format.Format_RGB32), QPolygonF()
painter = QPainter(image)
for _ in range(calls):
    thing.setObjectName("x")
    painter.setOpacity(0.5)
    painter.setTransform(QTransform())
    polygon.clear()
painter.end()
print("alive")
"""


def test_void_calls_by_the_ten_thousand_leave_the_interpreter_alive():
    ended = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(CALLS)], capture_output=True, text=True, timeout=120, check=False
    )
    assert (ended.returncode, ended.stdout) == (0, "alive\n"), ended.stderr


@pytest.mark.parametrize("package", ["PySide6-Essentials", "shiboken6"])
def test_the_installed_qt_is_in_the_range_that_was_tried(package):
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    (pin,) = [x for x in tomllib.loads(text)["project"]["dependencies"] if x.startswith("PySide6")]
    low, high = re.fullmatch(r"PySide6-Essentials>=([\d.]+),<([\d.]+)", pin).groups()
    assert _numbers(low) <= _numbers(version(package)) < _numbers(high)


def _numbers(text):
    return tuple(map(int, re.findall(r"\d+", text)))

"""A sheet of all pictures beside each other, and a JSON that says which is where and for how long."""

import contextlib
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QImage, QPainter

from app.export.film import Film, Shot
from app.export.frames import look_of
from app.export.png import encode_png
from app.export.pool import painted, useful_processes
from app.export.render import Job
from app.export.whole import whole_file
from core.errors import InkbetweenError

LARGEST_SIDE = 32_767
LARGEST_SHEET = 400_000_000
"""Pixels: 1.6 GB of memory."""


def write(film: Film, path: Path, told: Callable[[object], object], cancelled: Callable[[], bool]) -> bool:
    """Write the sheet and its JSON; False if it was cancelled, and then there is neither."""
    shots = film.shots()
    columns, rows = _grid(len(shots), film.settings.size)
    sheet = _sheet(film, shots, columns, rows, told, cancelled)
    if sheet is None:
        return False
    text = json.dumps(_described(film, path.name, shots, columns, rows), indent=1, ensure_ascii=False)
    # both are whole before either takes its name
    with whole_file(path) as picture, whole_file(path.with_suffix(".json")) as description:
        picture.write_bytes(encode_png(sheet))
        description.write_bytes(text.encode() + b"\n")
    return True


def _grid(count: int, size: tuple[int, int]) -> tuple[int, int]:
    """Return columns and rows of a sheet about as wide as high; raises InkbetweenError if it is too large."""
    width, height = size
    columns = max(1, min(count, round(math.sqrt(count * height / width))))
    rows = math.ceil(count / columns)
    wide, high = columns * width, rows * height
    if max(wide, high) > LARGEST_SIDE or wide * high > LARGEST_SHEET:
        raise InkbetweenError(f"the sheet would have {wide} x {high} px; choose a smaller size or fewer frames")
    return columns, rows


def _sheet(
    film: Film,
    shots: list[Shot],
    columns: int,
    rows: int,
    told: Callable[[object], object],
    cancelled: Callable[[], bool],
) -> QImage | None:
    width, height = film.settings.size
    look = look_of(film)
    sheet = QImage(columns * width, rows * height, QImage.Format.Format_RGBA8888)
    if sheet.isNull():
        raise InkbetweenError("no memory for so large a sheet; choose a smaller size or fewer frames")
    sheet.fill(Qt.GlobalColor.transparent)
    processes = film.settings.processes or useful_processes(len(shots), film.settings.size)
    jobs = (Job(film.pictures(shot)) for shot in shots)
    painter = QPainter(sheet)
    painter.setCompositionMode(QPainter.CompositionMode.CompositionMode_Source)
    done = 0
    try:
        with contextlib.closing(painted(jobs, look, processes, cancelled)) as found:
            for i, pixels in enumerate(found):
                cell = QImage(pixels, width, height, 4 * width, QImage.Format.Format_RGBA8888)
                painter.drawImage(QPoint(i % columns * width, i // columns * height), cell)
                told(shots[i])
                done += 1
    finally:
        painter.end()
    return sheet if done == len(shots) and not cancelled() else None


def _described(film: Film, picture: str, shots: list[Shot], columns: int, rows: int) -> dict[str, Any]:
    width, height = film.settings.size
    frames = [
        {
            "filename": f"{film.settings.name} {shot.frame}",
            "frame": {"x": i % columns * width, "y": i // columns * height, "w": width, "h": height},
            "rotated": False,
            "trimmed": False,
            "spriteSourceSize": {"x": 0, "y": 0, "w": width, "h": height},
            "sourceSize": {"w": width, "h": height},
            "duration": round(1000 * (i + 1) / film.rate) - round(1000 * i / film.rate),
        }
        for i, shot in enumerate(shots)
    ]
    meta = {
        "app": "inkbetween",
        "image": picture,
        "format": "RGBA8888",
        "size": {"w": columns * width, "h": rows * height},
        "scale": "1",
        "frameRate": float(film.rate),
    }
    return {"frames": frames, "meta": meta}

"""Open Cel Animation: a folder of drawings a layer, and a file that says when each is seen.

Krita, OpenToonz and After Effects read it. The folder is made under another name and renamed when it is whole.
"""

import contextlib
import json
import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

from app.export.drawings import Cell, cells_of
from app.export.film import Film
from app.export.frames import look_of
from app.export.names import layer_names
from app.export.pool import painted, useful_processes
from app.export.render import Job, Look
from app.export.whole import InTheWayError, reason, temporary_of, write_whole
from core.errors import StorageError
from core.model.document import Layer

VERSION = "1.2.0"
CLEAR = (0.0, 0.0, 0.0, 0.0)

Json = dict[str, Any]


def write(film: Film, path: Path, told: Callable[[object], object], cancelled: Callable[[], bool]) -> bool:
    """Write the folder; False if it was cancelled, and then there is none."""
    part = temporary_of(path)
    try:
        part.mkdir()
        if not _fill(film, part, path.stem, told, cancelled):
            return False
        _take_place(part, path)
    except StorageError as e:  # of a file in the folder under its other name
        raise StorageError(str(e).replace(str(part), str(path))) from e
    except OSError as e:
        raise StorageError(f"cannot write {path}: {reason(e)}") from e
    finally:
        shutil.rmtree(part, ignore_errors=True)
    return True


def _take_place(part: Path, path: Path) -> None:
    """Rename the whole folder; an older export is taken away, a folder of something else is not."""
    if not os.path.lexists(path):
        part.rename(path)
        return
    if not path.is_dir() or (any(path.iterdir()) and not any(path.glob("*.oca"))):
        raise InTheWayError([path])
    old = path.with_name(f".{path.name}.{os.getpid()}.old")
    path.rename(old)
    try:
        part.rename(path)
    except OSError:
        old.rename(path)
        raise
    with contextlib.suppress(OSError):
        shutil.rmtree(old)


def _fill(
    film: Film, folder: Path, name: str, told: Callable[[object], object], cancelled: Callable[[], bool]
) -> bool:
    layers = tuple(x for x in film.document.layers if x.visible)
    names = layer_names(layers)
    cells = {x.id: cells_of(film, x) for x in layers}
    jobs: list[Job] = []
    for layer in layers:
        (folder / names[layer.id]).mkdir()
        drawn = [c for c in cells[layer.id] if c.number]
        jobs += [Job(c.pictures, folder / _file_of(names[layer.id], c)) for c in drawn]
    look = look_of(film)
    look = Look(look.stage, look.size, None)
    processes = film.settings.processes or useful_processes(len(jobs), look.size)
    with contextlib.closing(painted(jobs, look, processes, cancelled)) as done:
        count = sum(1 for _ in done)
    if count < len(jobs) or cancelled():
        return False
    made = _document(film, [_layer(film, x, names[x.id], cells[x.id]) for x in layers])
    write_whole(folder / f"{name}.oca", json.dumps(made, indent=1, ensure_ascii=False).encode() + b"\n")
    for shot in film.shots():
        told(shot)
    return True


def _file_of(layer: str, cell: Cell) -> str:
    return f"{layer}/{_name_of(layer, cell)}.png"


def _name_of(layer: str, cell: Cell) -> str:
    return f"{layer}_{cell.frame:05}"


def _document(film: Film, layers: list[Json]) -> Json:
    color = film.background
    shade = [round(c / 255, 5) for c in bytes.fromhex(color[1:].ljust(8, "f"))] if color else list(CLEAR)
    width, height = film.settings.size
    return {
        "name": film.settings.name,
        "frameRate": float(film.document.rate),
        "width": width,
        "height": height,
        "startTime": 0,
        "endTime": film.settings.last - film.settings.first + 1,
        "colorDepth": "U8",
        "backgroundColor": shade,
        "layers": layers,
        "ocaVersion": VERSION,
    }


def _layer(film: Film, layer: Layer, name: str, cells: list[Cell]) -> Json:
    return _box(film) | {
        "name": name,
        "frames": [_frame(film, name, cell) for cell in cells],
        "childLayers": [],
        "type": "paintlayer",
        "fileType": "png",
        "blendingMode": "normal",
        "animated": len(cells) > 1,
        "label": 0,
        "opacity": 1.0,
        "visible": True,
        "passThrough": False,
        "reference": False,
        "inheritAlpha": False,
    }


def _frame(film: Film, layer: str, cell: Cell) -> Json:
    times = {"frameNumber": cell.frame, "duration": cell.count, "opacity": 1.0}
    if not cell.number:
        return _box(film) | times | {"name": "_blank", "fileName": ""}
    return _box(film) | times | {"name": _name_of(layer, cell), "fileName": _file_of(layer, cell)}


def _box(film: Film) -> Json:
    """Return where a picture lies: its middle, and its size."""
    width, height = film.settings.size
    return {"position": [width // 2, height // 2], "width": width, "height": height}

"""Exposure sheet as XDTS, which Clip Studio Paint and OpenToonz read.

One line that names the format, then JSON. A column a layer, the one at the back first; a cell is named where it
begins and holds until the next one. A cross (`SYMBOL_NULL_CELL`) is where the column is empty.
"""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from app.export.drawings import cells_of
from app.export.film import Film
from app.export.names import layer_names
from app.export.whole import write_whole

HEADER = "exchangeDigitalTimeSheet Save Data"
VERSION = 5
CELLS = 0
"""The field of the drawings; others are for dialogue and camera."""
EMPTY = "SYMBOL_NULL_CELL"


def write(film: Film, path: Path, told: Callable[[object], object], cancelled: Callable[[], bool]) -> bool:
    """Write the sheet; False if it was cancelled, and then there is no file."""
    text = json.dumps(sheet(film), indent=1, ensure_ascii=False)
    if cancelled():
        return False
    write_whole(path, f"{HEADER}\n{text}\n".encode())
    for shot in film.shots():
        told(shot)
    return True


def sheet(film: Film) -> dict[str, Any]:
    """Return the sheet as what JSON can hold."""
    layers = tuple(x for x in film.document.layers if x.visible)
    names = layer_names(layers)
    count = film.settings.last - film.settings.first + 1
    tracks = [{"trackNo": i, "frames": _column(film, layer, count)} for i, layer in enumerate(layers)]
    table = {
        "name": film.settings.name,
        "duration": count,
        "fields": [{"fieldId": CELLS, "tracks": tracks}],
        "timeTableHeaders": [{"fieldId": CELLS, "names": [names[x.id] for x in layers]}],
    }
    return {"header": {"cut": "1", "scene": "1"}, "timeTables": [table], "version": VERSION}


def _column(film: Film, layer: Any, count: int) -> list[dict[str, Any]]:
    """Return what begins where; behind the last frame the column is empty."""
    found = [(c.frame, str(c.number) if c.number else EMPTY) for c in cells_of(film, layer)]
    return [{"frame": frame, "data": [{"id": 0, "values": [value]}]} for frame, value in [*found, (count, EMPTY)]]

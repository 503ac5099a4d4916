"""What every layer shows as drawings with numbers, as an exposure sheet names them."""

from dataclasses import dataclass, replace

from app.export.film import Film, Pictures, same_pictures
from core.model.document import Layer
from core.model.motion import picture_at


@dataclass(frozen=True, slots=True, eq=False)
class Cell:
    """A drawing of one layer, and how long it is held.

    Attributes
    ----------
    frame : int
        Where it begins, from 0: the first frame of the export.
    count : int
        Frames.
    number : int
        From 1, in the order of time; 0 where the layer shows nothing.
    pictures : tuple of Picture
        What is seen, or nothing.
    key : bool
        Whether the artist drew it.
    """

    frame: int
    count: int
    number: int
    pictures: Pictures
    key: bool


def cells_of(film: Film, layer: Layer) -> list[Cell]:
    """Return the drawings of a layer in the range of the export."""
    keys = set(layer.frames())
    cells: list[Cell] = []
    drawn = 0
    for index, frame in enumerate(range(film.settings.first, film.settings.last + 1)):
        picture = picture_at(film.document, layer, frame, film.plans)
        pictures = (picture,) if picture is not None and picture.outlines else ()
        if cells and same_pictures(cells[-1].pictures, pictures):
            cells[-1] = replace(cells[-1], count=cells[-1].count + 1)
            continue
        drawn += bool(pictures)
        cells.append(Cell(index, 1, drawn if pictures else 0, pictures, frame in keys))
    return cells

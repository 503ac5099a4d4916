"""Drawings that came from another program's file, and how they are put into a document."""

from collections import Counter
from dataclasses import dataclass, replace

import numpy as np

from core.errors import DocumentError
from core.geometry.outline import FloatArray
from core.model.document import LONGEST_NAME, Document, Stage
from core.model.drawing import WIDEST_STROKE, Drawing, Outline, Style
from core.model.edits import add_layer, put_drawing

MOST_LAYERS = 100


@dataclass(frozen=True, slots=True, eq=False)
class ImportedDrawing:
    """One path or shape.

    Attributes
    ----------
    outlines : tuple of (points, closed)
        Points (n, 2) in px, y down; closed ones fill even-odd.
    style : Style
    name : str
        What the other program called it; may be empty.
    """

    outlines: tuple[tuple[FloatArray, bool], ...]
    style: Style
    name: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Imported:
    """What was found in a file.

    Attributes
    ----------
    drawings : tuple of ImportedDrawing
        From the back to the front; at least one.
    size : (float, float)
        Width and height of the picture in px.
    left_out : tuple of str
        What was not taken over, or not as it looked: "2 texts", "a gradient (painted in its first colour)".
    """

    drawings: tuple[ImportedDrawing, ...]
    size: tuple[float, float]
    left_out: tuple[str, ...] = ()

    @property
    def styles(self) -> int:
        """Number of different styles."""
        return len({d.style for d in self.drawings})


def remark(imported: Imported, *, as_one: bool = False) -> str:
    """Return what became of things that were not taken over as they were, as half a sentence; "" if nothing."""
    names = list(imported.left_out)
    if as_one and imported.styles > 1:
        names.append(f"{imported.styles - 1} of {imported.styles} styles (a keyframe has one, the first is used)")
    return f"not taken over: {', '.join(names)}" if names else ""


def fitted(imported: Imported, stage: Stage) -> Imported:
    """Return the drawings in the middle of the stage, made smaller if the picture is larger than the stage.

    A picture as large as the stage stays exactly where it is; a smaller one keeps its size, so that several
    pictures from one program keep theirs to each other.
    """
    wide, high = imported.size
    scale = min(1.0, stage.width / wide, stage.height / high)
    shift = np.array([stage.width - wide * scale, stage.height - high * scale]) / 2
    if scale == 1.0 and not shift.any():
        return imported
    return replace(imported, drawings=tuple(_moved(d, scale, shift) for d in imported.drawings))


def _moved(drawing: ImportedDrawing, scale: float, shift: FloatArray) -> ImportedDrawing:
    outlines = tuple((points * scale + shift, closed) for points, closed in drawing.outlines)
    style = replace(drawing.style, width=min(drawing.style.width * scale, WIDEST_STROKE))
    return replace(drawing, outlines=outlines, style=style)


def as_drawing(imported: Imported) -> Drawing:
    """Return one drawing with all outlines, painted like the first one."""
    return _drawing(imported.drawings, imported.drawings[0].style)


def import_keyframe(document: Document, layer_id: int, frame: int, imported: Imported) -> Document:
    """Make everything that was imported the keyframe at `frame`, in place of one that is there."""
    return put_drawing(document, layer_id, frame, as_drawing(imported))


def import_layers(document: Document, frame: int, imported: Imported) -> Document:
    """Add what was imported as layers in front, each with one keyframe.

    Paths that lie on each other in the order of painting share a layer when they are painted alike and do not
    overlap: then nothing looks different, and there are no more layers than needed.
    """
    groups = painted_alike(imported.drawings)
    if len(groups) > MOST_LAYERS:
        raise DocumentError(
            f"the picture would become {len(groups)} layers, the limit is {MOST_LAYERS}; import it as a keyframe, "
            "or join paths of one colour first"
        )
    used: Counter[str] = Counter()
    for group in groups:
        name = next((d.name for d in group if d.name), "Imported")[: LONGEST_NAME - 10]
        used[name] += 1
        document = add_layer(document, name if used[name] == 1 else f"{name} {used[name]}")
        document = put_drawing(document, document.layers[-1].id, frame, _drawing(group, group[0].style))
    return document


def painted_alike(drawings: tuple[ImportedDrawing, ...]) -> list[tuple[ImportedDrawing, ...]]:
    """Return runs of drawings that one layer can show without looking different."""
    boxes = np.array([_box(d) for d in drawings])
    starts: list[int] = []
    for i, drawing in enumerate(drawings):
        alike = bool(starts) and drawings[starts[-1]].style == drawing.style
        if not alike or _overlaps(boxes[starts[-1] : i], boxes[i]):
            starts.append(i)
    return [drawings[a:b] for a, b in zip(starts, [*starts[1:], len(drawings)], strict=True)]


def _drawing(drawings: tuple[ImportedDrawing, ...], style: Style) -> Drawing:
    shapes = [shape for d in drawings for shape in d.outlines]
    return Drawing(tuple(Outline(i, p, closed) for i, (p, closed) in enumerate(shapes, start=1)), style)


def _box(drawing: ImportedDrawing) -> FloatArray:
    """Return left, top, right and bottom, with half the stroke."""
    every = np.concatenate([points for points, _ in drawing.outlines])
    reach = drawing.style.width / 2 if drawing.style.stroke else 0.0
    return np.concatenate([every.min(axis=0) - reach, every.max(axis=0) + reach])


def _overlaps(others: FloatArray, box: FloatArray) -> bool:
    apart = (others[:, :2] >= box[2:]).any(axis=1) | (others[:, 2:] <= box[:2]).any(axis=1)
    return not bool(apart.all())

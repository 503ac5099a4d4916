"""Keyframes that came from another program: layers of drawings in time, and how they get into a document."""

from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from core.errors import DocumentError
from core.model.document import LARGEST_STAGE, LONGEST, LONGEST_NAME, Document, Keyframe, Layer, Stage
from core.model.drawing import WIDEST_STROKE, Color, Drawing, Outline
from core.model.edits import add_layer, set_length

MOST_LAYERS = 100


@dataclass(frozen=True, slots=True, eq=False)
class ImportedLayer:
    """One layer.

    Attributes
    ----------
    name : str
    keyframes : tuple of Keyframe
        Frames strictly rising; the first frame of the film is 1.
    """

    name: str
    keyframes: tuple[Keyframe, ...]


@dataclass(frozen=True, slots=True, eq=False)
class ImportedFilm:
    """What was found in a file or folder.

    Attributes
    ----------
    layers : tuple of ImportedLayer
        From the back to the front; at least one.
    size : (float, float)
        Width and height of the picture in px.
    length : int
        Number of frames.
    rate : Fraction or None
        Frames a second, if the file says so.
    background : Color or None
    left_out : tuple of str
        What was not taken over, or not as it looked.
    """

    layers: tuple[ImportedLayer, ...]
    size: tuple[float, float]
    length: int
    rate: Fraction | None = None
    background: Color | None = None
    left_out: tuple[str, ...] = ()


def film_remark(film: ImportedFilm) -> str:
    """Return what became of things that were not taken over, as half a sentence; "" if nothing."""
    return f"not taken over: {', '.join(film.left_out)}" if film.left_out else ""


def import_film(document: Document, film: ImportedFilm, frame: int = 1) -> Document:
    """Add the layers in front, fitted into the stage, beginning at `frame`; a film that is too short grows.

    Raises DocumentError where there would be too many layers or frames.
    """
    if len(film.layers) > MOST_LAYERS:
        raise DocumentError(f"it would become {len(film.layers)} layers, the limit is {MOST_LAYERS}")
    end = frame - 1 + max(film.length, *(k.frame for x in film.layers for k in x.keyframes))
    if end > LONGEST:
        raise DocumentError(f"the film would have {end} frames, the limit is {LONGEST}")
    scale, shift = _fit(film.size, document.stage)
    for layer in film.layers:
        document = add_layer(document, layer.name[:LONGEST_NAME] or "Imported")
        keyframes = tuple(_placed(k, frame - 1, scale, shift) for k in layer.keyframes)
        document = document.with_layer(replace(document.layers[-1], keyframes=keyframes))
    return set_length(document, max(document.length, end))


def film_document(film: ImportedFilm) -> Document:
    """Return a new document of what was imported: its size, its rate, its length."""
    scale = min(1.0, LARGEST_STAGE / max(film.size))
    width, height = (min(max(int(np.ceil(side * scale - 1e-6)), 1), LARGEST_STAGE) for side in film.size)
    stage = Stage(width, height, film.background)
    empty = Document(stage, film.rate or Document().rate, max(film.length, 1), (Layer(1),))
    made = import_film(empty, film)
    layers = tuple(replace(x, id=i) for i, x in enumerate(made.layers[1:], start=1))
    return replace(made, layers=layers)


def _fit(size: tuple[float, float], stage: Stage) -> tuple[float, np.ndarray]:
    wide, high = size
    scale = min(1.0, stage.width / wide, stage.height / high)
    return scale, np.array([stage.width - wide * scale, stage.height - high * scale]) / 2


def _placed(keyframe: Keyframe, later: int, scale: float, shift: np.ndarray) -> Keyframe:
    """Return a keyframe at its frame and place in the document."""
    if scale == 1.0 and not shift.any():
        return replace(keyframe, frame=keyframe.frame + later)
    drawing = keyframe.drawing
    outlines = tuple(Outline(o.id, o.points * scale + shift, o.closed) for o in drawing.outlines)
    style = replace(drawing.style, width=min(drawing.style.width * scale, WIDEST_STROKE))
    return replace(keyframe, frame=keyframe.frame + later, drawing=Drawing(outlines, style))

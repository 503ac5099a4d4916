"""Documents for the endurance scripts: one whose number can be read from it, and large ones."""

from dataclasses import replace

import numpy as np

from core.model.document import Document, Keyframe, Layer
from core.model.drawing import Drawing, Outline


def many_vertices(count, outlines=8, keyframes=2):
    """Return a document with `count` vertices in all."""
    turn = np.linspace(0, 2 * np.pi, count // (outlines * keyframes), endpoint=False)
    random = np.random.default_rng(6)

    def drawing():
        reach = 200 + 40 * random.standard_normal((outlines, len(turn)))
        rings = np.stack([reach * np.cos(turn) + 960, reach * np.sin(turn) + 540], axis=-1)
        return Drawing(tuple(Outline(i + 1, ring) for i, ring in enumerate(rings)))

    frames = [Keyframe(1 + 10 * i, drawing()) for i in range(keyframes)]
    return numbered(Document(length=10 * keyframes + 1, layers=(Layer(1, keyframes=tuple(frames)),)), 0)


def numbered(document, number):
    """Return the document with the first vertex of all moved to x = number."""
    layer = document.layers[0]
    keyframe = layer.keyframes[0]
    outline = keyframe.drawing.outlines[0]
    points = outline.points.copy()
    points[0, 0] = number
    drawing = keyframe.drawing.with_outline(replace(outline, points=points))
    changed = replace(layer, keyframes=(replace(keyframe, drawing=drawing), *layer.keyframes[1:]))
    return document.with_layer(changed)


def number_of(document):
    """Return the number that `numbered` wrote, 0 where there is no drawing yet."""
    keyframes = document.layers[0].keyframes
    return round(keyframes[0].drawing.outlines[0].points[0, 0]) if keyframes else 0

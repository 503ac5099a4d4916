"""The sample of a bouncing ball: it falls by gravity, stretches with its speed, is squashed, keeps its area."""

from itertools import pairwise

import numpy as np

from core.geometry.outline import FloatArray
from core.model import edits
from core.model.document import Anchor, Document
from core.model.drawing import Drawing, Outline, Style
from core.model.easing import Easing

RADIUS, FLOOR = 92.0, 930.0
GRAVITY = 11.6
"""Px a frame and frame."""

CONTACTS = (11, 29, 43, 53)
APEXES = (1, 20, 36, 48, 56)
LAST = 60
START, SPEED = 240.0, 24.0
VERTICES = 32
BALL = Style("#e4572e", "#8f2f13", 6.0)
SHADOW = Style("#2e3440", None, 0.0)


def bouncing_ball() -> Document:
    """Return a ball that bounces to the right and comes to rest, and its shadow."""
    film = edits.set_layer(edits.set_length(Document(), LAST), 1, name="shadow")
    film = edits.add_layer(film, "ball")
    for frame in _frames():
        film = edits.put_drawing(film, 2, frame, Drawing((Outline(1, _ball(frame)),), BALL))
    for frame in sorted({*CONTACTS, *APEXES, LAST}):
        film = edits.put_drawing(film, 1, frame, _shadow(frame))
    for layer in (1, 2):
        film = _tied(film, layer)
    hit = {c + beside for c in CONTACTS for beside in (-1, 0, 1)}
    smooth = [f for f in _frames()[1:-1] if f not in hit]
    return edits.set_smooth(film, 2, smooth, True)


def _tied(film: Document, layer: int) -> Document:
    """Let every span go straight and evenly, vertex by vertex."""
    frames = film.layer(layer).frames()
    for before in frames[:-1]:
        film = edits.set_span(film, layer, before, method="linear", easing=Easing())
        for i in range(0, VERTICES, VERTICES // 4):
            film = edits.add_anchor(film, layer, before, 1, 1, Anchor(float(i), float(i)))
    return film


def _frames() -> list[int]:
    """Return the frames of the keyframes: contacts, a frame beside them, apexes, and some between."""
    chosen = {1, *CONTACTS, *APEXES, LAST}
    for contact in CONTACTS:
        chosen |= {contact - 1, contact + 1}
    while gaps := [(a, b) for a, b in pairwise(sorted(chosen)) if b - a > 3]:
        chosen |= {(a + b) // 2 for a, b in gaps}
    return sorted(chosen)


def _height(frame: float) -> tuple[float, float]:
    """Return how high the lowest point of a round ball is, and how fast it rises, px a frame."""
    apex = min(APEXES, key=lambda a: (abs(a - frame), a)) if frame <= 56 else 56
    starts = [c for c in CONTACTS if c <= frame]
    if starts and frame < LAST:
        apex = APEXES[CONTACTS.index(starts[-1]) + 1]
    half = (CONTACTS[APEXES.index(apex)] - apex) if apex in APEXES[:-1] else 3
    if frame >= 59:
        return 0.0, 0.0
    top = GRAVITY * half * half / 2
    return max(top - GRAVITY * (frame - apex) ** 2 / 2, 0.0), -GRAVITY * (frame - apex)


def _ball(frame: int) -> FloatArray:
    turn = 2 * np.pi * np.arange(VERTICES) / VERTICES
    circle = RADIUS * np.column_stack([np.sin(turn), -np.cos(turn)])
    height, rise = _height(frame)
    x = START + SPEED * (frame - 1) * (1 - 0.004 * max(frame - 40, 0))
    if frame in CONTACTS:
        flat = (0.62, 0.70, 0.78, 0.88)[CONTACTS.index(frame)]
        points = circle * (1 / flat, flat)
        low = RADIUS * flat
    else:
        speed = np.hypot(SPEED, rise)
        long = 1 + 0.24 * (speed / 120) ** 2 if height > 0 else 1.0
        way = np.array([SPEED, -rise]) / speed
        stretch = long * np.outer(way, way) + (np.eye(2) - np.outer(way, way)) / long
        points = circle @ stretch
        low = float(points[:, 1].max())
    return np.round(points + np.array([x, FLOOR - low - height]), 2) + 0.0


def _shadow(frame: int) -> Drawing:
    turn = 2 * np.pi * np.arange(VERTICES) / VERTICES
    height, _ = (0.0, 0.0) if frame in CONTACTS else _height(frame)
    x = _ball(frame).mean(axis=0)[0]
    wide = RADIUS * (1.25 - 0.9 * height / 1000)
    points = np.column_stack([x + wide * np.sin(turn), FLOOR + 12 - 14 * np.cos(turn)])
    style = Style(SHADOW.fill, None, 0.0, round(0.34 - 0.26 * height / 600, 3))
    return Drawing((Outline(1, np.round(points, 2) + 0.0),), style)

"""How large a picture is, and how a viewBox fills its room."""

from xml.etree.ElementTree import Element

from core.io.svg_path import NUMBER
from core.io.svg_style import Matrix, length

FARTHEST = 1e6
"""In px; what lies beyond is no drawing."""


def root_place(root: Element) -> tuple[tuple[float, float] | None, tuple[float, float], Matrix]:
    """Return the picture's size in px (None: not stated), its viewport in user units, and the matrix between."""
    box = view_box(root)
    natural = (box[2], box[3]) if box else (0.0, 0.0)
    stated = [length(root.get(n, ""), whole) for n, whole in zip(("width", "height"), natural, strict=True)]
    sizes = [s if 0 < s <= FARTHEST else 0.0 for s in stated]
    if box is None:
        known = (sizes[0], sizes[1]) if sizes[0] and sizes[1] else None
        return known, known or (300.0, 150.0), (1, 0, 0, 1, 0, 0)
    wide, high = sizes
    if not wide and not high:
        wide, high = natural
    wide = wide or high * natural[0] / natural[1]
    high = high or wide * natural[1] / natural[0]
    return (wide, high), natural, box_fit(box, (wide, high), root.get("preserveAspectRatio", ""))


def view_box(element: Element) -> tuple[float, float, float, float] | None:
    """Return left, top, width and height of a viewBox that makes sense."""
    numbers = [float(x) for x in NUMBER.findall(element.get("viewBox", ""))]
    if len(numbers) != 4 or not all(abs(n) <= FARTHEST for n in numbers) or min(numbers[2:]) <= 0:
        return None
    return numbers[0], numbers[1], numbers[2], numbers[3]


def box_fit(box: tuple[float, float, float, float], room: tuple[float, float], how: str) -> Matrix:
    """Return the matrix that puts a viewBox into its room, as preserveAspectRatio says."""
    left, top, wide, high = box
    sx, sy = room[0] / wide, room[1] / high
    if "none" not in how:
        sx = sy = max(sx, sy) if "slice" in how else min(sx, sy)
    x = _aligned(how, "x", room[0] - wide * sx)
    y = _aligned(how, "Y", room[1] - high * sy)
    return sx, 0.0, 0.0, sy, x - left * sx, y - top * sy


def _aligned(how: str, axis: str, spare: float) -> float:
    if f"{axis}Min" in how:
        return 0.0
    return spare if f"{axis}Max" in how else spare / 2

"""Path data and basic shapes of SVG as chains of cubic curves.

svgelements reads path data too, but number by number through several calls, and it cannot be stopped on the way.
"""

import cmath
import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
_COMMAND = re.compile(r"([MmZzLlHhVvCcSsQqTtAa])([^MmZzLlHhVvCcSsQqTtAa]*)")
_FOREIGN = re.compile(r"[^MmZzLlHhVvCcSsQqTtAaEe0-9+\-.,\s]")
_GAP = r"[\s,]*"
_ARC = re.compile(_GAP.join([f"({NUMBER.pattern})"] * 3 + ["([01])"] * 2 + [f"({NUMBER.pattern})"] * 2), re.ASCII)

COUNTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7}
ARC_PIECE = math.pi / 4
"""Widest angle of a curve that stands for an arc: it is then right to 4 millionths of the radius."""

Curve = tuple[complex, complex, complex, complex]
Step = Callable[[float], object]


@dataclass(slots=True)
class Subpath:
    """One line of a path: cubic curves, straight ones marked, in user units."""

    start: complex
    curves: list[Curve] = field(default_factory=list)
    straight: list[bool] = field(default_factory=list)
    closed: bool = False


class Trail:
    """Collects subpaths as a pen draws them."""

    def __init__(self, step: Step) -> None:
        self.subpaths: list[Subpath] = []
        self.at = 0j
        self.whole = True
        self._step = step
        self._open: Subpath | None = None

    def move(self, to: complex) -> None:
        """Lift the pen and begin a subpath at `to`."""
        self.at = to
        self._open = None

    def line(self, to: complex) -> None:
        """Draw a straight line."""
        self._add((self.at, self.at, to, to), straight=True)

    def cubic(self, b: complex, c: complex, to: complex) -> None:
        """Draw a cubic curve."""
        self._add((self.at, b, c, to), straight=False)

    def quadratic(self, b: complex, to: complex) -> None:
        """Draw a quadratic curve, as the cubic one that it is."""
        self.cubic(self.at + (b - self.at) * (2 / 3), to + (b - to) * (2 / 3), to)

    def arc(self, radii: complex, angle: float, large: bool, sweep: bool, to: complex) -> None:
        """Draw part of an ellipse turned by `angle` degrees (SVG 1.1, appendix F.6)."""
        rx, ry = abs(radii.real), abs(radii.imag)
        if to == self.at:
            return
        if rx == 0 or ry == 0 or not cmath.isfinite(radii) or not math.isfinite(angle):
            self.line(to)
            return
        turn = cmath.rect(1, math.radians(angle))
        half = (self.at - to) / 2 / turn
        p = complex(half.real / rx, half.imag / ry)  # half the chord, where the ellipse is a circle of radius 1
        far = abs(p)
        if far > 1:  # too small to reach: as large as needed
            rx, ry, p, far = rx * far, ry * far, p / far, 1.0
        side = -1 if large == sweep else 1
        middle = side * math.sqrt(max(0.0, 1 / far**2 - 1)) * complex(p.imag, -p.real)
        start, end = p - middle, -p - middle
        swept = cmath.phase(end / start)
        if sweep and swept < 0:
            swept += 2 * math.pi
        elif not sweep and swept > 0:
            swept -= 2 * math.pi

        mid = (self.at + to) / 2

        def place(unit: complex) -> complex:
            return complex(rx * unit.real, ry * unit.imag) * turn + mid

        self._round(start, middle, swept, place, to)

    def _round(
        self, start: complex, middle: complex, swept: float, place: Callable[[complex], complex], to: complex
    ) -> None:
        """Draw an arc of a unit circle about `middle`, whose points `place` carries to where they belong."""
        count = max(1, math.ceil(abs(swept) / ARC_PIECE - 1e-9))
        piece = swept / count
        reach = 4 / 3 * math.tan(piece / 4) * 1j
        for i in range(count):
            p = start * cmath.rect(1, i * piece)
            q = start * cmath.rect(1, (i + 1) * piece)
            end = to if i == count - 1 else place(middle + q)
            self.cubic(place(middle + p + reach * p), place(middle + q - reach * q), end)

    def close(self) -> None:
        """Go straight back to where the subpath began."""
        if self._open is None:
            return
        self._open.closed = True
        self.at = self._open.start
        self._open = None

    def _add(self, curve: Curve, *, straight: bool) -> None:
        if self._open is None:
            self._open = Subpath(self.at)
            self.subpaths.append(self._open)
        self._open.curves.append(curve)
        self._open.straight.append(straight)
        self.at = curve[3]


class _Reader:
    """Reads path data; what comes before the first mistake is drawn, as the standard wants."""

    def __init__(self, trail: Trail, step: Step) -> None:
        self.trail = trail
        self._step = step
        self._control: complex | None = None
        self._control_of = ""

    def read(self, text: str) -> None:
        trail = self.trail
        foreign = _FOREIGN.search(text)
        if foreign:
            text, trail.whole = text[: foreign.start()], False
        began = False
        for match in _COMMAND.finditer(text):
            letter, numbers = match.groups()
            if not began and letter not in "Mm":
                break
            began = True
            if not self._run(letter, numbers):
                trail.whole = False
                return
        trail.whole &= began or not text.strip()

    def _run(self, letter: str, text: str) -> bool:
        """Draw one command with all its repetitions; False where its numbers break off."""
        upper = letter.upper()
        if upper == "Z":
            self.trail.close()
            self._control = None
            return not text.strip()
        done = 0
        for group in self._groups(upper, text):
            origin = self.trail.at if letter.islower() else 0j
            if not self._draw("L" if upper == "M" and done else upper, group, origin):
                return False
            done += 1
        return done > 0 and self._complete

    def _groups(self, upper: str, text: str) -> Iterator[list[float]]:
        count = COUNTS[upper]
        self._complete = True
        if upper == "A":
            found = [[float(x) for x in match.groups()] for match in _ARC.finditer(text)]
            self._complete = not _ARC.sub("", text).strip(" ,\t\r\n")
        else:
            numbers = [float(x) for x in NUMBER.findall(text)]
            self._complete = len(numbers) % count == 0
            found = [numbers[i : i + count] for i in range(0, len(numbers) - count + 1, count)]
        share = (len(text) + 1) / max(len(found), 1)
        for group in found:
            self._step(share)
            yield group

    def _draw(self, kind: str, n: list[float], origin: complex) -> bool:
        trail = self.trail
        if not all(map(math.isfinite, n)):
            return False
        if kind == "H":
            trail.line(complex(n[0] + origin.real, trail.at.imag))
        elif kind == "V":
            trail.line(complex(trail.at.real, n[0] + origin.imag))
        elif kind == "A":
            trail.arc(complex(n[0], n[1]), n[2], n[3] == 1, n[4] == 1, origin + complex(n[5], n[6]))
        else:
            self._draw_points(kind, [origin + complex(n[i], n[i + 1]) for i in range(0, len(n), 2)])
        if kind not in "CSQT":
            self._control = None
        return True

    def _draw_points(self, kind: str, points: list[complex]) -> None:
        trail = self.trail
        if kind == "M":
            trail.move(points[0])
        elif kind == "L":
            trail.line(points[0])
        elif kind in "CS":
            b, c, d = points if kind == "C" else [self._mirrored("CS"), *points]
            trail.cubic(b, c, d)
            self._control, self._control_of = c, kind
        else:
            b, d = points if kind == "Q" else [self._mirrored("QT"), *points]
            trail.quadratic(b, d)
            self._control, self._control_of = b, kind

    def _mirrored(self, kinds: str) -> complex:
        """Return the last control point mirrored at where the pen is, for a smooth joint."""
        if self._control is None or self._control_of not in kinds:
            return self.trail.at
        return 2 * self.trail.at - self._control


def read_path(text: str, step: Step) -> Trail:
    """Return what path data draws; `step` is told how many characters are done."""
    trail = Trail(step)
    _Reader(trail, step).read(text)
    return trail


def read_shape(kind: str, attributes: Mapping[str, str], length: Callable[[str, str], float], step: Step) -> Trail:
    """Return what a basic shape draws; `length(name, along)` measures an attribute along "x", "y" or "both"."""
    trail = Trail(step)
    if kind == "rect":
        _draw_rect(trail, attributes, length)
    elif kind in ("circle", "ellipse"):
        centre = complex(length("cx", "x"), length("cy", "y"))
        if kind == "circle":
            radii = complex(1, 1) * length("r", "both")
        else:
            radii = complex(length("rx", "x"), length("ry", "y"))
        if min(radii.real, radii.imag) > 0:
            _draw_ellipse(trail, centre, radii)
    elif kind == "line":
        trail.move(complex(length("x1", "x"), length("y1", "y")))
        trail.line(complex(length("x2", "x"), length("y2", "y")))
    else:
        numbers = [float(x) for x in NUMBER.findall(attributes.get("points", ""))]
        points = [complex(*numbers[i : i + 2]) for i in range(0, len(numbers) - 1, 2)]
        trail.move(points[0] if points else 0j)
        for point in points[1:]:
            step(8)
            trail.line(point)
        if kind == "polygon":
            trail.close()
    return trail


def _draw_ellipse(trail: Trail, centre: complex, radii: complex) -> None:
    east, west = centre + radii.real, centre - radii.real
    trail.move(east)
    trail.arc(radii, 0, False, True, west)
    trail.arc(radii, 0, False, True, east)
    trail.close()


def _draw_rect(trail: Trail, attributes: Mapping[str, str], length: Callable[[str, str], float]) -> None:
    x, y = length("x", "x"), length("y", "y")
    wide, high = length("width", "x"), length("height", "y")
    if wide <= 0 or high <= 0:
        return
    rx = length("rx", "x") if attributes.get("rx", "auto") != "auto" else -1.0
    ry = length("ry", "y") if attributes.get("ry", "auto") != "auto" else rx
    rx = min(max(rx if rx >= 0 else ry, 0.0), wide / 2)
    ry = min(max(ry, 0.0), high / 2)
    corners = (complex(x, y), complex(x + wide, y), complex(x + wide, y + high), complex(x, y + high))
    if rx == 0 or ry == 0:
        trail.move(corners[0])
        for corner in corners[1:]:
            trail.line(corner)
    else:
        trail.move(corners[0] + rx)
        cuts = ((-rx, ry * 1j), (-ry * 1j, -rx), (rx, -ry * 1j), (ry * 1j, rx))
        for corner, (before, after) in zip((*corners[1:], corners[0]), cuts, strict=True):
            if abs(corner + before - trail.at) > 0:
                trail.line(corner + before)
            trail.arc(complex(rx, ry), 0, False, True, corner + after)
    trail.close()

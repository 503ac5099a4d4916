"""Reading SVG: paths, shapes, groups, transforms and `use` become drawings; the rest is named.

The tree is walked here and not by svgelements, whose parser cannot be stopped, follows a `use` of itself for ever
and draws what lies in masks. docs/decisions/0008-svg-import.md has the figures.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from core.errors import FileFormatError
from core.geometry.curves import count_chords, flatten
from core.geometry.outline import SMALLEST_SIZE, FloatArray, size
from core.geometry.simplify import without_repeats
from core.geometry.winding import even_odd
from core.io.imported import Imported, ImportedDrawing
from core.io.storage import read_whole
from core.io.svg_notes import APPLIED, UNSUPPORTED, Notes
from core.io.svg_path import Subpath, Trail, read_path, read_shape
from core.io.svg_style import Look, Matrix, Paints, Sheet, href, joined, length, transform
from core.io.svg_viewport import FARTHEST, box_fit, root_place, view_box
from core.io.svg_xml import DEEPEST, XML_SHARE, Asked, Progress, Watch, local_name, parse_xml
from core.model.document import LONGEST_NAME
from core.model.drawing import WIDEST_STROKE, Style

LARGEST_FILE = 128 * 1024 * 1024
TOLERANCE = 0.25
FINE = 4000
"""A tolerance chosen by itself is at most this share of the longer side: an icon is to be enlarged."""

MOST_VERTICES = 2_000_000
MOST_REPEATED = 30_000
ELEMENT = 40.0
"""What an element counts for the progress, besides the characters of its path."""

SHAPES = frozenset({"rect", "circle", "ellipse", "line", "polyline", "polygon"})
GROUPS = frozenset({"g", "a", "switch"})
LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"


@dataclass(frozen=True, slots=True)
class _Place:
    """Where in the tree the walk is, and what holds there."""

    matrix: Matrix
    look: Look
    viewport: tuple[float, float]
    name: str = ""
    depth: int = 0
    used: frozenset[str] = frozenset()


def read_svg(
    content: bytes | Path | str,
    *,
    tolerance: float | None = TOLERANCE,
    progress: Progress | None = None,
    cancelled: Asked | None = None,
) -> Imported:
    """Return the drawings of an SVG.

    Parameters
    ----------
    content : bytes or path
        The file itself, or where it lies.
    tolerance : float or None
        How far a curve's polygon may lie off it, in px; None: 0.25 px, less for a picture below 1,000 px.
    progress : function of a share, optional
        Called now and then with 0 to 1.
    cancelled : function, optional
        Asked now and then whether to stop.

    Returns
    -------
    Imported
        Every filled or stroked path with its fill, stroke and width, and the names of what was left out.

    Raises
    ------
    FileFormatError
        No SVG, a damaged or hostile one, or one in which nothing can be drawn; one sentence.
    StorageError
        The file cannot be read.
    CancelledError
        `cancelled` said so.
    """
    name = "" if isinstance(content, bytes) else Path(content).name
    body = content if isinstance(content, bytes) else read_whole(Path(content), LARGEST_FILE)
    watch = Watch(len(body), progress, cancelled)
    try:
        root = parse_xml(body, watch)
        return _Reader(root, watch, tolerance).read()
    except FileFormatError as e:
        raise FileFormatError(f"cannot import {name}: {e}" if name else str(e)) from None


class _Reader:
    """Walks one SVG."""

    def __init__(self, root: Element, watch: Watch, tolerance: float | None) -> None:
        self._root, self._watch = root, watch
        self._notes = Notes()
        self._ids: dict[str, Element] = {}
        self._sheet = Sheet(self._notes)
        self._paints = Paints(self._ids, self._sheet, self._notes)
        self._drawings: list[ImportedDrawing] = []
        self._vertices = self._repeated = 0
        self._stated, viewport, matrix = root_place(root)
        side = max(self._stated or viewport)
        self._tolerance = min(TOLERANCE, side / FINE) if tolerance is None else tolerance
        self._top = _Place(matrix, Look(), viewport)

    def read(self) -> Imported:
        self._collect()
        self._watch.stretch(XML_SHARE, 1.0)
        self._walk_children(self._root, self._inside(self._root, self._top))
        if not self._drawings:
            rest = f" (only {', '.join(self._notes.names())})" if self._notes.names() else ""
            raise FileFormatError("there is no path or shape in it that could be drawn" + rest)
        return Imported(tuple(self._drawings), self._stated or self._extent(), self._notes.names())

    def _collect(self) -> None:
        """Find what has an id, and read the style sheets."""
        for element in self._root.iter():
            if "id" in element.attrib:
                self._ids.setdefault(element.attrib["id"], element)
            if local_name(element) == "style":
                self._sheet.add("".join(element.itertext()))

    def _extent(self) -> tuple[float, float]:
        """Return the size of a picture that does not state one: as far as its drawings reach."""
        far = np.max([np.max(p, axis=0) for d in self._drawings for p, _ in d.outlines], axis=0)
        return max(float(far[0]), 1.0), max(float(far[1]), 1.0)

    # the walk

    def _inside(self, element: Element, place: _Place) -> _Place:
        """Return the place inside an element, with its transform, look and name."""
        said = self._sheet.properties(element)
        matrix = place.matrix
        if said.get("transform"):
            try:
                matrix = joined(matrix, transform(said["transform"]))
            except ValueError:
                self._notes("unreadable transform")
        for key, word in APPLIED.items():
            if said.get(key, "none") != "none":
                self._notes(word)
        name = (element.get(LABEL) or element.get("id") or place.name)[:LONGEST_NAME]
        look = place.look.under(said)
        hidden = said.get("display", "") == "none"
        if hidden:
            look = replace(look, opacity=0.0)
        return replace(place, matrix=matrix, look=look, name=name, depth=place.depth + 1)

    def _walk_children(self, element: Element, place: _Place) -> None:
        if place.look.opacity <= 0:
            return
        for child in element:
            self._walk(child, place)

    def _walk(self, element: Element, place: _Place) -> None:
        kind = local_name(element)
        self._watch.step(ELEMENT)
        if place.used:
            self._repeated += 1
            if self._repeated > MOST_REPEATED:
                raise FileFormatError(
                    f"it repeats parts of itself more than {MOST_REPEATED} times; simplify it first"
                )
        if kind in UNSUPPORTED:
            if self._sheet.properties(element).get("display") != "none":
                self._notes(UNSUPPORTED[kind])
        elif kind == "path" or kind in SHAPES:
            self._draw(element, kind, self._inside(element, place))
        elif kind in GROUPS:
            inside = self._inside(element, place)
            if kind == "switch":
                element = _first_choice(element)
            self._walk_children(element, inside)
        elif kind == "svg":
            self._walk_children(element, self._in_viewport(element, self._inside(element, place), element.attrib))
        elif kind == "use":
            self._use(element, place)

    def _use(self, element: Element, place: _Place) -> None:
        link = href(element)
        if not link.startswith("#"):
            if link:
                raise FileFormatError(f"it uses parts of another file ({link[:60]}); save it as a plain SVG")
            return
        target = self._ids.get(link[1:])
        if target is None or link in place.used or place.depth >= DEEPEST:
            self._notes("broken repetition" if target is None else "part that repeats itself")
            return
        inside = self._inside(element, place)
        shift = (self._length(element, "x", inside, 0), self._length(element, "y", inside, 0))
        inside = replace(inside, matrix=joined(inside.matrix, (1, 0, 0, 1, *shift)), used=inside.used | {link})
        if local_name(target) in ("symbol", "svg"):
            own = self._inside(target, inside)
            sized: dict[str, str] = {k: element.attrib[k] for k in ("width", "height") if k in element.attrib}
            self._walk_children(target, self._in_viewport(target, own, sized))
        else:
            self._walk(target, inside)

    def _in_viewport(self, element: Element, place: _Place, sized: Mapping[str, str]) -> _Place:
        """Return the place inside a nested picture, whose viewBox fills the room that `sized` tells."""
        x, y = self._length(element, "x", place, 0), self._length(element, "y", place, 0)
        room = [
            length(sized.get(name, element.get(name, "100%")), whole)
            for name, whole in zip(("width", "height"), place.viewport, strict=True)
        ]
        if not all(math.isfinite(r) and r > 0 for r in room):
            room = list(place.viewport)
        matrix = joined(place.matrix, (1, 0, 0, 1, x, y))
        box = view_box(element)
        if box is None:
            return replace(place, matrix=matrix, viewport=(room[0], room[1]))
        fit = box_fit(box, (room[0], room[1]), element.get("preserveAspectRatio", ""))
        return replace(place, matrix=joined(matrix, fit), viewport=(box[2], box[3]))

    # drawing

    def _draw(self, element: Element, kind: str, place: _Place) -> None:
        look = place.look
        if look.opacity <= 0 or look.visibility in ("hidden", "collapse"):
            return
        style = self._style(look, kind, place)
        if style.fill is None and style.stroke is None:
            return
        if kind == "path":
            text = self._sheet.properties(element).get("d", "")
            trail = read_path(text, self._watch.step)
        else:
            trail = read_shape(
                kind,
                element.attrib,
                lambda name, along: self._length(element, name, place, along),
                self._watch.step,
            )
        if not trail.whole:
            self._notes("path with a mistake")
        outlines = self._outlines(trail, place.matrix, style)
        if style.fill is not None and look.rule != "evenodd":
            outlines = self._as_even_odd(outlines)
        if outlines:
            self._drawings.append(ImportedDrawing(tuple(outlines), style, place.name))

    def _style(self, look: Look, kind: str, place: _Place) -> Style:
        fill = stroke = None
        if kind != "line":
            fill = self._paints.color(look.fill, look.color, look.fill_opacity * look.opacity)
        width = length(look.width, math.hypot(*place.viewport) / math.sqrt(2))
        a, b, c, d, _, _ = place.matrix
        width *= math.sqrt(abs(a * d - b * c))
        if not width > 0:
            width = 0.0
        else:
            stroke = self._paints.color(look.stroke, look.color, look.stroke_opacity * look.opacity)
        if stroke is not None:
            if look.dashes not in ("none", ""):
                self._notes("dashed stroke")
            if look.marker not in ("none", ""):
                self._notes("marker")
        return Style(fill, stroke, min(width, WIDEST_STROKE) if stroke else Style().width)

    def _outlines(self, trail: Trail, matrix: Matrix, style: Style) -> list[tuple[FloatArray, bool]]:
        found = []
        for subpath in trail.subpaths:
            points = self._flattened(subpath, matrix)
            if points is None:
                continue
            returns = len(points) > 3 and bool((points[0] == points[-1]).all())
            closed = subpath.closed or returns or style.stroke is None
            points = without_repeats(points)
            if closed and len(points) > 1 and (points[0] == points[-1]).all():
                points = points[:-1]
            if closed and len(points) == 2 and style.stroke is not None:
                closed = False
            if len(points) >= (3 if closed else 2) and size(points) > SMALLEST_SIZE * np.abs(points).max():
                found.append((points, closed))
                self._vertices += len(points)
        return found

    def _flattened(self, subpath: Subpath, matrix: Matrix) -> FloatArray | None:
        """Return the subpath's vertices in px; None where they lie too far away to be drawn."""
        user = np.array(subpath.curves, dtype=np.complex128)
        a, b, c, d, e, f = matrix
        with np.errstate(all="ignore"):
            curves = (a * user.real + c * user.imag + e) + 1j * (b * user.real + d * user.imag + f)
            near = (
                np.isfinite(curves).all() and max(np.abs(curves.real).max(), np.abs(curves.imag).max()) <= FARTHEST
            )
        if not near:
            self._notes("shape too far away")
            return None
        straight = np.array(subpath.straight)
        if self._vertices + count_chords(curves, straight, self._tolerance) > MOST_VERTICES:
            raise FileFormatError(f"it would become more than {MOST_VERTICES} vertices; simplify it first")
        return flatten(curves, straight, self._tolerance)

    def _as_even_odd(self, outlines: list[tuple[FloatArray, bool]]) -> list[tuple[FloatArray, bool]]:
        if not outlines:
            return outlines
        chosen = even_odd([points for points, _ in outlines])
        if not chosen.exact:
            self._notes("overlapping path")
        return [outlines[i] for i in chosen.kept]

    # small things

    def _length(self, element: Element, name: str, place: _Place, along: str | int) -> float:
        """Return an attribute in px, 0 where it is missing or no number."""
        text = element.get(name)
        if text is None:
            return 0.0
        wide, high = place.viewport
        key = along or name
        whole = wide if key == "x" else high if key == "y" else math.hypot(wide, high) / math.sqrt(2)
        found = length(text, whole)
        return found if math.isfinite(found) else 0.0


def _first_choice(element: Element) -> Element:
    """Return a `switch` with only the branch that needs no language or extension."""
    chosen = Element(element.tag)
    fitting: Iterable[Element] = (e for e in element if not {"systemLanguage", "requiredFeatures"} & set(e.attrib))
    chosen.extend(e for e in list(fitting) if local_name(e) not in ("", "foreignObject"))
    return chosen

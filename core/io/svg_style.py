"""How elements of an SVG are painted: attributes, style sheets, inheritance, colours."""

import functools
import math
import re
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from xml.etree.ElementTree import Element

from core.errors import FileFormatError
from core.io.svg_path import NUMBER
from core.io.svg_xml import local_name
from core.model.drawing import Color

Note = Callable[[str], object]

HREFS = ("href", "{http://www.w3.org/1999/xlink}href")
MID_GREY = "#808080"
MOST_LINKS = 20
"""Gradients that take their stops from each other."""

MOST_RULES = 20_000

INCH = 96.0
UNITS = {"in": INCH, "cm": INCH / 2.54, "mm": INCH / 25.4, "q": INCH / 101.6, "pt": INCH / 72, "pc": INCH / 6}
UNITS |= {"em": 16.0, "rem": 16.0, "ex": 8.0}
"""px a unit; those of fonts as browsers begin."""

_SELECTOR = re.compile(r"(\*|[\w-]+)?((?:[.#][\w-]+)*)")
_URL = re.compile(r"url\(\s*['\"]?([^'\")]*)['\"]?\s*\)\s*(.*)", re.DOTALL)
_MODERN = re.compile(r"((?:rgb|hsl)a?)\(\s*([^\s,]+)\s+([^\s,]+)\s+([^\s,/]+)\s*(?:/\s*([^\s)]+)\s*)?\)")

_INHERITED = {
    "fill": "fill",
    "fill-rule": "rule",
    "stroke": "stroke",
    "stroke-width": "width",
    "color": "color",
    "visibility": "visibility",
    "stroke-dasharray": "dashes",
    "marker-start": "marker",
    "marker-mid": "marker",
    "marker-end": "marker",
}
_SHARES = {"fill-opacity": "fill_opacity", "stroke-opacity": "stroke_opacity"}

Properties = dict[str, str]
Matrix = tuple[float, float, float, float, float, float]


@dataclass(frozen=True, slots=True)
class Look:
    """What an element hands on to those inside it; lengths and colours as they were written."""

    fill: str = "black"
    rule: str = "nonzero"
    fill_opacity: float = 1.0
    stroke: str = "none"
    stroke_opacity: float = 1.0
    width: str = "1"
    color: str = "black"
    visibility: str = "visible"
    dashes: str = "none"
    marker: str = "none"
    opacity: float = 1.0

    def under(self, properties: Properties) -> "Look":
        """Return the look of an element inside, with its own properties."""
        changes: dict[str, str | float] = {
            name: properties[key]
            for key, name in _INHERITED.items()
            if key in properties and properties[key] != "inherit"
        }
        changes |= {n: share(properties[k], getattr(self, n)) for k, n in _SHARES.items() if k in properties}
        if "opacity" in properties:
            changes["opacity"] = self.opacity * share(properties["opacity"], 1.0)
        return replace(self, **changes) if changes else self  # type: ignore[arg-type]


class Sheet:
    """The rules of all style elements, by what they ask of an element."""

    def __init__(self, note: Note) -> None:
        self._rules: dict[str, list[tuple[tuple[int, int], frozenset[str], Properties]]] = defaultdict(list)
        self._known: dict[tuple[str, str, str], Properties] = {}
        self._count = 0
        self._note = note

    def add(self, text: str) -> None:
        """Read a style sheet."""
        self._known.clear()
        text = _without_remarks(text)
        if "@import" in text.lower():
            raise FileFormatError("it takes its style sheet from another file; save it as a plain SVG")
        for selectors, body in _rules(text):
            properties = declarations(body)
            for selector in selectors.split(","):
                self._add_rule(selector.strip(), properties)

    def _add_rule(self, selector: str, properties: Properties) -> None:
        if selector.startswith("@"):  # fonts and the like
            return
        match = _SELECTOR.fullmatch(selector)
        if match is None or not selector:
            self._note("style rule")
            return
        self._count += 1
        if self._count > MOST_RULES:
            raise FileFormatError(f"it has more than {MOST_RULES} style rules; simplify it first")
        name, rest = match.groups()
        needed = frozenset(re.findall(r"[.#][\w-]+", rest))
        rank = 100 * sum(n[0] == "#" for n in needed) + 10 * sum(n[0] == "." for n in needed)
        rank += name not in (None, "*")
        wanted = needed | ({name} if name not in (None, "*") else frozenset())
        self._rules[min(wanted, default="*")].append(((rank, self._count), wanted, properties))

    def _ruled(self, element: Element) -> Properties:
        """Return what the rules say of an element; the same for all with its name, classes and id."""
        name, own = local_name(element), "#" + element.get("id", "")
        key = (name, element.get("class", ""), own if own in self._rules else "")
        if key not in self._known:
            traits = {"*", name, own, *("." + c for c in key[1].split())}
            fitting = [r for t in traits for r in self._rules.get(t, ()) if r[1] <= traits]
            merged: Properties = {}
            for _, _, properties in sorted(fitting, key=lambda r: r[0]):
                merged |= properties
            self._known[key] = merged
        return self._known[key]

    def properties(self, element: Element) -> Properties:
        """Return what an element's attributes, the rules and its own style say, the last one winning."""
        found = {k: v.strip() for k, v in element.attrib.items() if k[0] != "{"}
        if self._rules:
            found |= self._ruled(element)
        if "style" in found:
            found |= declarations(found["style"])
        return found


def _without_remarks(text: str) -> str:
    """Take remarks away; by hand, as a pattern looks for the end of each one anew where it has none."""
    parts = []
    at = 0
    while (start := text.find("/*", at)) >= 0:
        parts.append(text[at:start])
        end = text.find("*/", start + 2)
        if end < 0:
            return " ".join(parts)
        at = end + 2
    parts.append(text[at:])
    return " ".join(parts)


def _rules(text: str) -> Iterator[tuple[str, str]]:
    """Yield what stands before each innermost pair of braces, and what stands in it."""
    *pieces, _ = text.split("}")
    for piece in pieces:
        before, brace, body = piece.rpartition("{")
        selectors = before[before.rfind("{") + 1 :]
        if brace and selectors:
            yield selectors, body


def declarations(text: str) -> Properties:
    """Return the properties of a style attribute or of one rule."""
    found = {}
    for part in text.split(";"):
        name, colon, value = part.partition(":")
        if colon:
            found[name.strip().lower()] = value.removesuffix("!important").replace("! important", "").strip()
    return found


class Paints:
    """Turns what is written of colours into colours; gradients become the colour of their first stop."""

    def __init__(self, ids: Mapping[str, Element], sheet: Sheet, note: Note) -> None:
        self._ids, self._sheet, self._note = ids, sheet, note

    def color(self, text: str, current: str, opacity: float) -> Color | None:
        """Return a colour with `opacity` multiplied in; None paints nothing."""
        match = _URL.match(text)
        if match:
            return self._linked(match[1], match[2].strip(), current, opacity)
        if text.lower() == "currentcolor":
            text = current if current.lower() != "currentcolor" else "black"
        elif text in ("context-fill", "context-stroke"):
            return None
        channels = parse_color(text)
        return None if channels is None else _with_opacity(channels, opacity)

    def _linked(self, link: str, otherwise: str, current: str, opacity: float) -> Color | None:
        target = self._ids.get(link[1:]) if link.startswith("#") else None
        if target is None:
            self._note("missing paint")
            return self.color(otherwise, current, opacity) if otherwise else _with_opacity(MID_GREY, opacity)
        if local_name(target) == "pattern":
            self._note("pattern")
            return _with_opacity(MID_GREY, opacity)
        stop = self._first_stop(target)
        if local_name(target) != "solidColor":
            self._note("gradient")
        if stop is None:
            return _with_opacity(MID_GREY, opacity)
        said = self._sheet.properties(stop)
        shade = said.get("stop-color", said.get("solid-color", "black"))
        opacity *= share(said.get("stop-opacity", "1"), 1.0)
        return self.color(
            said.get("color", current) if shade.lower() == "currentcolor" else shade, current, opacity
        )

    def _first_stop(self, gradient: Element) -> Element | None:
        for _ in range(MOST_LINKS):
            if local_name(gradient) == "solidColor":
                return gradient
            stop = next((e for e in gradient if local_name(e) == "stop"), None)
            link = href(gradient)
            if stop is not None or not link.startswith("#") or link[1:] not in self._ids:
                return stop
            gradient = self._ids[link[1:]]
        return None


def href(element: Element) -> str:
    """Return where an element points to, "" if nowhere."""
    return next((element.attrib[name].strip() for name in HREFS if name in element.attrib), "")


@functools.lru_cache(maxsize=4096)
def parse_color(text: str) -> Color | None:
    """Return a colour that is written in one of the ways of CSS; None for none, black where nobody knows it."""
    from svgelements import Color as ReadColor

    text = text.strip().lower()
    if text in ("none", ""):
        return None
    modern = _MODERN.fullmatch(text)
    if modern:
        kind, *channels = modern.groups()
        text = f"{kind}({', '.join(c for c in channels[:3])}{f', {channels[3]}' if channels[3] else ''})"
    alpha = re.search(r",\s*([\d.]+)%\s*\)$", text)
    if alpha and text.count(",") == 3:
        text = f"{text[: alpha.start()]}, {share(alpha[1] + '%', 1.0)})"
    try:
        value = int(ReadColor(text).value)
    except (ValueError, TypeError, OverflowError, ArithmeticError, AttributeError):
        value = 0xFF
    digits = f"{value & 0xFFFFFFFF:08x}"
    return "#" + digits.removesuffix("ff") if digits.endswith("ff") else "#" + digits


def _with_opacity(color: Color, opacity: float) -> Color | None:
    """Return the colour with its alpha multiplied; None where nothing is left to see."""
    alpha = round((int(color[7:9], 16) if len(color) == 9 else 255) * opacity)
    if alpha <= 0:
        return None
    return color[:7] if alpha >= 255 else f"{color[:7]}{alpha:02x}"


def share(text: str, otherwise: float) -> float:
    """Return an opacity, 0 to 1, written as a number or in percent."""
    match = NUMBER.match(text.strip())
    if match is None:
        return otherwise
    value = float(match[0]) / (100 if text.strip().endswith("%") else 1)
    return min(max(value, 0.0), 1.0)


def length(text: str, whole: float) -> float:
    """Return a length in px; a percentage is one of `whole`; NaN where there is no number."""
    text = text.strip()
    match = NUMBER.match(text)
    if match is None:
        return math.nan
    unit = text[match.end() :].strip().lower()
    return float(match[0]) * (whole / 100 if unit == "%" else UNITS.get(unit, 1.0))


def transform(text: str) -> Matrix:
    """Return what a transform attribute says, or raise ValueError."""
    from svgelements import Matrix as ReadMatrix

    try:
        read = ReadMatrix(text)
        read.render(ppi=96.0, width=0.0, height=0.0)
        found = (float(read.a), float(read.b), float(read.c), float(read.d), float(read.e), float(read.f))
    except (ValueError, TypeError, LookupError, ArithmeticError, AttributeError) as e:
        raise ValueError(f"no transform: {e}") from None
    if not all(map(math.isfinite, found)):
        raise ValueError("a transform that is not finite")
    return found


def joined(outer: Matrix, inner: Matrix) -> Matrix:
    """Return the matrix that does `inner` first and `outer` then."""
    a, b, c, d, e, f = outer
    p, q, r, s, t, u = inner
    return (a * p + c * q, b * p + d * q, a * r + c * s, b * r + d * s, a * t + c * u + e, b * t + d * u + f)

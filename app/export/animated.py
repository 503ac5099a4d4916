"""Animated SVG that plays in a browser: by SMIL (`<animate>`), or by CSS (`@keyframes` with `d: path(...)`).

Every stretch of a layer is a group that is seen in its own time only; all run in one loop as long as the film.
"""

from collections.abc import Callable, Iterable, Sequence
from html import escape
from pathlib import Path

from app.export.film import Film
from app.export.shapes import Moment, Stretch, shape_layers
from app.export.svg import (
    closed_attributes,
    number,
    open_attributes,
    path_data,
    svg_head,
)
from app.export.whole import write_whole
from core.model.easing import Easing
from core.model.inbetweens import Picture

Told = Callable[[object], object]
Asked = Callable[[], bool]
Track = tuple[str, list[str]]
"""The name of an attribute, and its value at every moment of a stretch."""

SHARE = 9
"""Digits of a share of the film's length: a frame in 100,000 is told apart."""


def write(film: Film, path: Path, told: Told, cancelled: Asked) -> bool:
    """Write the film; False if it was cancelled, and then there is no file."""
    text = animated_svg(film, css=film.settings.format == "svg-css")
    if cancelled():
        return False
    write_whole(path, text.encode())
    for shot in film.shots():
        told(shot)
    return True


def animated_svg(film: Film, *, css: bool) -> str:
    """Return the SVG file."""
    count = film.settings.last - film.settings.first + 1
    make = _Css(count, count / film.document.rate) if css else _Smil(count, count / film.document.rate)
    groups = []
    for layer in shape_layers(film):
        shown = "".join(make.stretch(s) for s in layer.stretches)
        groups.append(f"<g><title>{escape(layer.name)}</title>\n{shown}</g>\n")
    head = svg_head(film.document.stage, film.settings.size, film.background)
    return f"{head}{make.style()}{''.join(groups)}</svg>\n"


def _parts(stretch: Stretch) -> list[tuple[str, list[Track]]]:
    """Return the paths of a stretch: what they are at first, and what of them changes."""
    pictures = [m.picture for m in stretch.moments]
    found = []
    for closed, attributes in ((True, closed_attributes), (False, open_attributes)):
        shapes = [_data(p, closed=closed) for p in pictures]
        if shapes[0]:
            looks = [_attributes(attributes(p.style)) for p in pictures]
            tracks: list[Track] = [("d", shapes)]
            tracks += [(name, [look.get(name, "1") for look in looks]) for name in looks[0] | looks[-1]]
            start = f'd="{shapes[0]}"{attributes(pictures[0].style)}'
            found.append((start, [t for t in tracks if len(set(t[1])) > 1]))
    return found


def _data(picture: Picture, *, closed: bool) -> str:
    return path_data((points for points, is_closed in picture.outlines if is_closed == closed), closed=closed)


def _attributes(text: str) -> dict[str, str]:
    pairs = (part.split("=", 1) for part in text.split(" ") if part)
    return {name: value.strip('"') for name, value in pairs}


class _Timed:
    """What both ways to animate share: the loop."""

    def __init__(self, count: int, seconds: object) -> None:
        self._count = count
        self._seconds = f"{float(seconds):.9f}".rstrip("0").rstrip(".")

    def _share(self, frame: float) -> str:
        return number_of(frame / self._count)

    def _moments(self, stretch: Stretch) -> list[Moment]:
        return [m for m in stretch.moments if m.time <= self._count]

    def style(self) -> str:
        return ""


def number_of(share: float) -> str:
    """Return a share of the whole as short as it can be."""
    return f"{share:.{SHARE}f}".rstrip("0").rstrip(".") or "0"


class _Smil(_Timed):
    """By elements inside the paths."""

    def stretch(self, stretch: Stretch) -> str:
        paths = "".join(
            f"<path {start}>{''.join(self._animate(stretch, *track) for track in tracks)}</path>\n"
            for start, tracks in _parts(stretch)
        )
        opacities = [number(m.picture.opacity) for m in stretch.moments]
        fade = self._animate(stretch, "opacity", opacities) if len(set(opacities)) > 1 else ""
        first = "" if opacities[0] == "1" else f' opacity="{opacities[0]}"'
        return f"<g{first}{self._hidden(stretch)}>{self._visible(stretch)}{fade}{paths}</g>\n"

    def _hidden(self, stretch: Stretch) -> str:
        """Return what a program shows that does not know animation: the first frame."""
        return "" if stretch.start <= 0 else ' visibility="hidden"'

    def _visible(self, stretch: Stretch) -> str:
        if stretch.start <= 0 and stretch.end >= self._count:
            return ""
        steps = [(0.0, stretch.start <= 0), (stretch.start, True), (stretch.end, False)]
        seen = {t: ("visible" if on else "hidden") for t, on in steps if t < self._count}
        times = ";".join(self._share(t) for t in seen)
        return self._element("visibility", "discrete", times, ";".join(seen.values()))

    def _animate(self, stretch: Stretch, name: str, values: list[str]) -> str:
        moments = self._moments(stretch)
        times, shown = [self._share(m.time) for m in moments], values[: len(moments)]
        if times[0] != "0":
            times, shown = ["0", *times], [shown[0], *shown]
        if stretch.held:
            return self._element(name, "discrete", ";".join(times), ";".join(shown))
        if times[-1] != "1":
            times, shown = [*times, "1"], [*shown, shown[-1]]
        splines = _splines(stretch.easing, len(times) - 1)
        mode = "spline" if splines else "linear"
        return self._element(name, mode, ";".join(times), ";".join(shown), splines)

    def _element(self, name: str, mode: str, times: str, values: str, splines: str = "") -> str:
        return (
            f'<animate attributeName="{name}" dur="{self._seconds}s" repeatCount="indefinite" calcMode="{mode}" '
            f'keyTimes="{times}"{splines} values="{values}"/>'
        )


def _splines(easing: Easing | None, count: int) -> str:
    if easing is None:
        return ""
    curve = " ".join(number(v) for v in (easing.x1, easing.y1, easing.x2, easing.y2))
    return f' keySplines="{";".join([curve] * count)}"'


class _Css(_Timed):
    """By a style sheet: names are given to what moves."""

    def __init__(self, count: int, seconds: object) -> None:
        super().__init__(count, seconds)
        self._rules: list[str] = []

    def style(self) -> str:
        return f"<style>\n{''.join(self._rules)}</style>\n" if self._rules else ""

    def stretch(self, stretch: Stretch) -> str:
        paths = "".join(f"<path{self._tracks(stretch, tracks)} {start}/>\n" for start, tracks in _parts(stretch))
        opacities = [number(m.picture.opacity) for m in stretch.moments]
        fade = [("opacity", opacities)] if len(set(opacities)) > 1 else []
        first = "" if opacities[0] == "1" else f' opacity="{opacities[0]}"'
        hidden = "" if stretch.start <= 0 else ' visibility="hidden"'
        inner = f"<g{self._tracks(stretch, fade)}{first}>{paths}</g>"
        return f"<g{self._visible(stretch)}{hidden}>{inner}</g>\n"

    def _visible(self, stretch: Stretch) -> str:
        if stretch.start <= 0 and stretch.end >= self._count:
            return ""
        steps = {0.0: stretch.start <= 0, stretch.start: True, stretch.end: False}
        frames = [
            (t, f"visibility:{'visible' if on else 'hidden'}", "step-end")
            for t, on in steps.items()
            if t < self._count
        ]
        return self._rule([*frames, (self._count, frames[-1][1], "step-end")])

    def _tracks(self, stretch: Stretch, tracks: Sequence[Track]) -> str:
        if not tracks:
            return ""
        moments = self._moments(stretch)
        looks = [";".join(_declared(name, values[i]) for name, values in tracks) for i in range(len(moments))]
        pace = "step-end" if stretch.held else _bezier(stretch.easing)
        frames = [(m.time, look, pace) for m, look in zip(moments, looks, strict=True)]
        if frames[0][0] > 0:
            frames.insert(0, (0, frames[0][1], "step-end"))
        if frames[-1][0] < self._count:
            frames.append((self._count, frames[-1][1], "step-end"))
        return self._rule(frames)

    def _rule(self, frames: Iterable[tuple[float, str, str]]) -> str:
        """Add a rule to the sheet and return the attribute that asks for it."""
        name = f"k{len(self._rules) + 1}"
        steps = "".join(
            f"{number_of(100 * t / self._count)}%{{{look};animation-timing-function:{pace}}}\n"
            for t, look, pace in frames
        )
        self._rules.append(
            f".{name}{{animation:{name} {self._seconds}s linear infinite}}\n@keyframes {name}{{\n{steps}}}\n"
        )
        return f' class="{name}"'


def _declared(name: str, value: str) -> str:
    if name == "d":
        return f'd:path("{value}")'
    return f"{name}:{value}px" if name == "stroke-width" else f"{name}:{value}"


def _bezier(easing: Easing | None) -> str:
    if easing is None:
        return "linear"
    return f"cubic-bezier({','.join(number(v) for v in (easing.x1, easing.y1, easing.x2, easing.y2))})"

"""A frame as SVG: true paths, even-odd, straight alpha, the stage as the visible part."""

from collections.abc import Iterable

from core.geometry.outline import FloatArray
from core.model.document import Stage
from core.model.drawing import Color, Style
from core.model.inbetweens import Picture

DIGITS = 3
"""After the point, of px of the picture."""


def frame_svg(
    pictures: Iterable[Picture],
    stage: Stage,
    size: tuple[int, int],
    background: Color | None,
) -> str:
    """Return the SVG file of one frame, a group a layer."""
    parts = [svg_head(stage, size, background)]
    parts += [f"<g{opacity_attribute(p)}>{''.join(picture_paths(p))}</g>\n" for p in pictures]
    return "".join([*parts, "</svg>\n"])


def svg_head(stage: Stage, size: tuple[int, int], background: Color | None) -> str:
    """Return everything up to the first drawing: the size, the stage as viewBox, the background."""
    fit = box_of(stage, size)
    box = " ".join(number(x) for x in fit)
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{size[0]}" height="{size[1]}" viewBox="{box}" '
        f'preserveAspectRatio="none">\n'
    )
    if background is None:
        return head
    x, y, wide, high = (number(v) for v in fit)
    rest = paint_attributes("fill", background)
    return head + f'<rect x="{x}" y="{y}" width="{wide}" height="{high}"{rest}/>\n'


def box_of(stage: Stage, size: tuple[int, int]) -> tuple[float, float, float, float]:
    """Return the part of the plane, in stage px, that a picture of `size` shows: the stage and its margins."""
    scale = min(size[0] / stage.width, size[1] / stage.height)
    wide, high = size[0] / scale, size[1] / scale
    return (stage.width - wide) / 2, (stage.height - high) / 2, wide, high


def picture_paths(picture: Picture) -> list[str]:
    """Return the elements of a picture: the closed outlines in one path, the open ones as strokes."""
    style = picture.style
    closed = [points for points, is_closed in picture.outlines if is_closed]
    opened = [points for points, is_closed in picture.outlines if not is_closed]
    paths = []
    if closed:
        paths.append(f'<path d="{path_data(closed, closed=True)}"{closed_attributes(style)}/>')
    if opened:
        paths.append(f'<path d="{path_data(opened, closed=False)}"{open_attributes(style)}/>')
    return paths


def closed_attributes(style: Style) -> str:
    """Return how closed outlines are painted."""
    fill = paint_attributes("fill", style.fill)
    return f'{fill} fill-rule="evenodd"{_stroke(style.stroke, style.width)}'


def open_attributes(style: Style) -> str:
    """Return how open outlines are painted: their own colour, or that of the fill; never filled."""
    return f' fill="none"{_stroke(style.stroke or style.fill, style.width)}'


def _stroke(color: Color | None, width: float) -> str:
    if color is None or not width > 0:
        return ""
    paint = paint_attributes("stroke", color)
    return f'{paint} stroke-width="{number(width)}" stroke-linecap="round" stroke-linejoin="round"'


def paint_attributes(name: str, color: Color | None) -> str:
    """Return ` fill="#rrggbb"` with its opacity if it has one."""
    if color is None:
        return f' {name}="none"'
    alpha = "" if len(color) == 7 else f' {name}-opacity="{number(int(color[7:], 16) / 255)}"'
    return f' {name}="{color[:7]}"{alpha}'


def opacity_attribute(picture: Picture) -> str:
    return "" if picture.opacity == 1 else f' opacity="{number(picture.opacity)}"'


def path_data(outlines: Iterable[FloatArray], *, closed: bool) -> str:
    """Return the `d` of a path."""
    end = "Z" if closed else ""
    return "".join(f"M{' '.join(map(number, points.ravel().tolist()))}{end}" for points in outlines)


def number(value: float) -> str:
    """Return a number as short as it can be."""
    text = f"{value:.{DIGITS}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text

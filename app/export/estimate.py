"""About how large an export will be, told before it begins, from the keyframes alone."""

from PySide6.QtCore import QSize
from PySide6.QtGui import QImage

from app.export.film import count_pictures
from app.export.png import encode_png
from app.export.settings import ExportSettings
from app.painting import render_pictures
from core.model.document import Document, Layer
from core.model.inbetweens import Picture
from core.model.motion import drawing_picture

SAMPLE_PIXELS = 200_000
GROWTH = 1.25
"""The bytes of edges grow with the sides, those of empty rows with the area: something between 1 and 2."""
SHARES = {
    "png": 1.0,
    "apng": 0.8,
    "webp": 0.34,
    "gif": 0.22,
    "mp4": 0.11,
    "webm": 0.55,
    "sprites": 0.97,
    "oca": 1.0,
}
"""Of the bytes of our PNG frames, as measured with the samples."""
DEEP = 2.2
PRORES, PRORES_PIXELS, PRORES_GROWTH = 24_000, 83_000, 0.576
"""Bytes of a picture of so many pixels, and the power at which they grow with the pixels."""
VERTEX = {"svg-frames": 35.0, "lottie": 65.0, "svg": 42.0, "svg-css": 42.0}
"""Bytes a vertex of a keyframe and picture; an in-between has the vertices of both its keyframes."""
SHEET_LINE = 185


def estimate(document: Document, settings: ExportSettings) -> float:
    """Return about how many bytes the export will take."""
    count = count_pictures(settings, document.rate)
    form = settings.format
    pixels = settings.size[0] * settings.size[1]
    if form == "prores":
        return PRORES * (pixels / PRORES_PIXELS) ** PRORES_GROWTH * count
    if form == "xdts":
        return float(SHEET_LINE * count * len(document.layers))
    pictures = [_near(layer, (settings.first + settings.last) // 2) for layer in document.layers if layer.visible]
    shown = [p for p in pictures if p is not None]
    if form in VERTEX:
        return VERTEX[form] * sum(len(points) for p in shown for points, _ in p.outlines) * count
    deep = DEEP if settings.depth == 16 else 1.0
    return SHARES[form] * deep * _png_bytes(document, settings, shown) * count


def _near(layer: Layer, frame: int) -> Picture | None:
    """Return a keyframe of the layer near a frame: an in-between may have to be solved first."""
    before, after = layer.around(frame)
    keyframe = before or after
    return None if keyframe is None else drawing_picture(keyframe.drawing)


def _png_bytes(document: Document, settings: ExportSettings, pictures: list[Picture]) -> float:
    """Return about how many bytes a frame has as our PNG, from a smaller one."""
    width, height = settings.size
    scale = min(1.0, (SAMPLE_PIXELS / (width * height)) ** 0.5)
    size = QSize(max(1, round(width * scale)), max(1, round(height * scale)))
    color = document.stage.background if settings.background == "stage" else settings.background
    kind = QImage.Format.Format_ARGB32_Premultiplied
    small = render_pictures(pictures, document.stage, size, color, format=kind)
    return float(len(encode_png(small)) * (1 / scale) ** GROWTH)


def told_size(count: float) -> str:
    """Return a size in words, with no more digits than can be known."""
    for unit, small in (("KB", 1e6), ("MB", 1e9), ("GB", 1e12)):
        if count < small:
            value = count / (small / 1e3)
            return f"{max(value, 1):.0f} {unit}" if value >= 10 or unit == "KB" else f"{value:.1f} {unit}"
    return f"{count / 1e12:.0f} TB"

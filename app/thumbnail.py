"""A small picture of a document that needs no thought: of every layer the keyframe at or before a frame."""

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QImage, QPainter

from app.painting import paint_frame, stage_transform, to_qcolor
from core.model.document import Document, Layer
from core.model.inbetweens import Picture

PAPER = "#ffffff"


def thumbnail(document: Document, frame: int, size: QSize) -> QImage:
    """Return the stage with the keyframes around `frame`, on its colour or on white paper."""
    image = QImage(size, QImage.Format.Format_ARGB32_Premultiplied)
    image.fill(Qt.GlobalColor.transparent)
    transform = stage_transform(document.stage, size)
    paper = transform.mapRect(QRectF(0, 0, document.stage.width, document.stage.height))
    painter = QPainter(image)
    try:
        painter.fillRect(paper, to_qcolor(PAPER))
        painter.fillRect(paper, to_qcolor(document.stage.background or PAPER))
        painter.setClipRect(paper)
        shown = [_picture(layer, frame) for layer in document.layers if layer.visible]
        paint_frame(painter, [p for p in shown if p is not None], transform)
    finally:
        painter.end()
    return image


def _picture(layer: Layer, frame: int) -> Picture | None:
    before, after = layer.around(frame)
    keyframe = before or after
    if keyframe is None:
        return None
    outlines = tuple((o.points, o.closed) for o in keyframe.drawing.outlines)
    style = keyframe.drawing.style
    return Picture(outlines, style, layer.opacity * style.opacity)

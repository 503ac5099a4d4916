"""What of the timeline stays as it is while one scrubs, painted once."""

from typing import Protocol

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QFont, QPainter, QPen, QPixmap

from app.keys import Keys
from app.panels.track_header import HeaderPainter
from app.panels.track_rows import RowPainter
from app.panels.track_ruler import paint_ruler, small_font
from app.panels.track_view import HEADER, RULER, TrackView
from app.preview.certificates import CertificatePreview
from app.theme import Theme
from core.model.frame_edits import KeyRef


class Track(Protocol):
    """What the picture shows of the widget."""

    view: TrackView
    keys: Keys
    theme: Theme
    certificates: CertificatePreview
    hover_key: KeyRef | None
    hover_part: tuple[int, str] | None

    def size(self) -> QSize: ...
    def devicePixelRatio(self) -> float: ...
    def font(self) -> QFont: ...


def whole_picture(track: Track) -> QPixmap:
    """Return the ruler, the heads and all rows but the active one."""
    theme, size = track.theme, track.size()
    picture = QPixmap(size * track.devicePixelRatio())
    picture.setDevicePixelRatio(track.devicePixelRatio())
    picture.fill(theme.color("panel"))
    painter = QPainter(picture)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    _paint_rows(painter, track)
    painter.fillRect(QRectF(0, 0, size.width(), RULER), theme.color("panel"))
    painter.setClipRect(QRectF(HEADER, 0, size.width(), RULER))
    paint_ruler(painter, track.view, theme, small_font(track.font()))
    painter.setClipping(False)
    painter.setPen(theme.color("muted"))
    painter.setFont(small_font(track.font(), bold=True))
    painter.drawText(QRectF(14, 0, 100, RULER), int(Qt.AlignmentFlag.AlignVCenter), "LAYERS")
    painter.setPen(QPen(theme.color("line"), 1))
    painter.drawLine(QPointF(HEADER - 0.5, 0), QPointF(HEADER - 0.5, size.height()))
    painter.end()
    return picture


def _paint_rows(painter: QPainter, track: Track) -> None:
    view, theme = track.view, track.theme
    rows = RowPainter(painter, view, theme, track.certificates)
    heads = HeaderPainter(painter, view, theme, track.font())
    for row, layer in enumerate(view.rows):
        rect, active = view.row_rect(row), layer.id == view.session.layer.id
        if rect.bottom() < RULER or rect.top() > view.height:
            continue
        if active:
            painter.fillRect(rect, theme.color("raised"))
        painter.setPen(QPen(theme.color("line", 0.5), 1))
        painter.drawLine(rect.bottomLeft() + QPointF(0, -0.5), rect.bottomRight() + QPointF(0, -0.5))
        if not active:
            rows.paint(row, layer, track.keys.chosen, track.hover_key)
        heads.paint(row, layer, track.hover_part)

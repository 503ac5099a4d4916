"""The ruler of the timeline: numbered frames, the range that is played, the playhead."""

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QFont, QPainter, QPen, QPolygonF

from app.panels.track_view import HEADER, RULER, TrackView
from app.session import Session
from app.theme import Theme

SELDOM = (1, 2, 5, 6, 12, 24, 48, 120, 240, 600, 1200, 6000, 12000, 60000)
EDGE = 6.0
"""So near an edge of the range a press takes it, px."""

RANGE_TOP = RULER - 6.0


def small_font(like: QFont, *, bold: bool = False) -> QFont:
    font = QFont(like)
    font.setPixelSize(11)
    font.setBold(bold)
    return font


def range_edge_under(view: TrackView, at: QPointF) -> str:
    """Return "first" or "last", the edge of the played range under the pointer, or ""."""
    session = view.session
    if not session.has_range or not RANGE_TOP - 8 <= at.y() <= RULER:
        return ""
    gaps = {name: abs(view.x_of(f) - at.x()) for name, f in zip(("first", "last"), session.range, strict=True)}
    name = min(gaps, key=lambda n: gaps[n])
    if len(set(session.range)) == 1:
        name = "last" if at.x() >= view.x_of(session.range[0]) else "first"
    return name if gaps[name] <= EDGE else ""


def paint_ruler(painter: QPainter, view: TrackView, theme: Theme, font: QFont) -> None:
    """Paint the numbers and strokes, and over them the range."""
    length, step = view.session.document.length, view.step
    painter.setFont(font)
    first, last = max(1, view.frame_at(HEADER)), min(length, view.frame_at(view.width))
    each = next((n for n in SELDOM if n * step >= 44), SELDOM[-1])
    fine = next((n for n in SELDOM if n * step >= 6), SELDOM[-1])
    numbered = {1, length, *_multiples(each, first, last)}
    for frame in sorted(numbered | _multiples(fine, first, last)):
        x = view.x_of(frame)
        painter.setPen(QPen(theme.color("muted" if frame in numbered else "line"), 1))
        painter.drawLine(QPointF(x, RULER - (8 if frame in numbered else 5)), QPointF(x, RULER - 1))
        crowded = frame == length and frame % each and (frame % each) * step < 26
        if frame in numbered and not crowded:
            painter.drawText(QRectF(x - 24, 4, 48, 16), int(Qt.AlignmentFlag.AlignCenter), str(frame))
    if view.session.has_range:
        _paint_range(painter, view, view.session, theme)


def _multiples(number: int, first: int, last: int) -> set[int]:
    return set(range(-(-first // number) * number, last + 1, number))


def _paint_range(painter: QPainter, view: TrackView, session: Session, theme: Theme) -> None:
    left, right = (view.x_of(frame) for frame in session.range)
    painter.fillRect(QRectF(left, RANGE_TOP, right - left, RULER - RANGE_TOP), theme.color("accent", 0.35))
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(theme.color("accent"))
    for x, way in ((left, 1), (right, -1)):
        corners = ((0, -4), (7 * way, -4), (0, RULER - RANGE_TOP))
        painter.drawPolygon(QPolygonF([QPointF(x + dx, RANGE_TOP + dy) for dx, dy in corners]))


def paint_playhead(painter: QPainter, view: TrackView, theme: Theme, font: QFont) -> None:
    frame = view.session.frame
    x = view.x_of(frame)
    if x < HEADER - 1:
        return
    painter.setPen(QPen(theme.color("accent"), 1.8))
    painter.drawLine(QPointF(x, 20), QPointF(x, view.height))
    text = str(frame)
    painter.setFont(font)
    width = max(26.0, painter.fontMetrics().horizontalAdvance(text) + 14)
    badge = QRectF(x - width / 2, 3, width, 18)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(theme.color("accent"))
    painter.drawRoundedRect(badge, 5, 5)
    painter.setPen(theme.color("accent_text"))
    painter.drawText(badge, int(Qt.AlignmentFlag.AlignCenter), text)

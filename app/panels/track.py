"""The frames of the timeline: a ruler, a row a layer, keyframes as diamonds, spans as bars, the playhead."""

from collections.abc import Mapping
from itertools import pairwise

from PySide6.QtCore import QPointF, QRect, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QAction,
    QContextMenuEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPixmap,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QScrollBar, QSizePolicy, QToolButton, QWidget

from app.keys import Keys
from app.panels import track_header, track_menus
from app.panels.track_drags import Band, Drag, MoveKeys, MoveLayer, Scrub, SetRange, StretchKeys
from app.panels.track_header import NameField
from app.panels.track_picture import whole_picture
from app.panels.track_rows import SEVERITY_COLORS, RowPainter
from app.panels.track_ruler import paint_playhead, range_edge_under, small_font
from app.panels.track_spot import Spot
from app.panels.track_view import HEADER, ROW, RULER, TrackView
from app.preview.certificates import CertificatePreview
from app.session import DocumentDiff, Session
from app.theme import Theme
from core.model.checking import SpanCertificate
from core.model.document import Document, Layer
from core.model.edits import set_layer
from core.model.frame_edits import KeyRef

SHIFT, CTRL = Qt.KeyboardModifier.ShiftModifier, Qt.KeyboardModifier.ControlModifier
BARELY = 9
"""Width of a scroll bar, px."""


def _shown(document: Document, layers: frozenset[int]) -> list[object]:
    """Return what of these layers is seen here."""
    return [
        (
            (x.id, x.name, x.visible, x.locked, x.color, x.parent),
            [(k.frame, k.smooth, k.span.hold, k.span.step, k.span.exposures) for k in x.keyframes],
        )
        for x in document.layers
        if x.id in layers
    ]


class Track(QWidget):
    """Drag in the ruler to scrub, a keyframe to move the selected ones, anywhere else to select several.

    `problemChosen` tells the place and the colour of the problem that a click on a bar went to.
    """

    problemChosen = Signal(object, str)

    def __init__(
        self,
        session: Session,
        certificates: CertificatePreview,
        keys: Keys,
        theme: Theme,
        actions: Mapping[str, QAction],
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.session, self.certificates, self.keys, self.theme = session, certificates, keys, theme
        self.actions_by_id = actions
        self.view = TrackView(session)
        self._painted: list[SpanCertificate | None] = []
        self._picture: QPixmap | None = None
        self._spot = Spot(self.view, certificates, keys)
        self._drag: Drag | None = None
        self.hover_key: KeyRef | None = None
        self.hover_part: tuple[int, str] | None = None
        self.name_field: NameField | None = None
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAccessibleName("Timeline")
        self._make_parts()
        self._connect()

    def _make_parts(self) -> None:
        self.add_button = QToolButton(self)
        self.add_button.setDefaultAction(self.actions_by_id["layer.add"])
        self.add_button.setIconSize(QSize(16, 16))
        self.add_button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.add_button.setGeometry(HEADER - 8 - 24, 4, 24, 24)
        self.across = QScrollBar(Qt.Orientation.Horizontal, self)
        self.down = QScrollBar(Qt.Orientation.Vertical, self)
        self.across.valueChanged.connect(lambda x: self._scroll_to(x, self.view.top))
        self.down.valueChanged.connect(lambda y: self._scroll_to(self.view.left, y))

    def _connect(self) -> None:
        session = self.session
        session.documentChanged.connect(self._on_document_changed)
        session.frameChanged.connect(self._on_frame_changed)
        session.layerChanged.connect(self._on_layer_changed)
        for signal in (session.soloChanged, session.rangeChanged, self.keys.changed, self.certificates.changed):
            signal.connect(self.refresh)

    def sizeHint(self) -> QSize:
        return QSize(600, RULER + 3 * ROW)

    def minimumSizeHint(self) -> QSize:
        return QSize(300, RULER + ROW + 8)

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self.refresh()

    # places

    def x_of(self, frame: float) -> float:
        return self.view.x_of(frame)

    def key_place(self, layer: Layer, frame: int) -> QPointF:
        """Return where a keyframe's diamond lies."""
        return self.view.key_place(layer, frame)

    def part_place(self, layer: Layer, part: str) -> QPointF:
        """Return the middle of a part of a row's head: "name", "visible", "locked" or "solo"."""
        rect = self.view.row_rect(self.view.row_of(layer.id))
        place = track_header.name_rect(rect) if part == "name" else track_header.part_rect(rect, part)
        return place.center()

    # the pointer

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            if self._drag is not None:  # whose release another window has got
                self._drag.release(event.position())
            self._drag = self._begun(event.position(), event.modifiers())
            self.update()

    def _begun(self, at: QPointF, held: Qt.KeyboardModifier) -> Drag | None:
        row = self.view.row_at(at.y())
        if row is not None:
            self.session.set_layer(self.view.rows[row].id)
        if at.x() < HEADER:
            return self._press_head(at)
        if at.y() < RULER:
            return self._press_ruler(at, held)
        key = self.view.key_under(at)
        if key is not None:
            return self._press_key(at, key, held)
        grip = self._spot.grip(at)
        if grip is not None:
            return StretchKeys(self, at, last=grip == 1)
        return Band(self, at, self._spot.goal(at), adds=bool(held & (SHIFT | CTRL)))

    def _press_ruler(self, at: QPointF, held: Qt.KeyboardModifier) -> Drag:
        edge = range_edge_under(self.view, at)
        if edge:
            return SetRange(self, at, self.session.range[0 if edge == "last" else 1])
        if held & SHIFT:
            length = self.session.document.length
            return SetRange(self, at, min(max(self.view.frame_at(at.x()), 1), length))
        return Scrub(self, at)

    def _press_key(self, at: QPointF, key: KeyRef, held: Qt.KeyboardModifier) -> Drag | None:
        if held & CTRL:
            self.keys.toggle(key)
        elif held & SHIFT:
            self.keys.choose(self.keys.chosen | self._up_to(key))
        elif key not in self.keys.chosen:
            self.keys.choose({key})
        if held & (CTRL | SHIFT):
            if key in self.keys.chosen:
                self.session.go_to(key[1])
            return None
        return MoveKeys(self, at, key)

    def _up_to(self, key: KeyRef) -> set[KeyRef]:
        """Return the keyframes from the selected ones of that layer up to this one."""
        layer_id, frame = key
        here = [f for i, f in self.keys.chosen if i == layer_id] or [frame]
        low, high = min(frame, *here), max(frame, *here)
        return {(layer_id, f) for f in self.session.document.layer(layer_id).frames() if low <= f <= high}

    def _press_head(self, at: QPointF) -> Drag | None:
        under = track_header.part_under(self.view, at)
        if under is None:
            return None
        layer, part = self.view.rows[under[0]], under[1]
        if part == "name":
            return MoveLayer(self, at, layer.id)
        if part == "solo":
            self.session.set_solo(self.session.solo ^ {layer.id})
        else:
            self.session.apply(*track_header.switched(layer, part))
        return None

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._drag is not None:
            self._drag.move(event.position())
        else:
            self._hover(event.position())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        drag, self._drag = self._drag, None
        if drag is not None:
            drag.release(event.position())
            self.update()

    def tell_problem(self, at: QPointF) -> None:
        """Say where the problem is that a click here leads to, if there is one."""
        problem = self._spot.problem(at)
        if problem is not None:
            self.problemChosen.emit(problem.place, SEVERITY_COLORS[problem.severity])

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        under = track_header.part_under(self.view, event.position())
        if under is not None and under[1] == "name":
            self.rename(self.view.rows[under[0]].id)
        else:
            self.mousePressEvent(event)

    def rename(self, layer_id: int) -> None:
        """Let a layer's name be changed in its place."""
        row = self.view.row_of(layer_id)
        self.view.show_row(row)
        name = self.session.document.layer(layer_id).name

        def done(text: str) -> None:
            self.session.apply("Rename Layer", set_layer, layer_id, name=text)

        self.name_field = NameField(self, track_header.name_rect(self.view.row_rect(row)), name, done)

    def _hover(self, at: QPointF) -> None:
        key, part = self.view.key_under(at), track_header.part_under(self.view, at)
        tip = self._spot.tip(at, key, part)
        if tip != self.toolTip():
            self.setToolTip(tip)
        if (key, part) != (self.hover_key, self.hover_part):
            self.hover_key, self.hover_part = key, part
            self.refresh()
        wide = key is not None or self._spot.edge(at)
        self.setCursor(Qt.CursorShape.SizeHorCursor if wide else Qt.CursorShape.ArrowCursor)

    def leaveEvent(self, _: object) -> None:
        self.hover_key = self.hover_part = None
        self.refresh()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        at = QPointF(event.pos())
        if self._drag is not None:
            return
        row = self.view.row_at(at.y())
        if row is not None:
            self.session.set_layer(self.view.rows[row].id)
        if at.x() < HEADER:
            menu = track_menus.layer_menu(self) if row is not None else None
        elif at.y() < RULER:
            menu = track_menus.ruler_menu(self)
        else:
            self._aim(at)
            menu = track_menus.key_menu(self)
        if menu is not None:
            menu.popup(event.globalPos())

    def _aim(self, at: QPointF) -> None:
        """Go to what a menu is asked for; a keyframe outside the selection becomes it."""
        key = self.view.key_under(at)
        if key is not None and key not in self.keys.chosen:
            self.keys.choose({key})
        elif key is None:
            self.keys.choose(())
        self.session.go_to(key[1] if key else self.view.frame_at(at.x()))

    def wheelEvent(self, event: QWheelEvent) -> None:
        delta, held = event.angleDelta(), event.modifiers()
        if held & CTRL:
            self.view.zoom_at(event.position().x(), 1.2 ** (delta.y() / 120))
        elif delta.x() or held & SHIFT or not self.view.most_top:
            self.view.scroll(-(delta.x() or delta.y()) / 2, 0)
        else:
            self.view.scroll(0, -delta.y() / 3)
        self._show_scroll()
        event.accept()

    # keys

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape and self._drag is not None:
            drag, self._drag = self._drag, None
            drag.cancel()
            self.update()
        elif event.key() == Qt.Key.Key_Escape and self.keys.chosen:
            self.keys.choose(())
        elif event.key() in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            row = self.view.row_of(self.session.layer.id) + (1 if event.key() == Qt.Key.Key_Down else -1)
            if 0 <= row < len(self.view.rows):
                self.session.set_layer(self.view.rows[row].id)
        else:
            super().keyPressEvent(event)

    # what changes

    def _on_document_changed(self, diff: DocumentDiff) -> None:
        """Paint again only what shows here: of a drag of a vertex only that the certificate is gone."""
        layers = diff.layers
        order = [x.id for x in diff.before.layers] != [x.id for x in diff.after.layers]
        if order or diff.frame_range or _shown(diff.before, layers) != _shown(diff.after, layers):
            self._show_scroll()
        elif self._certificates() != self._painted:
            self.refresh()

    def _on_frame_changed(self, frame: int) -> None:
        left = self.view.left
        self.view.show(frame)
        if self.view.left == left:
            self.update()
        else:
            self._show_scroll()

    def _on_layer_changed(self) -> None:
        self.view.show_row(self.view.row_of(self.session.layer.id))
        self._show_scroll()

    def fit(self) -> None:
        """Show all frames."""
        self.view.fit()
        self._show_scroll()

    def resizeEvent(self, event: QResizeEvent) -> None:
        self.view.width, self.view.height = self.width(), self.height()
        self._show_scroll()
        super().resizeEvent(event)

    def _scroll_to(self, left: float, top: float) -> None:
        if (round(self.view.left), round(self.view.top)) != (round(left), round(top)):
            self.view.left, self.view.top = left, top
            self.refresh()

    def _show_scroll(self) -> None:
        """Bring the scroll bars in line with what is shown, and paint."""
        view = self.view
        view.clip()
        bars = ((self.across, view.most_left, view.left, view.room), (self.down, view.most_top, view.top, ROW * 3))
        for bar, most, value, page in bars:
            bar.setRange(0, round(most))
            bar.setPageStep(round(page))
            bar.setValue(round(value))
            bar.setVisible(most >= 1)
        self.across.setGeometry(QRect(HEADER, self.height() - BARELY, self.width() - HEADER - BARELY, BARELY))
        self.down.setGeometry(QRect(self.width() - BARELY, RULER, BARELY, self.height() - RULER - BARELY))
        self.refresh()

    def _certificates(self) -> list[SpanCertificate | None]:
        keyframes = self.session.layer.keyframes
        return [self.certificates.of(*pair) for pair in pairwise(keyframes)]

    # painting

    def refresh(self) -> None:
        """Paint everything anew; `update` paints only the active row and the playhead over the rest."""
        self._picture = None
        self.update()

    def paintEvent(self, _: object) -> None:
        if self._picture is None or self._picture.size() != self.size() * self.devicePixelRatio():
            self._painted = self._certificates()
            self._picture = whole_picture(self)
        view, theme = self.view, self.theme
        with QPainter(self) as painter:  # ended whatever happens: under an open one an error ends the program
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.drawPixmap(0, 0, self._picture)
            painter.setClipRect(QRectF(HEADER, RULER, self.width(), self.height()))
            rows = RowPainter(painter, view, theme, self.certificates)
            rows.paint(view.row_of(self.session.layer.id), self.session.layer, self.keys.chosen, self.hover_key)
            rows.paint_grips(self.keys.chosen)
            painter.setClipRect(QRectF(HEADER, 0, self.width(), self.height()))
            paint_playhead(painter, view, theme, small_font(self.font(), bold=True))
            painter.setClipping(False)
            if self._drag is not None:
                self._drag.paint(painter)

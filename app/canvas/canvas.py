"""The canvas: shows the session's document and hands the pointer and keys to the active tool."""

from collections.abc import Callable

import pyqtgraph as pg
from PySide6.QtCore import QEvent, QPointF, QSizeF, Qt, Signal
from PySide6.QtGui import QFocusEvent, QKeyEvent, QMouseEvent, QPaintEvent, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QGraphicsView, QWidget

from app.canvas.camera import Camera, fitted
from app.canvas.content import Content, build_content
from app.canvas.heat import HeatItem
from app.canvas.items import (
    FilmItem,
    HandlesItem,
    LabelsItem,
    LinesItem,
    MarkItem,
    OthersItem,
    PaperItem,
    ShapesItem,
    ToolItem,
)
from app.canvas.onion import OnionItem
from app.canvas.papers import whole_area
from app.canvas.paths import PathsItem, PinsItem
from app.canvas.pins import PinMark, pin_marks
from app.canvas.reference import ReferenceItem, ReferencePictures
from app.canvas.tool import Pointer, Tool
from app.painting import ROUNDS, Thinner
from app.preview.spans import SpanPreview
from app.session import Session
from app.theme import Theme
from app.view import ViewState
from core.errors import InkbetweenError
from core.model.parts import check_open

ZOOM_STEP = 1.0015
"""Factor an eighth of a degree of the wheel: a notch of 120 zooms by a fifth."""


class Canvas(pg.GraphicsView):
    """See the module. Scene coordinates are view px; the camera alone knows the stage."""

    playPressed = Signal()
    pointed = Signal(str)
    zoomed = Signal(float)
    toolChanged = Signal()

    def __init__(
        self,
        session: Session,
        preview: SpanPreview,
        view: ViewState,
        theme: Theme,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent, useOpenGL=False, background=theme.color("background"))
        self.setObjectName("canvas")
        self.session, self.preview, self.view_state, self.theme = session, preview, view, theme
        self.camera = Camera()
        self.tool: Tool | None = None
        self.hover: QPointF | None = None
        self.marked: tuple[tuple[float, float], str] | None = None
        self.thinner = Thinner()
        self.references = ReferencePictures(self)
        self.key_of: Callable[[str], str] = lambda _: ""
        self.space_plays = True
        self._content: Content | None = None
        self._pin_marks: tuple[Content, tuple[PinMark, ...]] | None = None
        self._follows_stage = True
        self._pan_from: QPointF | None = None
        self._space_down = False
        self._space_used = False
        self.setCentralItem(None)
        self.setViewportUpdateMode(QGraphicsView.ViewportUpdateMode.FullViewportUpdate)
        self.setCacheMode(QGraphicsView.CacheModeFlag.CacheNone)
        self.setMinimumSize(240, 160)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.viewport().setMouseTracking(True)
        self._add_items()
        self._connect()

    def _add_items(self) -> None:
        kinds = (
            PaperItem,
            OnionItem,
            FilmItem,
            ShapesItem,
            HeatItem,
            LinesItem,
            LabelsItem,
            HandlesItem,
            MarkItem,
            ToolItem,
        )
        self._items = [kind(self, 10 * z) for z, kind in enumerate(kinds)]
        self._items += [PathsItem(self, 45), PinsItem(self, 65)]
        self._items.append(ReferenceItem(self, 2))
        self._items.append(OthersItem(self, 5, in_front=False))
        self._items.append(OthersItem(self, 35, in_front=True))
        for item in self._items:
            self.scene().addItem(item)

    def _connect(self) -> None:
        s = self.session
        for signal in (s.documentChanged, s.frameChanged, s.layerChanged, s.selectionChanged, s.soloChanged):
            signal.connect(self._on_changed)
        for signal in (s.documentChanged, s.frameChanged, s.layerChanged):
            signal.connect(lambda _=None: self.mark(None))
        self.preview.planned.connect(self._on_changed)
        s.gestureChanged.connect(self._on_gesture_changed)
        self.view_state.changed.connect(self._on_view_changed)
        self._shown_papers: object = None

    # what is seen

    @property
    def content(self) -> Content:
        """What is to be seen now; worked out when first asked for after a change."""
        if self._content is None:
            self._content = build_content(self.session, self.preview, self.view_state.options)
            if self._follows_stage:
                papers = (self._content.papers, self._content.document.stage)
                if papers != self._shown_papers:
                    self._shown_papers = papers
                    self.camera = self._fitted_camera()
        return self._content

    @property
    def pin_marks(self) -> tuple[PinMark, ...]:
        """The pins of what is to be seen now."""
        if self._pin_marks is None or self._pin_marks[0] is not self.content:
            self._pin_marks = self.content, pin_marks(self.content)
        return self._pin_marks[1]

    @property
    def shows_pins(self) -> bool:
        """Whether the ways of pins are shown, in place of the correspondence."""
        return self.tool is not None and self.tool.shows_pins

    def _on_changed(self, *_: object) -> None:
        self._content = None
        self.viewport().update()

    def _on_gesture_changed(self, under_way: bool) -> None:
        """Paint a little coarser while the hand moves, in full when it rests."""
        self.thinner.rounds = 1 if under_way else ROUNDS
        self.viewport().update()

    def _on_view_changed(self) -> None:
        if self._content is not None and self._content.options.arrangement != self.view_state.options.arrangement:
            self._follows_stage = True
            self.hover = None  # what lay under the pointer lies elsewhere now
        self._on_changed()

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self.setBackground(theme.color("background"))
        self.viewport().update()

    def refresh(self) -> None:
        """Paint again what has not changed (a tool's own marks)."""
        self.viewport().update()

    def set_tool(self, tool: Tool) -> None:
        """Make a tool the active one; the old one forgets what it was doing."""
        if self.tool is not None:
            self.tool.cancel()
        self.tool = tool
        self.hover = None
        self.viewport().setCursor(tool.cursor)
        self.toolChanged.emit()
        self.refresh()

    # looking around

    def fit(self) -> None:
        """Show all of the stage, and keep showing all of it when the window changes its size."""
        self._follows_stage = True
        self._set_camera(self._fitted_camera())

    def zoom(self, factor: float, at: QPointF | None = None) -> None:
        """Zoom about a place of the view, or about its middle."""
        self._follows_stage = False
        self._set_camera(self.camera.zoomed(factor, at or QPointF(self.viewport().rect().center())))

    def zoom_to(self, scale: float) -> None:
        """Show the stage at `scale` view px a stage px."""
        self.zoom(scale / self.camera.scale)

    def _fitted_camera(self) -> Camera:
        area = whole_area(self.content.papers, self.session.document.stage)
        return fitted(area, QSizeF(self.viewport().size()))

    def _set_camera(self, camera: Camera) -> None:
        self.camera = camera
        self.zoomed.emit(camera.scale)
        self.viewport().update()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if getattr(self, "_items", None) is None:
            return  # the base class resizes itself while it is being made
        for item in self._items:
            item.prepareGeometryChange()
        if self._follows_stage:
            self._set_camera(self._fitted_camera())

    def paintEvent(self, event: QPaintEvent) -> None:
        # worked out before any painter is at work: an error under an active painter ends the program
        _ = self.content
        super().paintEvent(event)

    # the pointer

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self.setFocus()
        pans = event.button() == Qt.MouseButton.MiddleButton
        if event.button() == Qt.MouseButton.LeftButton:
            if self._space_down:
                pans = True
            elif self.tool is not None and not self._refuses():
                self.tool.press(_pointer(event))
        elif event.button() == Qt.MouseButton.RightButton and self.tool is not None:
            self.tool.right_press(_pointer(event))
        if pans:
            self._pan_from = event.position()
            self._space_used = True
            self.viewport().setCursor(Qt.CursorShape.ClosedHandCursor)
        event.accept()

    def _refuses(self) -> bool:
        """Whether the tool only draws and the layer is locked: said at the press, not after a whole outline."""
        tool, layer = self.tool, self.session.layer
        if tool is None or not tool.only_draws:
            return False
        try:
            check_open(layer)
        except InkbetweenError as e:
            self.session.problem.emit(str(e))
            return True
        return False

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        self._tell_place(event.position())
        if self._pan_from is not None:
            d = event.position() - self._pan_from
            self._pan_from = event.position()
            self._follows_stage = False
            self._set_camera(self.camera.panned(d.x(), d.y()))
        elif self.tool is not None:
            if event.buttons() & Qt.MouseButton.LeftButton:
                self.tool.drag(_pointer(event))
            else:
                self.tool.hover(_pointer(event))
        event.accept()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self._pan_from is not None:
            self._pan_from = None
            self._reset_cursor()
        elif event.button() == Qt.MouseButton.LeftButton and self.tool is not None:
            self.tool.release(_pointer(event))
        event.accept()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton and self.tool is not None:
            self.tool.double_click(_pointer(event))
        event.accept()

    def wheelEvent(self, event: QWheelEvent) -> None:
        delta = event.angleDelta()
        if event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            self._follows_stage = False
            self._set_camera(self.camera.panned(delta.y() / 2 or delta.x() / 2, 0))
        else:
            self.zoom(ZOOM_STEP ** (delta.y() or delta.x()), event.position())
        event.accept()

    def leaveEvent(self, event: QEvent) -> None:
        self.set_hover(None)
        self.pointed.emit("")

    def set_hover(self, spot: QPointF | None) -> None:
        """Light up a place of the view, or none."""
        if spot != self.hover:
            self.hover = spot
            self.refresh()

    def mark(self, place: tuple[float, float] | None, token: str = "error") -> None:
        """Ring a place of the stage in a colour of the theme, until the playhead moves or the document changes."""
        marked = None if place is None else (place, token)
        if marked != self.marked:
            self.marked = marked
            self.refresh()

    def _tell_place(self, at: QPointF) -> None:
        x, y = self.camera.to_stage(at)
        self.pointed.emit(f"{x:.0f}, {y:.0f}")

    def _reset_cursor(self) -> None:
        if self._space_down:
            self.viewport().setCursor(Qt.CursorShape.OpenHandCursor)
        elif self.tool is not None:
            self.viewport().setCursor(self.tool.cursor)

    # the keys

    def event(self, event: QEvent) -> bool:
        # Qt asks here whether a key shall go to the focused widget rather than to a menu's shortcut
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent):
            wanted = event.key() == Qt.Key.Key_Space and not event.modifiers()
            if wanted or (self.tool is not None and self.tool.wants_key(event)):
                event.accept()
                return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Space:
            if not event.isAutoRepeat():
                self._space_down, self._space_used = True, False
                self._reset_cursor()
            event.accept()
        elif self.tool is not None and self.tool.key(event):
            event.accept()
        else:
            event.ignore()

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Space and not event.isAutoRepeat():
            self._space_down = False
            self._reset_cursor()
            if self.space_plays and not self._space_used:
                self.playPressed.emit()
        event.accept()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        self._space_down = False
        super().focusOutEvent(event)


def _pointer(event: QMouseEvent) -> Pointer:
    return Pointer(event.position(), event.modifiers())

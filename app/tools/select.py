"""The select tool: choose, move, turn and scale vertices and whole outlines."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QKeyEvent, QPainter, QPen

from app.canvas.content import box_around
from app.canvas.hits import OutlineHit, outline_around, outline_under
from app.canvas.papers import Paper
from app.canvas.tool import Pointer, Tool
from app.session import Gesture, OutlineRef, Selection, Session
from core.geometry.outline import FloatArray
from core.model.document import Document
from core.model.edits import delete_vertices, insert_vertex, move_vertices

Change = Callable[[FloatArray], FloatArray]
"""From vertices (k, 2) to vertices, in stage px."""

HANDLE_REACH = 9.0
TURN_HANDLE = 26.0
BOX_MARGIN = 10.0
SMALLEST_BOX = 12.0
NUDGE, LONG_NUDGE = 1.0, 10.0
ARROWS = {
    Qt.Key.Key_Left: (-1, 0),
    Qt.Key.Key_Right: (1, 0),
    Qt.Key.Key_Up: (0, -1),
    Qt.Key.Key_Down: (0, 1),
}
HANDLES = {
    "nw": (0.0, 0.0),
    "n": (0.5, 0.0),
    "ne": (1.0, 0.0),
    "e": (1.0, 0.5),
    "se": (1.0, 1.0),
    "s": (0.5, 1.0),
    "sw": (0.0, 1.0),
    "w": (0.0, 0.5),
}


@dataclass
class _Press:
    """What a press began, before and after it has become a drag."""

    at: QPointF
    paper: Paper
    kind: str  # "move", "box", "turn" or the name of a scale handle
    click: Callable[[], None] | None = None
    gesture: Gesture | None = None
    box: QRectF | None = None
    now: QPointF | None = None


class SelectTool(Tool):
    name, icon = "Select", "select"
    hint = "Drag vertices, shapes or a box. Double click an edge: new vertex. Arrows: nudge. Delete: take away."
    held = (("Shift", "add; straight; nudge 10 px"), ("Alt", "about the middle"))
    shows_vertices = True

    def __init__(self, canvas) -> None:
        super().__init__(canvas)
        self._press: _Press | None = None

    @property
    def busy(self) -> bool:
        return self._press is not None and self._press.now is not None

    def wants_key(self, event: QKeyEvent) -> bool:
        key = event.key()
        if key in ARROWS or key in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            return self.canvas.session.selection.count > 0
        return super().wants_key(event)

    # the pointer

    def press(self, pointer: Pointer) -> None:
        content, camera = self.canvas.content, self.canvas.camera
        handle = self._handle_under(pointer.at)
        if handle is not None:
            name, paper, box = handle
            self._press = _Press(pointer.at, paper, name, box=box)
            return
        hit = outline_under(content, camera, pointer.at)
        if hit is not None and hit.vertex is not None:
            self._press_vertex(hit, pointer)
        elif hit is not None:
            self._press_outline(hit.paper, hit.ref, pointer)
        else:
            around = outline_around(content, camera, pointer.at)
            if around is not None:
                self._press_outline(around[0], around[2], pointer)
            else:
                self._press = _Press(pointer.at, content.papers[0], "box", click=lambda: self._clear(pointer))

    def _press_vertex(self, hit: OutlineHit, pointer: Pointer) -> None:
        session, i = self.canvas.session, hit.vertex
        chosen = session.selection.vertices.get(hit.ref, ())
        click = None
        if pointer.shift:
            rest = set(chosen) ^ {i}
            session.select(session.selection.with_vertices(hit.ref, rest))
            if i not in rest:
                return
        elif i not in chosen:
            session.select(Selection({hit.ref: (i,)}))
        else:
            click = lambda: session.select(Selection({hit.ref: (i,)}))  # noqa: E731 - only a click narrows it
        self._press = _Press(pointer.at, hit.paper, "move", click=click)

    def _press_outline(self, paper: Paper, ref: OutlineRef, pointer: Pointer) -> None:
        session = self.canvas.session
        everything = tuple(range(len(outline_of(session.document, session, ref).points)))
        chosen = session.selection.vertices.get(ref, ())
        if pointer.shift:
            rest = () if chosen == everything else everything
            session.select(session.selection.with_vertices(ref, rest))
        elif chosen != everything:
            session.select(Selection({ref: everything}))
        self._press = _Press(pointer.at, paper, "move")

    def _clear(self, pointer: Pointer) -> None:
        if not pointer.shift:
            self.canvas.session.select(Selection())

    def drag(self, pointer: Pointer) -> None:
        press = self._press
        if press is None or (press.now is None and not pointer.far_from(press.at)):
            return
        press.now = pointer.at
        if press.kind == "box":
            self.canvas.refresh()
            return
        if press.gesture is None:
            press.gesture = self.canvas.session.begin(self._label(press))
            self.canvas.set_hover(None)
        change = self._change(press, pointer)
        gesture = press.gesture
        gesture.update(changed_vertices(self.canvas.session, gesture.before.selection, change))

    def release(self, pointer: Pointer) -> None:
        press, self._press = self._press, None
        if press is None:
            return
        if press.now is None:
            if press.click is not None:
                press.click()
        elif press.kind == "box":
            self._select_box(QRectF(press.at, pointer.at).normalized(), add=pointer.shift)
        elif press.gesture is not None:
            press.gesture.commit()
        self.canvas.refresh()

    def hover(self, pointer: Pointer) -> None:
        if self._handle_under(pointer.at) is not None:
            self.canvas.set_hover(None)
            self.canvas.viewport().setCursor(Qt.CursorShape.SizeAllCursor)
            return
        self.canvas.viewport().setCursor(self.cursor)
        hit = outline_under(self.canvas.content, self.canvas.camera, pointer.at)
        if hit is None or hit.vertex is None:
            self.canvas.set_hover(None)
            return
        outline = outline_of(self.canvas.session.document, self.canvas.session, hit.ref)
        place = self.canvas.camera.to_view(outline.points[hit.vertex], hit.paper.offset)
        self.canvas.set_hover(QPointF(*place))

    def double_click(self, pointer: Pointer) -> None:
        self._press = None
        hit = outline_under(self.canvas.content, self.canvas.camera, pointer.at)
        if hit is None or hit.vertex is not None:
            return
        session, (frame, outline_id) = self.canvas.session, hit.ref
        session.apply(
            "Insert Vertex",
            insert_vertex,
            session.layer.id,
            frame,
            outline_id,
            hit.position,
        )
        session.select(Selection({hit.ref: (int(hit.position) + 1,)}))

    # the keys

    def key(self, event: QKeyEvent) -> bool:
        key = event.key()
        if key == Qt.Key.Key_Escape:
            if self.busy:
                self.cancel()
            else:
                self.canvas.session.select(Selection())
            return True
        if key in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            return delete_selected_vertices(self.canvas.session)
        if key in ARROWS and self.canvas.session.selection.count:
            length = LONG_NUDGE if event.modifiers() & Qt.KeyboardModifier.ShiftModifier else NUDGE
            self._nudge(np.array(ARROWS[key]) * length)
            return True
        return False

    def _nudge(self, shift: FloatArray) -> None:
        session = self.canvas.session
        edit = changed_vertices(session, session.selection, lambda p: p + shift)
        session.apply("Nudge Vertices", edit, merge_key=("nudge", tuple(session.selection.vertices.items())))

    def cancel(self) -> None:
        press, self._press = self._press, None
        if press is not None and press.gesture is not None:
            press.gesture.cancel()
        self.canvas.set_hover(None)
        self.canvas.refresh()

    # the box round the selection

    def _box(self) -> QRectF | None:
        """The rectangle round the selected vertices in stage px; None where there is nothing to turn."""
        session = self.canvas.session
        if session.selection.count < 2:
            return None
        chosen = [
            outline_of(session.document, session, r).points[list(i)] for r, i in session.selection.vertices.items()
        ]
        left, top, right, bottom = box_around(np.concatenate(chosen))
        return QRectF(QPointF(left, top), QPointF(right, bottom))

    def _view_box(self, box: QRectF, paper: Paper) -> QRectF:
        seen = self.canvas.camera.transform(paper.offset).mapRect(box)
        wide = max(0.0, (SMALLEST_BOX - seen.width()) / 2) + BOX_MARGIN
        high = max(0.0, (SMALLEST_BOX - seen.height()) / 2) + BOX_MARGIN
        return seen.adjusted(-wide, -high, wide, high)

    def _papers(self) -> list[Paper]:
        """The papers that show a selected outline."""
        chosen = self.canvas.session.selection.vertices
        return list(dict.fromkeys(p for p, _, ref, _ in self.canvas.content.outlines() if ref in chosen))

    def _handle_under(self, at: QPointF) -> tuple[str, Paper, QRectF] | None:
        box = self._box()
        if box is None:
            return None
        for paper in self._papers():
            for name, place in handle_places(self._view_box(box, paper)).items():
                d = place - at
                if math.hypot(d.x(), d.y()) <= HANDLE_REACH:
                    return name, paper, box
        return None

    def _label(self, press: _Press) -> str:
        what = "Vertex" if self.canvas.session.selection.count == 1 else "Vertices"
        return {"move": f"Move {what}", "turn": "Turn"}.get(press.kind, "Scale")

    def _change(self, press: _Press, pointer: Pointer) -> Change:
        camera, offset = self.canvas.camera, press.paper.offset
        start, end = (np.array(camera.to_stage(p, offset)) for p in (press.at, pointer.at))
        if press.kind == "move":
            return shifted(start, end, straight=pointer.shift)
        if press.kind == "turn":
            return turned(press.box, start, end, steps=pointer.shift)
        return scaled(press.box, press.kind, start, end, even=pointer.shift, about_centre=pointer.alt)

    def _select_box(self, view: QRectF, *, add: bool) -> None:
        content, camera = self.canvas.content, self.canvas.camera
        chosen = dict(self.canvas.session.selection.vertices) if add else {}
        for paper, _, ref, outline in content.outlines():
            p = camera.to_view(outline.points, paper.offset)
            inside = (
                (p[:, 0] >= view.left())
                & (p[:, 0] <= view.right())
                & (p[:, 1] >= view.top())
                & (p[:, 1] <= view.bottom())
            )
            found = set(np.flatnonzero(inside).tolist()) | set(chosen.get(ref, ()))
            if found:
                chosen[ref] = tuple(sorted(found))
        self.canvas.session.select(Selection(chosen))

    def paint(self, painter: QPainter) -> None:
        press, theme = self._press, self.canvas.theme
        if press is not None and press.kind == "box" and press.now is not None:
            painter.setPen(QPen(theme.color("accent"), 1, Qt.PenStyle.DashLine))
            painter.setBrush(theme.color("accent", 0.10))
            painter.drawRect(QRectF(press.at, press.now).normalized())
            return
        box = self._box()
        if box is None or (press is not None and press.kind == "turn" and press.now is not None):
            return
        for paper in self._papers():
            view = self._view_box(box, paper)
            painter.setPen(QPen(theme.color("accent", 0.7), 1, Qt.PenStyle.DashLine))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRect(view)
            painter.setPen(QPen(theme.color("accent"), 1.4))
            painter.setBrush(theme.color("stage"))
            for name, place in handle_places(view).items():
                if name == "turn":
                    painter.drawLine(QPointF(view.center().x(), view.top()), place)
                    painter.drawEllipse(place, 5, 5)
                else:
                    painter.drawRect(QRectF(place.x() - 3.5, place.y() - 3.5, 7, 7))


def handle_places(view: QRectF) -> dict[str, QPointF]:
    """Return where the handles of a box lie, in view px."""
    places = {
        name: QPointF(view.left() + fx * view.width(), view.top() + fy * view.height())
        for name, (fx, fy) in HANDLES.items()
    }
    places["turn"] = QPointF(view.center().x(), view.top() - TURN_HANDLE)
    return places


def shifted(start: FloatArray, end: FloatArray, *, straight: bool) -> Change:
    """Move along; `straight` keeps to the nearer of the two axes."""
    d = end - start
    if straight:
        d[int(abs(d[0]) > abs(d[1]))] = 0.0
    return lambda p: p + d


def turned(box: QRectF, start: FloatArray, end: FloatArray, *, steps: bool) -> Change:
    """Turn about the box's centre; `steps` turns by multiples of 15 degrees."""
    c = np.array([box.center().x(), box.center().y()])
    a, b = start - c, end - c
    angle = math.atan2(b[1], b[0]) - math.atan2(a[1], a[0])
    if steps:
        angle = round(angle / math.radians(15)) * math.radians(15)
    cos, sin = math.cos(angle), math.sin(angle)
    return lambda p: (p - c) @ np.array([[cos, sin], [-sin, cos]]) + c


def scaled(
    box: QRectF, handle: str, start: FloatArray, end: FloatArray, *, even: bool, about_centre: bool
) -> Change:
    """Scale so that the handle follows the pointer; the opposite side, or the centre, stays."""
    fx, fy = HANDLES[handle]
    anchor = np.array([0.5, 0.5]) if about_centre else np.array([1 - fx, 1 - fy])
    fixed = np.array([box.left() + anchor[0] * box.width(), box.top() + anchor[1] * box.height()])
    factor = np.ones(2)
    for axis, (f, length) in enumerate(((fx, box.width()), (fy, box.height()))):
        reach = (f - anchor[axis]) * length
        if f != 0.5 and abs(reach) > 1e-9:
            factor[axis] = 1 + (end[axis] - start[axis]) / reach
    if even:
        moving = [i for i, f in enumerate((fx, fy)) if f != 0.5]
        factor[:] = max((factor[i] for i in moving), key=lambda f: abs(f - 1))
    factor = np.where(
        np.abs(factor) < 1e-3, np.copysign(1e-3, factor), factor
    )  # never flat: it could not come back
    return lambda p: fixed + (p - fixed) * factor


def outline_of(document: Document, session: Session, ref: OutlineRef):
    """Return the outline that a reference names."""
    frame, outline_id = ref
    return document.layer(session.layer.id).keyframe_at(frame).drawing.outline(outline_id)


def changed_vertices(session: Session, selection: Selection, change: Change) -> Callable[[Document], Document]:
    """Return the edit that applies `change` to the selected vertices."""
    layer_id = session.layer.id
    by_frame: dict[int, dict[int, list[int]]] = {}
    for (frame, outline_id), indices in selection.vertices.items():
        by_frame.setdefault(frame, {})[outline_id] = list(indices)

    def edit(document: Document) -> Document:
        for frame, outlines in by_frame.items():
            moved = {}
            for outline_id, indices in outlines.items():
                points = outline_of(document, session, (frame, outline_id)).points.copy()
                points[indices] = change(points[indices])
                moved[outline_id] = points
            document = move_vertices(document, layer_id, frame, moved)
        return document

    return edit


def delete_selected_vertices(session: Session) -> bool:
    """Take the selected vertices away, and outlines that keep too few; False if none are selected."""
    chosen = session.selection.vertices
    if not chosen:
        return False

    def edit(document: Document) -> Document:
        for (frame, outline_id), indices in chosen.items():
            document = delete_vertices(document, session.layer.id, frame, {outline_id: indices})
        return document

    label = "Delete Vertex" if session.selection.count == 1 else "Delete Vertices"
    session.apply(label, edit, selection=Selection())
    return True

"""The pin tool: hold a point of the drawing before still, or draw the arc that it takes to the keyframe after."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QKeyEvent

from app.canvas.hits import OutlineHit, outline_around, outline_under
from app.canvas.papers import BEFORE, Paper
from app.canvas.pins import PinHit, Point, arc_pulled, arc_through, pin_under
from app.canvas.tool import Pointer, Tool
from app.session import Gesture, PinRef, Selection
from core.geometry.outline import points_at
from core.model.document import Document
from core.model.edits import add_pin, delete_pin, move_pin, set_pin_handles
from core.model.pins import SpanPin

Edit = Callable[[Document], Document]


@dataclass
class _Drag:
    """A press on a pin or on a place for one, and the edit that each place of the pointer means."""

    start: QPointF
    paper: Paper
    label: str
    edit: Callable[[Pointer, Point], Edit | None]
    gesture: Gesture | None = None
    moved: bool = False


class PinTool(Tool):
    name, icon = "Pin", "pin"
    hint = (
        "Click a point of the drawing before; drag a pin, its path or its squares to bend the arc. "
        "Double click: straight again. Delete: take away."
    )
    held = (("Shift", "no snapping"), ("Alt", "move the pin"))
    cursor = Qt.CursorShape.CrossCursor
    only_draws = True
    shows_vertices = True
    shows_pins = True

    def __init__(self, canvas) -> None:
        super().__init__(canvas)
        self._drag: _Drag | None = None

    @property
    def busy(self) -> bool:
        return self._drag is not None

    def wants_key(self, event: QKeyEvent) -> bool:
        if event.key() in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            return self.canvas.session.selection.pin is not None
        return super().wants_key(event)

    # the pointer

    def press(self, pointer: Pointer) -> None:
        hit = self._pin_hit(pointer)
        if hit is not None:
            self.canvas.session.select(Selection(pin=hit.mark.ref))
            self._drag = self._taken(hit, pointer)
            return
        self.canvas.session.select(Selection())
        found = self._place_for_pin(pointer)
        if found is not None:
            self._make(*found, pointer)

    def drag(self, pointer: Pointer) -> None:
        drag = self._drag
        if drag is None:
            return
        if not drag.moved:
            if not pointer.far_from(drag.start):
                return
            drag.moved = True
        edit = drag.edit(pointer, self.canvas.camera.to_stage(pointer.at, drag.paper.offset))
        if edit is None:
            return
        if drag.gesture is None:
            drag.gesture = self.canvas.session.begin(drag.label)
        drag.gesture.update(edit, quiet=True)
        self.canvas.set_hover(pointer.at if drag.label != "Move Pin" else None)

    def release(self, pointer: Pointer) -> None:
        drag, self._drag = self._drag, None
        if drag is not None and drag.gesture is not None:
            drag.gesture.commit()
        self.hover(pointer)
        self.canvas.refresh()

    def hover(self, pointer: Pointer) -> None:
        hit = self._pin_hit(pointer)
        if hit is not None:
            self.canvas.set_hover(QPointF(*self.canvas.camera.to_view(hit.place, hit.paper.offset)))
            return
        edge = self._outline_hit(pointer)
        self.canvas.set_hover(self._spot(edge) if edge else None)

    def double_click(self, pointer: Pointer) -> None:
        """Make the way of a pin straight again."""
        self.cancel()
        hit = self._pin_hit(pointer)
        if hit is not None and hit.mark.handles is not None:
            session, ref = self.canvas.session, hit.mark.ref
            session.apply("Straighten Arc", set_pin_handles, session.layer.id, ref.frame, ref.index, None)

    def key(self, event: QKeyEvent) -> bool:
        if event.key() == Qt.Key.Key_Escape and self._drag:
            self.cancel()
            return True
        if event.key() in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            return delete_selected_pin(self.canvas.session)
        return False

    def cancel(self) -> None:
        drag, self._drag = self._drag, None
        if drag is not None and drag.gesture is not None:
            drag.gesture.cancel()
        self.canvas.set_hover(None)
        self.canvas.refresh()

    # what a press begins

    def _taken(self, hit: PinHit, pointer: Pointer) -> _Drag:
        """Pick up a pin, its way or a handle."""
        mark, part = hit.mark, hit.part
        if part == "pin" and pointer.alt:
            return _Drag(pointer.at, hit.paper, "Move Pin", lambda p, _: self._moved(mark.ref, p))
        if isinstance(part, int):
            other = mark.bent[1 - part]
            return self._bending(hit.paper, pointer, mark.ref, lambda at: (other, at) if part else (at, other))
        if part == "pin":
            return self._bending(hit.paper, pointer, mark.ref, lambda at: arc_through(mark, at))
        return self._bending(hit.paper, pointer, mark.ref, lambda at: arc_pulled(mark, hit.place, at))

    def _bending(self, paper: Paper, pointer: Pointer, ref: PinRef, arc: Callable[[Point], tuple[Point, Point]]):
        layer_id = self.canvas.session.layer.id

        def edit(_: Pointer, at: Point) -> Edit:
            return lambda document: set_pin_handles(document, layer_id, ref.frame, ref.index, arc(at))

        return _Drag(pointer.at, paper, "Bend Arc", edit)

    def _moved(self, ref: PinRef, pointer: Pointer) -> Edit | None:
        found = self._place_for_pin(pointer, quiet=True)
        if found is None:
            return None
        layer_id = self.canvas.session.layer.id
        return lambda document: move_pin(document, layer_id, ref.frame, ref.index, found[1])

    def _make(self, paper: Paper, pin: SpanPin, pointer: Pointer) -> None:
        """Make a pin at once; dragging on draws its arc in the same gesture."""
        session, before = self.canvas.session, self.canvas.content.before
        layer_id, ref = session.layer.id, PinRef(before.frame, len(before.span.pins))

        def add(document: Document) -> Document:
            return add_pin(document, layer_id, ref.frame, pin)

        gesture = session.begin("Add Pin")
        if not gesture.update(add):
            gesture.cancel()
            return
        session.select(Selection(pin=ref))
        mark = next((m for m in self.canvas.pin_marks if m.ref == ref), None)
        if mark is None:  # there was one at this very place
            gesture.cancel()
            return

        def edit(_: Pointer, at: Point) -> Edit:
            arc = arc_through(mark, at)
            return lambda document: set_pin_handles(add(document), layer_id, ref.frame, ref.index, arc)

        self._drag = _Drag(pointer.at, paper, gesture.label, edit, gesture)

    def _place_for_pin(self, pointer: Pointer, *, quiet: bool = False) -> tuple[Paper, SpanPin] | None:
        """Return the pin that a click would make; without one, say why where a click means something."""
        content, camera = self.canvas.content, self.canvas.camera
        edge = self._outline_hit(pointer)
        around = outline_around(content, camera, pointer.at, only=BEFORE)
        there = edge or around or outline_around(content, camera, pointer.at)
        if there is None:
            return None
        if content.before is None or content.after is None:
            self._tell("There is only one keyframe here: draw another one at a later frame, then pin points.")
            return None
        if edge is None and around is None:
            if not quiet:
                self._tell("Pins sit on the keyframe before: click a point of that drawing.")
            return None
        if edge is not None:
            return edge.paper, SpanPin(edge.ref[1], edge.position)
        paper = around[0]
        return paper, SpanPin(place=camera.to_stage(pointer.at, paper.offset))

    def _tell(self, text: str) -> None:
        self.canvas.session.problem.emit(text)

    # what lies under the pointer

    def _pin_hit(self, pointer: Pointer) -> PinHit | None:
        chosen = self.canvas.session.selection.pin
        return pin_under(self.canvas.content, self.canvas.pin_marks, self.canvas.camera, pointer.at, chosen)

    def _outline_hit(self, pointer: Pointer) -> OutlineHit | None:
        return outline_under(
            self.canvas.content, self.canvas.camera, pointer.at, vertices_first=not pointer.shift, side=BEFORE
        )

    def _spot(self, hit: OutlineHit) -> QPointF:
        outline = self.canvas.content.editable(hit.side).drawing.outline(hit.ref[1])
        place = points_at(outline.points, np.array([hit.position]), closed=outline.closed)[0]
        return QPointF(*self.canvas.camera.to_view(place, hit.paper.offset))


def delete_selected_pin(session) -> bool:
    """Take the selected pin away; False if none is selected."""
    ref = session.selection.pin
    if ref is None:
        return False
    session.apply("Delete Pin", delete_pin, session.layer.id, ref.frame, ref.index, selection=Selection())
    return True

"""The correspond tool: drag from a point of one outline to the point of the other that it becomes."""

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QKeyEvent, QPainter, QPen

from app.canvas.hits import AnchorHit, OutlineHit, anchor_places, anchor_under, outline_under
from app.canvas.lines import arrow, line_papers, line_under, start_marks
from app.canvas.papers import AFTER, BEFORE
from app.canvas.tool import Pointer, Tool
from app.session import AnchorRef, Gesture, Selection
from core.geometry.outline import points_at
from core.model.document import Anchor, Document
from core.model.edits import add_anchor, delete_anchor, move_anchor, set_muted

TARGET_REACH = 26.0
"""View px: while an end is dragged it sticks to the outline from this far, so that the hand may be loose."""


@dataclass
class _Drag:
    """An anchor under way: from an end that stays to the one in the hand."""

    fixed: OutlineHit
    hand_side: str
    gesture: Gesture
    old: AnchorRef | None
    hand: QPointF
    refused: bool = False
    landed: bool = False


class CorrespondTool(Tool):
    name, icon = "Correspond", "correspond"
    hint = (
        "Drag from outline to outline, or an end along its outline. "
        "Double click a line: anchor it. Delete: take away. M: mute."
    )
    held = (("Shift", "no snapping"),)
    cursor = Qt.CursorShape.PointingHandCursor
    only_draws = True
    shows_vertices = True
    shows_anchors = True

    def __init__(self, canvas) -> None:
        super().__init__(canvas)
        self._drag: _Drag | None = None

    @property
    def busy(self) -> bool:
        return self._drag is not None

    def wants_key(self, event: QKeyEvent) -> bool:
        if event.key() in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace, Qt.Key.Key_M):
            return self.canvas.session.selection.anchor is not None
        return super().wants_key(event)

    def press(self, pointer: Pointer) -> None:
        content = self.canvas.content
        end = anchor_under(content, self.canvas.camera, pointer.at)
        if end is not None:
            self._take_end(end, pointer)
            return
        self.canvas.session.select(Selection())
        start = self._outline_hit(pointer)
        if start is not None:
            if content.before is None or content.after is None:
                self.canvas.session.problem.emit(
                    "There is only one keyframe here: draw another one at a later frame, then join their points."
                )
                return
            other = AFTER if start.side == BEFORE else BEFORE
            self._drag = _Drag(start, other, self.canvas.session.begin("Add Anchor"), None, pointer.at)

    def _take_end(self, end: AnchorHit, pointer: Pointer) -> None:
        """Pick up one end of an anchor; the other end stays."""
        self.canvas.session.select(Selection(anchor=end.ref))
        before, after = self.canvas.content.before, self.canvas.content.after
        pair = before.span.pair_of(end.ref.before, end.ref.after)
        anchor = pair.anchors[end.ref.index]
        if end.side == BEFORE:
            side, ref, position = AFTER, (after.frame, end.ref.after), anchor.after
        else:
            side, ref, position = BEFORE, (before.frame, end.ref.before), anchor.before
        fixed = OutlineHit(end.paper, side, ref, position, None, 0.0)
        gesture = self.canvas.session.begin("Move Anchor")
        self._drag = _Drag(fixed, end.side, gesture, end.ref, pointer.at, landed=True)

    def drag(self, pointer: Pointer) -> None:
        drag = self._drag
        if drag is None:
            return
        drag.hand = pointer.at
        target = self._target(pointer, drag)
        if target is None:
            drag.landed = drag.old is not None
            drag.refused = False
            if drag.old is None:
                drag.gesture.reset()
        else:
            drag.landed = drag.gesture.update(self._edit(drag, target), quiet=True)
            drag.refused = not drag.landed
            drag.hand = self._spot(target)
        self.canvas.set_hover(self._spot(target) if target else None)
        self.canvas.refresh()

    def release(self, pointer: Pointer) -> None:
        drag, self._drag = self._drag, None
        if drag is None:
            return
        if drag.refused:
            drag.gesture.cancel()
            self.canvas.session.problem.emit("These anchors would cross, so this one was not made.")
        elif drag.landed:
            drag.gesture.commit()
            if drag.old is None:
                self._select_made()
        else:
            drag.gesture.cancel()
        self.canvas.refresh()

    def _select_made(self) -> None:
        """Select the anchor that was just made, so that Delete takes it away again."""
        before = self.canvas.content.before
        if before is not None and before.span.pairs:
            pair = before.span.pairs[-1]
            index = len(pair.anchors) - 1
            ref = AnchorRef(before.frame, pair.before, pair.after, index)
            self.canvas.session.select(Selection(anchor=ref))

    def hover(self, pointer: Pointer) -> None:
        content, camera = self.canvas.content, self.canvas.camera
        end = anchor_under(content, camera, pointer.at)
        if end is not None:
            place = next(p if end.side == BEFORE else q for r, p, q in anchor_places(content) if r == end.ref)
            self.canvas.set_hover(QPointF(*camera.to_view(place, end.paper.offset)))
            return
        hit = self._outline_hit(pointer)
        self.canvas.set_hover(self._spot(hit) if hit else None)

    def key(self, event: QKeyEvent) -> bool:
        if event.key() == Qt.Key.Key_Escape and self._drag:
            self.cancel()
            return True
        if event.key() in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            return delete_selected_anchor(self.canvas.session)
        if event.key() == Qt.Key.Key_M:
            return mute_selected_anchor(self.canvas.session)
        return False

    def double_click(self, pointer: Pointer) -> None:
        """Make the line of the correspondence under the pointer an anchor."""
        self.cancel()
        line = line_under(self.canvas.content, self.canvas.camera, pointer.at)
        if line is None:
            return
        session = self.canvas.session
        pair, anchor = (line.before, line.after), Anchor(*line.places)
        frame = self.canvas.content.before.frame
        if session.apply("Add Anchor", add_anchor, session.layer.id, frame, *pair, anchor):
            self._select_made()

    def cancel(self) -> None:
        drag, self._drag = self._drag, None
        if drag is not None:
            drag.gesture.cancel()
        self.canvas.set_hover(None)
        self.canvas.refresh()

    def paint(self, painter: QPainter) -> None:
        self._paint_starts(painter)
        drag = self._drag
        if drag is None or (drag.landed and not drag.refused):
            return
        color = self.canvas.theme.color("error" if drag.refused else "accent")
        style = Qt.PenStyle.SolidLine if drag.refused else Qt.PenStyle.DashLine
        painter.setPen(QPen(color, 1.8, style))
        start = self._spot(drag.fixed)
        painter.drawLine(start, drag.hand)
        painter.setBrush(color)
        painter.drawEllipse(start, 4, 4)
        painter.drawEllipse(drag.hand, 4, 4)

    def _paint_starts(self, painter: QPainter) -> None:
        """Show where the correspondence begins on both outlines, and which way it runs."""
        content, theme = self.canvas.content, self.canvas.theme
        for start, end in line_papers(content):
            for mark in start_marks(content):
                paper = start if mark.side == BEFORE else end
                at = QPointF(*self.canvas.camera.to_view(mark.place, paper.offset))
                painter.setPen(QPen(theme.color("stage"), 1.2))
                painter.setBrush(theme.color(mark.side))
                painter.drawPolygon(arrow(at, mark.direction, 9.0))

    def _outline_hit(self, pointer: Pointer) -> OutlineHit | None:
        return outline_under(
            self.canvas.content, self.canvas.camera, pointer.at, vertices_first=not pointer.shift, reach=10.0
        )

    def _target(self, pointer: Pointer, drag: _Drag) -> OutlineHit | None:
        """The point of the other outline under the hand; an old anchor stays on the outlines it joins."""
        hit = outline_under(
            self.canvas.content,
            self.canvas.camera,
            pointer.at,
            vertices_first=not pointer.shift,
            reach=TARGET_REACH,
            side=drag.hand_side,
        )
        if hit is not None and drag.old is not None:
            own = drag.old.before if drag.hand_side == BEFORE else drag.old.after
            return hit if hit.ref[1] == own else None
        return hit

    def _edit(self, drag: _Drag, target: OutlineHit):
        """The edit that ties the two places together."""
        before, after = (drag.fixed, target) if drag.fixed.side == BEFORE else (target, drag.fixed)
        session = self.canvas.session
        frame, layer_id = before.ref[0], session.layer.id
        pair = before.ref[1], after.ref[1]
        anchor = Anchor(before.position, after.position)
        old = drag.old

        def edit(document: Document) -> Document:
            if old is None:
                return add_anchor(document, layer_id, frame, *pair, anchor)
            return move_anchor(document, layer_id, frame, *pair, old.index, anchor)

        return edit

    def _spot(self, hit: OutlineHit) -> QPointF:
        keyframe = self.canvas.content.editable(hit.side)
        outline = keyframe.drawing.outline(hit.ref[1])
        place = points_at(outline.points, np.array([hit.position]), closed=outline.closed)[0]
        return QPointF(*self.canvas.camera.to_view(place, hit.paper.offset))


def delete_selected_anchor(session) -> bool:
    """Take the selected anchor away; False if none is selected."""
    ref = session.selection.anchor
    if ref is None:
        return False
    session.apply(
        "Delete Anchor",
        delete_anchor,
        session.layer.id,
        ref.frame,
        ref.before,
        ref.after,
        ref.index,
        selection=Selection(),
    )
    return True


def mute_selected_anchor(session) -> bool:
    """Mute the selected anchor, or let it take effect again; False if none is selected."""
    ref = session.selection.anchor
    if ref is None:
        return False
    pair = session.layer.keyframe_at(ref.frame).span.pair_of(ref.before, ref.after)
    muted = not pair.anchors[ref.index].muted
    label = "Mute Anchor" if muted else "Unmute Anchor"
    places = (ref.frame, ref.before, ref.after, ref.index)
    session.apply(label, set_muted, session.layer.id, *places, muted)
    return True

"""The span panel: how vertices travel between the two keyframes around the playhead."""

from PySide6.QtGui import QAction
from PySide6.QtWidgets import QCheckBox, QHBoxLayout, QProgressBar, QPushButton, QWidget

from app.panels.parts import Section, Segments, flat_button, label, number_field, show_value
from app.preview.spans import SpanPreview
from app.session import Session
from app.view import ViewState
from core.model.document import MOST_TURNS, Keyframe
from core.model.edits import clear_anchors, set_span

METHODS = (
    ("linear", "linear", "Every vertex goes straight: fast and plain; what turns gets smaller on the way"),
    ("intrinsic", "intrinsic", "Edge lengths and angles change evenly: limbs bend and keep their size"),
    ("rigid", "rigid", "The inside stays as stiff as it can: areas hold, thick and thin alike"),
    ("auto", "auto", "The better of rigid and intrinsic, by their certificates"),
)
PLACEMENTS = (
    (
        "still",
        "still parts stay",
        "What hardly moves between the keyframes stays where it is: a foot does not slide",
    ),
    ("centroid", "centroid straight", "The middle of the area goes straight, as that of a thrown thing does"),
)
STROKES_ONLY = "Strokes have no inside that could be stiff: they move as with intrinsic"
LINES = (
    ("all", "all", "Draw the lines of the whole correspondence"),
    ("anchors", "anchors", "Draw only the pairs that you fixed"),
    ("none", "none", "Draw no lines"),
)


class SpanPanel(QWidget):
    """Method, extra turns and the correspondence of the span under the playhead."""

    def __init__(
        self,
        session: Session,
        view: ViewState,
        actions: dict[str, QAction],
        preview: SpanPreview,
        alternatives: QWidget,
        parent: QWidget | None = None,
    ) -> None:
        """`alternatives` is the panel shown below the correspondence."""
        super().__init__(parent)
        self.alternatives, self.preview = alternatives, preview
        self.session, self.view_state = session, view
        self._method_section(actions)
        self._correspondence_section(actions)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setDirection(QHBoxLayout.Direction.TopToBottom)
        row.addWidget(self.span_section)
        row.addWidget(self.correspondence_section)
        for signal in (session.documentChanged, session.frameChanged, session.layerChanged, view.changed):
            signal.connect(self._refresh)
        preview.planned.connect(self._refresh)
        for signal in (session.documentChanged, session.frameChanged, session.layerChanged):
            signal.connect(lambda *_: self._on_pointed(self._pointed))
        self._refresh()

    def _method_section(self, actions: dict[str, QAction]) -> None:
        self.span_section = Section("Span")
        self.methods = Segments(METHODS)
        self.methods.chosen.connect(self._on_method)
        self.methods.pointed.connect(self._on_pointed)
        self._pointed = ""
        self.span_section.box.addWidget(self.methods)
        self.about = label("", "muted")
        self.about.setWordWrap(True)
        self.span_section.box.addWidget(self.about)
        self.turns = number_field(
            -MOST_TURNS,
            MOST_TURNS,
            "Extra whole turns on the way, clockwise; not for linear",
            self._on_turns,
        )
        self.other_way = QPushButton("Other way round")
        self.other_way.setToolTip(actions["span.other_way"].toolTip())
        self.other_way.clicked.connect(actions["span.other_way"].trigger)
        self.compare = QPushButton("Compare")
        self.compare.setCheckable(True)
        self.compare.setToolTip("Show linear and intrinsic beside each other, at t = 0, 0.2 ... 1")
        self.compare.clicked.connect(lambda on: self.view_state.set(arrangement="compare" if on else "overlaid"))
        self.span_section.add_row("turns", self.turns, self.other_way)
        self.placement = Segments(PLACEMENTS)
        self.placement.chosen.connect(self._on_placement)
        self.span_section.box.addWidget(self.placement)
        self.repair = QCheckBox("repair crossings")
        self.repair.setToolTip("Bend the in-betweens just as far as needed, so that none crosses itself")
        self.repair.clicked.connect(self._on_repair)
        self.progress = QProgressBar()
        self.progress.setTextVisible(False)
        self.progress.setFixedHeight(6)
        self.progress.setRange(0, 100)
        self.stop = flat_button("Stop", "Leave this span unrepaired for now")
        self.stop.clicked.connect(self._on_stop)
        row = QHBoxLayout()
        for widget in (self.repair, self.progress, self.stop, self.compare):
            row.addWidget(widget)
        self.span_section.box.addLayout(row)
        self.preview.progressed.connect(lambda share: self.progress.setValue(round(100 * share)))

    def _correspondence_section(self, actions: dict[str, QAction]) -> None:
        self.correspondence_section = Section("Correspondence")
        self.lines = Segments(LINES)
        self.lines.chosen.connect(lambda value: self.view_state.set(lines=value))
        self.correspondence_section.box.addWidget(self.lines)
        row = QHBoxLayout()
        self.add = flat_button("Add anchors", "Take the correspond tool: drag from outline to outline")
        self.add.clicked.connect(actions["tool.correspond"].trigger)
        self.clear = flat_button("Clear anchors", "Forget every pair that you fixed in this span")
        self.clear.clicked.connect(self._on_clear)
        row.addWidget(self.add)
        row.addStretch(1)
        row.addWidget(self.clear)
        self.correspondence_section.box.addLayout(row)
        self.correspondence_section.box.addWidget(self.alternatives)

    def _refresh(self, *_: object) -> None:
        before, after = self.session.span_keyframes()
        there = before is not None and after is not None
        for widget in (
            self.methods,
            self.turns,
            self.other_way,
            self.placement,
            self.compare,
            self.add,
            self.repair,
        ):
            widget.setEnabled(there)
        self.lines.set_value(self.view_state.options.lines)
        self.compare.setChecked(self.view_state.options.arrangement == "compare")
        repairing = there and before.span.repair and self.preview.waiting(before, self.session.layer.id)
        self.progress.setVisible(repairing)
        self.stop.setVisible(repairing)
        if not there or before is None or after is None:
            self.span_section.title.setText("SPAN")
            self.about.setText(self._advice())
            self.correspondence_section.note.setText("")
            self.clear.setEnabled(False)
            return
        span = before.span
        self.span_section.title.setText(f"SPAN {before.frame} TO {after.frame}")
        self.methods.set_value(span.method)
        self.repair.setChecked(span.repair)
        self.about.setText(self._about(before, after))
        show_value(self.turns, span.turns)
        self.placement.set_value(span.placement)
        for widget in (self.turns, self.other_way):
            widget.setEnabled(span.method != "linear")
        self.placement.setEnabled(span.method != "linear" and not span.pins)
        count = sum(len(p.anchors) for p in span.pairs)
        self.correspondence_section.note.setText(
            f"{count} anchor{'' if count == 1 else 's'}" if count else "automatic"
        )
        self.clear.setEnabled(bool(span.pairs))

    def _about(self, before: Keyframe, after: Keyframe) -> str:
        """Say what the method does; of auto what it chose, and what did not go as asked."""
        span = before.span
        if span.hold:
            return f"Held: the drawing of keyframe {before.frame} stays until {after.frame}, with no in-betweens."
        method = self.preview.tried_method(before, self.session.layer.id) or span.method
        plan = self.preview.plan(before, after, self.session.layer.id)
        if self.preview.waiting(before, self.session.layer.id):
            what = "the repair" if span.repair else method
            return f"Solving {what}; until then {plan.paths.method} is shown."
        tip = next(tip for value, _, tip in METHODS if value == method)
        if method == "rigid" and not any(o.closed for k in (before, after) for o in k.drawing.outlines):
            tip = STROKES_ONLY
        return ". ".join((plan.paths.reason or tip, *plan.paths.notes))

    def _advice(self) -> str:
        count = len(self.session.layer.keyframes)
        if count == 0:
            return "Draw the first keyframe: take the pen or the pencil."
        if count == 1:
            return "One keyframe so far. Go to another frame and draw the second one, or add a copy there."
        return "The playhead stands outside the keyframes."

    def _frame(self) -> int | None:
        before, after = self.session.span_keyframes()
        return before.frame if before is not None and after is not None else None

    def _on_method(self, method: str) -> None:
        frame = self._frame()
        if frame is not None:
            self.session.apply("Change Method", set_span, self.session.layer.id, frame, method=method)

    def _on_pointed(self, method: str) -> None:
        """Show the in-betweens by the method under the pointer as long as it rests there."""
        self._pointed = method
        before, after = self.session.span_keyframes()
        there = method and before is not None and after is not None and not self.session.in_gesture
        self.preview.try_method(before if there else None, self.session.layer.id, method)

    def _on_placement(self, placement: str) -> None:
        frame = self._frame()
        if frame is not None:
            self.session.apply("Change Placement", set_span, self.session.layer.id, frame, placement=placement)

    def _on_repair(self, on: bool) -> None:
        frame = self._frame()
        if frame is not None:
            label = "Repair Crossings" if on else "Leave Crossings"
            self.session.apply(label, set_span, self.session.layer.id, frame, repair=on)

    def _on_stop(self) -> None:
        self.preview.cancel_slow()
        self._on_repair(False)

    def _on_turns(self, turns: int) -> None:
        frame = self._frame()
        if frame is not None:
            self.session.apply(
                "Change Turns", set_span, self.session.layer.id, frame, turns=turns, merge_key=("turns", frame)
            )

    def _on_clear(self) -> None:
        frame = self._frame()
        if frame is not None:
            self.session.apply("Clear Anchors", clear_anchors, self.session.layer.id, frame)

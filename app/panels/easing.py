"""The easing of a span: presets, the curve, and beside it the timing chart, two views of one thing."""

from collections.abc import Callable

from PySide6.QtWidgets import QCheckBox, QComboBox, QHBoxLayout, QWidget

from app.panels.chart import TimingChart
from app.panels.curve import EasingPlot
from app.panels.parts import Section, Segments, flat_button, label, number_field, show_value
from app.panels.spacing import Spacing
from app.session import Gesture, Session
from app.theme import Theme
from core.model.document import LONGEST_STEP, Document, Keyframe, Span
from core.model.easing import PRESETS, Easing, preset_name
from core.model.edits import delete_tick, divide_tick, move_tick, set_smooth, set_span, set_step
from core.model.sheet_edits import hold_over

Edit = Callable[..., Document]
OWN_CURVE = "own curve"
HOLD = "hold"
MOVE = "Move Drawing in Chart"
STEPS = (
    ("1", "on ones", "A new drawing on every frame"),
    ("2", "twos", "A new drawing on every second frame"),
    ("3", "threes", "A new drawing on every third frame"),
)
SMOOTH_TIP = (
    "Smooth: the motion goes through keyframe {0} without a jump in its velocity.\n"
    "Sharp (off): what comes before and what comes after know nothing of each other."
)


class EasingPanel(Section):
    """For the span under the playhead."""

    def __init__(self, session: Session, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__("Easing", parent)
        self.session = session
        self._gesture: Gesture | None = None
        self._frame: int | None = None
        self._held_span = 0, 0
        self._make_presets()
        self.plot, self.chart = EasingPlot(theme), TimingChart(theme)
        views = QHBoxLayout()
        views.setSpacing(4)
        views.addWidget(self.plot, 1)
        views.addWidget(self.chart)
        self.box.addLayout(views)
        self._make_drawing_row()
        self._make_smooth_row()
        self._connect_views()
        for signal in (session.documentChanged, session.frameChanged, session.layerChanged):
            signal.connect(self._refresh)
        self._refresh()

    def _make_presets(self) -> None:
        self.presets = QComboBox()
        self.presets.addItems([*PRESETS, HOLD, OWN_CURVE])
        self.presets.setToolTip("How the drawings are spaced between the two keyframes")
        self.presets.activated.connect(self._on_preset)
        self.box.addWidget(self.presets)
        self.steps = Segments(STEPS)
        self.steps.chosen.connect(lambda step: self._on_step(int(step), key=None))
        self.step_field = number_field(
            0, LONGEST_STEP, "Frames that each drawing is held; own: the timing chart says so", self._on_step, 52
        )
        self.step_field.setSpecialValueText("own")
        row = QHBoxLayout()
        row.setSpacing(6)
        row.addWidget(self.steps, 1)
        row.addWidget(self.step_field)
        self.box.addLayout(row)

    def _make_drawing_row(self) -> None:
        """The drawing at the playhead: how long it is held; and what divides the way to the next one."""
        self.half = flat_button("Half", "Add a drawing in the middle between this one and the next")
        self.thirds = flat_button("Thirds", "Add two drawings between this one and the next")
        self.delete = flat_button("Delete", "Take this drawing out; the one before is held in its place")
        self.half.clicked.connect(lambda: self._divide(self._here(), 2))
        self.thirds.clicked.connect(lambda: self._divide(self._here(), 3))
        self.delete.clicked.connect(lambda: self._delete(self._here()))
        self.held_field = number_field(
            1, LONGEST_STEP, "Frames that the drawing at the playhead is held", self._on_held, 44
        )
        row = QHBoxLayout()
        row.setSpacing(4)
        row.addWidget(label("held", "muted"))
        row.addWidget(self.held_field)
        row.addStretch(1)
        for button in (self.half, self.thirds, self.delete):
            row.addWidget(button)
        self.box.addLayout(row)

    def _make_smooth_row(self) -> None:
        self.smooth = (QCheckBox(), QCheckBox())
        for i, box in enumerate(self.smooth):
            box.clicked.connect(lambda on, i=i: self._on_smooth(i, on))
        self.add_row("smooth through", *self.smooth)

    def _connect_views(self) -> None:
        plot, chart = self.plot, self.chart
        plot.pressed.connect(lambda: self._begin("Change Easing"))
        plot.moved.connect(lambda easing: self._update(set_span, easing=easing))
        plot.changed.connect(self._on_curve_changed)
        plot.refused.connect(self.session.problem)
        chart.pressed.connect(lambda: self._begin(MOVE))
        chart.moved.connect(lambda index, t: self._update(move_tick, index, t))
        for view in (plot, chart):
            view.released.connect(lambda: self._end(keep=True))
            view.escaped.connect(lambda: self._end(keep=False))
        chart.frameWanted.connect(self.session.go_to)
        chart.nudged.connect(lambda i, t: self._apply(MOVE, move_tick, i, t, key=("tick", i)))
        chart.exposureWanted.connect(self._hold)
        chart.divisionWanted.connect(self._divide)
        chart.deletionWanted.connect(self._delete)
        chart.hovered.connect(self._on_hovered)

    def set_theme(self, theme: Theme) -> None:
        self.plot.set_theme(theme)
        self.chart.set_theme(theme)

    # showing

    def _refresh(self, *_: object) -> None:
        before, after = self.session.span_keyframes()
        there = before is not None and after is not None
        spacing = None
        if there:
            spacing = Spacing(before.span, before.frame, after.frame, self.session.frame)
        self._frame = before.frame if there else None
        for widget in (self.presets, self.plot, self.chart):
            widget.setEnabled(there)
        self.plot.show_spacing(spacing)
        self.chart.show_spacing(spacing)
        self._show_choices(before.span if there else Span(), charted=there)
        self._show_drawing(spacing)
        self._show_smooth(before, after)

    def _show_choices(self, span: Span, *, charted: bool) -> None:
        self.presets.setCurrentText(HOLD if span.hold else preset_name(span.easing) or OWN_CURVE)
        live = charted and not span.hold
        self.steps.setEnabled(live)
        self.step_field.setEnabled(live)
        step = 0 if span.exposures else span.step
        self.steps.set_value(str(step) if charted else "")
        show_value(self.step_field, step)

    def _show_drawing(self, spacing: Spacing | None) -> None:
        here = spacing.here if spacing is not None else None
        live = here is not None and not spacing.span.hold
        for button in (self.half, self.thirds):
            button.setEnabled(live)
        self.delete.setEnabled(live and here > 0)
        self.held_field.setEnabled(live and here < len(spacing.ticks) - 1)
        count = spacing.exposures[here] if here is not None else 1
        show_value(self.held_field, count)
        self._on_hovered(-1)

    def _show_smooth(self, before: Keyframe | None, after: Keyframe | None) -> None:
        """Show both ends; at the first and the last keyframe of a layer there is nothing to go through."""
        frames = self.session.layer.frames()
        for box, keyframe in zip(self.smooth, (before, after), strict=True):
            inside = keyframe is not None and keyframe.frame in frames[1:-1]
            box.setEnabled(inside)
            box.setText(str(keyframe.frame) if keyframe is not None else "–")
            box.setAccessibleName(f"Smooth through keyframe {box.text()}")
            box.setChecked(keyframe is not None and keyframe.smooth)
            tip = (
                SMOOTH_TIP.format(keyframe.frame) if inside else "Only between two spans is there a way to smooth"
            )
            box.setToolTip(tip)

    def _on_hovered(self, index: int) -> None:
        """Tell of the drawing under the pointer, else of the one at the playhead."""
        spacing = self.plot.spacing
        if spacing is None:
            self.note.setText("")
        elif index < 0 and spacing.here is not None:
            self.note.setText(spacing.told(spacing.here))
        elif 0 <= index < len(spacing.ticks):
            self.note.setText(spacing.told(index))
        else:
            self.note.setText(f"keyframe {spacing.last}")

    def _here(self) -> int | None:
        return self.plot.spacing.here if self.plot.spacing is not None else None

    # changing

    def _apply(self, text: str, edit: Edit, *args: object, key: object = None, **options) -> None:
        """Edit the span that is shown; edits with the same `key` in a row are one step."""
        if self._frame is not None:
            if key is not None:
                options["merge_key"] = (key, self.session.layer.id, self._frame)
            self.session.apply(text, edit, self.session.layer.id, self._frame, *args, **options)
        self._refresh()

    def _begin(self, text: str) -> None:
        if self._frame is not None:
            self._held_span = self.session.layer.id, self._frame  # the film may play on meanwhile
            self._gesture = self.session.begin(text)

    def _update(self, edit: Edit, *args: object, **options: object) -> None:
        span = self._held_span
        if self._gesture is not None:
            self._gesture.update(lambda d: edit(d, *span, *args, **options))

    def _end(self, *, keep: bool) -> None:
        gesture, self._gesture = self._gesture, None
        if gesture is not None:
            if keep:
                gesture.commit()
            else:
                gesture.cancel()

    def _on_preset(self, _: int) -> None:
        name = self.presets.currentText()
        if name == HOLD:
            self._apply("Hold Keyframe", set_span, hold=True)
        elif name in PRESETS:
            self._apply("Change Easing", set_span, easing=PRESETS[name], hold=False)
        else:
            self._apply("Change Easing", set_span, hold=False)

    def _on_curve_changed(self, text: str, easing: Easing, key: object) -> None:
        self._apply(text, set_span, easing=easing, key=key)

    def _on_step(self, step: int, key: object = ("step",)) -> None:
        spacing = self.plot.spacing
        if spacing is not None and step > 0 and (step != spacing.span.step or spacing.span.exposures):
            self._apply(f"Put on {_step_name(step)}", set_step, step, key=key)
        else:
            self._refresh()

    def _on_held(self, count: int) -> None:
        here = self._here()
        if here is not None and self.plot.spacing.exposures[here] != count:
            self._hold(here, count)

    def _hold(self, index: int, count: int) -> None:
        self._apply("Change Exposure", hold_over, index, count, key=("held", index))

    def _divide(self, index: int | None, parts: int) -> None:
        if index is not None:
            self._apply("Add Half" if parts == 2 else "Add Thirds", divide_tick, index, parts)

    def _delete(self, index: int | None) -> None:
        if index is not None:
            self._apply("Delete Drawing", delete_tick, index)

    def _on_smooth(self, end: int, on: bool) -> None:
        keyframe = self.session.span_keyframes()[end]
        if keyframe is not None:
            text = "Smooth Keyframe" if on else "Sharp Keyframe"
            self.session.apply(text, set_smooth, self.session.layer.id, [keyframe.frame], on)
        self._refresh()


def _step_name(step: int) -> str:
    return {1: "Ones", 2: "Twos", 3: "Threes"}.get(step, f"{step}s")

"""The timeline: transport, frame and rate fields, onion skin, and the track below."""

from fractions import Fraction

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QAction, QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QLineEdit, QToolButton, QVBoxLayout, QWidget

from app.keys import Keys
from app.panels.onion import OnionFields
from app.panels.parts import label, number_field, separator, show_value
from app.panels.track import Track
from app.playback import Playback
from app.preview.certificates import CertificatePreview
from app.session import Session
from app.theme import Theme
from app.view import ViewState
from core.errors import InkbetweenError
from core.model.document import LONGEST, as_rate
from core.model.edits import set_length, set_rate
from core.model.timing import drawn_ratio

ROOMY = 960
"""Width in px from which the onion skin's fields fit beside the rest."""
STEPPING = ("play.first", "play.previous", "play.toggle", "play.next", "play.last")
BUTTONS = (*STEPPING, "play.loop", "play.ping_pong", "key.add")
AFTER_BUTTON = {"play.last": 6, "key.add": 10}
"""Room in px behind the last button of a group."""


class Timeline(QWidget):
    """See the module. `actions` gives the buttons their QActions by id."""

    def __init__(
        self,
        session: Session,
        view: ViewState,
        playback: Playback,
        certificates: CertificatePreview,
        keys: Keys,
        theme: Theme,
        actions: dict[str, QAction],
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("timeline")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self.session, self.view_state, self.playback, self.theme = session, view, playback, theme
        self.track = Track(session, certificates, keys, theme, actions)
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.setSpacing(0)
        box.addWidget(self._bar(actions))
        box.addWidget(separator())
        box.addWidget(self.track, 1)
        session.documentChanged.connect(self._refresh)
        session.frameChanged.connect(self._refresh)
        session.layerChanged.connect(self._refresh)
        view.changed.connect(self._refresh)
        self._refresh()

    def _bar(self, actions: dict[str, QAction]) -> QWidget:
        bar = QWidget()
        bar.setFixedHeight(48)
        row = QHBoxLayout(bar)
        row.setContentsMargins(12, 8, 16, 8)
        row.setSpacing(4)
        buttons = {name: action_button(actions[name]) for name in BUTTONS}
        for name, button in buttons.items():
            row.addWidget(button)
            row.addSpacing(AFTER_BUTTON.get(name, 0))
        self.t_label = label("", "strong")
        self.t_label.setMinimumWidth(52)
        self.t_label.setToolTip("Eased time in the span, 0 at the keyframe before and 1 at the one after")
        row.addWidget(self.t_label)
        frame, fps = self._add_frame_fields(row)
        row.addStretch(1)
        row.addWidget(action_button(actions["view.onion"]))
        self.onion_fields = OnionFields(self.session, self.view_state, self.theme)
        row.addWidget(self.onion_fields)
        ends = (buttons[name] for name in ("play.ping_pong", "play.first", "play.last"))
        self._spare = (self.dropped_label, fps, self.t_label, frame, *ends, self.rate_field)
        self._row = row
        return bar

    def resizeEvent(self, event: QResizeEvent) -> None:
        """In a narrow window the frame fields are worth more than those of the onion skin."""
        self.onion_fields.set_compact(event.size().width() < ROOMY)
        self._fit()
        super().resizeEvent(event)

    def _fit(self) -> None:
        """Leave out what can be missed most easily, as much as has no room: nothing lies over anything else."""
        for widget in self._spare:
            widget.show()
        for widget in self._spare:
            self._row.invalidate()
            if self._row.minimumSize().width() <= self.width():
                return
            widget.hide()

    def _add_frame_fields(self, row: QHBoxLayout) -> tuple[QLabel, QLabel]:
        """Add frame, length and rate; return the words beside them."""
        frame, fps = label("frame", "muted"), label("fps", "muted")
        row.addWidget(frame)
        self.frame_field = number_field(1, LONGEST, "The frame that is shown", self.session.go_to)
        row.addWidget(self.frame_field)
        row.addWidget(label("/", "muted"))
        self.length_field = number_field(1, LONGEST, "Number of frames of the film", self._on_length)
        row.addWidget(self.length_field)
        row.addSpacing(6)
        self.rate_field = QLineEdit()
        self.rate_field.setFixedWidth(64)
        self.rate_field.setAlignment(Qt.AlignmentFlag.AlignRight)
        self.rate_field.setToolTip("Frames a second: 24, 29.97 or 30000/1001")
        self.rate_field.editingFinished.connect(self._on_rate)
        row.addWidget(self.rate_field)
        row.addWidget(fps)
        self.dropped_label = label("", "badge")
        self.dropped_label.setToolTip("Frames that were not shown in time since playing began")
        self.playback.dropping.connect(self._show_dropped)
        row.addSpacing(6)
        row.addWidget(self.dropped_label)
        return frame, fps

    def _show_dropped(self, count: int) -> None:
        self.dropped_label.setText(f"{count} dropped" if count else "")
        self._fit()

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self.track.set_theme(theme)
        self.onion_fields.set_theme(theme)

    def _refresh(self, *_: object) -> None:
        document = self.session.document
        # never less than what it shows: it would clip that, and the playhead would go there
        self.frame_field.setMaximum(max(document.length, self.frame_field.value()))
        show_value(self.frame_field, self.session.frame)
        self.frame_field.setMaximum(document.length)
        show_value(self.length_field, document.length)
        if not self.rate_field.hasFocus():
            self.rate_field.setText(rate_text(document.rate))
        self.t_label.setText(self._t_text())

    def _t_text(self) -> str:
        before, after = self.session.span_keyframes()
        if before is None or after is None:
            return ""
        length, offset = after.frame - before.frame, self.session.frame - before.frame
        if before.span.hold and offset < length:
            return "hold"
        t = before.span.easing.t_at(drawn_ratio(before.span, length, offset) if offset < length else 1.0)
        return f"t {float(t):.2f}"

    def _on_length(self, length: int) -> None:
        self.session.apply("Change Length", set_length, length, merge_key="length")

    def _on_rate(self) -> None:
        try:
            rate = as_rate(self.rate_field.text())
        except InkbetweenError as e:
            self.session.problem.emit(str(e))
        else:
            self.session.apply("Change Frame Rate", set_rate, rate)
        self.rate_field.setText(rate_text(self.session.document.rate))


def rate_text(rate: Fraction) -> str:
    """Return a rate as people write it: 24, 23.976, else the fraction."""
    if rate.denominator == 1:
        return str(rate.numerator)
    short = f"{float(rate):.3f}".rstrip("0")
    return short if Fraction(short) == rate else f"{rate.numerator}/{rate.denominator}"


def action_button(action: QAction) -> QToolButton:
    """Return a flat icon button for an action; its tooltip names the shortcut."""
    button = QToolButton()
    button.setDefaultAction(action)
    button.setIconSize(QSize(20, 20))
    button.setFixedSize(32, 32)
    button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    button.setAccessibleName(action.text().replace("&", ""))
    return button

"""The onion skin's fields in the timeline's bar, and the small window with everything seldom changed."""

from PySide6.QtCore import QPoint, QSize, Qt
from PySide6.QtGui import QColor, QIcon, QPainter, QPixmap
from PySide6.QtWidgets import (
    QApplication,
    QCheckBox,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QSlider,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.panels.parts import Segments, label, number_field, show_value
from app.session import Session
from app.theme import Theme, icon
from app.view import TINTS, ViewState
from core.model.document import Layer

MOST_SKINS = 12

ROWS = (
    (
        "onion_keys",
        "drawings",
        (("all", "all", "Show in-betweens and keyframes"), ("keys", "keyframes", "Show only keyframes")),
        (False, True),
    ),
    (
        "onion_filled",
        "as",
        (("outline", "outlines", "Draw only the outlines"), ("filled", "filled", "Fill the drawings")),
        (False, True),
    ),
    (
        "onion_tints",
        "colours",
        (
            ("red and green", "red, green", "Red before the playhead, green after"),
            ("blue and orange", "blue, orange", "Blue before, orange after: for every kind of colour vision"),
        ),
        tuple(TINTS),
    ),
    (
        "onion_all",
        "layers",
        (("active", "active", "Only the layer that is drawn on"), ("every", "all visible", "Every visible layer")),
        (False, True),
    ),
)
"""Option, name, choices and their values, of the rows that are a choice."""


class OnionFields(QWidget):
    """How many drawings before and after, and a button for the rest."""

    def __init__(self, session: Session, view: ViewState, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.view_state = view
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(4)
        self.before = number_field(0, MOST_SKINS, "", lambda n: view.set(onion_before=n), 36)
        self.after = number_field(0, MOST_SKINS, "", lambda n: view.set(onion_after=n), 36)
        self.more = QToolButton()
        self.more.setFixedSize(28, 28)
        self.more.setIconSize(QSize(16, 16))
        self.more.setToolTip("More about the onion skin: strength, colours, keyframes only, layers")
        self.more.setAccessibleName("onion skin options")
        self.more.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.more.clicked.connect(self._open)
        for widget in (self.before, label("before", "muted"), self.after, label("after", "muted"), self.more):
            row.addWidget(widget)
        self._wide = [row.itemAt(i).widget() for i in range(row.count() - 1)]
        self.options = OnionOptions(session, view, self)
        view.changed.connect(self._refresh)
        self.set_theme(theme)
        self._refresh()

    def set_theme(self, theme: Theme) -> None:
        self.more.setIcon(icon("settings", theme))
        self.options.set_theme(theme)

    def set_compact(self, compact: bool) -> None:
        """Leave, where there is little room, only the button; its window has the counts too."""
        for widget in self._wide:
            widget.setVisible(not compact)

    def _open(self) -> None:
        self.options.show_above(self.more)

    def _refresh(self) -> None:
        options = self.view_state.options
        colors = options.onion_tints.split(" and ")
        for field, count, side, color in (
            (self.before, options.onion_before, "before", colors[0]),
            (self.after, options.onion_after, "after", colors[1]),
        ):
            show_value(field, count)
            what = "keyframes" if options.onion_keys else "drawings"
            field.setToolTip(f"Onion skin: {what} {side} the playhead, {color}")
            field.setAccessibleName(f"onion skin {side}")
            field.setEnabled(options.onion)


class OnionOptions(QFrame):
    """The small window: it closes with a click beside it, or Escape."""

    def __init__(self, session: Session, view: ViewState, parent: QWidget) -> None:
        super().__init__(parent, Qt.WindowType.Popup)
        self.setObjectName("popup")
        self.session, self.view_state = session, view
        self._opened: object = None
        box = QVBoxLayout(self)
        box.setContentsMargins(14, 12, 14, 12)
        box.setSpacing(10)
        box.addWidget(label("ONION SKIN", "title"))
        grid = QGridLayout()
        grid.setHorizontalSpacing(12)
        grid.setVerticalSpacing(8)
        self.strength = QSlider(Qt.Orientation.Horizontal)
        self.strength.setRange(5, 100)
        self.strength.setToolTip("How strong the nearest drawing is; farther ones are fainter")
        self.strength.valueChanged.connect(lambda n: view.set(onion_strength=n / 100))
        grid.addWidget(label("strength", "muted"), 0, 0)
        grid.addWidget(self.strength, 0, 1)
        grid.addWidget(label("how many", "muted"), 1, 0)
        grid.addLayout(self._count_row(), 1, 1)
        self.choices = {name: self._choice_row(grid, i, *row) for i, (name, *row) in enumerate(ROWS, 2)}
        box.addLayout(grid)
        self.layer_box = QVBoxLayout()
        self.layer_box.setSpacing(6)
        self.layer_switches: dict[int, QCheckBox] = {}
        box.addLayout(self.layer_box)
        view.changed.connect(self._refresh)
        session.documentChanged.connect(self._on_document_changed)
        session.fileChanged.connect(self._forget_layers)
        self._refresh()

    def _count_row(self) -> QHBoxLayout:
        self.counts = {
            side: number_field(
                0,
                MOST_SKINS,
                f"How many drawings {side} the playhead are shown",
                lambda n, s=side: self.view_state.set(**{f"onion_{s}": n}),
            )
            for side in ("before", "after")
        }
        row = QHBoxLayout()
        row.setSpacing(6)
        for side, field in self.counts.items():
            row.addWidget(field)
            row.addWidget(label(side, "muted"))
        row.addStretch(1)
        return row

    def _choice_row(self, grid: QGridLayout, row: int, name: str, choices, values) -> Segments:
        option = ROWS[row - 2][0]
        segments = Segments(choices)
        by_choice = dict(zip((c[0] for c in choices), values, strict=True))
        segments.chosen.connect(lambda choice: self.view_state.set(**{option: by_choice[choice]}))
        grid.addWidget(label(name, "muted"), row, 0)
        grid.addWidget(segments, row, 1)
        return segments

    def set_theme(self, theme: Theme) -> None:
        for pair, (before, after) in TINTS.items():
            button = self.choices["onion_tints"].button(pair)
            button.setIcon(_two_dots(theme.color(before), theme.color(after)))
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)

    def show_above(self, button: QWidget) -> None:
        """Open over a button, inside the screen."""
        self._show_layers()
        self.adjustSize()
        at = button.mapToGlobal(QPoint(button.width() - self.width(), -self.height() - 4))
        screen = (button.screen() or QApplication.primaryScreen()).availableGeometry()
        self.move(max(screen.left(), at.x()), max(screen.top(), at.y()))
        self.show()

    def _show_layers(self) -> None:
        """Offer a switch for every layer, if there are several."""
        while self.layer_box.count():
            self.layer_box.takeAt(0).widget().deleteLater()
        self.layer_switches = {}
        layers = self.session.document.layers
        if len(layers) > 1 and self.view_state.options.onion_all:
            self.layer_switches = {layer.id: self._layer_switch(layer) for layer in reversed(layers)}

    def _layer_switch(self, layer: Layer) -> QCheckBox:
        switch = QCheckBox(layer.name)
        switch.setToolTip(f"Show the onion skin of layer {layer.name}")
        switch.setChecked(layer.id not in self.view_state.options.onion_off)
        switch.clicked.connect(lambda on, i=layer.id: self._switch(i, on))
        self.layer_box.addWidget(switch)
        return switch

    def _switch(self, layer: int, on: bool) -> None:
        off = self.view_state.options.onion_off
        self.view_state.set(onion_off=off - {layer} if on else off | {layer})

    def _refresh(self) -> None:
        options = self.view_state.options
        show_value(self.strength, round(100 * options.onion_strength))
        for side, field in self.counts.items():
            show_value(field, getattr(options, f"onion_{side}"))
        for name, _, choices, values in ROWS:
            chosen = choices[values.index(getattr(options, name))][0]
            self.choices[name].set_value(chosen)
        if self.isVisible() and bool(self.layer_switches) != options.onion_all:
            self._show_layers()
            self.adjustSize()

    def _on_document_changed(self) -> None:
        if self.isVisible():
            self._show_layers()

    def _forget_layers(self) -> None:
        """Another document has other layers; saving this one changes nothing."""
        if self.session.undo_stack.count() == 0 and self.session.document is not self._opened:
            self._opened = self.session.document
            self.view_state.set(onion_off=frozenset())


def _two_dots(left: QColor, right: QColor) -> QIcon:
    picture = QPixmap(48, 32)
    picture.fill(Qt.GlobalColor.transparent)
    painter = QPainter(picture)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(Qt.PenStyle.NoPen)
    for x, color in ((4, left), (26, right)):
        painter.setBrush(color)
        painter.drawEllipse(x, 7, 18, 18)
    painter.end()
    picture.setDevicePixelRatio(2)
    return QIcon(picture)

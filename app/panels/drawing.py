"""How the keyframes at the playhead are painted; and what the pen and the pencil draw."""

from dataclasses import replace

from PySide6.QtCore import QSize
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QCheckBox, QColorDialog, QDoubleSpinBox, QToolButton, QWidget

from app.painting import to_qcolor
from app.panels.parts import Section, Segments, label, percent_fields, show_value, swatch_icon
from app.penoptions import FARTHEST, PenOptions
from app.session import Session
from app.theme import Theme
from core.model.document import Document
from core.model.drawing import WIDEST_STROKE, Style
from core.model.edits import set_style

KINDS = (
    ("closed", "closed", "Pen and pencil draw closed outlines: shapes that are filled"),
    ("open", "open", "Pen and pencil draw open outlines: strokes with round ends"),
)


class DrawingPanel(Section):
    """On a keyframe it changes that one; between two keyframes it changes both."""

    def __init__(
        self,
        session: Session,
        theme: Theme,
        pens: PenOptions,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__("Drawing", parent)
        self.session, self.theme, self.pens = session, theme, pens
        self.fill, self.fill_on = self._color_row("fill")
        self.stroke, self.stroke_on = self._color_row("stroke")
        self.width_field = _decimal_field(0, WIDEST_STROKE, "Width of the stroke, in px of the stage")
        self.width_field.valueChanged.connect(lambda w: self._change("Change Stroke Width", width=w))
        self.add_row("width", self.width_field)
        tip = "Opacity of the whole drawing: fill and stroke do not show through each other"
        self.opacity, self.opacity_field = percent_fields(tip, self._on_opacity)
        self.add_row("opacity", self.opacity, self.opacity_field)
        self.about = label("", "muted")
        self.about.setWordWrap(True)
        self.box.addWidget(self.about)
        self._make_pen_rows()
        for signal in (session.documentChanged, session.frameChanged, session.layerChanged):
            signal.connect(self._refresh)
        self._refresh()

    def _make_pen_rows(self) -> None:
        """What the pen and the pencil do; it is of no drawing that is there already."""
        pens = self.pens
        self.kinds = Segments(KINDS)
        self.kinds.chosen.connect(lambda kind: pens.set_closed(kind == "closed"))
        self.add_row("draw", self.kinds)
        self.tolerance_field = _decimal_field(
            0, FARTHEST, "Pencil: how far the simplified outline may lie off the hand's"
        )
        self.tolerance_field.setValue(pens.tolerance)
        self.tolerance_field.valueChanged.connect(pens.set_tolerance)
        self.add_row("pencil", self.tolerance_field)
        pens.changed.connect(self._show_pens)
        self._show_pens()

    def _show_pens(self) -> None:
        self.kinds.set_value("closed" if self.pens.closed else "open")
        self.tolerance_field.setValue(self.pens.tolerance)

    def _color_row(self, name: str) -> tuple[QToolButton, QCheckBox]:
        swatch = QToolButton()
        swatch.setProperty("swatch", True)
        swatch.setIconSize(QSize(18, 18))
        swatch.setToolTip(f"Choose the colour of the {name}")
        swatch.setAccessibleName(f"{name} colour")
        swatch.clicked.connect(lambda: self._choose(name))
        on = QCheckBox()
        on.setToolTip(f"Paint the {name} in exported frames")
        on.setAccessibleName(f"{name} on")
        on.clicked.connect(lambda checked: self._switch(name, checked))
        self.add_row(name, on, swatch)
        return swatch, on

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self._refresh()

    def _frames(self) -> tuple[int, ...]:
        here = self.session.layer.keyframe_at(self.session.frame)
        if here is not None:
            return (here.frame,)
        return tuple(k.frame for k in self.session.span_keyframes() if k is not None)

    def _style(self) -> Style | None:
        frames = self._frames()
        keyframe = self.session.layer.keyframe_at(frames[0]) if frames else None
        return keyframe.drawing.style if keyframe else None

    def _refresh(self, *_: object) -> None:
        frames, style = self._frames(), self._style()
        names = " and ".join(map(str, frames))
        self.note.setText(f"keyframe{'s' if len(frames) > 1 else ''} {names}" if frames else "")
        self.about.setText(self._advice(style))
        self.about.setVisible(bool(self.about.text()))
        fields = self.width_field, self.opacity, self.opacity_field
        for widget in (self.fill, self.fill_on, self.stroke, self.stroke_on, *fields):
            widget.setEnabled(style is not None)
        style = style or Style()
        line = self.theme.color("muted")
        for swatch, on, color in (
            (self.fill, self.fill_on, style.fill),
            (self.stroke, self.stroke_on, style.stroke),
        ):
            swatch.setIcon(swatch_icon(to_qcolor(color) if color else None, line))
            on.setChecked(color is not None)
        show_value(self.width_field, style.width)
        percent = round(100 * style.opacity)
        for field in (self.opacity, self.opacity_field):
            show_value(field, percent)

    def _advice(self, style: Style | None) -> str:
        """Say what becomes of open outlines."""
        keyframes = [k for k in map(self.session.layer.keyframe_at, self._frames()) if k is not None]
        if style is None or all(o.closed for k in keyframes for o in k.drawing.outlines):
            return ""
        if style.width == 0 or not (style.stroke or style.fill):
            return "Open outlines are strokes: give them a width and a colour to see them."
        if not style.stroke:
            return "Open outlines are strokes: without a stroke they take the colour of the fill."
        return "Open outlines are strokes: the fill is not for them." if style.fill else ""

    def _on_opacity(self, percent: int) -> None:
        style = self._style()
        if style is not None and percent != round(100 * style.opacity):
            self._change("Change Opacity", opacity=percent / 100)

    def _choose(self, name: str) -> None:
        style = self._style()
        if style is None:
            return
        current = getattr(style, name)
        start = to_qcolor(current) if current else QColor(self.theme.accent)
        color = QColorDialog.getColor(
            start, self, f"Colour of the {name}", QColorDialog.ColorDialogOption.ShowAlphaChannel
        )
        if color.isValid():
            self._change(f"Change {name.capitalize()}", **{name: color_text(color)})

    def _switch(self, name: str, on: bool) -> None:
        self._change(f"Change {name.capitalize()}", **{name: self.theme.inbetween if on else None})

    def _change(self, label: str, **changes: object) -> None:
        session, frames, style = self.session, self._frames(), self._style()
        if style is None or all(getattr(style, k) == v for k, v in changes.items()):
            return
        layer_id = session.layer.id

        def edit(document: Document) -> Document:
            for frame in frames:
                keyframe = document.layer(layer_id).keyframe_at(frame)
                if keyframe is not None:
                    changed = replace(keyframe.drawing.style, **changes)
                    document = set_style(document, layer_id, frame, changed)
            return document

        session.apply(label, edit, merge_key=(label, frames))


def color_text(color: QColor) -> str:
    """Return #rrggbb, or #rrggbbaa where it is not opaque."""
    return color.name() if color.alpha() == 255 else f"{color.name()}{color.alpha():02x}"


def _decimal_field(low: float, high: float, tip: str) -> QDoubleSpinBox:
    field = QDoubleSpinBox()
    field.setRange(low, high)
    field.setDecimals(1)
    field.setSuffix(" px")
    field.setKeyboardTracking(False)
    field.setToolTip(tip)
    field.setFixedWidth(90)
    return field

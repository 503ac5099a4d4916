"""The layer that tools draw on: its name, opacity, colour, and the layer it follows."""

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QCheckBox, QComboBox, QLineEdit, QMenu, QToolButton, QWidget

from app.layercolors import LAYER_COLORS, layer_color
from app.panels.parts import Section, percent_fields, show_value, swatch_icon
from app.session import Session
from app.theme import Theme
from core.model.document import LONGEST_NAME, Document
from core.model.edits import set_layer, set_parent

FOLLOWS_TIP = (
    "The layer whose motion this one follows.\n"
    "Keyframes stay where they are drawn; what lies between them moves with the other layer."
)
NOBODY = "none"


class LayerPanel(Section):
    """See the module."""

    def __init__(self, session: Session, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__("Layer", parent)
        self.session, self.theme = session, theme
        self._make_name()
        self._make_opacity()
        self.parents = QComboBox()
        self.parents.setToolTip(FOLLOWS_TIP)
        self.parents.setAccessibleName("Follows")
        self.parents.setMinimumWidth(150)
        self.parents.activated.connect(self._on_parent)
        self.add_row("follows", self.parents)
        self.visible_box, self.locked_box = QCheckBox("visible"), QCheckBox("locked")
        self.visible_box.setToolTip("Show the layer, here and in exported frames")
        self.locked_box.setToolTip("The layer is seen, but not changed")
        self.visible_box.clicked.connect(lambda on: self._set("Show Layer" if on else "Hide Layer", visible=on))
        self.locked_box.clicked.connect(lambda on: self._set("Lock Layer" if on else "Unlock Layer", locked=on))
        self.add_row("", self.visible_box, self.locked_box)
        for signal in (session.documentChanged, session.layerChanged):
            signal.connect(self._refresh)
        self._refresh()

    def _make_name(self) -> None:
        self.swatch = QToolButton()
        self.swatch.setProperty("swatch", True)
        self.swatch.setIconSize(QSize(18, 18))
        self.swatch.setToolTip("The colour that marks the layer in the window; it is never exported")
        self.swatch.setAccessibleName("Colour of the layer")
        self.swatch.clicked.connect(lambda: self.color_menu().popup(self._below(self.swatch)))
        self.name_field = QLineEdit()
        self.name_field.setMaxLength(LONGEST_NAME)
        self.name_field.setMinimumWidth(118)
        self.name_field.setToolTip("Name of the layer")
        self.name_field.setAccessibleName("Name of the layer")
        self.name_field.editingFinished.connect(self._on_name)
        self.add_row("name", self.name_field, self.swatch)

    def _make_opacity(self) -> None:
        tip = "Opacity of the layer, times that of each drawing"
        self.opacity, self.opacity_field = percent_fields(tip, self._on_opacity)
        self.add_row("opacity", self.opacity, self.opacity_field)

    @staticmethod
    def _below(widget: QWidget):
        return widget.mapToGlobal(widget.rect().bottomLeft())

    def color_menu(self) -> QMenu:
        """Return the colours to choose from."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        line = self.theme.color("line")
        for name, color in LAYER_COLORS.items():
            action = menu.addAction(swatch_icon(QColor(color), line), name)
            action.triggered.connect(lambda _=False, c=color: self._set("Change Layer Colour", color=c))
        menu.addSeparator()
        menu.addAction("Automatic", lambda: self._set("Change Layer Colour", color=None))
        return menu

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self._refresh()

    # showing

    def _refresh(self, *_: object) -> None:
        layer = self.session.layer
        self.note.setText("locked" if layer.locked else "")
        if not self.name_field.hasFocus() or not self.name_field.isModified():
            self.name_field.setText(layer.name)
        self.swatch.setIcon(swatch_icon(layer_color(layer), self.theme.color("line")))
        percent = round(100 * layer.opacity)
        for field in (self.opacity, self.opacity_field):
            show_value(field, percent)
        self.visible_box.setChecked(layer.visible)
        self.locked_box.setChecked(layer.locked)
        self._show_parents()

    def _show_parents(self) -> None:
        """Offer every layer that does not follow this one already."""
        document, layer = self.session.document, self.session.layer
        offered = [
            (NOBODY, None),
            *((x.name, x.id) for x in document.layers if not follows(document, x.id, layer.id)),
        ]
        shown = [(self.parents.itemText(i), self.parents.itemData(i)) for i in range(self.parents.count())]
        if shown != offered:
            self.parents.clear()
            for name, layer_id in offered:
                self.parents.addItem(name, layer_id)
        self.parents.setCurrentIndex([layer_id for _, layer_id in offered].index(layer.parent))
        self.parents.setEnabled(len(offered) > 1)

    # changing

    def _set(self, text: str, *, key: object = None, **changes: object) -> None:
        self.session.apply(text, set_layer, self.session.layer.id, merge_key=key, **changes)
        self._refresh()

    def _on_name(self) -> None:
        name = self.name_field.text().strip()
        self.name_field.setModified(False)
        if name and name != self.session.layer.name:
            self._set("Rename Layer", name=name)
        self._refresh()

    def _on_opacity(self, percent: int) -> None:
        layer = self.session.layer
        if percent != round(100 * layer.opacity):
            self._set("Change Layer Opacity", opacity=percent / 100, key=("layer opacity", layer.id))

    def _on_parent(self, index: int) -> None:
        self.session.apply("Follow Layer", set_parent, self.session.layer.id, self.parents.itemData(index))
        self._refresh()


def follows(document: Document, layer_id: int, other: int) -> bool:
    """Whether a layer is another one, or follows it, directly or through others."""
    seen: int | None = layer_id
    while seen is not None:
        if seen == other:
            return True
        seen = document.layer(seen).parent
    return False

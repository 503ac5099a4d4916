"""The colours that mark layers in the window; none of them is exported."""

from PySide6.QtGui import QColor

from core.model.document import Layer

LAYER_COLORS = {
    "Violet": "#8b6cff",
    "Blue": "#3f8cf3",
    "Teal": "#1fa8a0",
    "Green": "#4caf50",
    "Ochre": "#c79a1e",
    "Orange": "#ee7d31",
    "Rose": "#e0568a",
    "Grey": "#8a93a3",
}
"""Names and colours to choose from; a layer without one of its own takes the next of them by its id."""


def layer_color(layer: Layer) -> QColor:
    """Return the colour that marks a layer."""
    colors = tuple(LAYER_COLORS.values())
    return QColor(layer.color[:7] if layer.color else colors[(layer.id - 1) % len(colors)])

"""Keys in the fields of the panels: Return and Escape end the typing, and the keys are the canvas's again."""

from collections.abc import Iterable

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QAbstractSpinBox, QLineEdit, QWidget

ENDING = (Qt.Key.Key_Return, Qt.Key.Key_Enter)


class FieldKeys(QObject):
    """Gives the focus back to `home`, so that the next key runs a shortcut and Ctrl+Z undoes in the document.

    Return keeps what was typed, since a field that loses the focus does; Escape first puts back what it showed.
    """

    def __init__(self, fields: Iterable[QWidget], home: QWidget) -> None:
        super().__init__(home)
        self._home = home
        self._shown = ""
        for field in fields:
            field.installEventFilter(self)

    def eventFilter(self, field: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.FocusIn and isinstance(field, QLineEdit):
            self._shown = field.text()
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent) and _ends(event):
            event.accept()  # else an action whose key it is would be run
            return True
        if event.type() != QEvent.Type.KeyPress or not isinstance(event, QKeyEvent) or not _ends(event):
            return False
        if event.key() == Qt.Key.Key_Escape:
            self._take_back(field)
        self._home.setFocus()
        return True

    def _take_back(self, field: QObject) -> None:
        if isinstance(field, QLineEdit):
            field.setText(self._shown)
        elif isinstance(field, QAbstractSpinBox):
            field.setValue(field.value())  # what is typed is no value yet


def _ends(event: QKeyEvent) -> bool:
    return event.key() in ENDING or event.key() == Qt.Key.Key_Escape


def fields_in(*parts: QWidget) -> list[QWidget]:
    """Return the fields to type in; the line inside a spin box is no field of its own."""
    found: list[QWidget] = []
    for part in parts:
        found += part.findChildren(QAbstractSpinBox)
        found += [x for x in part.findChildren(QLineEdit) if not isinstance(x.parent(), QAbstractSpinBox)]
    return found

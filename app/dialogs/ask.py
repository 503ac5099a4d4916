"""One question with named answers."""

from collections.abc import Sequence

from PySide6.QtWidgets import QMessageBox, QWidget

CANCEL = "Cancel"


def ask(parent: QWidget, question: str, detail: str, answers: Sequence[str]) -> str:
    """Return the answer that was chosen; the first one is offered, and leaving the box is "Cancel"."""
    box = QMessageBox(parent)
    box.setWindowTitle("Inkbetween")
    box.setIcon(QMessageBox.Icon.Warning)
    box.setText(question)
    box.setInformativeText(detail)
    role = QMessageBox.ButtonRole
    buttons = {box.addButton(text, role.AcceptRole): text for text in answers}
    cancel = box.addButton(CANCEL, role.RejectRole)
    box.setDefaultButton(next(iter(buttons)))
    box.setEscapeButton(cancel)
    box.exec()
    return buttons.get(box.clickedButton(), CANCEL)

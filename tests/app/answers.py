"""A person who answers the questions that stop everything else."""

from PySide6.QtCore import Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMessageBox, QPushButton


class Person:
    """Presses a named button in each question to come, in that order, and remembers what was asked."""

    def __init__(self, *answers):
        self.left = list(answers)
        self.asked = []
        self._timer = QTimer()
        self._timer.timeout.connect(self._look)
        self._timer.start(5)

    def _look(self):
        box = QApplication.activeModalWidget()
        if not isinstance(box, QMessageBox) or not box.isVisible():
            return
        self.asked.append(f"{box.text()} {box.informativeText()}")
        answer = self.left.pop(0) if self.left else "Cancel"
        names = {b.text().replace("&", ""): b for b in box.findChildren(QPushButton)}
        QTest.mouseClick(names[answer], Qt.MouseButton.LeftButton)

    def leave(self):
        """Answer no more."""
        self._timer.stop()

"""The list of unsaved work that was found, with pictures; what is not opened or discarded stays for later."""

import time
from collections.abc import Sequence

from PySide6.QtCore import QDateTime, QLocale, QSize
from PySide6.QtGui import QIcon, QPixmap
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app.panels.parts import label
from app.recovery import Found
from app.thumbnail import thumbnail

PICTURE = QSize(160, 90)
DISCARD, KEEP = "Discard", "Do Not Discard"


class RecoveryDialog(QDialog):
    """`opened` is the one to open, `discarded` those to take away, once the dialog is left by a button."""

    def __init__(self, found: Sequence[Found], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Recover Unsaved Work")
        self.setMinimumSize(600, 440)
        self._found = list(found)
        self._marked: set[int] = set()
        self.opened: Found | None = None
        column = QVBoxLayout(self)
        column.setContentsMargins(20, 20, 20, 16)
        column.setSpacing(12)
        many = f"{len(found)} drawings were" if len(found) > 1 else "A drawing was"
        text = label(f"{many} not saved when Inkbetween ended. What you do not open or discard stays for later.")
        text.setWordWrap(True)
        column.addWidget(text)
        self.list = QListWidget()
        self.list.setIconSize(PICTURE)
        self.list.setSpacing(4)
        self.list.setWordWrap(True)
        for i, each in enumerate(self._found):
            item = QListWidgetItem(_icon(each, self), self._text(i))
            item.setToolTip(str(each.recovery.path or each.place.file))
            self.list.addItem(item)
        self.list.currentRowChanged.connect(self._on_row_changed)
        self.list.itemDoubleClicked.connect(self._open)
        column.addWidget(self.list, 1)
        column.addWidget(self._buttons())
        self.list.setCurrentRow(0)

    def _buttons(self) -> QDialogButtonBox:
        roles, box = QDialogButtonBox.ButtonRole, QDialogButtonBox()
        self.open_button = QPushButton("Open")
        self.discard_button = QPushButton(DISCARD)
        self.later_button = QPushButton("Keep for Later")
        box.addButton(self.open_button, roles.AcceptRole)
        box.addButton(self.later_button, roles.RejectRole)
        box.addButton(self.discard_button, roles.ActionRole)
        self.open_button.setDefault(True)
        self.open_button.clicked.connect(self._open)
        self.discard_button.clicked.connect(self._mark)
        self.later_button.clicked.connect(self.accept)
        return box

    def reject(self) -> None:
        """Leave by Escape or the window's cross: everything stays."""
        self._marked.clear()
        super().reject()

    @property
    def discarded(self) -> list[Found]:
        return [self._found[i] for i in sorted(self._marked)]

    def _text(self, row: int) -> str:
        recovery = self._found[row].recovery
        where = str(recovery.path.parent) if recovery.path else "never saved"
        lines = [recovery.path.name if recovery.path else recovery.title, f"{_when(recovery.time)}, {where}"]
        if row in self._marked:
            lines.append("Will be discarded.")
        elif self._found[row].saved_later:
            lines.append("The file was saved after this.")
        return "\n".join(lines)

    def _on_row_changed(self, row: int) -> None:
        marked = row in self._marked
        self.discard_button.setText(KEEP if marked else DISCARD)
        self.open_button.setEnabled(not marked)
        everything = len(self._marked) == len(self._found)
        self.later_button.setText("Discard All" if everything and marked else "Keep for Later")
        if self._marked and not everything:
            self.later_button.setText("Discard Marked")

    def _mark(self) -> None:
        row = self.list.currentRow()
        self._marked ^= {row}
        item = self.list.item(row)
        item.setText(self._text(row))
        font = item.font()
        font.setStrikeOut(row in self._marked)
        item.setFont(font)
        self._on_row_changed(row)

    def _open(self) -> None:
        row = self.list.currentRow()
        if row >= 0 and row not in self._marked:
            self.opened = self._found[row]
            self.accept()


def _icon(found: Found, widget: QWidget) -> QIcon:
    """Return the picture, in its own colours in the selected row too."""
    picture, icon = _picture(found, widget), QIcon()
    for mode in (QIcon.Mode.Normal, QIcon.Mode.Selected):
        icon.addPixmap(picture, mode)
    return icon


def _picture(found: Found, widget: QWidget) -> QPixmap:
    ratio = widget.devicePixelRatioF()
    image = thumbnail(found.recovery.document, found.recovery.frame, PICTURE * ratio)
    pixmap = QPixmap.fromImage(image)
    pixmap.setDevicePixelRatio(ratio)
    return pixmap


def _when(seconds: float) -> str:
    """Return "today, 14:03:12" or a date and time; with seconds, for two files of the same minute."""
    moment = QDateTime.fromSecsSinceEpoch(int(min(max(seconds, 0.0), 4e9)))
    clock = moment.toString("HH:mm:ss")
    if moment.date() == QDateTime.fromSecsSinceEpoch(int(time.time())).date():
        return f"today, {clock}"
    return f"{QLocale().toString(moment.date(), QLocale.FormatType.ShortFormat)}, {clock}"

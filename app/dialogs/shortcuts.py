"""The dialog of shortcuts: choose a preset, press another key for an action. Every change holds at once."""

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QHBoxLayout,
    QKeySequenceEdit,
    QLabel,
    QLineEdit,
    QPushButton,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.action_table import ActionTable
from app.actions import ACTIONS, MENUS
from app.shortcuts import PRESETS, Shortcuts, normal

ID = Qt.ItemDataRole.UserRole


class ShortcutsDialog(QDialog):
    """See the module."""

    def __init__(self, shortcuts: Shortcuts, table: ActionTable, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.shortcuts, self.table = shortcuts, table
        self._wanted = ""
        self.setWindowTitle("Shortcuts")
        self.resize(620, 620)
        box = QVBoxLayout(self)
        box.setContentsMargins(16, 16, 16, 16)
        box.setSpacing(10)
        box.addLayout(self._head())
        box.addWidget(self._tree())
        box.addLayout(self._editor())
        self.message = QLabel()
        self.message.setWordWrap(True)
        self.take = QPushButton("Take it")
        self.take.setToolTip("Give the key to this action; the other one loses it")
        self.take.clicked.connect(self._on_take)
        row = QHBoxLayout()
        row.addWidget(self.message, 1)
        row.addWidget(self.take)
        box.addLayout(row)
        box.addLayout(self._foot())
        shortcuts.changed.connect(self._refresh)
        self._tell("")
        self._refresh()
        self._on_row()

    def _head(self) -> QHBoxLayout:
        self.presets = QComboBox()
        self.presets.addItems(list(PRESETS))
        self.presets.setToolTip("All keys as in this program; keys of your own are forgotten")
        self.presets.activated.connect(lambda _: self._on_preset())
        self.search = QLineEdit()
        self.search.setPlaceholderText("Search by name or key")
        self.search.setToolTip("Show only the actions whose name or key has this in it")
        self.search.setClearButtonEnabled(True)
        self.search.textChanged.connect(self._filter)
        row = QHBoxLayout()
        row.addWidget(QLabel("Keys like"))
        row.addWidget(self.presets)
        row.addSpacing(12)
        row.addWidget(self.search, 1)
        return row

    def _tree(self) -> QTreeWidget:
        self.tree = QTreeWidget()
        self.tree.setHeaderLabels(["Action", "Keys"])
        self.tree.setColumnWidth(0, 360)
        self.tree.setRootIsDecorated(False)
        self.tree.setIndentation(14)
        self.tree.setToolTip("Choose an action, then press its key below")
        self.rows: dict[str, QTreeWidgetItem] = {}
        for menu in MENUS:
            specs = [s for s in ACTIONS if s.menu == menu and s.id and s.id != "file.recent"]
            if not specs:
                continue
            head = QTreeWidgetItem([menu])
            head.setFlags(Qt.ItemFlag.ItemIsEnabled)
            self.tree.addTopLevelItem(head)
            for spec in specs:
                row = QTreeWidgetItem([spec.text.rstrip("…"), ""])
                row.setData(0, ID, spec.id)
                row.setToolTip(0, spec.tip or spec.text.rstrip("…"))
                head.addChild(row)
                self.rows[spec.id] = row
        self.tree.expandAll()
        self.tree.currentItemChanged.connect(lambda *_: self._on_row())
        return self.tree

    def _editor(self) -> QHBoxLayout:
        self.name = QLabel()
        self.edit = QKeySequenceEdit()
        self.edit.setMaximumSequenceLength(1)
        self.edit.setToolTip("Click here, then press the key")
        self.edit.keySequenceChanged.connect(self._on_key)
        self.none = QPushButton("No key")
        self.none.setToolTip("Leave this action without a key")
        self.none.clicked.connect(lambda: self._assign(""))
        self.reset = QPushButton("Reset")
        self.reset.setToolTip("Give this action the keys of the preset again")
        self.reset.clicked.connect(self._on_reset)
        row = QHBoxLayout()
        row.addWidget(self.name, 1)
        for widget in (self.edit, self.none, self.reset):
            row.addWidget(widget)
        return row

    def _foot(self) -> QHBoxLayout:
        self.reset_all = QPushButton("Reset all")
        self.reset_all.setToolTip("Forget every key of your own; the preset stays")
        self.reset_all.clicked.connect(self.shortcuts.reset_all)
        close = QPushButton("Close")
        close.setToolTip("Close this window; every change is kept already")
        close.clicked.connect(self.accept)
        close.setDefault(True)
        row = QHBoxLayout()
        row.addWidget(self.reset_all)
        row.addStretch(1)
        row.addWidget(close)
        return row

    # what a person does

    @property
    def chosen(self) -> str:
        """The id of the action that is chosen; "" for none."""
        item = self.tree.currentItem()
        return (item.data(0, ID) or "") if item is not None else ""

    def _on_preset(self) -> None:
        self.shortcuts.set_preset(self.presets.currentText())

    def _on_row(self) -> None:
        there = bool(self.chosen)
        self.name.setText(self._text(self.chosen) if there else "Choose an action above")
        for widget in (self.edit, self.none, self.reset):
            widget.setEnabled(there)
        self._tell("")
        self._show_key()

    def _on_key(self, sequence: QKeySequence) -> None:
        key = sequence.toString(QKeySequence.SequenceFormat.PortableText)
        if not self.chosen or not key or key == self._key():
            return  # the field is empty for a moment before each key
        owners = self.shortcuts.owners(key, self.chosen)
        if owners:
            self._wanted = key
            self._tell(f"{key} is the key of {self._names(owners)}.", may_take=True)
        else:
            self._assign(key)

    def _on_take(self) -> None:
        self._assign(self._wanted)

    def _assign(self, key: str) -> None:
        self._tell("")
        self.shortcuts.assign(self.chosen, key)

    def _on_reset(self) -> None:
        taken = self.shortcuts.reset(self.chosen)
        self._tell(f"Its key belongs to {self._names(taken)} by now: give that one another key." if taken else "")
        self._show_key()

    # showing

    def _refresh(self) -> None:
        self.presets.setCurrentText(self.shortcuts.preset)
        own, keys = self.shortcuts.own, self.shortcuts.keys
        for name, row in self.rows.items():
            row.setText(1, "  or  ".join(keys[name]))
            font = row.font(1)
            font.setBold(name in own)
            row.setFont(1, font)
        self.reset_all.setEnabled(bool(own))
        self._show_key()
        self._filter(self.search.text())

    def _show_key(self) -> None:
        if normal(self.edit.keySequence().toString()) != self._key():
            self.edit.setKeySequence(QKeySequence(self._key()))

    def _key(self) -> str:
        keys = self.shortcuts.keys.get(self.chosen, ())
        return normal(keys[0]) if keys else ""

    def _tell(self, text: str, *, may_take: bool = False) -> None:
        self.message.setText(text)
        self.take.setVisible(may_take)

    def _text(self, name: str) -> str:
        return self.table.spec(name).text.rstrip("…")

    def _names(self, names: tuple[str, ...]) -> str:
        return " and ".join(f"“{self._text(x)}”" for x in names)

    def _filter(self, text: str) -> None:
        wanted = text.lower()
        for row in self.rows.values():
            row.setHidden(wanted not in row.text(0).lower() and wanted not in row.text(1).lower())
        for i in range(self.tree.topLevelItemCount()):
            head = self.tree.topLevelItem(i)
            head.setHidden(all(head.child(j).isHidden() for j in range(head.childCount())))

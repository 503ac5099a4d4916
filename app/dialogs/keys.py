"""All keys, laid over the window: grouped, as they are now; Escape or a click takes it away."""

from collections.abc import Iterable

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QFrame, QGridLayout, QHBoxLayout, QLabel, QScrollArea, QVBoxLayout, QWidget

from app.action_table import ActionTable
from app.actions import ACTIONS, MENUS
from app.canvas.tool import Tool
from app.shortcuts import Shortcuts

KEY_NAMES = {",": ", (comma)", ".": ". (point)", "/": "/ (slash)"}
CANVAS = (
    ("Space + drag", "Pan"),
    ("Middle button", "Pan"),
    ("Wheel", "Zoom at the pointer"),
    ("Shift + wheel", "Pan sideways"),
    ("Escape", "Give up a drag"),
)
COLUMN_WIDTH = 300

Group = tuple[str, list[tuple[str, str]]]


class KeysOverlay(QWidget):
    """See the module. It is made when it is opened and thrown away when it is closed."""

    def __init__(
        self, window: QWidget, table: ActionTable, shortcuts: Shortcuts, tools: Iterable[Tool], tool: Tool | None
    ) -> None:
        super().__init__(window)
        self.setObjectName("keys")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.groups = key_groups(table, tool)
        self._from = window.focusWidget()
        outer = QVBoxLayout(self)
        outer.setContentsMargins(48, 40, 48, 40)
        card = QFrame()
        card.setObjectName("card")
        box = QVBoxLayout(card)
        box.setContentsMargins(24, 20, 24, 16)
        box.addLayout(self._head(shortcuts.preset))
        self._scroll = QScrollArea()
        self._scroll.setWidgetResizable(True)
        self._scroll.setFrameShape(QFrame.Shape.NoFrame)
        columns = max(2, min(4, (window.width() - 150) // COLUMN_WIDTH))
        self._scroll.setWidget(self._columns(columns))
        self._scroll.viewport().installEventFilter(self)
        box.addWidget(self._scroll)
        outer.addStretch(1)
        outer.addWidget(card)
        outer.addStretch(1)
        window.installEventFilter(self)
        self._fit()
        self.show()
        self.raise_()
        self.setFocus()

    def _head(self, preset: str) -> QHBoxLayout:
        row = QHBoxLayout()
        title = QLabel("Keys and Mouse")
        title.setProperty("role", "heading")
        note = QLabel(f"preset: {preset}      Escape or a click closes")
        note.setProperty("role", "muted")
        row.addWidget(title)
        row.addStretch(1)
        row.addWidget(note)
        return row

    def _columns(self, count: int) -> QWidget:
        inner = QWidget()
        row = QHBoxLayout(inner)
        row.setContentsMargins(0, 8, 0, 0)
        row.setSpacing(28)
        for groups in _balanced(self.groups, count):
            column = QVBoxLayout()
            column.setSpacing(10)
            for title, rows in groups:
                column.addWidget(_title(title))
                column.addLayout(_rows(rows))
            column.addStretch(1)
            row.addLayout(column, 1)
        return inner

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(0, 0, 0, 120))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Escape, Qt.Key.Key_F1, Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._leave()
        event.accept()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        event.accept()
        self._leave()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Resize and watched is self.parentWidget():
            self._fit()
        if event.type() == QEvent.Type.MouseButtonPress and watched is self._scroll.viewport():
            self._leave()
            return True
        return False

    def _fit(self) -> None:
        """Cover the window; the card is as high as what it holds, if there is room."""
        self.setGeometry(self.parentWidget().rect())
        inner = self._scroll.widget()
        wanted = max(inner.sizeHint().height(), inner.layout().totalHeightForWidth(self.width() - 160))
        self._scroll.setFixedHeight(min(wanted + 28, self.height() - 160))

    def _leave(self) -> None:
        if self._from is not None:
            self._from.setFocus()
        self.close()


def key_groups(table: ActionTable, tool: Tool | None) -> list[Group]:
    """Return every action that has a key, by subject, and what the mouse does."""
    groups: list[Group] = []
    for menu in MENUS:
        names = [s.id for s in ACTIONS if s.menu == menu and s.id and table.keys_of(s.id)]
        for title, part in _subjects(menu, names):
            rows = [(_keys(table, name), table[name].text().rstrip("…")) for name in part]
            if rows:
                groups.append((title, rows))
    groups.sort(key=lambda group: group[0] != "Tools")
    groups.append(("Canvas", list(CANVAS)))
    if tool is not None and tool.held:
        groups.append((f"With the {tool.name.lower()} tool", list(tool.held)))
    return groups


def _subjects(menu: str, names: list[str]) -> list[tuple[str, list[str]]]:
    """Split the menu that holds two subjects."""
    tools = [n for n in names if n.startswith("tool.")]
    return [("Tools", tools), (menu, [n for n in names if n not in tools])]


def _keys(table: ActionTable, name: str) -> str:
    return "  ".join(_readable(k) for k in table.keys_of(name))


def _readable(key: str) -> str:
    """Spell out the marks that are hard to see."""
    head, plus, last = key.rpartition("+")
    if key.endswith("+"):
        return key
    return f"{head}{plus}{KEY_NAMES.get(last, last)}"


def _title(text: str) -> QLabel:
    title = QLabel(text.upper())
    title.setProperty("role", "title")
    return title


def _rows(rows: list[tuple[str, str]]) -> QGridLayout:
    grid = QGridLayout()
    grid.setHorizontalSpacing(12)
    grid.setVerticalSpacing(4)
    for i, (keys, text) in enumerate(rows):
        caps = QHBoxLayout()
        caps.setSpacing(4)
        for key in keys.split("  "):
            cap = QLabel(key)
            cap.setProperty("role", "key")
            caps.addWidget(cap)
        caps.addStretch(1)
        what = QLabel(text)
        what.setWordWrap(True)
        what.setContentsMargins(0, 2, 0, 0)
        grid.addLayout(caps, i, 0, Qt.AlignmentFlag.AlignTop)
        grid.addWidget(what, i, 1, Qt.AlignmentFlag.AlignTop)
    grid.setColumnStretch(1, 1)
    grid.setColumnMinimumWidth(0, 120)
    return grid


def _balanced(groups: list[Group], count: int) -> list[list[Group]]:
    """Share groups out to columns in order, none much longer than the others."""
    total = sum(len(rows) + 2 for _, rows in groups)
    columns: list[list[Group]] = [[]]
    filled = 0
    for group in groups:
        height = len(group[1]) + 2
        if columns[-1] and len(columns) < count and filled + height / 2 > total * len(columns) / count:
            columns.append([])
        columns[-1].append(group)
        filled += height
    return columns

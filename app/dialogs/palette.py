"""The command palette: type a part of a name, press Enter, and it is done."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QFocusEvent, QKeyEvent
from PySide6.QtWidgets import QFrame, QHeaderView, QLineEdit, QTreeWidget, QTreeWidgetItem, QVBoxLayout, QWidget

from app.action_table import ActionTable
from app.actions import ACTIONS

WIDTH, ROW_HEIGHT, MOST_ROWS = 620, 28, 12
LEFT_OUT = ("file.recent", "help.find")


@dataclass(frozen=True, slots=True)
class Entry:
    """One line of the palette.

    Attributes
    ----------
    text, menu, keys : str
    run : function
    enabled : bool
        Whether it can be done now; otherwise it is greyed out.
    words : str
        What else it is found by.
    """

    text: str
    menu: str
    keys: str
    run: Callable[[], object]
    enabled: bool = True
    words: str = ""


def entries_of(table: ActionTable) -> list[Entry]:
    """Return the actions of the menus, as they are now."""
    found = []
    for spec in ACTIONS:
        if spec.id and spec.menu and spec.id not in LEFT_OUT:
            action = table[spec.id]
            text = action.text().rstrip("…")
            found.append(
                Entry(text, spec.menu, table.key_of(spec.id), action.trigger, action.isEnabled(), spec.tip)
            )
    return found


def score(query: str, text: str) -> float:
    """Return how well a query names a text: 0 for not at all, more for whole words and for letters together.

    All letters of the query must come in order. A run of letters counts by its length squared, one that begins a
    word more.
    """
    wanted, text = "".join(query.lower().split()), text.lower()
    if not wanted:
        return 1.0
    best = 0.0
    for start in (i for i, c in enumerate(text) if c == wanted[0]):
        best = max(best, _score_from(wanted, text, start))
    return best


def _score_from(wanted: str, text: str, start: int) -> float:
    total, at, i = 0.0, start, 0
    while i < len(wanted):
        run = 0
        word = at == 0 or not text[at - 1].isalnum()
        while i + run < len(wanted) and at + run < len(text) and text[at + run] == wanted[i + run]:
            run += 1
            while at + run < len(text) and text[at + run] == " " and i + run < len(wanted):
                at += 1  # a space in the text is no gap
        total += run * run * (2.0 if word else 1.0)
        i, at = i + run, at + run
        if i < len(wanted):
            at = _next_place(wanted[i:], text, at)
            if at < 0:
                return 0.0
    return total / (len(wanted) ** 2) + 0.2 + 0.2 * (start == 0) - 0.002 * len(text)


def _next_place(rest: str, text: str, at: int) -> int:
    """Return where the first letter of the rest comes next: where a word begins, if all the rest still follows."""
    place = text.find(rest[0], at)
    word = place
    while word >= 0:
        if (word == 0 or not text[word - 1].isalnum()) and _follows(rest, text[word:]):
            return word
        word = text.find(rest[0], word + 1)
    return place


def _follows(letters: str, text: str) -> bool:
    """Whether letters come in this order in a text."""
    there = iter(text)
    return all(letter in there for letter in letters)


def ranked(query: str, entries: Iterable[Entry]) -> list[Entry]:
    """Return the entries that a query may mean, the likeliest first."""
    scored = []
    for i, entry in enumerate(entries):
        points = max(
            score(query, entry.text),
            0.6 * score(query, f"{entry.menu} {entry.text}"),
            0.35 * score(query, entry.words) if entry.words and len(query) > 2 else 0.0,
            3.0 if query and query.lower() == entry.keys.lower() else 0.0,
        )
        if points > 0:
            scored.append((-points, not entry.enabled, i, entry))
    scored.sort(key=lambda x: x[:3])
    return [x[3] for x in scored]


class CommandPalette(QFrame):
    """See the module. `entries` is asked each time it opens."""

    def __init__(self, window: QWidget, entries: Callable[[], list[Entry]]) -> None:
        super().__init__(window)
        self.setObjectName("card")
        self._entries = entries
        self._all: list[Entry] = []
        self._shown: list[Entry] = []
        self._from: QWidget | None = None
        box = QVBoxLayout(self)
        box.setContentsMargins(10, 10, 10, 10)
        box.setSpacing(8)
        self.field = QLineEdit()
        self.field.setPlaceholderText("Type a command, a sample or a recent file")
        self.field.setToolTip("Arrows choose, Enter runs, Escape closes")
        self.field.textChanged.connect(self._search)
        self.field.installEventFilter(self)
        self.list = QTreeWidget()
        self.list.setObjectName("palette")
        self.list.setColumnCount(3)
        self.list.setHeaderHidden(True)
        self.list.setRootIsDecorated(False)
        self.list.setUniformRowHeights(True)
        self.list.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.header().setStretchLastSection(False)
        self.list.header().setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        self.list.header().setSectionResizeMode(1, QHeaderView.ResizeMode.ResizeToContents)
        self.list.header().setSectionResizeMode(2, QHeaderView.ResizeMode.ResizeToContents)
        self.list.itemClicked.connect(lambda _: self._run())
        box.addWidget(self.field)
        box.addWidget(self.list)
        self.hide()

    def open(self) -> None:
        """Show it over the window, empty."""
        self._all = self._entries()
        window = self.parentWidget()
        self._from = window.focusWidget() if not self.isVisible() else self._from
        width = min(WIDTH, window.width() - 80)
        self.setGeometry((window.width() - width) // 2, 72, width, MOST_ROWS * ROW_HEIGHT)
        self.field.clear()
        self._search("")
        self.show()
        self.raise_()
        self.field.setFocus()

    @property
    def shown(self) -> list[str]:
        """The texts in the list, the likeliest first."""
        return [entry.text for entry in self._shown]

    def _search(self, text: str) -> None:
        self._shown = ranked(text.strip(), self._all)
        self.list.clear()
        for entry in self._shown:
            item = QTreeWidgetItem([entry.text, entry.menu, entry.keys])
            item.setToolTip(0, entry.words or entry.text)
            if not entry.enabled:
                item.setDisabled(True)
            item.setTextAlignment(2, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            self.list.addTopLevelItem(item)
        self.resize(self.width(), min(max(len(self._shown), 1), MOST_ROWS) * ROW_HEIGHT + 64)
        self.list.setCurrentItem(None)
        if self._shown and self._shown[0].enabled:  # what cannot be done now is not replaced by something else
            self._choose(0)

    def _choose(self, row: int) -> None:
        self.list.setCurrentItem(self.list.topLevelItem(row))

    def _step(self, step: int) -> None:
        """Go to the next entry that can be run."""
        rows = [i for i, entry in enumerate(self._shown) if entry.enabled]
        now = self._row()
        if step > 0:
            beyond = [i for i in rows if i >= now + step] or rows[-1:]
        else:
            beyond = [i for i in rows if i <= now + step][::-1] or rows[:1]
        if beyond:
            self._choose(beyond[0])

    def _row(self) -> int:
        item = self.list.currentItem()
        return self.list.indexOfTopLevelItem(item) if item is not None else -1

    def _run(self) -> None:
        row = self._row()
        if row < 0 or not self._shown[row].enabled:
            return
        self._leave()
        self._shown[row].run()

    def _leave(self) -> None:
        self.hide()
        if self._from is not None:
            self._from.setFocus()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            return self._on_key(Qt.Key(event.key()))
        if isinstance(event, QFocusEvent) and event.type() == QEvent.Type.FocusOut:
            self.hide()
        return False

    def _on_key(self, key: Qt.Key) -> bool:
        """Take the keys that mean the list; True if it was one."""
        steps = {
            Qt.Key.Key_Down: 1,
            Qt.Key.Key_Up: -1,
            Qt.Key.Key_PageDown: MOST_ROWS,
            Qt.Key.Key_PageUp: -MOST_ROWS,
        }
        if key in steps:
            self._step(steps[key])
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._run()
        elif key == Qt.Key.Key_Escape:
            self._leave()
        else:
            return False
        return True

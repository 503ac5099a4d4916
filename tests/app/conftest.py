"""The real window, driven as a person drives it: by mouse and key events on the widgets."""

import threading
from collections.abc import Iterator
from pathlib import Path

import pyqtgraph
import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, QSettings, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget
from pytestqt.qtbot import QtBot

from app.bootstrap import Editor, make_application
from app.settings import Settings

LEFT, NONE = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
SHIFT, ALT, CTRL = (
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.AltModifier,
    Qt.KeyboardModifier.ControlModifier,
)

pyqtgraph.setConfigOption("mouseRateLimit", 0)  # it would swallow quick moves


class Hand:
    """A person's hand on one open editor; places are in stage px."""

    def __init__(self, editor: Editor) -> None:
        self.editor = editor
        self.canvas = editor.window.canvas
        self.session = editor.session

    # the canvas

    def view(self, place: tuple[float, float], offset: float = 0.0) -> QPoint:
        return self.canvas.camera.transform(offset).map(QPointF(*place)).toPoint()

    def click(self, *places: tuple[float, float], held: Qt.KeyboardModifier = NONE) -> None:
        for place in places:
            QTest.mouseClick(self.canvas.viewport(), LEFT, held, self.view(place))

    def double_click(self, place: tuple[float, float]) -> None:
        at = self.view(place)
        QTest.mouseClick(self.canvas.viewport(), LEFT, NONE, at)
        QTest.mouseDClick(self.canvas.viewport(), LEFT, NONE, at)

    def press(self, place: tuple[float, float], held: Qt.KeyboardModifier = NONE) -> None:
        QTest.mousePress(self.canvas.viewport(), LEFT, held, self.view(place))

    def move(self, place: tuple[float, float], held: Qt.KeyboardModifier = NONE, button=LEFT) -> None:
        move_pointer(self.canvas.viewport(), self.view(place), held, button)

    def release(self, place: tuple[float, float], held: Qt.KeyboardModifier = NONE) -> None:
        QTest.mouseRelease(self.canvas.viewport(), LEFT, held, self.view(place))

    def drag(
        self,
        start: tuple[float, float],
        *way: tuple[float, float],
        held: Qt.KeyboardModifier = NONE,
    ) -> None:
        """Press at the start, move along the way, release at its end."""
        pad, path = self.canvas.viewport(), [self.view(p) for p in (start, *way)]
        QTest.mousePress(pad, LEFT, held, path[0])
        for at in path[1:]:
            move_pointer(pad, at, held, LEFT)
        QTest.mouseRelease(pad, LEFT, held, path[-1])

    # keys, menus, the rest of the window

    def key(self, key: Qt.Key | str, held: Qt.KeyboardModifier = NONE, into: QWidget | None = None) -> None:
        QTest.keyClick(into or self.canvas, key, held)

    def menu(self, name: str) -> None:
        """Choose a menu entry; it must be enabled, as for a person."""
        action = self.editor.window.table[name]
        assert action.isEnabled(), f"{name} is greyed out"
        action.trigger()

    def press_button(self, widget: QWidget) -> None:
        QTest.mouseClick(widget, LEFT)

    @property
    def message(self) -> str:
        return self.editor.window.message_bar.text

    def settle(self, qtbot: QtBot) -> None:
        """Wait until what is shown is final."""
        qtbot.waitUntil(lambda: self.canvas.content is not None and self.editor.preview.settled, timeout=20_000)

    def certify(self, qtbot: QtBot) -> None:
        """Wait until every span of the layer has its certificate."""
        done = self.editor.preview, self.editor.certificates
        qtbot.waitUntil(lambda: all(x.settled for x in done), timeout=20_000)

    def move_on(self, widget: QWidget, at: QPoint) -> None:
        """Move over another widget with the left button down."""
        move_pointer(widget, at, NONE, LEFT)

    def picture(self):
        return self.canvas.grab().toImage()


def move_pointer(widget: QWidget, at: QPoint, held: Qt.KeyboardModifier, button: Qt.MouseButton) -> None:
    """QTest.mouseMove tells neither buttons nor modifiers, so the event is made here."""
    where = QPointF(at)
    event = QMouseEvent(
        QEvent.Type.MouseMove,
        where,
        QPointF(widget.mapToGlobal(at)),
        Qt.MouseButton.NoButton,
        button,
        held,
    )
    QApplication.sendEvent(widget, event)


@pytest.fixture(autouse=True)
def no_thread_is_left() -> Iterator[None]:
    """Fail a test that leaves one of our threads running."""
    before = set(threading.enumerate())
    yield
    ours = ("preview", "export", "png", "import", "autosave", "watch", "file")
    left = [t.name for t in set(threading.enumerate()) - before if t.name.startswith(ours)]
    assert left == []


@pytest.fixture(scope="session")
def qapp() -> Iterator[QApplication]:
    """The application; what a test has copied goes with it.

    The offscreen display's clipboard is a static of Qt. It would free a Python object after the interpreter's end,
    and the process would end with a segmentation fault.
    """
    app = make_application()
    yield app
    app.clipboard().clear()


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    """Settings that no other test and no person has touched."""
    return Settings(QSettings(str(tmp_path / "settings.ini"), QSettings.Format.IniFormat))


@pytest.fixture
def editor(qtbot: QtBot, settings: Settings, tmp_path: Path) -> Iterator[Editor]:
    settings.keep("theme", "dark")
    made = Editor(settings, tmp_path / "state")
    # the window is closed before this fixture ends, and nobody is there to answer a question
    qtbot.addWidget(made.window, before_close_func=lambda _: setattr(made.files, "may_leave", lambda: True))
    made.window.resize(1440, 900)
    with qtbot.waitExposed(made.window):
        made.window.show()
    made.window.activateWindow()
    made.window.canvas.setFocus()
    yield made
    made.safekeeping.stop()
    made.files.stop()
    made.playback.stop()
    made.preview.stop()
    made.ranked.stop()
    made.certificates.stop()


@pytest.fixture
def hand(editor: Editor) -> Hand:
    return Hand(editor)

"""Make the pictures of the README: `python docs/make_pictures.py [FOLDER]`, by default into docs/pictures.

Every picture is the program itself, on a bundled sample: the window is built, arranged and grabbed without a
display. Only the bundled font is known to it, and no settings of the person who runs the script.
"""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import resources

FOLDER = Path(__file__).resolve().parent / "pictures"
THEMES = {"light": "", "dark": "-dark"}
"""What each theme's file names end with; the light ones are what a page without dark pages shows."""

WINDOW = (1280, 860)
FIGURE = (1280, 400)
FIGURE_SAMPLE = "bending arm"
FONTS = """<?xml version="1.0"?>
<!DOCTYPE fontconfig SYSTEM "fonts.dtd">
<fontconfig><dir>{fonts}</dir><cachedir>{cache}</cachedir></fontconfig>
"""


def main(folder: Path = FOLDER) -> None:
    """Write every picture, light and dark."""
    folder.mkdir(parents=True, exist_ok=True)
    with _bare_desktop() as settings_folder:
        for theme, ending in THEMES.items():
            with _editor(theme, settings_folder) as editor:
                for name, picture in (("editor", _window(editor)), ("methods", _methods(editor))):
                    _write(picture, folder / f"{name}{ending}.png")


@contextmanager
def _bare_desktop() -> Iterator[Path]:
    """Start Qt without a display, where no font but ours is installed; give a folder for settings."""
    with TemporaryDirectory() as temporary:
        fonts = Path(temporary) / "fonts.conf"
        fonts.write_text(FONTS.format(fonts=resources.folder() / "fonts", cache=temporary), encoding="utf-8")
        os.environ |= {"QT_QPA_PLATFORM": "offscreen", "QT_SCALE_FACTOR": "1", "FONTCONFIG_FILE": str(fonts)}
        from PySide6.QtGui import QFont

        from app.bootstrap import make_application

        app = make_application()
        app.setFont(QFont("DejaVu Sans", 9))
        yield Path(temporary)


@contextmanager
def _editor(theme: str, settings_folder: Path) -> Iterator:
    """Open the demo in the middle of its first span."""
    from PySide6.QtCore import QSettings

    from app.bootstrap import Editor
    from app.settings import Settings

    kept = Settings(QSettings(str(settings_folder / f"{theme}.ini"), QSettings.Format.IniFormat))
    kept.keep("theme", theme)
    editor = Editor(kept)
    _open(editor, resources.DEMO)
    editor.window.resize(*WINDOW)
    editor.window.show()
    _settle(editor)
    yield editor
    editor.playback.stop()
    editor.preview.stop()
    editor.certificates.stop()
    editor.window.hide()


def _open(editor, sample: str) -> None:
    """Open a sample in the middle of its first span, or a little before, where the drawings lie apart."""
    editor.files.open_sample(next(path for path in resources.samples() if path.stem == sample))
    before, after = editor.session.layer.frames()[:2]
    editor.session.go_to((before + after) // 2 - 1)


def _settle(editor) -> None:
    """Wait for everything that is solved or laid out beside the window."""
    from PySide6.QtTest import QTest

    QTest.qWait(50)
    while not (editor.preview.settled and editor.certificates.settled):
        QTest.qWait(50)


def _window(editor):
    """The whole window, with the correspond tool in the hand."""
    editor.window.choose_tool("tool.correspond")
    _settle(editor)
    return editor.window.grab()


def _methods(editor):
    """Linear and intrinsic beside each other, as the canvas shows them."""
    canvas = editor.window.canvas
    _open(editor, FIGURE_SAMPLE)
    editor.view_state.set(arrangement="compare")
    editor.window.choose_tool("tool.select")
    canvas.setParent(None)
    canvas.resize(*FIGURE)
    canvas.show()
    canvas.fit()
    _settle(editor)
    return canvas.grab()


def _write(picture, path: Path) -> None:
    """Write a PNG as small as Qt makes it."""
    from PySide6.QtGui import QImage, QImageWriter

    writer = QImageWriter(str(path), b"png")
    writer.setCompression(100)
    if not writer.write(picture.toImage().convertToFormat(QImage.Format.Format_RGB888)):
        raise OSError(f"{path}: {writer.errorString()}")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))

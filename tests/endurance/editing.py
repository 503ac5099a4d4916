"""The program that `kill_while_editing.py` kills: a real window in which edit after edit is made.

    python tests/endurance/editing.py FOLDER SEED

It says "NUMBER TIME" on stdout after each edit (or step of a drag), and "ready" before the first.
"""

import random
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from films import many_vertices, numbered
from PySide6.QtCore import QSettings, QTimer

from app.bootstrap import Editor, make_application
from app.settings import Settings
from core.io.project import save

STATE, FILM = "state", "film.inkb"


class Hands:
    """Edits, drags and saves in a random order."""

    def __init__(self, editor, seed):
        self.session, self.editor = editor.session, editor
        self.random = random.Random(seed)
        self.number = 0
        self.gesture = None

    def edit(self):
        self.number += 1
        what = self.random.random()
        if self.gesture is not None and not self.gesture.open:
            self.gesture = None
        if self.gesture is not None:
            self.gesture.update(lambda d: numbered(d, self.number))
            if what < 0.05:
                self.gesture.commit()
        elif what < 0.03:
            self.gesture = self.session.begin("Move Vertices")
            self.gesture.update(lambda d: numbered(d, self.number))
        else:
            self.session.apply("Move Vertices", numbered, self.number)
        sys.stdout.write(f"{self.number} {time.monotonic()}\n")
        sys.stdout.flush()
        if what > 0.99 and self.session.path is not None:
            self.editor.files.save()
        QTimer.singleShot(self.random.randint(0, 60), self.edit)


def main():
    folder, seed = Path(sys.argv[1]), int(sys.argv[2])
    application = make_application()
    settings = Settings(QSettings(str(folder / "settings.ini"), QSettings.Format.IniFormat))
    editor = Editor(settings, folder / STATE)
    editor.window.show()
    document = many_vertices(random.Random(seed).choice([200, 2_000, 20_000, 200_000]))
    if seed % 3:
        save(document, folder / FILM)
        editor.files.open_path(folder / FILM)
    else:
        editor.session.new(document)
    sys.stdout.write("ready\n")
    sys.stdout.flush()
    hands = Hands(editor, seed)
    QTimer.singleShot(0, hands.edit)
    application.exec()


if __name__ == "__main__":
    main()

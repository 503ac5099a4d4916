"""Save on a disk that is full, in the real window: a clear message, the old file whole, nothing half beside it.

    python tests/endurance/full_disk.py

As root on Linux it mounts a disk of 1 MB; elsewhere the largest file that the process may write is set to 1 MB.
"""

import os
import subprocess
import sys
import tempfile
from contextlib import contextmanager
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from films import many_vertices, numbered
from PySide6.QtCore import QSettings
from PySide6.QtTest import QTest

from app.bootstrap import Editor, make_application
from app.settings import Settings
from core.io.project import load, save
from core.io.storage import backup_of

LARGEST = 1024 * 1024
NOISE = (".lock",)


@contextmanager
def small_disk():
    """Give a folder with room for 1 MB, and the name of what makes it small."""
    with tempfile.TemporaryDirectory() as folder:
        mount = ["mount", "-t", "tmpfs", "-o", "size=1m", "none", folder]
        if hasattr(os, "geteuid") and os.geteuid() == 0 and subprocess.run(mount, check=False).returncode == 0:
            try:
                yield Path(folder), "a disk of 1 MB"
            finally:
                subprocess.run(["umount", "-l", folder], check=True)
        else:
            import resource
            import signal

            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (LARGEST, resource.RLIM_INFINITY))
            yield Path(folder), "files of at most 1 MB"


def listed(folder):
    return {p.name: p.read_bytes() for p in folder.iterdir() if p.is_file() and p.suffix not in NOISE}


def main():
    application = make_application()
    with small_disk() as (disk, name), tempfile.TemporaryDirectory() as home:
        print(name)
        path = disk / "film.inkb"
        save(many_vertices(2_000), path)
        settings = Settings(QSettings(f"{home}/settings.ini", QSettings.Format.IniFormat))
        editor = Editor(settings, disk / "state")  # unsaved work has nowhere to go either
        editor.window.show()
        editor.files.open_path(path)
        told = []
        editor.safekeeping.autosave.troubled.connect(told.append)
        before, old = listed(disk), load(path)
        large = many_vertices(200_000)
        editor.session.apply("Draw", lambda _: large)
        for number in range(3):
            editor.session.apply("Move Vertices", numbered, number)
            editor.safekeeping.autosave.keep()
            QTest.qWait(1500)
        print("autosave:", *told)
        assert len(told) == 1
        assert not editor.files.save()
        print("save:", editor.window.message_bar.text)
        assert [b.text() for b in editor.window.message_bar.buttons] == ["Retry", "Save As…"]
        assert listed(disk) == before
        assert load(path) == old
        assert editor.session.is_modified
        assert not list(disk.rglob("*.part"))
        print("the old file is whole, and nothing lies beside it")
        small = many_vertices(2_000)
        editor.session.apply("Simplify", lambda _: small)
        assert editor.files.save()
        assert (load(path), load(backup_of(path))) == (small, old)
        print("as soon as it fits, it is saved, with a backup")
        for part in (editor.safekeeping, editor.files, editor.preview, editor.ranked, editor.certificates):
            part.stop()
    application.processEvents()


if __name__ == "__main__":
    main()

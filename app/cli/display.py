"""Whether a window can be opened here, and the sentence for the person if not."""

import ctypes
import os
import sys


class Problem(Exception):
    """What stops a command: one sentence for the person who typed it."""


PACKAGES = "libgl1 libegl1 libxkbcommon0 libfontconfig1 libdbus-1-3 libglib2.0-0"
"""What a bare Debian lacks for Qt to be imported."""
WINDOW_LIBRARIES = {
    "libxcb-cursor.so.0": "libxcb-cursor0",
    "libxcb-icccm.so.4": "libxcb-icccm4",
    "libxcb-keysyms.so.1": "libxcb-keysyms1",
    "libxcb-shape.so.0": "libxcb-shape0",
    "libxcb-xkb.so.1": "libxcb-xkb1",
    "libxkbcommon-x11.so.0": "libxkbcommon-x11-0",
}
"""What Qt needs for a window on X, and the Debian packages; without one of them it would abort the program."""


def has_display() -> bool:
    """Whether Qt would find a screen, or has been told to do without one."""
    if not sys.platform.startswith("linux"):
        return True
    return any(os.environ.get(name) for name in ("QT_QPA_PLATFORM", "DISPLAY", "WAYLAND_DISPLAY"))


def check_window_libraries() -> None:
    """Raise Problem where the plugin for X would not load: Qt itself would end the program, with a riddle."""
    on_x = bool(os.environ.get("DISPLAY"))
    if not on_x or os.environ.get("WAYLAND_DISPLAY") or os.environ.get("QT_QPA_PLATFORM", "xcb") != "xcb":
        return
    missing = [package for library, package in WINDOW_LIBRARIES.items() if not _loads(library)]
    if missing:
        raise Problem(f"Qt cannot open a window without {' '.join(missing)}; {_install(' '.join(missing))}")


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def _install(packages: str) -> str:
    return f"on Debian and Ubuntu: sudo apt install {packages}"


def without_qt(error: ImportError) -> Exception:
    """Return the sentence for a Qt that cannot be imported, or the error itself if it is another one."""
    if isinstance(error, ModuleNotFoundError):
        if (error.name or "").partition(".")[0] not in ("PySide6", "shiboken6"):
            return error
        return Problem("Qt for Python is not installed; pip install PySide6-Essentials")
    library = str(error).partition(":")[0]
    return Problem(f"Qt cannot be loaded, {library} is missing; {_install(PACKAGES)}")

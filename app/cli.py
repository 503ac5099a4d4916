"""The command line. Nothing heavier than argparse is imported before a command needs it."""

import argparse
import io
import os
import re
import signal
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from app import __version__

if TYPE_CHECKING:
    from app.export.frames import ExportSettings
    from core.model.document import Document

DONE, PROBLEM, INTERRUPTED = 0, 1, 130

DEMO_SAMPLE = "bending arm.inkb"
DEMO_FOLDER = "inkbetween-demo"

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

COMMANDS_TEXT = """\
commands:
  demo                  open the editor on a sample; without a display, export the sample's frames
  export FILE OUT_DIR   write the frames as numbered PNG pictures
  info FILE             say what is in a project

"inkbetween export --help" and so on tell more. A file with the name of a command: inkbetween ./demo
"""


class Problem(Exception):
    """What stops a command: one sentence for the person who typed it."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; return 0, 1 after a problem, 130 when interrupted. Wrong usage exits with 2."""
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")  # file names may hold what a terminal cannot show
    try:
        try:
            return _run(list(sys.argv[1:] if arguments is None else arguments))
        finally:
            sys.stdout.flush()
    except OSError as e:
        # mostly a reader that has gone (inkbetween info | head); Python would complain again at its end
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return PROBLEM if isinstance(e, BrokenPipeError) else _report(e.strerror or e)


def _run(words: list[str]) -> int:
    command = COMMANDS.get(words[0]) if words else None
    parsed = command(words[0]).parse_args(words[1:]) if command else _editor_parser().parse_args(words)
    from core.errors import InkbetweenError

    try:
        code: int = parsed.run(parsed)
    except KeyboardInterrupt:
        return INTERRUPTED
    except (Problem, InkbetweenError) as e:
        return _report(e)
    return code


def _report(problem: object) -> int:
    sys.stderr.write(f"inkbetween: {problem}\n")
    return PROBLEM


def _editor_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="inkbetween",
        usage="inkbetween [FILE]\n       inkbetween COMMAND ...",
        description="A desktop in-betweening editor: draw keyframes, say which point goes where, "
        "see every in-between at once.",
        epilog=COMMANDS_TEXT,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("file", metavar="FILE", nargs="?", help="a project (.inkb) to open in the editor")
    parser.add_argument("--version", action="version", version=f"inkbetween {__version__}")
    parser.set_defaults(run=_edit)
    return parser


def _demo_parser(name: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=f"inkbetween {name}",
        description="Open the editor on a sample. Without a display, export the sample's frames "
        f"into ./{DEMO_FOLDER} instead.",
    )
    parser.set_defaults(run=_demo)
    return parser


def _export_parser(name: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=f"inkbetween {name}",
        description="Write the frames of a project as NAME.0001.png and so on, with straight alpha. "
        "Files of the same names are replaced.",
    )
    parser.add_argument("file", metavar="FILE", type=Path, help="a project (.inkb)")
    parser.add_argument("folder", metavar="OUT_DIR", type=Path, help="where to; made if it is not there")
    parser.add_argument("--size", metavar="WxH", type=_size, help="of the pictures in px (the stage's)")
    parser.add_argument("--frames", metavar="A-B", type=_frames, help="the first and the last one (all)")
    parser.add_argument("--name", metavar="N", help="what the file names begin with (the project's name)")
    parser.add_argument(
        "--background",
        metavar="COLOR",
        type=_background,
        default="stage",
        help="rrggbb, rrggbbaa, none for transparent, or stage for the colour of the stage (stage)",
    )
    parser.set_defaults(run=_export)
    return parser


def _info_parser(name: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog=f"inkbetween {name}", description="Say what is in a project.")
    parser.add_argument("file", metavar="FILE", type=Path, help="a project (.inkb)")
    parser.add_argument("--json", action="store_true", help="for other programs to read")
    parser.set_defaults(run=_info)
    return parser


COMMANDS: dict[str, Callable[[str], argparse.ArgumentParser]] = {
    "demo": _demo_parser,
    "export": _export_parser,
    "info": _info_parser,
}


def _size(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d{1,9})[xX×](\d{1,9})", text)
    if not found:
        raise argparse.ArgumentTypeError(f"{text!r} is no size; write width x height in px, such as 1920x1080")
    from core.model.document import LARGEST_STAGE

    width, height = int(found[1]), int(found[2])
    if not (1 <= width <= LARGEST_STAGE and 1 <= height <= LARGEST_STAGE):
        raise argparse.ArgumentTypeError(f"{text} px; each side must be 1 to {LARGEST_STAGE}")
    return width, height


def _frames(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d{1,9})(?:-(\d{1,9}))?", text)
    if not found:
        raise argparse.ArgumentTypeError(f"{text!r} are no frames; write the first and the last, such as 1-24")
    first, last = int(found[1]), int(found[2] or found[1])
    if first < 1:
        raise argparse.ArgumentTypeError(f"{text!r} begins at {first}; the first frame is 1")
    if last < first:
        raise argparse.ArgumentTypeError(f"{text!r} ends before it begins; write {last}-{first}")
    return first, last


def _background(text: str) -> str | None:
    if text in ("none", "stage"):
        return None if text == "none" else text
    if not re.fullmatch(r"#?[0-9a-fA-F]{6}([0-9a-fA-F]{2})?", text):
        raise argparse.ArgumentTypeError(f"{text!r} is no colour; write rrggbb, rrggbbaa, none or stage")
    return "#" + text.removeprefix("#").lower()


def _edit(parsed: argparse.Namespace) -> int:
    if parsed.file is not None and not os.path.isfile(parsed.file):
        raise Problem(f"there is no file {parsed.file}; make a new project with: inkbetween")
    if not _has_display():
        raise Problem(
            "there is no display to open a window on (neither DISPLAY nor WAYLAND_DISPLAY is set); "
            "inkbetween export works without one"
        )
    return _open_window(parsed.file)


def _demo(parsed: argparse.Namespace) -> int:
    import resources

    sample = resources.folder() / "samples" / DEMO_SAMPLE
    if _has_display():
        return _open_window(str(sample))
    from core.io.project import load

    document = load(sample)
    folder = _free_folder(Path.cwd(), DEMO_FOLDER)
    frames = _qt_export()
    settings = frames.ExportSettings.whole_film(document, folder, sample.stem)
    return _write_frames(document, settings, "there is no display, so the sample is here as pictures:\n")


def _free_folder(parent: Path, name: str) -> Path:
    """Return a name that nothing has yet: the demo overwrites no one's files."""
    free, number = parent / name, 1
    while os.path.lexists(free):
        number += 1
        free = parent / f"{name}-{number}"
    return free


def _has_display() -> bool:
    if not sys.platform.startswith("linux"):
        return True
    return any(os.environ.get(name) for name in ("QT_QPA_PLATFORM", "DISPLAY", "WAYLAND_DISPLAY"))


def _open_window(path: str | None) -> int:
    _check_window_libraries()
    try:
        from app import bootstrap
    except ImportError as e:
        raise _without_qt(e) from e
    return bootstrap.run(path)


def _check_window_libraries() -> None:
    on_x = bool(os.environ.get("DISPLAY"))
    if not on_x or os.environ.get("WAYLAND_DISPLAY") or os.environ.get("QT_QPA_PLATFORM", "xcb") != "xcb":
        return
    missing = [package for library, package in WINDOW_LIBRARIES.items() if not _loads(library)]
    if missing:
        raise Problem(f"Qt cannot open a window without {' '.join(missing)}; {_install(' '.join(missing))}")


def _loads(library: str) -> bool:
    import ctypes

    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def _install(packages: str) -> str:
    return f"on Debian and Ubuntu: sudo apt install {packages}"


def _without_qt(error: ImportError) -> Exception:
    """Return the sentence for a Qt that cannot be imported, or the error itself if it is another one."""
    if isinstance(error, ModuleNotFoundError):
        if (error.name or "").partition(".")[0] not in ("PySide6", "shiboken6"):
            return error
        return Problem("Qt for Python is not installed; pip install PySide6-Essentials")
    library = str(error).partition(":")[0]
    return Problem(f"Qt cannot be loaded, {library} is missing; {_install(PACKAGES)}")


def _qt_export():
    try:
        from app.export import frames
    except ImportError as e:
        raise _without_qt(e) from e
    return frames


def _export(parsed: argparse.Namespace) -> int:
    from core.io.project import load

    document = load(parsed.file)
    first, last = parsed.frames or (1, document.length)
    size = parsed.size or (document.stage.width, document.stage.height)
    name = parsed.name if parsed.name is not None else parsed.file.stem
    settings = _qt_export().ExportSettings(parsed.folder, name, first, last, size, background=parsed.background)
    return _write_frames(document, settings)


def _write_frames(document: "Document", settings: "ExportSettings", remark: str = "") -> int:
    """Export with a line of progress; Ctrl+C stops between two frames."""
    interrupts: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, _: interrupts.append(number))
    try:
        exported = _qt_export().export_frames(
            document, settings, progress=_show_progress, cancelled=lambda: bool(interrupts)
        )
    finally:
        signal.signal(signal.SIGINT, before)
        if sys.stderr.isatty():
            sys.stderr.write("\r\x1b[K")  # the line of progress gives way to the result
    count = len(exported.files)
    if exported.cancelled:
        sys.stderr.write(f"inkbetween: stopped; {count} complete frames stay in {settings.folder}\n")
        return INTERRUPTED
    sys.stdout.write(f"{remark}{count} frames, {exported.files[0]} to {exported.files[-1].name}\n")
    return DONE


def _show_progress(done: int, total: int) -> None:
    if sys.stderr.isatty():
        sys.stderr.write(f"\rframe {done} of {total}")
        sys.stderr.flush()


def _info(parsed: argparse.Namespace) -> int:
    from core.io.project import load

    facts = _facts(load(parsed.file))
    if parsed.json:
        import json

        sys.stdout.write(json.dumps({"file": str(parsed.file), **facts}, indent=2) + "\n")
    else:
        sys.stdout.write(f"{parsed.file}\n{_fact_lines(facts)}")
    return DONE


def _facts(document: "Document") -> dict:
    return {
        "stage": {
            "width": document.stage.width,
            "height": document.stage.height,
            "background": document.stage.background,
        },
        "rate": str(document.rate),
        "length": document.length,
        "layers": [
            {
                "name": layer.name,
                "visible": layer.visible,
                "keyframes": [
                    {
                        "frame": k.frame,
                        "outlines": len(k.drawing.outlines),
                        "vertices": sum(len(o.points) for o in k.drawing.outlines),
                        "method": k.span.method,
                    }
                    for k in layer.keyframes
                ],
            }
            for layer in document.layers
        ],
    }


def _fact_lines(facts: dict) -> str:
    stage, layers = facts["stage"], facts["layers"]
    lines = [
        f"stage: {stage['width']} x {stage['height']} px, {stage['background'] or 'transparent'}",
        f"film: {facts['length']} frames, {facts['rate']} a second",
    ]
    for layer in layers:
        lines.append(f"layer {layer['name']!r}{'' if layer['visible'] else ', hidden'}:")
        if not layer["keyframes"]:
            lines.append("  no keyframes")
        for i, k in enumerate(layer["keyframes"], start=1):
            then = f", then {k['method']}" if i < len(layer["keyframes"]) else ""
            lines.append(f"  keyframe at {k['frame']}: outlines {k['outlines']}, vertices {k['vertices']}{then}")
    return "\n".join(lines) + "\n"

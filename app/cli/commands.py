"""The commands: their arguments, and what they do."""

import argparse
import json
import os
import re
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import resources
from app.cli.display import Problem, check_window_libraries, has_display, without_qt
from app.cli.new import new_parser

if TYPE_CHECKING:  # numpy comes with core: not for a usage error
    from app.export.frames import ExportSettings
    from core.model.document import Document, Keyframe

DONE, INTERRUPTED = 0, 130

DEMO_FOLDER = "inkbetween-demo"


def _demo_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="inkbetween demo",
        description="Open the editor on a sample. Without a display, export the sample's frames "
        f"into ./{DEMO_FOLDER} instead.",
    )
    parser.set_defaults(run=_demo)
    return parser


def _export_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="inkbetween export",
        description="Write the frames of a project as NAME.0001.png and so on, with straight alpha. "
        "Files of the same names are replaced.",
    )
    parser.add_argument("file", metavar="FILE", help="a project (.inkb)")
    parser.add_argument("folder", metavar="OUT_DIR", help="where to; made if it is not there")
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


def _info_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="inkbetween info", description="Say what is in a project.")
    parser.add_argument("file", metavar="FILE", help="a project (.inkb)")
    parser.add_argument("--json", action="store_true", help="for other programs to read")
    parser.set_defaults(run=_info)
    return parser


def parse(words: list[str]) -> Callable[[], int]:
    """Return what the words ask for, ready to be run; raises SystemExit after wrong usage or help."""
    if words and words[0] in COMMANDS:
        parsed = COMMANDS[words[0]]().parse_args(words[1:])
        return lambda: parsed.run(parsed)
    parsed = _editor_parser().parse_args(words)
    return lambda: _edit(parsed)


def _editor_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="inkbetween", usage="inkbetween [FILE]\n       inkbetween COMMAND ...", add_help=False
    )
    parser.add_argument("file", nargs="?")
    return parser


COMMANDS = {"demo": _demo_parser, "export": _export_parser, "info": _info_parser, "new": new_parser}


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
    if not has_display():
        raise Problem(
            "there is no display to open a window on (neither DISPLAY nor WAYLAND_DISPLAY is set); "
            "inkbetween export works without one"
        )
    return _open_window(parsed.file)


def _demo(parsed: argparse.Namespace) -> int:
    sample = resources.folder() / "samples" / f"{resources.DEMO}.inkb"
    if has_display():
        return _open_window(str(sample), sample=True)
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


def _open_window(path: str | None, *, sample: bool = False) -> int:
    check_window_libraries()
    try:
        from app import bootstrap
    except ImportError as e:
        raise without_qt(e) from e
    return bootstrap.run(path, sample=sample)


def _qt_export() -> ModuleType:
    try:
        from app.export import frames
    except ImportError as e:
        raise without_qt(e) from e
    return frames


def _export(parsed: argparse.Namespace) -> int:
    from core.io.project import load

    document = load(parsed.file)
    first, last = parsed.frames or (1, document.length)
    size = parsed.size or (document.stage.width, document.stage.height)
    name = parsed.name if parsed.name is not None else Path(parsed.file).stem
    settings = _qt_export().ExportSettings(
        Path(parsed.folder), name, first, last, size, background=parsed.background
    )
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
        sys.stdout.write(json.dumps({"file": parsed.file, **facts}, indent=2) + "\n")
    else:
        sys.stdout.write(f"{parsed.file}\n{_fact_lines(facts)}")
    return DONE


def _facts(document: "Document") -> dict[str, Any]:
    stage = document.stage
    return {
        "stage": {"width": stage.width, "height": stage.height, "background": stage.background},
        "rate": str(document.rate),
        "length": document.length,
        "layers": [
            {"name": x.name, "visible": x.visible, "keyframes": [_keyframe_facts(k) for k in x.keyframes]}
            for x in document.layers
        ],
    }


def _keyframe_facts(keyframe: "Keyframe") -> dict[str, Any]:
    outlines = keyframe.drawing.outlines
    vertices = sum(len(o.points) for o in outlines)
    return {
        "frame": keyframe.frame,
        "outlines": len(outlines),
        "vertices": vertices,
        "method": keyframe.span.method,
    }


def _fact_lines(facts: dict[str, Any]) -> str:
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

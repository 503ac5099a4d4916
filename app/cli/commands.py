"""The commands: their arguments, and what they do."""

import argparse
import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import resources
from app.cli.check import check_parser
from app.cli.display import Problem, check_window_libraries, has_display, without_qt
from app.cli.export import export_parser, write
from app.cli.new import new_parser

if TYPE_CHECKING:  # numpy comes with core: not for a usage error
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


def _info_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="inkbetween info", description="Say what is in a project.")
    parser.add_argument("file", metavar="FILE", help="a project (.inkb)")
    parser.add_argument("--json", action="store_true", help="for other programs to read")
    parser.set_defaults(run=_info)
    return parser


def parse(words: list[str]) -> Callable[[], int]:
    """Return what the words ask for, ready to be run; raises SystemExit after wrong usage or help."""
    if len(words) > 1 and words[0] not in COMMANDS and not words[0].startswith("-"):
        _editor_parser().error(f"there is no command {words[0]!r}; the commands are {', '.join(COMMANDS)}")
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


COMMANDS = {
    "check": check_parser,
    "demo": _demo_parser,
    "export": export_parser,
    "info": _info_parser,
    "new": new_parser,
}


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
    from app.export.settings import ExportSettings

    settings = ExportSettings.whole_film(document, folder, sample.stem)
    return write(document, settings, "there is no display, so the sample is here as pictures:\n")


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

"""`inkbetween new`: a project of two SVG drawings, of a folder of them, or of a Lottie animation."""

import argparse
import math
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.display import Problem

if TYPE_CHECKING:  # numpy comes with core: not for a usage error
    from core.io.film import ImportedFilm
    from core.io.imported import Imported
    from core.model.document import Document, Stage

DONE = 0
FRAMES = 24


def new_parser() -> argparse.ArgumentParser:
    """Return what reads the words behind `new`."""
    parser = argparse.ArgumentParser(
        prog="inkbetween new",
        description="Make a project of two SVG drawings: the first frame shows the one, the last frame the other. "
        "The stage is as large as the first drawing; the second one is put in its middle. Or make one of a folder "
        "of SVG drawings, each a keyframe (walk.0001.svg, walk.0009.svg: the numbers are the frames; numbered 1, "
        "2, 3 ... without a gap they are put 8 frames apart), or of the shape layers of a Lottie film (.json).",
    )
    parser.add_argument("before", metavar="BEFORE", help="the first keyframe (.svg), a folder of SVG, or a .json")
    parser.add_argument("after", metavar="AFTER", nargs="?", help="the last keyframe (.svg)")
    parser.add_argument("-o", "--output", metavar="FILE.inkb", required=True, help="the project to write")
    parser.add_argument(
        "--frames", metavar="N", type=_frame_count, help=f"length of the film of two drawings ({FRAMES})"
    )
    parser.add_argument(
        "--method", metavar="M", type=_method, help="how vertices travel (intrinsic; of Lottie, linear)"
    )
    parser.add_argument("--force", action="store_true", help="replace FILE.inkb if it exists")
    parser.set_defaults(run=run_new)
    return parser


def run_new(parsed: argparse.Namespace) -> int:
    """Read everything, then write the project: nothing is written if something is wrong."""
    if os.path.lexists(parsed.output) and not parsed.force:
        raise Problem(f"{parsed.output} exists already; choose another name, or replace it with --force")
    if parsed.after is None:
        return _new_film(parsed)
    return _new_pair(parsed)


def _new_pair(parsed: argparse.Namespace) -> int:
    from core.io.project import save
    from core.io.svg import read_svg

    pictures = [read_svg(Path(name), tolerance=None) for name in (parsed.before, parsed.after)]
    document = _document(pictures, parsed.frames or FRAMES, parsed.method or "intrinsic")
    save(document, Path(parsed.output))
    for name, picture in zip((parsed.before, parsed.after), pictures, strict=True):
        _tell_rest(name, picture)
    return _tell_made(document, parsed.output)


def _new_film(parsed: argparse.Namespace) -> int:
    """Make a project of a folder or a Lottie animation."""
    from core.io.film import film_document, film_remark
    from core.io.project import save

    if parsed.frames is not None:
        raise Problem("--frames is for two drawings; a folder or an animation has a length of its own")
    film = _read_film(Path(parsed.before))
    document = film_document(film)
    if parsed.method is not None:
        document = _with_method(document, parsed.method)
    save(document, Path(parsed.output))
    if film_remark(film):
        sys.stderr.write(f"inkbetween: {parsed.before}: {film_remark(film)}\n")
    return _tell_made(document, parsed.output)


def _read_film(path: Path) -> "ImportedFilm":
    from core.io.lottie import read_lottie
    from core.io.svg_folder import read_svg_folder

    if path.is_dir():
        return read_svg_folder(path)
    if path.suffix.lower() == ".json":
        return read_lottie(path)
    raise Problem(f"{path} alone makes no film; name a second drawing, a folder of SVG, or a Lottie animation")


def _with_method(document: "Document", method: str) -> "Document":
    from core.model.edits import set_span

    for layer in document.layers:
        for keyframe in layer.keyframes[:-1]:
            document = set_span(document, layer.id, keyframe.frame, method=method)
    return document


def _tell_made(document: "Document", output: str) -> int:
    stage = document.stage
    sys.stdout.write(f"{output}: {document.length} frames, {stage.width} x {stage.height} px\n")
    return DONE


def _document(pictures: list["Imported"], frames: int, method: str) -> "Document":
    from core.io.imported import fitted, import_keyframe
    from core.model.document import Document
    from core.model.edits import set_span

    document = Document(stage=_stage(pictures[0].size), length=frames)
    for frame, picture in zip((1, frames), pictures, strict=True):
        document = import_keyframe(document, 1, frame, fitted(picture, document.stage))
    return set_span(document, 1, 1, method=method)


def _stage(size: tuple[float, float]) -> "Stage":
    from core.model.document import LARGEST_STAGE, Stage

    scale = min(1.0, LARGEST_STAGE / max(size))
    width, height = (min(max(math.ceil(side * scale - 1e-6), 1), LARGEST_STAGE) for side in size)
    return Stage(width, height)


def _tell_rest(name: str, picture: "Imported") -> None:
    from core.io.imported import remark

    rest = remark(picture, as_one=True)
    if rest:
        sys.stderr.write(f"inkbetween: {name}: {rest}\n")


def _frame_count(text: str) -> int:
    from core.model.document import LONGEST

    if not (text.isascii() and text.isdigit() and 2 <= int(text[:9]) <= LONGEST):
        raise argparse.ArgumentTypeError(f"{text!r} is no length; write a number of frames, 2 to {LONGEST}")
    return int(text)


def _method(text: str) -> str:
    from core.methods.plan import METHODS

    if text not in METHODS:
        raise argparse.ArgumentTypeError(f"{text!r} is no method; known are {', '.join(METHODS)}")
    return text

"""`inkbetween export`: a project becomes frames, a film, a sheet or an interchange file, without a display."""

import argparse
import json
import os
import re
import signal
import sys
import time
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from app.cli.display import Problem, without_qt

if TYPE_CHECKING:  # numpy comes with core: not for a usage error
    from fractions import Fraction

    from app.export.export import Exported
    from app.export.settings import ExportSettings
    from core.model.document import Document

DONE, INTERRUPTED = 0, 130
BAR = 30
"""Characters of the bar."""
PATIENCE = 0.5
"""Seconds before the time that is left can be told."""

FORMAT_HELP = """\
formats, and the ending of OUT that means each of them:
  png          numbered PNG frames in the folder OUT; OUT without an ending
  svg-frames   numbered SVG frames in the folder OUT
  gif          .gif, alpha of one bit
  apng         .apng
  webp         .webp, lossless
  mp4          .mp4, H.264 without alpha: transparent becomes white
  webm         .webm, VP9 with alpha
  prores       .mov, ProRes 4444 with alpha
  lottie       .json, shapes with keyframes
  svg          .svg, animated by SMIL
  svg-css      animated by CSS (Chromium)
  sprites      .png, one sheet and a JSON beside it
  xdts         .xdts, exposure sheet
  oca          .oca, a folder of drawings a layer (Open Cel Animation)
"""


def export_parser() -> argparse.ArgumentParser:
    """Return what reads the words behind `export`."""
    parser = argparse.ArgumentParser(
        prog="inkbetween export",
        usage="inkbetween export [options] FILE OUT",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Write the frames of a project as pictures, a film, a sheet or for another program. Every "
        "file is whole\nor not there, none is replaced unasked, and the same project gives the same bytes.",
        epilog=FORMAT_HELP,
    )
    parser.add_argument("file", metavar="FILE", help="a project (.inkb)")
    parser.add_argument(
        "out", metavar="OUT", type=_place, help="the file or folder; folders are made if they are not there"
    )
    parser.add_argument("--format", metavar="F", type=_format, help="see below (as the ending of OUT says)")
    _add_picture_options(parser)
    _add_name_options(parser)
    parser.add_argument("--force", "--overwrite", action="store_true", help="replace files that are there")
    parser.add_argument(
        "--continue", dest="proceed", action="store_true", help="make only the files that are not there yet"
    )
    parser.add_argument(
        "--processes", metavar="N", type=_processes, default=0, help="that paint (as many as are of use)"
    )
    parser.add_argument("--json", action="store_true", help="progress and result for other programs to read")
    parser.set_defaults(run=run_export)
    return parser


def _add_picture_options(parser: argparse.ArgumentParser) -> None:
    sizes = parser.add_mutually_exclusive_group()
    sizes.add_argument("--size", metavar="WxH", type=_size, help="of the pictures in px (the stage's)")
    sizes.add_argument("--scale", metavar="S", type=_scale, default=1.0, help="size as a share of the stage's (1)")
    parser.add_argument("--frames", metavar="A-B", type=_frames, help="the first and the last one (all)")
    parser.add_argument("--rate", metavar="R", type=_rate, help="pictures a second (the project's)")
    parser.add_argument(
        "--background",
        metavar="COLOR",
        type=_background,
        default="stage",
        help="rrggbb, rrggbbaa, none for transparent, or stage for the colour of the stage (stage)",
    )
    parser.add_argument("--depth", type=int, choices=(8, 16), default=8, help="bits a channel of PNG frames (8)")
    parser.add_argument(
        "--layer", metavar="NAME", action="append", help="show this layer only; may be given more than once"
    )
    parser.add_argument("--each-layer", action="store_true", help="every layer on its own")
    parser.add_argument("--exposures", action="store_true", help="write a drawing that is held only once")
    parser.add_argument("--chart", action="store_true", help="print the timing chart beside the drawing")


def _add_name_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--name", metavar="N", help="what the file names begin with (the project's name)")
    parser.add_argument("--separator", metavar="S", default=".", help="between name and number (.)")
    parser.add_argument("--padding", metavar="N", type=_padding, default=4, help="least number of digits (4)")
    parser.add_argument("--number", metavar="N", type=_number, help="number of the first file (its frame's)")
    parser.add_argument(
        "--pattern",
        metavar="P",
        default="",
        help="names without their ending, of {name} {layer} {frame} {drawing} {separator}",
    )


def run_export(parsed: argparse.Namespace) -> int:
    """Export what the words say."""
    from app.export.formats import check_ending, format_of
    from core.io.project import load

    form = parsed.format or format_of(parsed.out)
    check_ending(parsed.out, form)
    document = load(parsed.file)
    settings = _settings(parsed, form, document)
    return write(document, settings, as_json=parsed.json)


def _place(text: str) -> str:
    if not text:
        raise argparse.ArgumentTypeError("it is empty; name a file or a folder, . for this one")
    return text


def _settings(parsed: argparse.Namespace, form: str, document: "Document") -> "ExportSettings":
    from app.export.settings import ExportSettings, fitting_size

    first, last = parsed.frames or (1, document.length)
    return ExportSettings(
        Path(parsed.out),
        parsed.name if parsed.name is not None else Path(parsed.file).stem,
        first,
        last,
        parsed.size or fitting_size(document, form, parsed.scale),
        form,
        background=parsed.background,
        rate=parsed.rate,
        padding=parsed.padding,
        separator=parsed.separator,
        pattern=parsed.pattern,
        number=parsed.number,
        depth=parsed.depth,
        exposures=parsed.exposures,
        chart=parsed.chart,
        layers=_layers(document, parsed.layer),
        each_layer=parsed.each_layer,
        replace=parsed.force,
        proceed=parsed.proceed,
        processes=parsed.processes,
    )


def _layers(document: "Document", names: list[str] | None) -> tuple[int, ...] | None:
    if names is None:
        return None
    ids: list[int] = []
    for name in names:
        found = [x.id for x in document.layers if x.name == name]
        if not found:
            known = ", ".join(x.name for x in document.layers)
            raise Problem(f"the project has no layer {name!r}; its layers are {known}")
        ids += found
    return tuple(ids)


def qt_export() -> ModuleType:
    """Return the module that exports; raises Problem where Qt cannot be loaded."""
    try:
        from app.export import export
    except ImportError as e:
        raise without_qt(e) from e
    return export


def write(document: "Document", settings: "ExportSettings", remark: str = "", *, as_json: bool = False) -> int:
    """Export with a bar on a terminal, or with lines for programs; Ctrl+C stops between two pictures."""
    from core.errors import InkbetweenError

    exporting = qt_export()
    interrupts: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, _: interrupts.append(number))
    show = _JsonProgress() if as_json else _Bar()
    try:
        exported = exporting.export(document, settings, progress=show, cancelled=lambda: bool(interrupts))
    except InkbetweenError as e:
        if as_json:
            _say({"error": str(e)})
        raise _with_hint(e) from None
    finally:
        signal.signal(signal.SIGINT, before)
        show.end()
    if as_json:
        _say({"files": [str(f) for f in exported.files], "kept": exported.kept, "cancelled": exported.cancelled})
    elif not exported.cancelled:
        sys.stdout.write(f"{remark}{_result(document, settings, exported)}\n")
    if exported.cancelled:
        sys.stderr.write(f"inkbetween: stopped; {_left(exported, settings)}\n")
        return INTERRUPTED
    return DONE


def _with_hint(error: Exception) -> Exception:
    """Return the error, with the ways out where files would have been replaced."""
    from app.export.whole import InTheWayError

    if isinstance(error, InTheWayError):
        return Problem(f"{error}; choose another place, replace with --force, or make the rest with --continue")
    return error


def _left(exported: "Exported", settings: "ExportSettings") -> str:
    from app.export.formats import FORMATS

    count = len(exported.files)
    if FORMATS[settings.format].frames:
        return f"{count} complete frames stay in {settings.out}, and --continue makes the rest"
    return f"{count} complete files stay" if count else "nothing has been written"


def _result(document: "Document", settings: "ExportSettings", exported: "Exported") -> str:
    """Return the line that tells what there is now."""
    from app.export.film import count_pictures
    from app.export.formats import FORMATS

    files, kept = exported.files, f"; {exported.kept} were there already" if exported.kept else ""
    if not files:
        if exported.kept == 1:
            return "nothing to do, the file was there already"
        return f"nothing to do, all {exported.kept} files were there already"
    if FORMATS[settings.format].frames:
        drawings = "drawings" if settings.exposures else "frames"
        if len(files) == 1:
            return f"1 {drawings[:-1]}, {files[0]}{kept}"
        return f"{len(files)} {drawings}, {files[0]} to {files[-1].name}{kept}"
    count = count_pictures(settings, document.rate)
    width, height = settings.size
    return f"{', '.join(map(str, files))}: {count} frames, {width} x {height} px{kept}"


class _Bar:
    """One line on a terminal that shows how far it is; nothing elsewhere."""

    def __init__(self) -> None:
        self._began = time.monotonic()
        self._shown = sys.stderr.isatty()

    def __call__(self, done: int, total: int) -> None:
        if self._shown:
            full = BAR * done // max(total, 1)
            left = seconds_left(self._began, done, total)
            rest = "" if left is None else f", {told(left)} left"
            sys.stderr.write(f"\r[{'#' * full}{'.' * (BAR - full)}] {done} of {total}{rest}\x1b[K")
            sys.stderr.flush()

    def end(self) -> None:
        """Give way to the result."""
        if self._shown:
            sys.stderr.write("\r\x1b[K")


class _JsonProgress:
    """A line of JSON for every picture."""

    def __init__(self) -> None:
        self._began = time.monotonic()

    def __call__(self, done: int, total: int) -> None:
        left = seconds_left(self._began, done, total)
        _say({"done": done, "total": total, "seconds_left": None if left is None else round(left, 1)})

    def end(self) -> None:
        """There is nothing to take away."""


def _say(line: dict[str, Any]) -> None:
    sys.stdout.write(json.dumps(line) + "\n")
    sys.stdout.flush()


def seconds_left(began: float, done: int, total: int) -> float | None:
    """Return how long the rest will take, once that can be told."""
    spent = time.monotonic() - began
    return None if spent < PATIENCE or not done else spent * (total - done) / done


def told(seconds: float) -> str:
    """Return a time in words: 12 s, 3 min 5 s."""
    whole = max(1, round(seconds))
    return f"{whole} s" if whole < 60 else f"{whole // 60} min {whole % 60} s"


# reading words


def _format(text: str) -> str:
    from app.export.formats import FORMATS

    if text not in FORMATS:
        raise argparse.ArgumentTypeError(f"{text!r} is no format; known are {', '.join(FORMATS)}")
    return text


def _size(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d{1,9})[xX×](\d{1,9})", text)
    if not found:
        raise argparse.ArgumentTypeError(f"{text!r} is no size; write width x height in px, such as 1920x1080")
    from core.model.document import LARGEST_STAGE

    width, height = int(found[1]), int(found[2])
    if not (1 <= width <= LARGEST_STAGE and 1 <= height <= LARGEST_STAGE):
        raise argparse.ArgumentTypeError(f"{text} px; each side must be 1 to {LARGEST_STAGE}")
    return width, height


def _scale(text: str) -> float:
    found = re.fullmatch(r"(\d{1,6}(?:\.\d{0,9})?|\.\d{1,9})(%?)", text)
    scale = float(found[1]) / (100 if found[2] else 1) if found else 0.0
    if not 0 < scale <= 1000:
        raise argparse.ArgumentTypeError(f"{text!r} is no scale; write a number above 0, such as 0.5 or 50%")
    return scale


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


def _rate(text: str) -> "Fraction":
    from core.errors import DocumentError
    from core.model.document import as_rate

    try:
        return as_rate(text)
    except DocumentError as e:
        raise argparse.ArgumentTypeError(str(e)) from None


def _background(text: str) -> str | None:
    if text in ("none", "stage"):
        return None if text == "none" else text
    if not re.fullmatch(r"#?[0-9a-fA-F]{6}([0-9a-fA-F]{2})?", text):
        raise argparse.ArgumentTypeError(f"{text!r} is no colour; write rrggbb, rrggbbaa, none or stage")
    return "#" + text.removeprefix("#").lower()


def _padding(text: str) -> int:
    if not re.fullmatch(r"[1-9]", text):
        raise argparse.ArgumentTypeError(f"{text!r} is no number of digits; choose 1 to 9")
    return int(text)


def _number(text: str) -> int:
    if not re.fullmatch(r"\d{1,8}", text):
        raise argparse.ArgumentTypeError(f"{text!r} is no number for a file; write 0 or more, at most 8 digits")
    return int(text)


def _processes(text: str) -> int:
    if not re.fullmatch(r"\d{1,2}", text) or not 1 <= int(text) <= 2 * (os.cpu_count() or 1) + 2:
        raise argparse.ArgumentTypeError(f"{text!r} is no number of processes for this machine; 1 to its cores")
    return int(text)

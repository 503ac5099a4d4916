"""The formats: what each is called, what it makes, and which one a file's ending means."""

import os
from dataclasses import dataclass
from pathlib import Path

from core.errors import InkbetweenError


@dataclass(frozen=True, slots=True)
class Format:
    """One way to export.

    Attributes
    ----------
    id : str
    label : str
        For people.
    ending : str
        Of the file, with its dot; of every frame where it makes a folder.
    folder : bool
        Whether it makes a folder.
    frames : bool
        Whether the folder holds numbered frames, nothing else.
    moving : bool
        Whether pictures are encoded one after another into one film.
    alpha : str
        "full", "one bit" or "none".
    even : bool
        Whether both sides must be even.
    deep : bool
        Whether 16 bits a channel can be asked for.
    drawn : bool
        Whether it holds shapes and no pixels.
    """

    id: str
    label: str
    ending: str
    folder: bool = False
    frames: bool = False
    moving: bool = False
    alpha: str = "full"
    even: bool = False
    deep: bool = False
    drawn: bool = False


FORMATS: dict[str, Format] = {
    form.id: form
    for form in (
        Format("png", "PNG frames", ".png", folder=True, frames=True, deep=True),
        Format("svg-frames", "SVG frames", ".svg", folder=True, frames=True, drawn=True),
        Format("gif", "GIF", ".gif", moving=True, alpha="one bit"),
        Format("apng", "Animated PNG", ".apng", moving=True),
        Format("webp", "Animated WebP", ".webp", moving=True),
        Format("mp4", "MP4 (H.264)", ".mp4", moving=True, alpha="none", even=True),
        Format("webm", "WebM (VP9)", ".webm", moving=True),
        Format("prores", "ProRes 4444", ".mov", moving=True),
        Format("lottie", "Lottie", ".json", drawn=True),
        Format("svg", "Animated SVG", ".svg", drawn=True),
        Format("svg-css", "Animated SVG (CSS)", ".svg", drawn=True),
        Format("sprites", "Sprite sheet", ".png"),
        Format("xdts", "Exposure sheet (XDTS)", ".xdts", drawn=True),
        Format("oca", "Open Cel Animation", "", folder=True),
    )
}
ENDINGS = {
    ".apng": "apng",
    ".gif": "gif",
    ".json": "lottie",
    ".mov": "prores",
    ".mp4": "mp4",
    ".oca": "oca",
    ".png": "sprites",
    ".svg": "svg",
    ".webm": "webm",
    ".webp": "webp",
    ".xdts": "xdts",
}


def check_ending(out: str, form: str) -> None:
    """Raise InkbetweenError if the path has the ending of another format: players go by it."""
    ending = Path(out).suffix.lower()
    meant = ENDINGS.get(ending)
    wanted = FORMATS[form].ending
    if meant is None or FORMATS[form].folder or ending == wanted or (form, ending) == ("apng", ".png"):
        return
    raise InkbetweenError(f"{out} ends as {FORMATS[meant].label} does, {FORMATS[form].label} ends in {wanted}")


def format_of(out: str) -> str:
    """Return the format that a path asks for by its ending; no ending is a folder of PNG frames.

    Raises InkbetweenError for an ending that means nothing.
    """
    ending = Path(out).suffix.lower()
    if not ending or out.endswith(("/", os.sep)) or (os.path.isdir(out) and ending != ".oca"):
        return "png"
    if ending not in ENDINGS:
        known = " ".join(ENDINGS)
        raise InkbetweenError(f"no format ends in {ending}; name one with --format, or use one of {known}")
    return ENDINGS[ending]

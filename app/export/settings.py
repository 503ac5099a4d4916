"""What to export: the frames, how they look, where they go and how they are called."""

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from app.export.formats import FORMATS
from core.errors import InkbetweenError
from core.model.document import FASTEST, LARGEST_STAGE, LONGEST, Document
from core.model.drawing import Color, as_color

DEPTHS = (8, 16)
PATTERN = "{name}{separator}{frame}"
LAYER_PATTERN = "{name}{separator}{layer}{separator}{frame}"
FORBIDDEN = frozenset('/\\:*?"<>|')
"""In file names; some systems know no such names."""

LARGEST_NUMBER = 10**8


@dataclass(frozen=True, slots=True)
class ExportSettings:
    """What to export and where to.

    Attributes
    ----------
    out : Path
        The file, or the folder of a format that makes one; folders are made if they are not there.
    name : str
        What the names of frames begin with.
    first, last : int
        Frames, both included.
    size : (int, int)
        Width and height in px; the stage is fitted in.
    format : str
        A key of `FORMATS`.
    background : "stage", Color or None
        "stage" takes the colour of the stage, None is transparent.
    rate : Fraction or None
        Pictures a second; the film lasts as long as before. None: one picture a frame.
    padding : int
        Least number of digits.
    separator : str
        Between name and number.
    pattern : str
        Of a frame's file, without its ending; "" is the usual one. `{name}`, `{layer}`, `{frame}`, `{drawing}` and
        `{separator}` are filled in.
    number : int or None
        Number of the first file; None: that of its frame.
    depth : int
        Bits a channel of PNG, 8 or 16.
    exposures : bool
        Whether a drawing that is held is written only once, where it begins.
    chart : bool
        Whether the timing chart of the span is printed beside the drawing.
    layers : tuple of int or None
        Ids of the layers to show; None: all visible ones.
    each_layer : bool
        Whether every layer becomes a file or sequence of its own.
    replace : bool
        Whether files that are there may be replaced.
    proceed : bool
        Whether files that are there are left as they are, and only the missing ones made.
    processes : int
        That paint; 0: as many as are of use, 1: none but this one.
    """

    out: Path
    name: str
    first: int
    last: int
    size: tuple[int, int]
    format: str = "png"
    background: Color | None = "stage"
    rate: Fraction | None = None
    padding: int = 4
    separator: str = "."
    pattern: str = ""
    number: int | None = None
    depth: int = 8
    exposures: bool = False
    chart: bool = False
    layers: tuple[int, ...] | None = None
    each_layer: bool = False
    replace: bool = False
    proceed: bool = False
    processes: int = 0

    def __post_init__(self) -> None:
        if self.format not in FORMATS:
            raise InkbetweenError(f"unknown format {self.format!r}; known are {', '.join(FORMATS)}")
        if not self.name.strip() or any(c in FORBIDDEN or ord(c) < 32 for c in self.name + self.separator):
            raise InkbetweenError(
                f"{self.name + self.separator!r} cannot begin a file name; use letters and digits"
            )
        if not 1 <= self.first <= self.last <= LONGEST:
            raise InkbetweenError(f"frames {self.first} to {self.last} are no range; write the smaller one first")
        if not all(1 <= side <= LARGEST_STAGE for side in self.size):
            width, height = self.size
            raise InkbetweenError(f"a picture of {width} x {height} px; each side must be 1 to {LARGEST_STAGE} px")
        if not 1 <= self.padding <= 9:
            raise InkbetweenError(f"frame numbers of {self.padding} digits; choose 1 to 9")
        if self.number is not None and not 0 <= self.number <= LARGEST_NUMBER:
            raise InkbetweenError(f"the first number is {self.number}; choose 0 to {LARGEST_NUMBER}")
        if self.depth not in DEPTHS:
            raise InkbetweenError(f"{self.depth} bits a channel; choose 8 or 16")
        if self.rate is not None and not 0 < self.rate <= FASTEST:
            raise InkbetweenError(f"the frame rate is {self.rate}; it must be above 0 and at most {FASTEST}")
        self._check_format()
        if self.background not in (None, "stage"):
            object.__setattr__(self, "background", as_color(self.background, name="background"))

    def _check_format(self) -> None:
        form = FORMATS[self.format]
        if form.even and (self.size[0] % 2 or self.size[1] % 2):
            width, height = (side + side % 2 for side in self.size)
            raise InkbetweenError(
                f"{form.label} needs even sides, {self.size[0]} x {self.size[1]} px are not; "
                f"choose {width} x {height}"
            )
        if self.depth == 16 and not form.deep:
            raise InkbetweenError(f"16 bits a channel are for PNG frames, not for {form.label}")
        if self.rate is not None and (form.drawn or form.id == "oca") and not form.frames:
            raise InkbetweenError(f"{form.label} keeps the frame rate of the project")
        if self.exposures and not form.frames:
            raise InkbetweenError(f"each drawing once is for frames in a folder, not for {form.label}")
        if self.chart and not form.frames:
            raise InkbetweenError(f"the timing chart is for frames in a folder, not for {form.label}")
        check_pattern(self.pattern)

    @classmethod
    def whole_film(cls, document: Document, out: Path, name: str, format: str = "png") -> "ExportSettings":
        """Return the settings to begin with: every frame, as large as the stage, on its background."""
        return cls(out, name, 1, document.length, fitting_size(document, format), format)


def fitting_size(document: Document, format: str, scale: float = 1.0) -> tuple[int, int]:
    """Return the size of the stage times `scale`, made even where the format asks for it."""
    width, height = (max(1, round(side * scale)) for side in (document.stage.width, document.stage.height))
    return (width + width % 2, height + height % 2) if FORMATS[format].even else (width, height)


def check_pattern(pattern: str) -> None:
    """Raise InkbetweenError unless `pattern` can name files, each another one."""
    if not pattern:
        return
    rest = pattern
    for word in ("name", "layer", "frame", "drawing", "separator"):
        rest = rest.replace("{" + word + "}", "")
    if "{" in rest or "}" in rest:
        raise InkbetweenError(
            f"the pattern {pattern!r} has braces that mean nothing; known are "
            "{name}, {layer}, {frame}, {drawing} and {separator}"
        )
    if any(c in FORBIDDEN or ord(c) < 32 for c in rest):
        raise InkbetweenError(f"the pattern {pattern!r} holds what no file name may hold")
    if "{frame}" not in pattern and "{drawing}" not in pattern:
        raise InkbetweenError(f"the pattern {pattern!r} gives all frames one name; write {{frame}} or {{drawing}}")

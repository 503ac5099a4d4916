"""Presets: what an export is for, as a few settings that go together."""

import json
from dataclasses import asdict, dataclass
from fractions import Fraction

from app.export.formats import FORMATS
from app.export.settings import DEPTHS
from core.errors import InkbetweenError
from core.model.document import as_rate

MOST_KEPT = 100
BACKGROUNDS = {"stage": "Stage", "none": "Transparent", "#ffffff": "White", "#000000": "Black"}
"""What the dialog offers, by what it means."""


def rate_of(text: str) -> Fraction | None:
    """Return the rate that a person wrote, None for nothing; raises DocumentError with one sentence."""
    return as_rate(text) if text.strip() else None


@dataclass(frozen=True, slots=True)
class Preset:
    """Some settings under a name.

    Attributes
    ----------
    format : str
    scale : float
        Share of the stage's size.
    rate : str
        As a person writes it; "" for the project's.
    background : str
        A key of `BACKGROUNDS`.
    depth : int
    exposures, chart, each_layer : bool
    """

    format: str = "png"
    scale: float = 1.0
    rate: str = ""
    background: str = "stage"
    depth: int = 8
    exposures: bool = False
    chart: bool = False
    each_layer: bool = False

    def __post_init__(self) -> None:
        if self.format not in FORMATS or self.depth not in DEPTHS or self.background not in BACKGROUNDS:
            raise InkbetweenError("a preset that means nothing here")
        if not 0 < self.scale <= 100:
            raise InkbetweenError(f"a preset with the scale {self.scale}")
        rate_of(self.rate)


PRESETS: dict[str, Preset] = {
    "Frames PNG": Preset(),
    "Frames PNG 16 bit": Preset(depth=16, background="none"),
    "Drawings for painting": Preset(exposures=True, background="none", chart=True),
    "Video MP4": Preset("mp4"),
    "Web GIF": Preset("gif", scale=0.5),
    "Web video with alpha": Preset("webm", background="none"),
    "Web Lottie": Preset("lottie"),
    "Compositing ProRes 4444": Preset("prores", background="none"),
    "Exposure sheet": Preset("xdts"),
}


def kept_presets(text: str) -> dict[str, Preset]:
    """Return a person's own presets from the settings file; what is damaged there is left out."""
    try:
        found = json.loads(text or "{}")
    except json.JSONDecodeError:
        return {}
    presets = {}
    for name, values in list(found.items())[:MOST_KEPT] if isinstance(found, dict) else ():
        try:
            presets[name] = Preset(**values)
        except (TypeError, InkbetweenError):
            continue
    return presets


def presets_text(presets: dict[str, Preset]) -> str:
    """Return presets as the settings file keeps them."""
    return json.dumps({name: asdict(preset) for name, preset in presets.items()})

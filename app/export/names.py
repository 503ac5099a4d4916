"""What files of an export are called."""

from dataclasses import replace
from pathlib import Path

from app.export.formats import FORMATS
from app.export.settings import FORBIDDEN, LAYER_PATTERN, PATTERN, ExportSettings
from core.model.document import Layer

LONGEST_FILE_NAME = 200


def frame_path(settings: ExportSettings, frame: int, *, drawing: int = 1, layer: str = "") -> Path:
    """Return where a frame goes: usually `out/name.0001.png`.

    `frame` is its number in the film, `drawing` counts the drawings from 1.
    """
    pattern = settings.pattern or (LAYER_PATTERN if settings.each_layer else PATTERN)
    shift = 0 if settings.number is None else settings.number - settings.first
    shown = drawing if settings.number is None else settings.number + drawing - 1
    words = {
        "name": settings.name,
        "separator": settings.separator,
        "layer": clean(layer),
        "frame": f"{frame + shift:0{settings.padding}}",
        "drawing": f"{shown:0{settings.padding}}",
    }
    name = pattern
    for word, text in words.items():
        name = name.replace("{" + word + "}", text)
    return settings.out / (name[:LONGEST_FILE_NAME] + FORMATS[settings.format].ending)


def clean(name: str) -> str:
    """Return a layer's name as a part of a file's name."""
    kept = "".join("_" if c in FORBIDDEN or ord(c) < 32 else c for c in name).strip(" .")
    return kept[:80] or "layer"


def layer_names(layers: tuple[Layer, ...]) -> dict[int, str]:
    """Return a name for every layer by its id, each another one on any file system."""
    names: dict[int, str] = {}
    used: set[str] = set()
    for layer in layers:
        name, count = clean(layer.name), 1
        while name.lower() in used:
            count += 1
            name = f"{clean(layer.name)} {count}"
        used.add(name.lower())
        names[layer.id] = name
    return names


def of_layer(settings: ExportSettings, layer: Layer, name: str) -> ExportSettings:
    """Return the settings for one layer alone: frames share a folder, everything else is a file of its own."""
    if FORMATS[settings.format].frames:
        return replace(settings, layers=(layer.id,))
    out = settings.out.with_name(f"{settings.out.stem}.{name}{settings.out.suffix}")
    return replace(settings, layers=(layer.id,), out=out, each_layer=False)

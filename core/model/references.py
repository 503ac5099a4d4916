"""Where reference pictures lie: absolute while one works, beside the project in its file."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path, PurePath

from core.model.document import Document, Keyframe


def with_relative_references(document: Document, folder: Path) -> Document:
    """Return a document whose pictures in or below `folder` are named from there: a project that can be moved."""

    def relative(path: str) -> str:
        try:
            return PurePath(path).relative_to(folder.absolute()).as_posix()
        except ValueError:
            return path

    return _renamed(document, relative)


def with_absolute_references(document: Document, folder: Path) -> Document:
    """Return a document whose pictures are named in full, those without a folder of their own from `folder`."""
    return _renamed(document, lambda path: str(folder.absolute() / path))


def _renamed(document: Document, rename: Callable[[str], str]) -> Document:
    """Return the document with other paths; the very same one if none is another."""

    def renamed(keyframe: Keyframe) -> Keyframe:
        kept = keyframe.reference
        path = rename(kept.path) if kept else ""
        return replace(keyframe, reference=replace(kept, path=path)) if kept and path != kept.path else keyframe

    for layer in document.layers:
        keyframes = tuple(map(renamed, layer.keyframes))
        if any(a is not b for a, b in zip(keyframes, layer.keyframes, strict=True)):
            document = document.with_layer(replace(layer, keyframes=keyframes))
    return document

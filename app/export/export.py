"""Exporting a document in any format: one call for the command line, the window and the tests."""

import os
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

from app.export.film import Film, shown_layers
from app.export.formats import FORMATS
from app.export.frames import frame_files, write_frames
from app.export.names import layer_names, of_layer
from app.export.settings import ExportSettings
from app.export.whole import check_free, make_folder
from core.errors import InkbetweenError
from core.model.document import Document

Progress = Callable[[int, int], object]
Asked = Callable[[], bool]

WRITERS = {
    "lottie": "lottie",
    "svg": "animated",
    "svg-css": "animated",
    "sprites": "sprites",
    "xdts": "xdts",
    "oca": "oca",
}
"""The module of each format that is neither frames nor a film; its `write` makes it."""


@dataclass(frozen=True, slots=True)
class Exported:
    """What came of an export.

    Attributes
    ----------
    files : tuple of Path
        Those that were written, whole, in order.
    cancelled : bool
        Whether it was stopped before the end.
    kept : int
        Number of files that were there already and were left as they are.
    """

    files: tuple[Path, ...]
    cancelled: bool = False
    kept: int = 0


class Watch:
    """What an export tells and asks while it works."""

    def __init__(self, total: int, progress: Progress, cancelled: Asked) -> None:
        self.total, self.done = total, 0
        self._progress = progress
        self.cancelled = cancelled

    def step(self, _: object = None) -> None:
        """One more picture is done."""
        self.done += 1
        self._progress(self.done, self.total)


def export(
    document: Document,
    settings: ExportSettings,
    *,
    progress: Progress = lambda done, total: None,
    cancelled: Asked = lambda: False,
) -> Exported:
    """Write what the settings say; files are whole or not there.

    Runs in the calling thread, which needs no event loop, and calls `progress(done, total)` and `cancelled()`
    there. Only a few pictures are in memory at a time.

    Raises
    ------
    InTheWayError
        Files would be replaced, and the settings do not allow it; nothing has been written.
    StorageError
        The folder cannot be written or the disk is full. Frames written before are complete and stay.
    InkbetweenError
        The film has no such frames or layers, or the format cannot hold it.
    """
    films = _films(document, settings)
    if FORMATS[settings.format].frames:
        return _write_frames(films, progress, cancelled)
    return _write_files(films, progress, cancelled)


def _films(document: Document, settings: ExportSettings) -> list[tuple[Film, str]]:
    """Return the film of every layer with its name, or the one of all."""
    layers = shown_layers(document, settings)
    if settings.layers is not None and len(layers) < len(set(settings.layers)):
        raise InkbetweenError("the document has not all of the layers that are to be exported")
    if not settings.each_layer:
        return [(Film(document, settings), "")]
    if not layers:
        raise InkbetweenError("no layer is visible, so there is none to export on its own")
    names = layer_names(layers)
    return [(Film(document, of_layer(settings, x, names[x.id])), names[x.id]) for x in layers]


def output_files(document: Document, settings: ExportSettings) -> list[Path]:
    """Return every file that an export would write; for a folder with files of its own, the folder."""
    films = _films(document, settings)
    if FORMATS[settings.format].frames:
        return [path for film, name in films for _, path in frame_files(film, name)]
    return [path for film, _ in films for path in _files_of(film.settings)]


def _files_of(settings: ExportSettings) -> list[Path]:
    out = settings.out
    return [out, out.with_suffix(".json")] if settings.format == "sprites" else [out]


def _write_frames(films: list[tuple[Film, str]], progress: Progress, cancelled: Asked) -> Exported:
    settings = films[0][0].settings
    found = [(film, frame_files(film, name)) for film, name in films]
    paths = [path for _, files in found for _, path in files]
    _check_names(paths)
    wanted = set(check_free(paths, replace=settings.replace, proceed=settings.proceed))
    watch = Watch(len(wanted), progress, cancelled)
    written: list[Path] = []

    def told(path: Path) -> None:
        written.append(path)
        watch.step()

    for film, files in found:
        write_frames(film, [f for f in files if f[1] in wanted], told, cancelled)
    return Exported(tuple(written), len(written) < len(wanted), len(paths) - len(wanted))


def _check_names(paths: list[Path]) -> None:
    if len(set(paths)) < len(paths):
        raise InkbetweenError(
            "the pattern gives several frames the same name; write {frame} and, if need be, {layer}"
        )


def _write_files(films: list[tuple[Film, str]], progress: Progress, cancelled: Asked) -> Exported:
    settings = films[0][0].settings
    paths = [path for film, _ in films for path in _files_of(film.settings)]
    wanted = set(check_free(paths, replace=settings.replace, proceed=settings.proceed))
    todo = [film for film, _ in films if film.settings.out in wanted]
    watch = Watch(sum(len(film.shots()) for film in todo), progress, cancelled)
    written: list[Path] = []
    for film in todo:
        make_folder(film.settings.out.parent)
        if not _write_one(film, watch):
            break
        written += _files_of(film.settings)
    return Exported(tuple(written), len(written) < len(todo), len(paths) - len(wanted))


def _write_one(film: Film, watch: Watch) -> bool:
    """Write one film; whether it was not cancelled."""
    settings = film.settings
    if os.path.isdir(settings.out) and not FORMATS[settings.format].folder:
        raise InkbetweenError(f"{settings.out} is a folder; {FORMATS[settings.format].label} is a file")
    if FORMATS[settings.format].moving:
        from app.export.moving import write_film

        return write_film(film, settings.out, watch.step, watch.cancelled)
    module = import_module(f"app.export.{WRITERS[settings.format]}")
    done: bool = module.write(film, settings.out, watch.step, watch.cancelled)
    return done

"""Numbered frames in a folder, PNG or SVG: every file whole or not there, an interrupted export goes on."""

import contextlib
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from app.export.film import Film, Shot
from app.export.names import frame_path, layer_names
from app.export.pool import painted, useful_processes
from app.export.render import Job, Look
from app.export.svg import frame_svg
from app.export.whole import make_folder, write_whole

Told = Callable[[Path], object]
Asked = Callable[[], bool]


def frame_files(film: Film, layer: str = "") -> list[tuple[Shot, Path]]:
    """Return every shot with the file it goes to."""
    settings = film.settings
    return [
        (shot, frame_path(settings, shot.frame, drawing=shot.drawing, layer=layer or _only_name(film)))
        for shot in film.shots()
    ]


def _only_name(film: Film) -> str:
    """Return the name for `{layer}` in a sequence of several layers: that of the one in front."""
    shown = tuple(x for x in film.document.layers if x.visible)
    return layer_names(shown)[shown[-1].id] if shown else "layer"


def write_frames(film: Film, files: list[tuple[Shot, Path]], told: Told, cancelled: Asked) -> None:
    """Write the files, telling each one that is whole; stops early when `cancelled` says so."""
    make_folder(film.settings.out)
    write = _write_svg if film.settings.format == "svg-frames" else _write_png
    write(film, files, told, cancelled)


def look_of(film: Film, *, deep: bool = False) -> Look:
    """Return what all pictures of a film have in common."""
    return Look(film.document.stage, film.settings.size, film.background, deep)


def _write_png(film: Film, files: list[tuple[Shot, Path]], told: Told, cancelled: Asked) -> None:
    settings = film.settings
    jobs = (Job(film.pictures(shot), path) for shot, path in files)
    processes = settings.processes or useful_processes(len(files), settings.size)
    with contextlib.closing(painted(jobs, look_of(film, deep=settings.depth == 16), processes, cancelled)) as done:
        for (_, path), _ in zip(files, done, strict=False):
            told(path)


def _write_svg(film: Film, files: list[tuple[Shot, Path]], told: Told, cancelled: Asked) -> None:
    stage, size, background = film.document.stage, film.settings.size, film.background

    def texts() -> Iterator[tuple[Path, bytes]]:
        for shot, path in files:
            if cancelled():
                return
            yield path, frame_svg(film.pictures(shot), stage, size, background).encode()

    with ThreadPoolExecutor(1, thread_name_prefix="export writer") as writer:
        last = None
        for path, text in texts():
            if last is not None:
                told(last[0].result() or last[1])
            last = (writer.submit(write_whole, path, text, lasting=False), path)
        if last is not None:
            told(last[0].result() or last[1])

"""Moving pictures through PyAV: GIF, APNG, WebP, MP4, WebM, ProRes.

FFmpeg writes no dates and no names of itself here, and the number of its threads is fixed: the same film gives the
same bytes on every machine with the same PyAV.
"""

import contextlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import numpy.typing as npt

from app.export.film import Film, Shot
from app.export.formats import FORMATS
from app.export.frames import look_of
from app.export.pool import painted, useful_processes
from app.export.render import Job
from app.export.whole import whole_file
from core.errors import InkbetweenError

THREADS = 2
"""Always as many, whatever the machine has: another number would give other bytes."""
MOST_SAMPLES = 32
"""Pictures that a GIF takes its colours from."""
INDEX, INDEX_FRAME = 4096, 32
"""Bytes kept free for the index at the head of an MP4, so that it plays while it still loads."""
WHITE = "#ffffff"
BT709 = 1
"""Number of the colours of HDTV, for the matrix, the primaries and the transfer."""
LIMITED = 1

Told = Callable[[int], object]
Asked = Callable[[], bool]


@dataclass(frozen=True, slots=True)
class Codec:
    """How FFmpeg makes one format.

    Attributes
    ----------
    container, encoder, pixels : str
        FFmpeg's names.
    options : dict
        Of the encoder.
    head : dict
        Of the container.
    video : bool
        Whether colours are luma and chroma, and are to be labelled so.
    deep : bool
        Whether it is given 16 bits a channel.
    tags : dict
        Of the stream.
    threads : int
        Of the encoder. x264 gives now and then other bytes with two than with one.
    """

    container: str
    encoder: str
    pixels: str
    options: dict[str, str] = field(default_factory=dict)
    head: dict[str, str] = field(default_factory=dict)
    video: bool = False
    deep: bool = False
    tags: dict[str, str] = field(default_factory=dict)
    threads: int = THREADS


CODECS = {
    "gif": Codec("gif", "gif", "pal8", {"gifflags": "+transdiff"}, {"loop": "0"}),
    "apng": Codec("apng", "apng", "rgba", {"pred": "none", "compression_level": "1"}, {"plays": "0"}),
    "webp": Codec("webp", "libwebp_anim", "bgra", {"lossless": "1", "compression_level": "2"}, {"loop": "0"}),
    "mp4": Codec("mp4", "libx264", "yuv420p", {"crf": "15", "preset": "medium"}, video=True, threads=1),
    "webm": Codec(
        "webm",
        "libvpx-vp9",
        "yuva420p",
        {"crf": "0", "b": "0", "auto-alt-ref": "0", "row-mt": "0", "cpu-used": "6"},
        video=True,
        tags={"alpha_mode": "1"},
    ),
    "prores": Codec(
        "mov",
        "prores_ks",
        "yuva444p10le",
        {"profile": "4444", "vendor": "apl0", "alpha_bits": "16", "global_quality": "472"},
        {},
        True,
        True,
    ),
}


class _CancelledFilm(Exception):
    """Somebody has asked to stop."""


class _Disk:
    """A file for FFmpeg that remembers why it could not be written: FFmpeg itself forgets."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self.error: OSError | None = None
        self.seek, self.tell, self.name = file.seek, file.tell, ""

    def write(self, content: bytes) -> int:
        rest = memoryview(content)
        try:
            while rest:  # a disk that is nearly full takes a part and says nothing
                rest = rest[self._file.write(rest) :]
        except OSError as e:
            self.error = self.error or e
            raise
        return len(content)


def write_film(film: Film, path: Path, told: Told, cancelled: Asked) -> bool:
    """Write a film and return True; when cancelled, False, and nothing is on the disk.

    Raises
    ------
    InkbetweenError
        FFmpeg refuses the size or the rate, or PyAV is not installed.
    StorageError
        The file cannot be written.
    """
    with contextlib.suppress(_CancelledFilm), whole_file(path) as temporary:
        with open(temporary, "wb", buffering=0) as file:
            disk = _Disk(file)
            try:
                _encode(film, disk, told, cancelled)
            except _CancelledFilm:
                raise
            except Exception as e:
                raise (disk.error or e) from None
            if disk.error is not None:
                raise disk.error
        return True
    return False


def _encode(film: Film, disk: _Disk, told: Told, cancelled: Asked) -> None:
    av = pyav()
    codec = CODECS[film.settings.format]
    shots = film.shots()
    try:
        palette = _palette(av, film, shots, cancelled) if codec.encoder == "gif" else None
        head = {"fflags": "+bitexact", **codec.head}
        if codec.encoder == "libx264":
            head["moov_size"] = str(INDEX + INDEX_FRAME * len(shots))
        with av.open(disk, "w", format=codec.container, options=head) as container:
            writer = _Writer(av, codec, container, film, palette)
            for i, pixels in enumerate(_pixels(film, codec, shots, cancelled)):
                writer.add(pixels)
                told(i + 1)
            writer.end()
    except av.FFmpegError as e:
        width, height = film.settings.size
        why = (e.strerror or str(e)).lower()
        raise InkbetweenError(f"FFmpeg makes no film of {width} x {height} px, {film.rate} a second: {why}") from e


def pyav() -> Any:
    """Return the package; its FFmpeg is large, so it comes with the first film and not before."""
    try:
        import av
    except ImportError as e:
        raise InkbetweenError(f"moving pictures need the package PyAV (pip install av): {e}") from e
    av.logging.set_level(av.logging.PANIC)
    return av


def _pixels(film: Film, codec: Codec, shots: list[Shot], cancelled: Asked) -> Iterator[npt.NDArray[Any]]:
    """Yield the straight pixels of every shot; raises _CancelledFilm."""
    look = look_of(film, deep=codec.deep)
    if FORMATS[film.settings.format].alpha == "none":
        look = replace(look, background=over_white(look.background))
    width, height = look.size
    processes = film.settings.processes or useful_processes(len(shots), look.size)
    jobs = (Job(film.pictures(shot)) for shot in shots)
    count = 0
    with contextlib.closing(painted(jobs, look, processes, cancelled)) as found:
        for body in found:
            if cancelled():
                raise _CancelledFilm
            yield np.frombuffer(body, np.uint16 if codec.deep else np.uint8).reshape(height, width, 4)
            count += 1
    if count < len(shots):
        raise _CancelledFilm


def over_white(color: str | None) -> str:
    """Return the colour that is seen when `color` lies on white paper."""
    if color is None:
        return WHITE
    alpha = int(color[7:], 16) / 255 if len(color) == 9 else 1.0
    channels = (round(c * alpha + 255 * (1 - alpha)) for c in bytes.fromhex(color[1:7]))
    return "#" + bytes(channels).hex()


def _palette(av: Any, film: Film, shots: list[Shot], cancelled: Asked) -> Any:
    """Return the 255 colours and the transparent one that serve the film best, from pictures all along it."""
    step = max(1, len(shots) / MOST_SAMPLES)
    some = [shots[int(i * step)] for i in range(min(len(shots), MOST_SAMPLES))]
    some = [*some[:-1], shots[-1]]
    graph = av.filter.Graph()
    source = _source(graph, film.settings.size, "rgba")
    generator = graph.add("palettegen", "max_colors=256:reserve_transparent=1:stats_mode=full")
    _linked(graph, source, generator, graph.add("buffersink"))
    for i, pixels in enumerate(_pixels(film, CODECS["gif"], some, cancelled)):
        frame = av.VideoFrame.from_ndarray(pixels, format="rgba")
        frame.pts, frame.time_base = i, Fraction(1, 100)
        source.push(frame)
    source.push(None)
    return graph.pull()


def _source(graph: Any, size: tuple[int, int], pixels: str) -> Any:
    return graph.add_buffer(width=size[0], height=size[1], format=pixels, time_base=Fraction(1, 100))


def _linked(graph: Any, *filters: Any) -> None:
    for left, right in pairwise(filters):
        left.link_to(right)
    graph.configure()


class _Writer:
    """One stream in one container."""

    def __init__(self, av: Any, codec: Codec, container: Any, film: Film, palette: Any) -> None:
        self._av, self._codec, self._container = av, codec, container
        self._base = Fraction(1, 100) if codec.encoder == "gif" else 1 / film.rate
        self._rate, self._count, self._muxed = film.rate, 0, 0
        rate = Fraction(100) if codec.encoder == "gif" else film.rate
        stream = self._stream = container.add_stream(codec.encoder, rate=rate, options=codec.options)
        stream.width, stream.height = film.settings.size
        stream.pix_fmt = codec.pixels
        stream.metadata.update(codec.tags)
        context = stream.codec_context
        context.time_base = self._base
        context.thread_count = codec.threads
        if codec.video:
            context.color_range, context.colorspace = LIMITED, BT709
            context.color_primaries, context.color_trc = BT709, BT709
        self._paint = self._with_palette(palette, film.settings.size) if palette is not None else self._converted

    def add(self, pixels: npt.NDArray[Any]) -> None:
        """Encode the next picture."""
        frame = self._av.VideoFrame.from_ndarray(pixels, format="rgba64le" if self._codec.deep else "rgba")
        frame.pts = self._at(self._count)
        frame.time_base = self._base
        self._count += 1
        self._mux(self._paint(frame))

    def _at(self, index: int) -> int:
        """Return when a picture begins, in ticks."""
        return round(index / self._rate / self._base)

    def end(self) -> None:
        """Encode what is still waiting."""
        self._mux(None)

    def _mux(self, frame: Any) -> None:
        for packet in self._stream.encode(frame):
            if self._codec.encoder == "gif":  # or the last picture is shown for the shortest time there is
                packet.duration = self._at(self._muxed + 1) - self._at(self._muxed)
            self._muxed += 1
            self._container.mux(packet)

    def _converted(self, frame: Any) -> Any:
        if not self._codec.video:
            return frame if self._codec.pixels == "rgba" else frame.reformat(format=self._codec.pixels)
        made = frame.reformat(
            format=self._codec.pixels, src_colorspace=BT709, dst_colorspace=BT709, dst_color_range=LIMITED
        )
        made.color_primaries = made.color_trc = BT709
        return made

    def _with_palette(self, palette: Any, size: tuple[int, int]) -> Callable[[Any], Any]:
        graph = self._av.filter.Graph()
        pictures, colors = _source(graph, size, "rgba"), _source(graph, (palette.width, palette.height), "bgra")
        use = graph.add("paletteuse", "dither=none:alpha_threshold=128")
        pictures.link_to(use, 0, 0)
        colors.link_to(use, 0, 1)
        use.link_to(graph.add("buffersink"))
        graph.configure()
        palette.pts, palette.time_base = 0, self._base
        colors.push(palette)
        colors.push(None)

        def paint(frame: Any) -> Any:
            pictures.push(frame)
            return graph.pull()

        return paint

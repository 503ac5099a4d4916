"""One picture to the bytes of a PNG file, with straight alpha.

Flat colours are runs of one pixel. The filter "sub" turns a run into zeros, and zlib's strategy for runs packs
those as fast as its level 1 and a quarter smaller: see docs/decisions/0004-painting-and-export.md.
"""

import struct
import zlib
from itertools import chain

import numpy as np
import numpy.typing as npt
from PySide6.QtGui import QImage

SIGNATURE = b"\x89PNG\r\n\x1a\n"
RGB, RGBA = 2, 6
SUB = 1
BLOCK_BYTES = 32_000_000
"""So much is filtered at once; smaller blocks would ask for the interpreter too often, while it is painting."""


def encode_png(image: QImage, *, deep: bool = False) -> bytes:
    """Return a PNG file: RGBA with straight alpha, or RGB if the picture's format has no alpha.

    `deep` writes 16 bits a channel, always with alpha.
    """
    alpha = deep or image.hasAlphaChannel()
    straight = straight_image(image, alpha=alpha, deep=deep)
    pixels = channels_of(straight, deep=deep)
    height, width, channels = pixels.shape
    header = struct.pack(">IIBBBBB", width, height, 16 if deep else 8, RGBA if alpha else RGB, 0, 0, 0)
    if deep:
        pixels = pixels.byteswap()
    lines = pixels.reshape(height, width * channels).view(np.uint8)
    chunks = (
        _chunk(b"IHDR", header),
        _chunk(b"sRGB", b"\x00"),
        _chunk(b"IDAT", _packed(lines, channels * (2 if deep else 1))),
        _chunk(b"IEND", b""),
    )
    return SIGNATURE + b"".join(chain.from_iterable(chunks))


def straight_image(image: QImage, *, alpha: bool, deep: bool) -> QImage:
    """Return the picture with 8 or 16 straight bits a channel, in the order red, green, blue, alpha."""
    kinds = QImage.Format
    return image.convertToFormat(
        kinds.Format_RGBA64 if deep else kinds.Format_RGBA8888 if alpha else kinds.Format_RGB888
    )


def channels_of(straight: QImage, *, deep: bool) -> npt.NDArray[np.uint8 | np.uint16]:
    """Return the (height, width, channels) array in a straight image, which must live as long as the array."""
    width, height, channels = straight.width(), straight.height(), 4 if straight.hasAlphaChannel() else 3
    lines = np.frombuffer(straight.constBits(), dtype=np.uint8).reshape(height, straight.bytesPerLine())
    used = np.ascontiguousarray(lines[:, : width * channels * (2 if deep else 1)])
    return used.view(np.uint16 if deep else np.uint8).reshape(height, width, channels)


def _chunk(kind: bytes, content: bytes) -> tuple[bytes, ...]:
    check = zlib.crc32(content, zlib.crc32(kind))
    return struct.pack(">I", len(content)), kind, content, struct.pack(">I", check)


def _packed(lines: npt.NDArray[np.uint8], channels: int) -> bytes:
    packer = zlib.compressobj(1, zlib.DEFLATED, zlib.MAX_WBITS, zlib.DEF_MEM_LEVEL, zlib.Z_RLE)
    step = max(1, BLOCK_BYTES // lines.shape[1])
    blocks = (_filtered(lines[i : i + step], channels) for i in range(0, len(lines), step))
    return b"".join([*(packer.compress(block.data) for block in blocks), packer.flush()])


def _filtered(lines: npt.NDArray[np.uint8], channels: int) -> npt.NDArray[np.uint8]:
    """Return each line as its filter's number and the differences from the pixel to the left."""
    filtered = np.zeros((len(lines), lines.shape[1] + 1), dtype=np.uint8)
    filtered[:, 0] = SUB
    filtered[:, 1 : channels + 1] = lines[:, :channels]
    np.subtract(lines[:, channels:], lines[:, :-channels], out=filtered[:, channels + 1 :])
    return filtered

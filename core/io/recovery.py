"""The recovery file: a document with what is needed to offer it after a crash, whole in one file."""

from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

import msgspec

from core.errors import FileFormatError
from core.io.project import LARGEST_FILE, decode, encode
from core.io.storage import read_bounded
from core.model.document import Document

FORMAT: Final = "inkbetween recovery"
VERSION: Final = 1
ENDING = "recovery"
HEADER = 65_536
"""Bytes that everything but the document may take."""


@dataclass(frozen=True, slots=True)
class Recovery:
    """What was open when the program ended.

    Attributes
    ----------
    document : Document
    path : Path or None
        The project's file; None for one that was never saved.
    title : str
        What the window called it.
    time : float
        When this was written, seconds since 1970.
    frame : int
        Where the playhead stood.
    """

    document: Document
    path: Path | None
    title: str
    time: float
    frame: int = 1


class _File(msgspec.Struct, forbid_unknown_fields=True):
    format: Literal["inkbetween recovery"]
    version: Literal[1]
    path: str | None
    title: str
    time: float
    frame: int
    document: msgspec.Raw


def encode_recovery(recovery: Recovery) -> bytes:
    """Return the bytes of a recovery file."""
    path = None if recovery.path is None else str(recovery.path)
    if path is not None and _holds_half_characters(path):
        path = None  # a name that no text can hold; the title still says which one it was
    title = recovery.title.encode("utf-8", "replace").decode("utf-8")
    raw = msgspec.Raw(encode(recovery.document))
    file = _File(FORMAT, VERSION, path, title, recovery.time, recovery.frame, raw)
    return msgspec.json.encode(file)


def _holds_half_characters(text: str) -> bool:
    return any(0xD800 <= ord(c) <= 0xDFFF for c in text)


def read_recovery(path: Path) -> Recovery:
    """Read a recovery file.

    Raises
    ------
    StorageError
        If it cannot be read.
    FileFormatError
        If it is none, or is damaged.
    """
    content = read_bounded(path, LARGEST_FILE + HEADER)
    try:
        file = msgspec.json.decode(content, type=_File)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as e:
        raise FileFormatError(f"{path.name} is damaged: {e}") from None
    document = decode(bytes(file.document))
    original = None if file.path is None else Path(file.path)
    return Recovery(document, original, file.title, file.time, file.frame)

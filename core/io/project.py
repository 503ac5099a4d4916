"""The project file, `.inkb`: UTF-8 JSON with a version, read strictly and written atomically.

What each field means is in docs/file-format.md. The structs of core.io.format are the file; the classes of
core.model are the document. They are kept apart so that either can change without the other.
"""

import os
from pathlib import Path
from typing import Final

import msgspec

from core.errors import FileFormatError
from core.io.format import FORMAT, LARGEST_FILE, MOST_OBJECTS, SUFFIX, VERSION, Head
from core.io.migration import project_of
from core.io.reading import from_file
from core.io.storage import Fingerprint, changed_at, fingerprint, read_bounded, write_atomically
from core.io.writing import to_file
from core.model.document import Document

__all__ = ["LARGEST_FILE", "SUFFIX", "VERSION", "decode", "encode", "load", "load_seen", "save"]

LARGEST_MB: Final = LARGEST_FILE >> 20


def load(path: str | os.PathLike[str]) -> Document:
    """Read a project file.

    Raises
    ------
    StorageError
        If the file cannot be read.
    FileFormatError
        If it is no project, is damaged, or was written by a newer version; the message names the place.
    """
    return load_seen(path)[0]


def load_seen(path: str | os.PathLike[str]) -> tuple[Document, Fingerprint]:
    """Read a project file as `load` does, and say by what it can be known again."""
    file = Path(path)
    time = changed_at(file)  # before it is read: a change in between is seen as one
    content = read_bounded(file, LARGEST_FILE)
    try:
        document = decode(content)
    except FileFormatError as e:
        raise FileFormatError(f"cannot open {file.name}: {e}") from None
    return document, fingerprint(file, content, time)


def save(document: Document, path: str | os.PathLike[str], *, backup: bool = False) -> Fingerprint:
    """Write a project file: whole, or not at all.

    The bytes go to a temporary file in the same folder, are forced to the disk, and take the old file's place in
    one step; until then the old file is untouched. With `backup` the old file stays as `backup_of(path)`.

    Returns
    -------
    Fingerprint
        Of what was written, to see later whether someone else has changed it.

    Raises
    ------
    StorageError
        If the folder cannot be written or the disk is full; the old file is as it was.
    """
    content = encode(document)
    write_atomically(Path(path), content, backup=backup)
    return fingerprint(Path(path), content)


def encode(document: Document) -> bytes:
    """Return the bytes of the project file; the same document gives the same bytes.

    Raises FileFormatError if the document has more than a file may hold.
    """
    content = msgspec.json.encode(to_file(document)) + b"\n"
    if len(content) > LARGEST_FILE:
        raise FileFormatError(
            f"the document would take {len(content) >> 20} MB; a file has at most {LARGEST_MB} MB"
        )
    return content


def decode(content: bytes) -> Document:
    """Return the document in the bytes of a project file; raises FileFormatError that names the place."""
    if content.count(b"{") > MOST_OBJECTS:
        raise FileFormatError(f"it has more than {MOST_OBJECTS:,} parts, or it is no Inkbetween project")
    try:
        head = msgspec.json.decode(content, type=Head)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        raise FileFormatError("it is no Inkbetween project, or it is damaged") from None
    if head.format != FORMAT:
        raise FileFormatError("it is no Inkbetween project")
    if head.version > VERSION:
        raise FileFormatError(
            f"it was written by a newer Inkbetween (file version {head.version}, this one reads up to {VERSION}); "
            "update Inkbetween to open it"
        )
    if head.version < 1:
        raise FileFormatError(f"its version is {head.version}; the first one is 1")
    return from_file(project_of(content, head.version))

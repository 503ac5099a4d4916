"""The errors of the engine: every one a ValueError whose text a person can act on."""


class InkbetweenError(ValueError):
    """Anything that the engine refuses; the message says what, where and what to do."""


class GeometryError(InkbetweenError):
    """An outline that cannot be drawn: too few vertices, a coordinate that is not a number."""


class CorrespondenceError(InkbetweenError):
    """A pairing of two outlines that is impossible, such as anchors that cross."""


class DocumentError(InkbetweenError):
    """An edit that the document cannot take; the document is as it was."""


class FileFormatError(InkbetweenError):
    """A file that is not what it claims to be; the message names the place inside it."""


class StorageError(InkbetweenError):
    """A file or folder that cannot be read or written; what was on the disk is as it was."""


class CancelledError(InkbetweenError):
    """Work that was stopped because nobody waits for it any more."""

"""The in-betweening engine: outlines, correspondences, vertex paths, documents. It knows no window."""

from core.correspondence.matching import match
from core.correspondence.pairing import Correspondence
from core.errors import (
    CorrespondenceError,
    DocumentError,
    FileFormatError,
    GeometryError,
    InkbetweenError,
)

__all__ = [
    "Correspondence",
    "CorrespondenceError",
    "DocumentError",
    "FileFormatError",
    "GeometryError",
    "InkbetweenError",
    "match",
]

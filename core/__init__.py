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
from core.methods.plan import METHODS, inbetween, plan

__all__ = [
    "METHODS",
    "Correspondence",
    "CorrespondenceError",
    "DocumentError",
    "FileFormatError",
    "GeometryError",
    "InkbetweenError",
    "inbetween",
    "match",
    "plan",
]

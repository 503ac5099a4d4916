"""The in-betweening engine: outlines, correspondences, vertex paths, documents. It knows no window."""

from core.correspondence.matching import match
from core.correspondence.pairing import Correspondence
from core.errors import (
    CorrespondenceError,
    DocumentError,
    FileFormatError,
    GeometryError,
    InkbetweenError,
    StorageError,
)
from core.io.project import load, save
from core.methods.plan import METHODS, inbetween, plan
from core.model.document import Document

__all__ = [
    "METHODS",
    "Correspondence",
    "CorrespondenceError",
    "Document",
    "DocumentError",
    "FileFormatError",
    "GeometryError",
    "InkbetweenError",
    "StorageError",
    "inbetween",
    "load",
    "match",
    "plan",
    "save",
]

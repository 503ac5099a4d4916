"""The in-betweening engine: outlines, correspondences, vertex paths, documents. It knows no window."""

from core.correspondence.drawings import OutlinePairs, pair_outlines
from core.correspondence.matching import Alternative, alternatives, match, match_quick
from core.correspondence.pairing import Correspondence
from core.errors import (
    CorrespondenceError,
    DocumentError,
    FileFormatError,
    GeometryError,
    InkbetweenError,
)

__all__ = [
    "Alternative",
    "Correspondence",
    "CorrespondenceError",
    "DocumentError",
    "FileFormatError",
    "GeometryError",
    "InkbetweenError",
    "OutlinePairs",
    "alternatives",
    "match",
    "match_quick",
    "pair_outlines",
]

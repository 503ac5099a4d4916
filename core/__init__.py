"""The in-betweening engine: outlines, correspondences, vertex paths, documents. It knows no window."""

from core.certificate import Certificate, Problem, certify, certify_drawing
from core.correspondence.drawings import OutlinePairs, pair_outlines
from core.correspondence.matching import Alternative, alternatives, match, match_quick
from core.correspondence.pairing import Correspondence
from core.errors import (
    CancelledError,
    CorrespondenceError,
    DocumentError,
    FileFormatError,
    GeometryError,
    InkbetweenError,
    StorageError,
)
from core.io.project import load, save
from core.methods.pins import Inside, OnOutline, Pin
from core.methods.plan import METHODS, plan
from core.model.document import Document
from core.repair.between import inbetween

__all__ = [
    "METHODS",
    "Alternative",
    "CancelledError",
    "Certificate",
    "Correspondence",
    "CorrespondenceError",
    "Document",
    "DocumentError",
    "FileFormatError",
    "GeometryError",
    "InkbetweenError",
    "Inside",
    "OnOutline",
    "OutlinePairs",
    "Pin",
    "Problem",
    "StorageError",
    "alternatives",
    "certify",
    "certify_drawing",
    "inbetween",
    "load",
    "match",
    "match_quick",
    "pair_outlines",
    "plan",
    "save",
]

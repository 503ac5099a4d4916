"""What the next edit is about: vertices, an anchor or a pin."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

OutlineRef = tuple[int, int]
"""The frame of a keyframe in the active layer, and the id of an outline in its drawing."""


@dataclass(frozen=True, slots=True)
class AnchorRef:
    """One anchor: the frame its span begins at, the two outlines' ids, its index in their pair."""

    frame: int
    before: int
    after: int
    index: int


@dataclass(frozen=True, slots=True)
class PinRef:
    """One pin: the frame its span begins at, its index in the span."""

    frame: int
    index: int


@dataclass(frozen=True, slots=True)
class Selection:
    """What the next edit is about.

    Attributes
    ----------
    vertices : mapping from OutlineRef to sorted tuple of int
        Selected vertices of each outline that has any.
    anchor : AnchorRef or None
    pin : PinRef or None
    """

    vertices: Mapping[OutlineRef, tuple[int, ...]] = field(default_factory=dict)
    anchor: AnchorRef | None = None
    pin: PinRef | None = None

    @property
    def count(self) -> int:
        """Number of selected vertices."""
        return sum(map(len, self.vertices.values()))

    def has(self, ref: OutlineRef, index: int) -> bool:
        return index in self.vertices.get(ref, ())

    def with_vertices(self, ref: OutlineRef, indices: Iterable[int]) -> "Selection":
        """Return a selection in which exactly these vertices of an outline are selected."""
        kept = dict(self.vertices)
        chosen = tuple(sorted(set(indices)))
        if chosen:
            kept[ref] = chosen
        else:
            kept.pop(ref, None)
        return Selection(kept)

"""Which neighbouring drawings the onion skin shows: found by exposure, worked out only when painted."""

from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass

from app.preview.spans import SpanPreview
from app.session import Session
from app.view import ViewOptions
from core.geometry.outline import FloatArray
from core.model.document import Document, Layer
from core.model.motion import drawing_picture
from core.model.timing import Exposure, exposures_of

OutlineShapes = tuple[tuple[FloatArray, bool], ...]

MOST_KEPT = 64


@dataclass(frozen=True, slots=True, eq=False)
class OnionSkin:
    """One neighbouring drawing.

    Attributes
    ----------
    layer, frame : int
        The layer it belongs to, and the first frame that shows it.
    side : str
        "before" or "after" the playhead.
    strength : float
        Its opacity.
    source : tuple of object
        What it was made of: two skins of the same objects look the same.
    shapes : function
        Works its outlines out.
    """

    layer: int
    frame: int
    side: str
    strength: float
    source: tuple[object, ...]
    shapes: Callable[[], OutlineShapes]

    @property
    def outlines(self) -> OutlineShapes:
        """Its outlines in stage px."""
        return self.shapes()

    @property
    def key(self) -> tuple[object, ...]:
        """Equal for skins that look the same, as long as their sources are kept."""
        return tuple(x if isinstance(x, int) else id(x) for x in self.source)


def onion_skins(session: Session, preview: SpanPreview, options: ViewOptions) -> tuple[OnionSkin, ...]:
    """Return the skins of all layers that show it, the farthest first, so that near ones lie on top."""
    found = []
    for layer in skin_layers(session, options):
        before, after = neighbours(session.document, layer, session.frame, keys_only=options.onion_keys)
        for side, near, count in (("before", before, options.onion_before), ("after", after, options.onion_after)):
            for distance, exposure in enumerate(near[:count]):
                strength = options.onion_strength * (1 - distance / (count + 1))
                found.append(_skin(session.document, layer, exposure, side, strength, preview))
    return tuple(sorted(found, key=lambda s: s.strength))


def skin_layers(session: Session, options: ViewOptions) -> list[Layer]:
    """Return the layers whose neighbouring drawings are shown."""
    if not options.onion_all:
        wanted = [session.layer]
    else:
        wanted = [x for x in session.document.layers if session.shows(x) or x.id == session.layer.id]
    return [x for x in wanted if x.id not in options.onion_off]


def neighbours(
    document: Document, layer: Layer, frame: int, *, keys_only: bool
) -> tuple[list[Exposure], list[Exposure]]:
    """Return the drawings before and after the one that a layer shows at a frame, the nearest first each.

    A drawing that is held for several frames counts once.
    """
    every = _exposures(document, layer)
    before = [e for e in every if e.frame + e.count <= frame and (e.keyframe or not keys_only)]
    after = [e for e in every if e.frame > frame and (e.keyframe or not keys_only)]
    return before[::-1], after


_known: OrderedDict[tuple[int, int], tuple[Layer, tuple[Exposure, ...]]] = OrderedDict()


def _exposures(document: Document, layer: Layer) -> tuple[Exposure, ...]:
    """Return `exposures_of` for the whole film, kept as long as the layer stays the same object."""
    key = id(layer), document.length
    found = _known.get(key)
    if found is None:
        found = _known[key] = layer, exposures_of(layer, 1, document.length)
    _known.move_to_end(key)
    while len(_known) > MOST_KEPT:
        _known.popitem(last=False)
    return found[1]


def _skin(
    document: Document, layer: Layer, exposure: Exposure, side: str, strength: float, preview: SpanPreview
) -> OnionSkin:
    frame = exposure.frame
    keyframe = layer.keyframe_at(frame)
    before, after = layer.around(frame)
    if keyframe is not None or before is None or after is None:
        drawing = (keyframe or before or after).drawing  # type: ignore[union-attr]
        return OnionSkin(layer.id, frame, side, strength, (drawing,), lambda: drawing_picture(drawing).outlines)
    motion = preview.motions.of(document, layer, before, after)

    def shapes() -> OutlineShapes:
        closed = (link.aligned.closed for link in motion.plan.links)
        return tuple((s[0], c) for s, c in zip(motion.frames([frame]), closed, strict=True))

    return OnionSkin(layer.id, frame, side, strength, (motion, frame), shapes)

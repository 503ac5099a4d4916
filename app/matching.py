"""What the span menu does with the correspondence: turn it round, shift its start."""

from app.preview.spans import SpanPreview
from app.session import Session
from core.correspondence.by_hand import reversed_direction, shifted_start
from core.correspondence.pairing import Correspondence
from core.errors import InkbetweenError
from core.model.drawing import Outline
from core.model.edits import choose_correspondence


def flip(session: Session, preview: SpanPreview) -> None:
    """Let the correspondence run the other way round from its start."""
    found = _main(session, preview)
    if found is not None:
        frame, a, b, c = found
        _choose(session, "Flip Direction", frame, a, b, reversed_direction(c))


def shift(session: Session, preview: SpanPreview, steps: int) -> None:
    """Slide the correspondence so that its start goes to the next vertex of the outline after."""
    found = _main(session, preview)
    if found is None:
        return
    frame, a, b, c = found
    try:
        moved = shifted_start(c, a.points, b.points, steps)
    except InkbetweenError as e:
        session.problem.emit(str(e))
        return
    _choose(session, "Shift Start", frame, a, b, moved)


def _main(session: Session, preview: SpanPreview) -> tuple[int, Outline, Outline, Correspondence] | None:
    """Return the span's frame, its main pair and what they are matched by; say why if that cannot be changed."""
    before, after = session.span_keyframes()
    pair = preview.main_pair(before, after) if before is not None and after is not None else None
    if before is None or after is None or pair is None:
        session.problem.emit("There is no correspondence here: draw two keyframes first.")
        return None
    a, b = pair
    made = before.span.pair_of(a.id, b.id)
    if made is not None and made.held:
        session.problem.emit("Anchors hold the start and the direction: move, mute or delete them instead.")
        return None
    return before.frame, a, b, preview.correspondence(before, after, session.layer.id, (a.id, b.id))


def _choose(session: Session, label: str, frame: int, a: Outline, b: Outline, c: Correspondence) -> None:
    session.apply(label, choose_correspondence, session.layer.id, frame, a.id, b.id, c)

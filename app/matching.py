"""What the span menu does: the correspondence turned round or shifted, the turn reversed, methods tried out."""

from PySide6.QtGui import QAction
from PySide6.QtWidgets import QMenu

from app.preview.spans import SpanPreview
from app.session import Session
from core.correspondence.by_hand import reversed_direction, shifted_start
from core.correspondence.pairing import Correspondence
from core.errors import InkbetweenError
from core.methods.plan import other_way
from core.model.drawing import Outline
from core.model.edits import choose_correspondence, set_span


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


def turn_other_way(session: Session, preview: SpanPreview) -> None:
    """Let the drawing of the span go round the other side."""
    before, after = session.span_keyframes()
    if before is None or after is None:
        return
    if before.span.method == "linear":
        session.problem.emit("Linear goes straight and turns no way round: choose another method first.")
        return
    turns = other_way(before.span.turns, preview.plan(before, after, session.layer.id).natural_turn)
    session.apply("Turn the Other Way", set_span, session.layer.id, before.frame, turns=turns)


def try_methods_in(menu: QMenu, methods: dict[str, str], session: Session, preview: SpanPreview) -> None:
    """Show the in-betweens by the method under the pointer in a menu; `methods` are by the name of the action."""

    def hovered(action: QAction) -> None:
        before, after = session.span_keyframes()
        method = methods.get(action.objectName(), "")
        preview.try_method(before if method and after is not None else None, session.layer.id, method)

    menu.hovered.connect(hovered)
    menu.aboutToHide.connect(lambda: preview.try_method(None))


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

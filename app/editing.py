"""What the edit and draw menus do: functions on the session."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from app.session import OutlineRef, Selection, Session
from app.tools.correspond import delete_selected_anchor
from app.tools.pin import delete_selected_pin
from app.tools.select import delete_selected_vertices, outline_of
from core.model.breakdowns import add_breakdown
from core.model.document import Document, Keyframe
from core.model.drawing import Drawing, Outline
from core.model.edits import add_outline, delete_keyframe, delete_vertices, put_drawing, set_smooth, set_span
from core.model.motion import Motions

PASTE_SHIFT = 12.0


@dataclass
class Clipboard:
    """Outlines that were copied, within this program."""

    outlines: tuple[Outline, ...] = ()


def chosen_outlines(session: Session) -> tuple[OutlineRef, ...]:
    """Return the outlines with selected vertices, else all of the keyframe at the playhead."""
    if session.selection.vertices:
        return tuple(session.selection.vertices)
    here = session.layer.keyframe_at(session.frame)
    return tuple((here.frame, o.id) for o in here.drawing.outlines) if here else ()


def copy(session: Session, clipboard: Clipboard) -> bool:
    """Remember the chosen outlines; False if there are none."""
    refs = chosen_outlines(session)
    if not refs:
        session.problem.emit("Nothing to copy: select an outline, or go to a keyframe.")
        return False
    clipboard.outlines = tuple(outline_of(session.document, session, ref) for ref in refs)
    return True


def cut(session: Session, clipboard: Clipboard) -> None:
    """Copy the chosen outlines and take them away."""
    refs = chosen_outlines(session)
    if not copy(session, clipboard):
        return
    layer_id = session.layer.id

    def edit(document: Document) -> Document:
        for frame, outline_id in refs:
            count = len(outline_of(document, session, (frame, outline_id)).points)
            document = delete_vertices(document, layer_id, frame, {outline_id: range(count)})
        return document

    session.apply("Cut", edit, selection=Selection())


def paste(session: Session, clipboard: Clipboard) -> None:
    """Add the remembered outlines to the drawing at the playhead, which may be a new keyframe."""
    if not clipboard.outlines:
        session.problem.emit("Nothing to paste: copy an outline first.")
        return
    layer_id, frame = session.layer.id, session.frame
    here = session.layer.keyframe_at(frame)
    taken = {o.points.tobytes() for o in here.drawing.outlines} if here else set()

    def edit(document: Document) -> Document:
        for outline in clipboard.outlines:
            # on top of the original nobody would see that there are two
            shift = PASTE_SHIFT if outline.points.tobytes() in taken else 0.0
            document = add_outline(document, layer_id, frame, outline.points + shift, closed=outline.closed)
        return document

    if session.apply("Paste", edit):
        drawing = session.layer.keyframe_at(frame).drawing
        made = drawing.outlines[-len(clipboard.outlines) :]
        session.select(Selection({(frame, o.id): tuple(range(len(o.points))) for o in made}))


def delete(session: Session) -> None:
    """Take away the selected anchor, pin or vertices, and say so if nothing is selected."""
    deletes = (delete_selected_anchor, delete_selected_pin, delete_selected_vertices)
    if not any(delete_one(session) for delete_one in deletes):
        session.problem.emit("Nothing is selected: click a vertex, a shape, an anchor or a pin first.")


def select_all(session: Session) -> None:
    """Select every vertex of the keyframe at the playhead, else of the keyframe before it."""
    keyframe = session.layer.keyframe_at(session.frame) or next((k for k in session.span_keyframes() if k), None)
    if keyframe is not None:
        session.select(
            Selection({(keyframe.frame, o.id): tuple(range(len(o.points))) for o in keyframe.drawing.outlines})
        )


def add_keyframe(session: Session, motions: Motions) -> None:
    """Make a keyframe of exactly what is shown at the playhead; in a span it is a breakdown."""
    frame, layer = session.frame, session.layer
    if layer.keyframe_at(frame) is not None:
        session.problem.emit(f"Frame {frame} is a keyframe already; go to another frame first.")
        return
    before, after = session.span_keyframes()
    if before is not None and after is not None and not before.span.hold:
        motion = motions.of(session.document, layer, before, after)
        session.apply("Add Breakdown", add_breakdown, layer.id, frame, motion)
        return
    if before is None and after is None:
        session.problem.emit("Nothing is shown here yet: draw with the pen or the pencil.")
        return
    session.apply("Add Keyframe", put_drawing, layer.id, frame, held_drawing(session, motions))


def held_drawing(session: Session, motions: Motions) -> Drawing:
    """Return what is held at the playhead, carried by its parent; before the first keyframe, that one."""
    before, after = session.span_keyframes()
    keyframe = before or after
    assert keyframe is not None
    picture = motions.picture(session.document, session.layer, session.frame)
    if picture is None:
        return keyframe.drawing
    shown = zip(keyframe.drawing.outlines, picture.outlines, strict=True)
    outlines = tuple(o if points is o.points else replace(o, points=points) for o, (points, _) in shown)
    return replace(keyframe.drawing, outlines=outlines)


def copy_to_other_keyframe(session: Session) -> None:
    """Put a copy of one keyframe's drawing into the other one of the span.

    From the keyframe at the playhead (or that of the selection) to the other one; with a single keyframe, to
    the playhead's frame, or to the last frame of the film if it stands on that keyframe.
    """
    source, target = _copy_ends(session)
    if source is None or target is None:
        session.problem.emit("There is no drawing to copy yet: draw one with the pen or the pencil.")
        return
    if session.apply("Copy Drawing", put_drawing, session.layer.id, target, source.drawing):
        session.go_to(target)


def _copy_ends(session: Session) -> tuple[Keyframe | None, int | None]:
    before, after = session.span_keyframes()
    if before is None or after is None:
        source = before or after
        if source is None:
            return None, None
        if session.frame != source.frame:
            return source, session.frame
        last = session.document.length
        return source, last if last != source.frame else max(1, source.frame - 1)
    selected = {frame for frame, _ in session.selection.vertices}
    from_after = session.frame == after.frame or selected == {after.frame}
    return (after, before.frame) if from_after else (before, after.frame)


def delete_current_keyframe(session: Session) -> None:
    """Take away the keyframe at the playhead."""
    if session.layer.keyframe_at(session.frame) is None:
        session.problem.emit(f"Frame {session.frame} is no keyframe; go to a diamond of the timeline first.")
        return
    session.apply("Delete Keyframe", delete_keyframe, session.layer.id, session.frame, selection=Selection())


def set_method(session: Session, method: str) -> None:
    """Choose how the vertices of the span under the playhead travel."""
    before, after = session.span_keyframes()
    if before is None or after is None:
        session.problem.emit("There is no span here: draw two keyframes first.")
        return
    session.apply("Change Method", set_span, session.layer.id, before.frame, method=method)


def go_to_keyframe(session: Session, step: int) -> None:
    """Go to the next (step 1) or previous (step -1) keyframe of the active layer."""
    frames = [f for f in session.layer.frames() if (f - session.frame) * step > 0]
    if frames:
        session.go_to(min(frames) if step > 0 else max(frames))


def smoothing_runs(session: Session) -> dict[str, Callable[[], None]]:
    """Return what the two actions for all keyframes of a layer run."""
    return {
        "key.smooth_layer": lambda: set_layer_smooth(session, True),
        "key.sharp_layer": lambda: set_layer_smooth(session, False),
    }


def set_layer_smooth(session: Session, smooth: bool) -> None:
    """Let the motion go through every keyframe of the active layer smoothly, or let all be sharp."""
    text = "Smooth Layer" if smooth else "Sharp Layer"
    session.apply(text, set_smooth, session.layer.id, session.layer.frames(), smooth)

"""The keyframes that are selected on the timeline, and what can be done with them."""

from collections.abc import Callable, Iterable
from typing import Any

from PySide6.QtCore import QObject, Signal

from app.session import DocumentDiff, Session
from core.errors import InkbetweenError
from core.model.document import Document, Keyframe
from core.model.frame_edits import (
    CopiedKeyframe,
    KeyRef,
    copy_keyframes,
    delete_keyframes,
    duplicate_keyframes,
    hold_keyframes,
    paste_keyframes,
    smooth_keyframes,
)

MOST_REMEMBERED = 50

Chosen = frozenset[KeyRef]


class Keys(QObject):
    """`chosen` are the selected ones; with an undo come back those that were selected then."""

    changed = Signal()

    def __init__(self, session: Session, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.session = session
        self.chosen: Chosen = frozenset()
        self.copied: tuple[CopiedKeyframe, ...] = ()
        self._remembered: list[tuple[Document, Chosen]] = []
        session.documentChanged.connect(self._on_document_changed)
        session.frameChanged.connect(self._on_frame_changed)
        session.selectionChanged.connect(self._on_selection_changed)

    # which

    def choose(self, keys: Iterable[KeyRef]) -> None:
        """Select exactly these keyframes, of which those that are there count."""
        chosen = frozenset(keys) & _there(self.session.document)
        if not self.session.in_gesture:
            self._remembered = [(d, c) for d, c in self._remembered if d is not self.session.document]
            self._remembered = [*self._remembered, (self.session.document, chosen)][-MOST_REMEMBERED:]
        if chosen != self.chosen:
            self.chosen = chosen
            self.changed.emit()

    def toggle(self, key: KeyRef) -> None:
        self.choose(self.chosen ^ {key})

    def choose_all(self) -> None:
        """Select every keyframe of the active layer."""
        layer = self.session.layer
        self.choose((layer.id, frame) for frame in layer.frames())

    @property
    def frames(self) -> tuple[int, ...]:
        """The frames of the selected keyframes, each once, in order."""
        return tuple(sorted({frame for _, frame in self.chosen}))

    def acted_on(self) -> Chosen:
        """Return the selected keyframes, else the one at the playhead; if there is none, say so."""
        if self.chosen:
            return self.chosen
        layer, frame = self.session.layer, self.session.frame
        if layer.keyframe_at(frame) is not None:
            return frozenset({(layer.id, frame)})
        self.session.problem.emit(f"Frame {frame} is no keyframe; select keyframes on the timeline first.")
        return frozenset()

    def keyframes(self) -> tuple[Keyframe, ...]:
        """Return the selected keyframes, else the one at the playhead, without a word if there is none."""
        document = self.session.document
        chosen = self.chosen & _there(document)  # while another document opens they are still the last one's
        refs = chosen or {(self.session.layer.id, self.session.frame)}
        found = (document.layer(i).keyframe_at(f) for i, f in sorted(refs))
        return tuple(k for k in found if k is not None)

    def _on_document_changed(self, diff: DocumentDiff) -> None:
        known = next((c for d, c in self._remembered if d is diff.after), None)
        chosen = self.chosen & _there(diff.after) if known is None else known
        if chosen != self.chosen:
            self.chosen = chosen
            self.changed.emit()

    def _on_frame_changed(self, frame: int) -> None:
        """Give up a single one when the playhead leaves it: what is done next is meant for where one is now."""
        if len(self.chosen) == 1 and not self.session.in_gesture and self.frames != (frame,):
            self.choose(())

    def _on_selection_changed(self) -> None:
        """Give way to what is selected on the canvas."""
        selection = self.session.selection
        if selection.vertices or selection.anchor or selection.pin:
            self.choose(())

    # what is done with them

    def delete(self) -> None:
        if keys := self.acted_on():
            self.session.apply(_many("Delete Keyframe", keys), delete_keyframes, keys)

    def copy(self) -> bool:
        """Remember the keyframes; False if there are none."""
        if keys := self.acted_on():
            self.copied = copy_keyframes(self.session.document, keys)
        return bool(keys)

    def cut(self) -> None:
        keys = self.acted_on()
        if keys and self.copy():
            self.session.apply(_many("Cut Keyframe", keys), delete_keyframes, keys)

    def paste(self) -> None:
        """Put the remembered keyframes into the active layer at the playhead, and select them."""
        layer, frame = self.session.layer.id, self.session.frame
        self._make(_many("Paste Keyframe", self.copied), paste_keyframes, self.copied, layer, frame)

    def duplicate(self) -> None:
        """Put copies behind the keyframes, and select them."""
        if keys := self.acted_on():
            self._make(_many("Duplicate Keyframe", keys), duplicate_keyframes, keys)

    def _make(self, label: str, edit: Callable[..., tuple[Document, tuple[KeyRef, ...]]], *args: Any) -> None:
        try:
            document, made = edit(self.session.document, *args)
        except InkbetweenError as e:
            self.session.problem.emit(str(e))
            return
        self.session.apply(label, lambda _: document)
        self.session.go_to(min(frame for _, frame in made))
        self.choose(made)

    def set_hold(self, hold: bool) -> None:
        if keys := self.acted_on():
            self.session.apply("Hold" if hold else "Give Up Hold", hold_keyframes, keys, hold)

    def set_smooth(self, smooth: bool) -> None:
        if keys := self.acted_on():
            label = "Smooth" if smooth else "Sharpen"
            self.session.apply(_many(f"{label} Keyframe", keys), smooth_keyframes, keys, smooth)


def _there(document: Document) -> Chosen:
    return frozenset((x.id, frame) for x in document.layers for frame in x.frames())


def _many(label: str, keys: Iterable[object]) -> str:
    return f"{label}s" if len(tuple(keys)) > 1 else label

"""The open document, what is selected in it and where the playhead stands; the only place that changes them."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QUndoStack

from app.commands import EditDocument, Step
from app.selection import AnchorRef, OutlineRef, PinRef, Selection
from core.errors import InkbetweenError
from core.io.project import load, save
from core.model.document import Document, Keyframe, Layer
from core.model.references import with_absolute_references, with_relative_references

__all__ = ["AnchorRef", "DocumentDiff", "Gesture", "OutlineRef", "PinRef", "Selection", "Session"]

UNDO_LIMIT = 1000


@dataclass(frozen=True, slots=True)
class DocumentDiff:
    """What changed, told by identity: parts that an edit left alone are the same objects."""

    before: Document
    after: Document

    @property
    def layers(self) -> frozenset[int]:
        """Ids of layers that were added, taken away or changed."""
        old = {x.id: x for x in self.before.layers}
        new = {x.id: x for x in self.after.layers}
        return frozenset(i for i in old.keys() | new.keys() if old.get(i) is not new.get(i))

    @property
    def frame_range(self) -> bool:
        """Whether the length or the rate changed."""
        return (self.before.length, self.before.rate) != (self.after.length, self.after.rate)

    @property
    def stage(self) -> bool:
        return self.before.stage != self.after.stage


class Gesture:
    """One drag: shown at every step, one undo command at the end, nothing at all when cancelled."""

    def __init__(self, session: "Session", label: str) -> None:
        self._session = session
        self.label = label
        self.before = Step(session.document, session.selection)
        self.open = True

    @property
    def document(self) -> Document:
        """The document as it was when the gesture began."""
        return self.before.document

    def update(self, edit: Callable[[Document], Document], *, quiet: bool = False) -> bool:
        """Show the first document with `edit` applied; one that is refused leaves the last picture.

        Why it was refused is told in the message bar, unless `quiet`.
        """
        try:
            document = edit(self.document)
        except InkbetweenError as e:
            if not quiet:
                self._session.problem.emit(str(e))
            return False
        self._session.show_document(document)
        return True

    def reset(self) -> None:
        """Show the document as it was when the gesture began, and stay open."""
        self._session.show_document(self.document)

    def commit(self) -> None:
        """End with one undo step, or with none if nothing changed."""
        if self.open:
            self.open = False
            self._session.end_gesture(self, keep=True)

    def cancel(self) -> None:
        """End as if it had never begun."""
        if self.open:
            self.open = False
            self._session.end_gesture(self, keep=False)


class Session(QObject):
    """See the module. Every change of the document emits `documentChanged` once."""

    documentChanged = Signal(object)  # DocumentDiff
    selectionChanged = Signal()
    frameChanged = Signal(int)
    layerChanged = Signal()
    fileChanged = Signal()
    soloChanged = Signal()
    rangeChanged = Signal()
    gestureChanged = Signal(bool)
    problem = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.undo_stack = QUndoStack(self)
        self.undo_stack.setUndoLimit(UNDO_LIMIT)
        self.undo_stack.cleanChanged.connect(self._on_clean_changed)
        self._document = Document()
        self._selection = Selection()
        self._frame = 1
        self._layer_id = 1
        self._gesture: Gesture | None = None
        self._solo: frozenset[int] = frozenset()
        self._range: tuple[int, int] | None = None
        self.path: Path | None = None
        self.title: str | None = None

    def _on_clean_changed(self, _: bool) -> None:
        self.fileChanged.emit()

    # what is open

    @property
    def document(self) -> Document:
        return self._document

    @property
    def selection(self) -> Selection:
        return self._selection

    @property
    def frame(self) -> int:
        return self._frame

    @property
    def layer(self) -> Layer:
        """The layer that tools draw on."""
        return self._document.layer(self._layer_id)

    @property
    def in_gesture(self) -> bool:
        return self._gesture is not None

    @property
    def is_modified(self) -> bool:
        return not self.undo_stack.isClean()

    @property
    def name(self) -> str:
        """The file's name without its suffix, for titles and exports."""
        return self.path.stem if self.path else (self.title or "untitled")

    @property
    def solo(self) -> frozenset[int]:
        """Ids of the layers that are shown alone; of none: all visible ones are shown."""
        return self._solo

    @property
    def range(self) -> tuple[int, int]:
        """The first and the last frame that are played."""
        last = self._document.length
        first, end = self._range or (1, last)
        return min(first, last), min(end, last)

    @property
    def has_range(self) -> bool:
        """Whether only a part of the film is played."""
        return self._range is not None

    def shows(self, layer: Layer) -> bool:
        """Whether a layer is seen in the window."""
        return layer.id in self._solo if self._solo else layer.visible

    def span_keyframes(self) -> tuple[Keyframe | None, Keyframe | None]:
        """Return the keyframes around the playhead in the active layer."""
        return self.layer.around(self._frame)

    # changing it

    def apply(self, label: str, edit: Callable[..., Document], *args: Any, **options: Any) -> bool:
        """Apply an edit as one undo step; where the engine refuses, say why and leave everything as it is.

        Options `merge_key` (see EditDocument) and `selection` (what to select afterwards) are taken out; the
        rest goes to the edit.
        """
        merge_key = options.pop("merge_key", None)
        selection = options.pop("selection", self._selection)
        if self._gesture is not None:
            self._gesture.commit()
        try:
            document = edit(self._document, *args, **options)
        except InkbetweenError as e:
            self.problem.emit(str(e))
            return False
        if document is not self._document:
            before = Step(self._document, self._selection)
            self._push(label, before, Step(document, selection), merge_key)
        elif selection is not self._selection:
            self.select(selection)
        return True

    def begin(self, label: str) -> Gesture:
        """Start a gesture; an open one is committed first."""
        if self._gesture is not None:
            self._gesture.commit()
        self._gesture = Gesture(self, label)
        self.gestureChanged.emit(True)
        return self._gesture

    def end_gesture(self, gesture: Gesture, *, keep: bool) -> None:
        """Called by the gesture itself."""
        self._gesture = None
        shown = Step(self._document, self._selection)
        if not keep:
            self._show(gesture.before)
        elif shown.document != gesture.before.document:
            self._push(gesture.label, gesture.before, shown)
        else:
            self.show_document(gesture.before.document)
        self.gestureChanged.emit(False)

    def _push(self, label: str, before: Step, after: Step, merge_key: object = None) -> None:
        self.undo_stack.push(EditDocument(label, before, after, self._show, merge_key))

    def _show(self, step: Step) -> None:
        self.show_document(step.document)
        if isinstance(step.selection, Selection):
            self.select(step.selection)

    def show_document(self, document: Document) -> None:
        """Make `document` the visible one, without an undo step; for gestures and undo commands only."""
        if document is self._document:
            return
        diff = DocumentDiff(self._document, document)
        self._document = document
        if all(layer.id != self._layer_id for layer in document.layers):
            self._layer_id = document.layers[-1].id
        self._solo &= {layer.id for layer in document.layers}
        valid = self._valid(self._selection)
        selection_changed = valid != self._selection
        self._selection = valid
        if self._frame > document.length:
            self._frame = document.length
            self.frameChanged.emit(self._frame)
        self.documentChanged.emit(diff)
        if selection_changed:
            self.selectionChanged.emit()

    # session state

    def select(self, selection: Selection) -> None:
        """Select what of `selection` exists."""
        valid = self._valid(selection)
        if valid != self._selection:
            self._selection = valid
            self.selectionChanged.emit()

    def go_to(self, frame: float) -> None:
        """Put the playhead on a frame of the film."""
        clipped = min(max(round(frame), 1), self._document.length)
        if clipped != self._frame:
            self._frame = clipped
            self.frameChanged.emit(clipped)

    def set_layer(self, layer_id: int) -> None:
        """Draw on another layer."""
        if layer_id != self._layer_id:
            self._document.layer(layer_id)
            self._layer_id = layer_id
            self.select(Selection())
            self.layerChanged.emit()

    def set_solo(self, layer_ids: Iterable[int]) -> None:
        """Show these layers alone, or, with none, all that are visible."""
        solo = frozenset(layer_ids) & {layer.id for layer in self._document.layers}
        if solo != self._solo:
            self._solo = solo
            self.soloChanged.emit()

    def set_range(self, first_and_last: tuple[int, int] | None) -> None:
        """Play from one frame to another, or, with None, the whole film."""
        if first_and_last is not None:
            first_and_last = (max(1, min(first_and_last)), max(first_and_last))
        if first_and_last != self._range:
            self._range = first_and_last
            self.rangeChanged.emit()

    def _valid(self, selection: Selection) -> Selection:
        counts = {(k.frame, o.id): len(o.points) for k in self.layer.keyframes for o in k.drawing.outlines}
        kept = {
            ref: indices
            for ref, indices in selection.vertices.items()
            if ref in counts and indices[-1] < counts[ref]
        }
        anchor = selection.anchor
        if anchor is not None:
            keyframe = self.layer.keyframe_at(anchor.frame)
            pair = keyframe.span.pair_of(anchor.before, anchor.after) if keyframe else None
            if pair is None or anchor.index >= len(pair.anchors):
                anchor = None
        pin = selection.pin
        if pin is not None:
            keyframe = self.layer.keyframe_at(pin.frame)
            if keyframe is None or pin.index >= len(keyframe.span.pins):
                pin = None
        if len(kept) == len(selection.vertices) and anchor is selection.anchor and pin is selection.pin:
            return selection
        return Selection(kept, anchor, pin)

    # files

    def new(self, document: Document | None = None, title: str | None = None) -> None:
        """Start over with a document that has no file."""
        self._replace(document or Document(), None, title)

    def open(self, path: Path) -> None:
        """Open a file; raises InkbetweenError and keeps the open document if that fails."""
        self.opened(load(path), path)

    def opened(self, document: Document, path: Path) -> None:
        """Show a document that was read from a file."""
        self._replace(with_absolute_references(document, path.parent), path, None)

    def recovered(self, document: Document, path: Path | None, title: str) -> None:
        """Show a document that was never saved like this, under the name it had."""
        self._replace(document, path, title)
        self.undo_stack.resetClean()

    def save(self, path: Path, completed: Document | None = None) -> None:
        """Write the document, or `completed`: the same one with the solver's answers stored in it.

        Raises StorageError and stays modified if that fails.
        """
        self.settle()
        save(with_relative_references(completed or self._document, path.parent), path)
        self.saved(path, self._document)

    def settle(self) -> None:
        """End an open gesture as if the button had been released."""
        if self._gesture is not None:
            self._gesture.commit()

    def saved(self, path: Path, document: Document) -> None:
        """Take note that `document` is in a file now; what was changed meanwhile is still unsaved."""
        self.path, self.title = path, None
        if self._document is document:
            self.undo_stack.setClean()
        else:
            self.undo_stack.resetClean()
        self.fileChanged.emit()

    def _replace(self, document: Document, path: Path | None, title: str | None) -> None:
        if self._gesture is not None:
            self._gesture.cancel()
        self.path, self.title = path, title
        self._selection = Selection()
        self._solo, self._range = frozenset(), None
        self._layer_id = document.layers[-1].id
        diff = DocumentDiff(self._document, document)
        self._document = document
        self._frame = 1
        self.undo_stack.clear()
        self.frameChanged.emit(1)
        self.documentChanged.emit(diff)
        self.layerChanged.emit()
        self.selectionChanged.emit()
        self.fileChanged.emit()

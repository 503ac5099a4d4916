"""The one undo command: it swaps two immutable documents, so it can neither fail nor drift."""

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtGui import QUndoCommand

from core.model.document import Document

MERGEABLE = 1


@dataclass(frozen=True, slots=True)
class Step:
    """One end of an edit: the document and whatever was selected in it."""

    document: Document
    selection: object


class EditDocument(QUndoCommand):
    """From one step to another and back.

    `merge_key`: commands in a row with the same key become one (arrow keys, spin boxes); None never merges.
    """

    def __init__(
        self,
        label: str,
        before: Step,
        after: Step,
        show: Callable[[Step], None],
        merge_key: object = None,
    ) -> None:
        super().__init__(label)
        self.before, self.after = before, after
        self.merge_key = merge_key
        self._show = show

    def redo(self) -> None:
        self._show(self.after)

    def undo(self) -> None:
        self._show(self.before)

    def id(self) -> int:
        return -1 if self.merge_key is None else MERGEABLE

    def mergeWith(self, other: QUndoCommand) -> bool:
        if not isinstance(other, EditDocument) or other.merge_key != self.merge_key:
            return False
        self.after = other.after
        self.setObsolete(self.after.document == self.before.document)
        return True

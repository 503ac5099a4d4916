"""The tour: which step a newcomer is at, and what ends it. The card that shows it is in app/dialogs/tour.py."""

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QObject, Signal

from app.session import Session
from app.settings import Settings

FRAMES_TO_SEE = 3
"""In-betweens at which the playhead must have stood before scrubbing is known."""


@dataclass(frozen=True, slots=True)
class Step:
    """One thing to do.

    Attributes
    ----------
    title : str
    text : str
        In braces the id of an action, told by its key.
    done : function
        Whether it has been done since the step began.
    """

    title: str
    text: str
    done: Callable[["Tour"], bool]


@dataclass(frozen=True, slots=True)
class _Counts:
    """What there is in a document, to see that it has become more."""

    outlines: int
    keyframes: int
    anchors: int


def _has_drawn(tour: "Tour") -> bool:
    return tour.counts().outlines > tour.before.outlines


def _has_two_keyframes(tour: "Tour") -> bool:
    return _has_drawn(tour) and tour.counts().keyframes >= 2


def _has_anchored(tour: "Tour") -> bool:
    return tour.counts().anchors > tour.before.anchors


STEPS = (
    Step(
        "Draw",
        "Press {tool.pen} and click the corners of a shape. Click the first corner again to close it.",
        _has_drawn,
    ),
    Step(
        "Draw where it goes",
        "Press {play.last} to go to the last frame, and draw the shape as it is there.",
        _has_two_keyframes,
    ),
    Step(
        "Correspond",
        "Press {tool.correspond} and drag from a point of the blue outline to the point of the orange one that it "
        "becomes.",
        _has_anchored,
    ),
    Step(
        "Scrub",
        "Drag the playhead along the timeline. The in-betweens are there already.",
        lambda tour: len(tour.seen) >= FRAMES_TO_SEE,
    ),
    Step(
        "Export",
        "Press {file.export} and write the frames into a folder.",
        lambda tour: tour.exported,
    ),
)


class Tour(QObject):
    """Goes on when a person has really done a step; `changed` when another one is shown or the tour ends.

    `index` is -1 at the welcome, the number of steps at the end, and None while there is no tour.
    """

    changed = Signal()

    def __init__(self, session: Session, settings: Settings, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._session, self._settings = session, settings
        self.index: int | None = None
        self.seen: set[int] = set()
        self.exported = False
        self.before = _Counts(0, 0, 0)
        session.documentChanged.connect(self._look)
        session.frameChanged.connect(self._on_frame)
        session.gestureChanged.connect(self._look)

    @property
    def step(self) -> Step | None:
        """The step that is shown."""
        at = self.index
        return STEPS[at] if at is not None and 0 <= at < len(STEPS) else None

    def offer(self) -> None:
        """Show the welcome, unless the person does not want it any more."""
        if not self._settings.flag("tour/done", False):
            self._go(-1)

    def restart(self) -> None:
        """Show the welcome whatever was said before."""
        self._go(-1)

    def start(self) -> None:
        """Go to the first step."""
        self._go(0)

    def leave(self, *, for_good: bool) -> None:
        """End the tour; for good it is never offered again, though it can be restarted."""
        if for_good:
            self._settings.keep("tour/done", True)
        self._go(None)

    def note_export(self) -> None:
        """Frames were written."""
        self.exported = True
        self._look()

    def counts(self) -> _Counts:
        """Count what is in the document now."""
        layers = self._session.document.layers
        keyframes = [k for layer in layers for k in layer.keyframes]
        anchors = sum(len(p.anchors) for k in keyframes for p in k.span.pairs)
        outlines = sum(len(k.drawing.outlines) for k in keyframes)
        return _Counts(outlines, max(len(layer.keyframes) for layer in layers), anchors)

    def _on_frame(self, frame: int) -> None:
        before, after = self._session.span_keyframes()
        if before is not None and after is not None and before.frame < frame < after.frame:
            self.seen.add(frame)
        self._look()

    def _look(self, *_: object) -> None:
        """Go on if the step is done, but not in the middle of a drag."""
        step = self.step
        if step is not None and not self._session.in_gesture and step.done(self):
            self._go((self.index or 0) + 1)

    def _go(self, index: int | None) -> None:
        self.index = index
        self.seen, self.exported = set(), False
        self.before = self.counts()
        if index == len(STEPS):
            self._settings.keep("tour/done", True)
        self.changed.emit()

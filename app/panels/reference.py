"""The reference picture at the playhead: its name, how strongly it shows, and away with it."""

from pathlib import PurePath

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QSlider, QToolButton, QWidget

from app.canvas.reference import reference_keyframe
from app.panels.parts import Section, label
from app.session import Gesture, Session
from core.model.document import Document, Reference
from core.model.edits import set_reference


class ReferencePanel(Section):
    """Shown only where there is a reference picture."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__("Reference", parent)
        self.session = session
        self._gesture: Gesture | None = None
        self._showing = False
        self.name = label("", "strong")
        self.opacity = QSlider(Qt.Orientation.Horizontal)
        self.opacity.setRange(0, 100)
        self.opacity.setFixedWidth(130)
        self.opacity.setToolTip("How strongly the picture shows through; it is never exported")
        self.opacity.setAccessibleName("Opacity of the reference picture")
        self.share = label("", "muted")
        self.remove = QToolButton()
        self.remove.setText("Remove")
        self.remove.setToolTip("Take the picture away from this keyframe; the file stays")
        self.remove.clicked.connect(self.remove_reference)
        self.add_row("picture", self.name)
        self.add_row("opacity", self.opacity, self.share)
        self.box.addWidget(self.remove, alignment=Qt.AlignmentFlag.AlignLeft)
        self.opacity.sliderPressed.connect(self._on_pressed)
        self.opacity.valueChanged.connect(self._on_moved)
        self.opacity.sliderReleased.connect(self._on_released)
        for signal in (session.documentChanged, session.frameChanged, session.layerChanged):
            signal.connect(self._refresh)
        self._refresh()

    def _current(self) -> tuple[int, Reference] | None:
        keyframe = reference_keyframe(self.session.layer, self.session.frame)
        return (keyframe.frame, keyframe.reference) if keyframe and keyframe.reference else None

    def _refresh(self, *_: object) -> None:
        current = self._current()
        self.setVisible(current is not None)
        if current is None:
            return
        frame, reference = current
        self.note.setText(f"keyframe {frame}")
        name = PurePath(reference.path).name
        self.name.setText(self.name.fontMetrics().elidedText(name, Qt.TextElideMode.ElideMiddle, 170))
        self.name.setToolTip(reference.path)
        self.share.setText(f"{round(100 * reference.opacity)} %")
        self._showing = True
        self.opacity.setValue(round(100 * reference.opacity))
        self._showing = False

    def remove_reference(self) -> None:
        current = self._current()
        if current is None:
            self.session.problem.emit("There is no reference picture here.")
            return
        self.session.apply("Remove Reference", set_reference, self.session.layer.id, current[0], None)

    def _on_pressed(self) -> None:
        self._gesture = self.session.begin("Change Reference Opacity")

    def _on_moved(self, value: int) -> None:
        current = self._current()
        if self._showing or current is None:
            return
        frame, reference = current
        layer_id = self.session.layer.id

        def edit(document: Document) -> Document:
            return set_reference(document, layer_id, frame, Reference(reference.path, value / 100))

        if self._gesture is not None and self._gesture.open:
            self._gesture.update(edit)
        else:  # by keys or the wheel
            key = ("reference opacity", layer_id, frame)
            self.session.apply("Change Reference Opacity", edit, merge_key=key)

    def _on_released(self) -> None:
        gesture, self._gesture = self._gesture, None
        if gesture is not None:
            gesture.commit()

"""The reference picture: under the shapes, on the paper, as large as the stage allows."""

import os
from collections import OrderedDict

from PySide6.QtCore import QObject, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QImageReader, QPainter, QPixmap

from app.canvas.content import Content
from app.canvas.items import CanvasItem
from app.session import Session
from core.model.document import Keyframe, Layer, Reference

MOST_KEPT = 8
LARGEST_SIDE = 4096


def reference_keyframe(layer: Layer, frame: int) -> Keyframe | None:
    """Return the keyframe whose reference is laid under a frame: the one there, else the one before it."""
    return next((k for k in reversed(layer.keyframes) if k.frame <= frame), None)


class ReferencePictures(QObject):
    """Pictures by path and time of change; each that cannot be shown is told once."""

    unreadable = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._kept: OrderedDict[tuple[str, int], QPixmap | None] = OrderedDict()

    def picture(self, path: str) -> QPixmap | None:
        """Return the picture, read when it is new or has changed; None if it cannot be read."""
        try:
            key = (path, os.stat(path).st_mtime_ns)
        except (OSError, ValueError):
            key = (path, -1)
        if key not in self._kept:
            self._kept[key] = self._read(path) if key[1] >= 0 else None
            if self._kept[key] is None:
                name = os.path.basename(path)
                why = "is not there" if key[1] < 0 else "cannot be read as a picture"
                self.unreadable.emit(f"the reference picture {name} {why}; lay another one under the stage")
            while len(self._kept) > MOST_KEPT:
                self._kept.popitem(last=False)
        self._kept.move_to_end(key)
        return self._kept[key]

    def _read(self, path: str) -> QPixmap | None:
        reader = QImageReader(path)
        reader.setAutoTransform(True)  # photographs say in the file which side is up
        size = reader.size()
        if max(size.width(), size.height()) > LARGEST_SIDE:
            reader.setScaledSize(
                size.scaled(QSize(LARGEST_SIDE, LARGEST_SIDE), Qt.AspectRatioMode.KeepAspectRatio)
            )
        image = reader.read()
        return None if image.isNull() else QPixmap.fromImage(image)


class ReferenceItem(CanvasItem):
    """Lies between the paper and everything drawn; never exported, and hidden in the final look."""

    def draw(self, painter: QPainter, content: Content) -> None:
        reference = current_reference(self.canvas.session)
        if reference is None or content.options.final or reference.opacity == 0:
            return
        picture = self.canvas.references.picture(reference.path)
        if picture is None:
            return
        stage = content.document.stage
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        painter.setOpacity(reference.opacity)
        scale = min(stage.width / picture.width(), stage.height / picture.height())
        wide, high = picture.width() * scale, picture.height() * scale
        for paper in content.papers:
            place = paper.rect(stage)
            side, top = (stage.width - wide) / 2, (stage.height - high) / 2
            target = self.canvas.camera.transform().mapRect(place.adjusted(side, top, -side, -top))
            painter.drawPixmap(target, picture, QRectF(picture.rect()))


def current_reference(session: Session) -> Reference | None:
    """Return the reference picture at the playhead."""
    keyframe = reference_keyframe(session.layer, session.frame)
    return keyframe.reference if keyframe else None

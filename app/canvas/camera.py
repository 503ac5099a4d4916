"""Where the stage lies in the view: one scale, one shift."""

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSizeF
from PySide6.QtGui import QTransform

from core.geometry.outline import FloatArray

SMALLEST_SCALE, LARGEST_SCALE = 0.01, 200.0


@dataclass(frozen=True, slots=True)
class Camera:
    """view px = scale * stage px + (dx, dy)."""

    scale: float = 1.0
    dx: float = 0.0
    dy: float = 0.0

    def transform(self, offset: float = 0.0) -> QTransform:
        """Return the map from a paper, whose left edge lies at `offset` stage px, to the view."""
        return QTransform(self.scale, 0, 0, self.scale, self.dx + self.scale * offset, self.dy)

    def to_view(self, points: FloatArray, offset: float = 0.0) -> FloatArray:
        """Map stage points (..., 2) to view px."""
        return self.scale * (points + np.array([offset, 0.0])) + np.array([self.dx, self.dy])

    def to_stage(self, view: QPointF, offset: float = 0.0) -> tuple[float, float]:
        """Map a place in the view to stage px."""
        return (view.x() - self.dx) / self.scale - offset, (view.y() - self.dy) / self.scale

    def panned(self, dx: float, dy: float) -> "Camera":
        return Camera(self.scale, self.dx + dx, self.dy + dy)

    def zoomed(self, factor: float, at: QPointF) -> "Camera":
        """Zoom so that what lies under `at` stays there."""
        scale = min(max(self.scale * factor, SMALLEST_SCALE), LARGEST_SCALE)
        f = scale / self.scale
        return Camera(scale, at.x() + f * (self.dx - at.x()), at.y() + f * (self.dy - at.y()))


def fitted(area: QRectF, view: QSizeF, margin: float = 32.0) -> Camera:
    """Return the camera that shows `area` (stage px) as large as it fits, centred."""
    room_x, room_y = max(view.width() - 2 * margin, 20.0), max(view.height() - 2 * margin, 20.0)
    scale = min(room_x / max(area.width(), 1e-6), room_y / max(area.height(), 1e-6))
    scale = min(max(scale, SMALLEST_SCALE), LARGEST_SCALE)
    centre = area.center()
    return Camera(scale, view.width() / 2 - scale * centre.x(), view.height() / 2 - scale * centre.y())

"""From arrays of vertices to pixels: the canvas, thumbnails and the export all paint through here.

What QPainter spends on an outline grows with its vertices, and most of them lie closer together than the eye can
tell. So vertices are mapped to device px by numpy first, and thinned there.
"""

import math
from collections import OrderedDict
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt
import shiboken6
from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPainterPath, QPen, QPolygonF, QTransform

from core.errors import StorageError
from core.geometry.outline import FloatArray
from core.model.document import Document, Stage
from core.model.drawing import Color

if TYPE_CHECKING:  # solving brings scipy with it; a process that only paints need not wait for that
    from core.model.inbetweens import Picture
    from core.model.motion import HasMotions

Outlines = Sequence[tuple[FloatArray, bool]]
Background = Literal["stage"] | Color | None

RUN_LENGTH = 6.0
"""Device px; of a smooth outline one or two vertices are kept in a run, of a rugged one four."""
UNSEEN = 0.05
"""Device px; antialiasing has 256 steps a pixel, so less than this changes a pixel by 13 of 255 at most."""
ROUNDS = 2
"""Once is enough while something moves; then a spike still shows, and its foot is a little off."""
FEW_VERTICES = 64
"""Outlines as small as this are cheaper to paint than to look at."""
BEVELLED = (1.0, 6.0)
"""Device px; thinner strokes have no joints at all, and wider ones QPainter paints faster with round ones."""
DOT = (0.001, 0.0)
MOST_DOTS = 0.1
"""Share of the vertices; with more sharp corners, rounding every joint is as fast."""


def to_qcolor(color: Color) -> QColor:
    """Return the Qt colour of `#rrggbb` or `#rrggbbaa` (Qt itself reads eight digits as aarrggbb)."""
    return QColor(*bytes.fromhex(color[1:]))


def outlines_path(outlines: Outlines, transform: QTransform) -> QPainterPath:
    """Return one path of all outlines in the px that `transform` maps to, thinned, to be filled odd-even."""
    return _path(_thinned_outlines(outlines, transform))


def _thinned_outlines(outlines: Outlines, transform: QTransform) -> list[tuple[FloatArray, bool]]:
    return [(_thinned(_mapped(p, transform), closed=closed), closed) for p, closed in outlines if len(p)]


class Thinner:
    """Thins outlines, and remembers those that cannot change (read-only arrays) for the next picture.

    `rounds` may be set lower while pictures follow each other quickly.
    """

    def __init__(self, capacity: int = 64) -> None:
        self.rounds = ROUNDS
        self._capacity = capacity
        self._kept: OrderedDict[object, tuple[FloatArray, FloatArray]] = OrderedDict()

    def __call__(self, outlines: Outlines, transform: QTransform) -> list[tuple[FloatArray, bool]]:
        where = (
            transform.m11(),
            transform.m12(),
            transform.m21(),
            transform.m22(),
            transform.dx(),
            transform.dy(),
        )
        return [(self._thinned(p, closed, where, transform), closed) for p, closed in outlines if len(p)]

    def _thinned(self, points: FloatArray, closed: bool, where: object, transform: QTransform) -> FloatArray:
        if points.flags.writeable:
            return _thinned(_mapped(points, transform), closed=closed, rounds=self.rounds)
        key = (id(points), closed, where, self.rounds)
        found = self._kept.get(key)
        if found is None:
            # the array is kept too, so that no other one can take its id
            found = self._kept[key] = (
                points,
                _thinned(_mapped(points, transform), closed=closed, rounds=self.rounds),
            )
        self._kept.move_to_end(key)
        while len(self._kept) > self._capacity:
            self._kept.popitem(last=False)
        return found[1]


def _path(outlines: Outlines) -> QPainterPath:
    path = QPainterPath()
    path.setFillRule(Qt.FillRule.OddEvenFill)
    for points, closed in outlines:
        path.addPolygon(_polygon(points, closed=closed))
    return path


def _mapped(points: FloatArray, transform: QTransform) -> FloatArray:
    linear = np.array([[transform.m11(), transform.m12()], [transform.m21(), transform.m22()]])
    mapped: FloatArray = points @ linear
    mapped += (transform.dx(), transform.dy())
    return mapped


def _thinned(points: FloatArray, *, closed: bool, rounds: int = ROUNDS) -> FloatArray:
    """Drop vertices that cannot be seen.

    Of every run of `RUN_LENGTH` px its start stays, then `rounds` times whatever stands out farthest from the
    lines between those that stay. An edge longer than a run is a run of its own, so the corners of ordinary
    polygons stay.
    """
    n = len(points)
    if n <= FEW_VERTICES:
        return points
    x, y = np.ascontiguousarray(points[:, 0]), np.ascontiguousarray(points[:, 1])
    position = np.zeros(n)
    np.cumsum(np.hypot(np.diff(x), np.diff(y)), out=position[1:])
    run = np.floor(position * (1 / RUN_LENGTH))
    stays = np.ones(n, dtype=bool)
    np.not_equal(run[1:], run[:-1], out=stays[1:])
    stays[-1] = True
    for _ in range(rounds):
        starts = np.flatnonzero(stays)
        distance = _distance_to_chord(x, y, starts, closed=closed)
        farthest = np.maximum.reduceat(distance, starts)
        if farthest.max() <= UNSEEN**2:
            break
        farthest[farthest <= UNSEEN**2] = np.inf
        stays |= distance == np.repeat(farthest, np.diff(starts, append=n))
    kept: FloatArray = points[stays]
    return kept


def _distance_to_chord(x: FloatArray, y: FloatArray, starts: npt.NDArray[np.intp], *, closed: bool) -> FloatArray:
    """Return every vertex's squared distance from the line between its run's start and the next run's."""
    counts = np.diff(starts, append=len(x))
    ends = np.append(starts[1:], 0 if closed else len(x) - 1)
    cx, cy = x[ends] - x[starts], y[ends] - y[starts]
    square = cx * cx + cy * cy
    inverse = np.divide(1.0, square, out=np.zeros_like(square), where=square > 0)
    px, py = x - np.repeat(x[starts], counts), y - np.repeat(y[starts], counts)
    cx, cy = np.repeat(cx, counts), np.repeat(cy, counts)
    along = np.clip((px * cx + py * cy) * np.repeat(inverse, counts), 0.0, 1.0)
    px -= along * cx
    py -= along * cy
    distance: FloatArray = px * px + py * py
    return distance


def _polygon(points: FloatArray, *, closed: bool) -> QPolygonF:
    """Return a polygon filled through its memory, 80 times as fast as from a list of QPointF.

    A closed one ends where it begins: this is how QPainter knows that there is a joint and no cap.
    """
    n = len(points)
    polygon = QPolygonF()
    polygon.resize(n + closed)
    address = shiboken6.getCppPointer(polygon.data())[0]
    memory = np.frombuffer(shiboken6.VoidPtr(address, (n + closed) * 16, True), dtype=np.float64)
    memory[: 2 * n] = points.reshape(-1)
    if closed:
        memory[2 * n :] = points[0]
    return polygon


def paint_outlines(
    painter: QPainter,
    outlines: Outlines,
    *,
    fill: QColor | None,
    stroke: QColor | None,
    width: float,
    transform: QTransform | None = None,
    thin: Callable[[Outlines, QTransform], Outlines] | None = None,
) -> None:
    """Fill outlines odd-even, then stroke them `width` device px wide.

    `transform` maps the vertices to the px of the painter's untransformed surface; None takes the painter's own.
    `thin` is a `Thinner` that is kept from picture to picture.
    """
    painter.save()
    own = painter.deviceTransform()
    surface = _enter_device(painter)
    thinned = (thin or _thinned_outlines)(outlines, own if transform is None else transform * surface)
    path = _path(thinned)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    if fill is not None:
        painter.fillPath(path, fill)
    if stroke is not None and width > 0:
        _stroke(painter, path, thinned, QPen(stroke, width))
    painter.restore()


def _stroke(painter: QPainter, path: QPainterPath, outlines: Outlines, pen: QPen) -> None:
    """Stroke with round joints.

    QPainter takes half as long again to round a joint as to bevel it, and on a smooth outline there is no seeing
    which. So joints are bevelled, and the few where it shows get a dot: a line of next to no length, round caps.
    """
    pen.setCapStyle(Qt.PenCapStyle.RoundCap)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    if BEVELLED[0] < pen.widthF() <= BEVELLED[1] and sum(len(p) for p, _ in outlines) > FEW_VERTICES:
        corners = [_sharp_corners(p, pen.widthF(), closed=closed) for p, closed in outlines]
        if sum(map(len, corners)) < MOST_DOTS * sum(len(p) for p, _ in outlines):
            pen.setJoinStyle(Qt.PenJoinStyle.BevelJoin)
            for corner in np.concatenate(corners):
                path.addPolygon(_polygon(np.array([corner, corner + DOT]), closed=False))
    painter.strokePath(path, pen)


def _sharp_corners(points: FloatArray, width: float, *, closed: bool) -> FloatArray:
    """Return the vertices where a bevel would cut more than `UNSEEN` off a round joint."""
    if len(points) < 3:
        return points[:0]
    edges = np.diff(points, axis=0, append=points[:1])
    into = np.roll(edges, 1, axis=0)
    dot = (into * edges).sum(axis=1)
    length = np.sqrt((into * into).sum(axis=1) * (edges * edges).sum(axis=1))
    # the bevel leaves (1 - cos(turn / 2)) width / 2 of the round joint
    half_cosine = max(0.0, 1 - 2 * UNSEEN / width)
    sharp = dot < (2 * half_cosine**2 - 1) * length
    if not closed:
        sharp[[0, -1]] = False
    corners: FloatArray = points[sharp]
    return corners


def _enter_device(painter: QPainter) -> QTransform:
    """Make the painter paint in real device px; return the map from its untransformed surface to them.

    That map is more than nothing on a screen with more than one device px a point, and on a widget in a window.
    """
    painter.resetTransform()
    surface = painter.deviceTransform()
    if not surface.isIdentity():
        painter.setTransform(surface.inverted()[0])
    return surface


def paint_picture(painter: QPainter, picture: "Picture", transform: QTransform) -> None:
    """Paint what one layer shows in its own style; the stroke grows with `transform`.

    Where fill and stroke would show through each other they are painted in full on a picture of their own first.
    """
    if picture.opacity <= 0:
        return
    if picture.opacity < 1 and _overlaps_itself(picture):
        _paint_through(painter, picture, transform)
        return
    painter.save()
    painter.setOpacity(painter.opacity() * picture.opacity)
    _paint_shapes(painter, picture, transform)
    painter.restore()


def _overlaps_itself(picture: "Picture") -> bool:
    """Whether parts of a picture are painted on top of others."""
    style, lines = picture.style, sum(not closed for _, closed in picture.outlines)
    both = style.fill is not None and style.stroke is not None and style.width > 0
    return (both and lines < len(picture.outlines)) or (lines > 0 and len(picture.outlines) > 1)


def _paint_shapes(painter: QPainter, picture: "Picture", transform: QTransform) -> None:
    """Paint closed outlines with fill and stroke, and open ones as strokes: they have no inside."""
    style = picture.style
    width = style.width * _scale(transform) * painter.device().devicePixelRatio()
    fill = to_qcolor(style.fill) if style.fill else None
    stroke = to_qcolor(style.stroke) if style.stroke else None
    areas = [x for x in picture.outlines if x[1]]
    lines = [x for x in picture.outlines if not x[1]]
    if areas:
        paint_outlines(painter, areas, fill=fill, stroke=stroke, width=width, transform=transform)
    if lines:
        paint_outlines(painter, lines, fill=None, stroke=stroke or fill, width=width, transform=transform)


def _paint_through(painter: QPainter, picture: "Picture", transform: QTransform) -> None:
    """Paint a picture in full on a sheet of its own, no larger than needed, and that one thinly."""
    device = painter.device()
    room = painter.clipBoundingRect() if painter.hasClipping() else QRectF(painter.viewport())
    area = _covered(picture, transform).intersected(room).toAlignedRect()
    if area.isEmpty():
        return
    fine = isinstance(device, QImage) and device.format() == QImage.Format.Format_RGBA64_Premultiplied
    kind = QImage.Format.Format_RGBA64_Premultiplied if fine else QImage.Format.Format_ARGB32_Premultiplied
    sheet = QImage(area.size() * device.devicePixelRatio(), kind)
    sheet.setDevicePixelRatio(device.devicePixelRatio())
    sheet.fill(Qt.GlobalColor.transparent)
    inner = QPainter(sheet)
    try:
        _paint_shapes(inner, picture, transform * QTransform.fromTranslate(-area.x(), -area.y()))
    finally:
        inner.end()
    painter.save()
    painter.setOpacity(painter.opacity() * picture.opacity)
    painter.drawImage(area.topLeft(), sheet)
    painter.restore()


def _covered(picture: "Picture", transform: QTransform) -> QRectF:
    """Return a rectangle around everything that is painted of a picture."""
    points = _mapped(np.concatenate([p for p, _ in picture.outlines]), transform)
    (left, top), (right, bottom) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    reach = picture.style.width * _scale(transform) / 2 + 2
    return QRectF(left, top, right - left, bottom - top).adjusted(-reach, -reach, reach, reach)


def _scale(transform: QTransform) -> float:
    return math.sqrt(abs(transform.determinant()))


def paint_frame(painter: QPainter, pictures: "Iterable[Picture]", transform: QTransform) -> None:
    """Paint the layers of a frame, from the back to the front."""
    for picture in pictures:
        paint_picture(painter, picture, transform)


def stage_transform(stage: Stage, size: QSize) -> QTransform:
    """Return the map that fits the stage into a picture of `size`, undistorted and in its middle."""
    scale = min(size.width() / stage.width, size.height() / stage.height)
    left = (size.width() - stage.width * scale) / 2
    top = (size.height() - stage.height * scale) / 2
    return QTransform(scale, 0.0, 0.0, scale, left, top)


def render_frame(
    document: Document,
    frame: float,
    size: QSize,
    plans: "HasMotions",
    *,
    background: Background = "stage",
    format: QImage.Format = QImage.Format.Format_ARGB32_Premultiplied,
) -> QImage:
    """Return the picture of a frame; see `render_pictures`."""
    from core.model.motion import pictures_at

    color = document.stage.background if background == "stage" else background
    return render_pictures(pictures_at(document, frame, plans), document.stage, size, color, format=format)


def render_pictures(
    pictures: "Iterable[Picture]",
    stage: Stage,
    size: QSize,
    background: Color | None,
    *,
    format: QImage.Format = QImage.Format.Format_ARGB32_Premultiplied,
) -> QImage:
    """Return the picture of what the layers show.

    Drawings are cut off at the edges of the stage; where `size` has another shape, the margins get
    the background. `format` is any that QPainter paints on.

    Raises
    ------
    StorageError
        If a picture of that size does not fit into memory.
    """
    image = QImage(size, format)
    if image.isNull():
        raise StorageError(f"no memory for a picture of {size.width()} x {size.height()} px; choose a smaller one")
    image.fill(to_qcolor(background) if background else Qt.GlobalColor.transparent)
    transform = stage_transform(stage, size)
    painter = QPainter(image)
    try:
        painter.setClipRect(transform.mapRect(QRectF(0, 0, stage.width, stage.height)))
        paint_frame(painter, pictures, transform)
    finally:
        painter.end()  # an image that dies under an active painter takes the program with it
    return image

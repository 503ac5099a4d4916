import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPainterPath, QTransform

from app import painting
from app.painting import outlines_path, paint_outlines, paint_picture, render_frame, stage_transform, to_qcolor
from core.errors import StorageError
from core.model.document import Stage
from core.model.drawing import Style
from core.model.inbetweens import Picture
from core.model.motion import PlanCache
from tests.app.sketches import film, ring, square

IDENTITY = QTransform()
BLACK, WHITE = QColor("black"), QColor("white")


def blank(width=640, height=480, color=WHITE):
    image = QImage(width, height, QImage.Format.Format_ARGB32_Premultiplied)
    image.fill(color)
    return image


def pixels(image):
    """Return the (height, width, 4) straight channels red, green, blue, alpha."""
    straight = image.convertToFormat(QImage.Format.Format_RGBA8888)
    rows = np.frombuffer(straight.constBits(), np.uint8).reshape(straight.height(), straight.bytesPerLine())
    return rows[:, : 4 * straight.width()].reshape(straight.height(), straight.width(), 4).astype(int)


def painted(outlines, *, fill=BLACK, stroke=None, width=1.0, transform=IDENTITY):
    image = blank()
    painter = QPainter(image)
    paint_outlines(painter, outlines, fill=fill, stroke=stroke, width=width, transform=transform)
    painter.end()
    return pixels(image)


def drawn_by_qt(points, *, stroke, width):
    """Return what QPainter makes of every single vertex."""
    path = QPainterPath()
    path.moveTo(*points[0])
    for x, y in points[1:]:
        path.lineTo(x, y)
    path.closeSubpath()
    image = blank()
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.fillPath(path, BLACK)
    pen = painter.pen()
    pen.setColor(stroke)
    pen.setWidthF(width)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    painter.strokePath(path, pen)
    painter.end()
    return pixels(image)


def vertices(path):
    return np.array([(path.elementAt(i).x, path.elementAt(i).y) for i in range(path.elementCount())])


@pytest.mark.parametrize(
    ("color", "channels"),
    [("#102030", (16, 32, 48, 255)), ("#10203040", (16, 32, 48, 64)), ("#00000000", (0, 0, 0, 0))],
)
def test_eight_digits_end_with_alpha(color, channels):
    assert to_qcolor(color).getRgb() == channels


def test_a_small_outline_keeps_every_vertex_to_the_last_bit():
    points = ring(painting.FEW_VERTICES, radius=3.0)
    assert np.array_equal(vertices(outlines_path([(points, True)], IDENTITY)), np.vstack([points, points[:1]]))


def test_long_edges_keep_every_vertex_however_many():
    points = ring(200, radius=2000.0)
    assert np.array_equal(vertices(outlines_path([(points, False)], IDENTITY)), points)


@pytest.mark.parametrize("count", [1_000, 10_000, 50_000])
def test_at_most_a_vertex_per_one_and_a_half_px_of_a_smooth_outline(count):
    points = ring(count)
    perimeter = np.hypot(*np.diff(points, axis=0, append=points[:1]).T).sum()
    assert outlines_path([(points, True)], IDENTITY).elementCount() <= perimeter / 1.5


@pytest.mark.parametrize("width", [1.0, 2.2, 8.0])
@pytest.mark.parametrize("count", [1_000, 10_000])
def test_a_thinned_outline_looks_as_if_every_vertex_were_drawn(count, width):
    points = ring(count)
    difference = np.abs(
        painted([(points, True)], stroke=QColor("#c04020"), width=width)
        - drawn_by_qt(points, stroke=QColor("#c04020"), width=width)
    ).max(axis=2)
    # QPainter itself rounds to 1/64 px, at every vertex: on a hairline of 10,000 it adds up to a few pixels
    assert difference.mean() < 0.25
    assert (difference > 48).mean() < 1e-4


@pytest.mark.parametrize("width", [4.0, 6.0, 20.0])
@pytest.mark.parametrize("closed", [True, False])
def test_corners_of_an_outline_of_many_vertices_are_round(closed, width):
    corners = square(100, 100, 200)
    sides = zip(corners, np.roll(corners, -1, axis=0), strict=True)
    points = np.concatenate([np.linspace(a, b, 50, endpoint=False) for a, b in sides])
    ends = corners if closed else np.vstack([corners, points[-1:]])
    dense = painted([(points, closed)], fill=None, stroke=BLACK, width=width)
    plain = painted([(ends, closed)], fill=None, stroke=BLACK, width=width)
    for x, y in corners.astype(int):
        near = np.s_[y - 15 : y + 15, x - 15 : x + 15, 0]
        missing = (dense[near] - plain[near]).sum() / 255
        assert abs(missing) < 0.14 * (width / 2) ** 2  # px; a bevel would lack twice that


@given(
    st.integers(65, 600),
    st.floats(0.01, 30),
    st.floats(0, 0.6),
    st.booleans(),
    st.integers(0, 2**32 - 1),
)
def test_thinning_leaves_out_only_what_lies_within_a_run_of_the_outline(count, radius, noise, closed, seed):
    points = ring(count, radius=radius) + np.random.default_rng(seed).normal(0, noise, (count, 2))
    kept = vertices(outlines_path([(points, closed)], IDENTITY))
    assert {tuple(p) for p in kept} <= {tuple(p) for p in points}
    assert np.array_equal(kept[0], points[0])
    assert np.array_equal(kept[-1], points[0] if closed else points[-1])
    distance = np.hypot(*(points[:, None] - kept[None]).transpose(2, 0, 1)).min(axis=1)
    assert distance.max() <= painting.RUN_LENGTH


def test_a_spike_thinner_than_a_pixel_is_not_lost():
    points = ring(2_000, depth=0.0)
    points[700] += 25 * (points[700] - points.mean(axis=0)) / 200
    kept = vertices(outlines_path([(points, True)], IDENTITY))
    assert (kept == points[700]).all(axis=1).any()


def test_ten_thousand_vertices_in_one_point_leave_two():
    points = np.full((10_000, 2), 7.0)
    assert outlines_path([(points, True)], IDENTITY).elementCount() <= 3


def test_outlines_fill_even_odd_so_a_hole_in_either_direction_is_a_hole():
    outer, hole = square(100, 100, 200), square(150, 150, 100)
    for inner in (hole, hole[::-1]):
        picture = painted([(outer, True), (inner, True)])
        assert (picture[155:245, 155:245, :3] == 255).all()
        assert (picture[105:145, 105:295, :3] == 0).all()


def test_closed_outlines_join_and_open_ones_do_not():
    points = square(100, 100, 200)
    closed = painted([(points, True)], fill=None, stroke=BLACK, width=6.0)
    opened = painted([(points, False)], fill=None, stroke=BLACK, width=6.0)
    assert (closed[200, 97:103, 0] == 0).all()  # the edge back to the start
    assert (opened[200, 97:103, 0] == 255).all()


def test_no_outline_and_no_colour_paint_nothing():
    assert (painted([]) == 255).all()
    assert (painted([(square(10, 10, 50), True)], fill=None, stroke=None) == 255).all()
    assert (painted([(square(10, 10, 50), True)], fill=None, stroke=BLACK, width=0.0) == 255).all()


def test_the_painters_own_transform_places_outlines_and_not_the_stroke_width():
    image = blank()
    painter = QPainter(image)
    painter.translate(50, 20)
    painter.scale(10, 10)
    paint_outlines(painter, [(square(1, 1, 10), True)], fill=None, stroke=BLACK, width=2.0)
    assert painter.transform() == QTransform(10, 0, 0, 10, 50, 20)
    painter.end()
    expected = painted([(square(60, 30, 100), True)], fill=None, stroke=BLACK, width=2.0)
    assert np.array_equal(pixels(image), expected)


def test_a_screen_with_two_device_px_a_point_gets_twice_the_detail():
    dense = blank(1280, 960)
    dense.setDevicePixelRatio(2.0)
    style = Style("#000000", "#ff0000", 3.0)
    picture = Picture(((square(50, 60, 100), True),), style)
    painter = QPainter(dense)
    paint_picture(painter, picture, IDENTITY)
    painter.end()
    plain = blank(1280, 960)
    painter = QPainter(plain)
    paint_picture(painter, picture, QTransform.fromScale(2, 2))
    painter.end()
    dense.setDevicePixelRatio(1.0)
    assert np.array_equal(pixels(dense), pixels(plain))


def test_the_stroke_of_a_picture_grows_with_the_transform():
    picture = Picture(((square(20, 20, 40), True),), Style(None, "#000000", 3.0))
    image = blank()
    painter = QPainter(image)
    paint_picture(painter, picture, QTransform.fromScale(4, 4))
    painter.end()
    assert np.array_equal(
        pixels(image), painted([(square(80, 80, 160), True)], fill=None, stroke=BLACK, width=12.0)
    )


def seen(picture, transform=IDENTITY, kind=QImage.Format.Format_ARGB32_Premultiplied):
    """The pixels of a picture on nothing."""
    image = QImage(640, 480, kind)
    image.fill(Qt.GlobalColor.transparent)
    painter = QPainter(image)
    paint_picture(painter, picture, transform)
    painter.end()
    return pixels(image)


@pytest.mark.parametrize(
    "kind", [QImage.Format.Format_ARGB32_Premultiplied, QImage.Format.Format_RGBA64_Premultiplied]
)
def test_a_thin_picture_is_the_full_one_with_less_alpha_and_its_fill_does_not_shine_through(kind):
    shape = ((square(20, 20, 40), True), (square(100, 20, 40), True))
    style = Style("#ff0000", "#0000ff", 12.0)
    full = seen(Picture(shape, style), QTransform.fromScale(1.5, 1.5), kind)
    thin = seen(Picture(shape, style, 0.5), QTransform.fromScale(1.5, 1.5), kind)
    assert np.abs(thin[..., 3] - full[..., 3] / 2).max() <= 1
    solid = full[..., 3] == 255
    assert np.abs(thin[solid] - full[solid])[:, :3].max() <= 1
    assert {tuple(p) for p in full[solid][:, :3]} >= {(255, 0, 0), (0, 0, 255)}
    assert not seen(Picture(shape, style, 0.0)).any()


def test_an_open_outline_is_a_stroke_with_round_ends_and_never_filled():
    bent = np.array([(100.0, 100.0), (200.0, 100.0), (200.0, 200.0)])
    line = seen(Picture(((bent, False),), Style("#ff0000", None, 20.0)))
    assert tuple(line[100, 150]) == (255, 0, 0, 255)  # in the fill's colour where there is no other
    assert line[140, 160, 3] == 0
    assert line[100, 92, 3] == 255
    assert line[91, 91, 3] == 0
    stroked = seen(Picture(((bent, False),), Style("#ff0000", "#00ff00", 20.0)))
    assert {tuple(p) for p in stroked[stroked[..., 3] == 255]} == {(0, 255, 0, 255)}


@pytest.mark.parametrize(
    ("size", "corner", "opposite"),
    [((100, 50), (0, 0), (100, 50)), ((400, 100), (100, 0), (300, 100)), ((50, 100), (0, 37.5), (50, 62.5))],
)
def test_the_stage_is_fitted_undistorted_and_centred(size, corner, opposite):
    transform = stage_transform(Stage(200, 100), QSize(*size))
    assert transform.map(0.0, 0.0) == pytest.approx(corner)
    assert transform.map(200.0, 100.0) == pytest.approx(opposite)


def test_a_frame_shows_the_in_between_over_the_stages_background():
    document = film(length=3, fill="#ff0000", background="#00ff00")
    picture = pixels(render_frame(document, 2, QSize(64, 48), PlanCache()))
    assert tuple(picture[12, 22]) == (255, 0, 0, 255)  # half way: the square reaches from 20 to 40
    assert tuple(picture[20, 30]) == (0, 255, 0, 255)  # the hole
    assert tuple(picture[12, 18]) == (0, 255, 0, 255)
    red = (picture[..., 0] == 255).sum()
    assert red == 20 * 20 - 10 * 10


def test_drawings_end_at_the_edge_of_the_stage_and_not_in_the_margin():
    document = film(length=2, fill="#000000", side=200.0)
    picture = pixels(render_frame(document, 1, QSize(164, 48), PlanCache()))
    assert (picture[..., 3][:, :50] == 0).all()
    assert (picture[..., 3][:, 114:] == 0).all()
    assert (picture[..., 3][12:, 62:114] == 255).any()


@pytest.mark.parametrize(
    ("background", "expected"),
    [("stage", (1, 2, 3, 255)), (None, (0, 0, 0, 0)), ("#0a0b0c", (10, 11, 12, 255))],
)
def test_the_background_is_the_stages_or_none_or_chosen(background, expected):
    document = film(background="#010203")
    picture = pixels(render_frame(document, 1, QSize(64, 48), PlanCache(), background=background))
    assert tuple(picture[0, 0]) == expected


def test_a_picture_too_large_for_memory_is_refused_in_one_sentence():
    with pytest.raises(StorageError, match=r"no memory for a picture of 300000 x 300000 px"):
        render_frame(film(), 1, QSize(300_000, 300_000), PlanCache())

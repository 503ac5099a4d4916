"""Lottie shape layers become layers with keyframes; what does not is named."""

import json
import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.errors import FileFormatError, InkbetweenError, StorageError
from core.geometry.outline import signed_area
from core.io.film import film_document, import_film
from core.io.lottie import read_lottie
from core.model.document import Document, Stage
from core.model.easing import Easing
from core.model.motion import PlanCache, picture_at

FLAT = {"a": 0, "k": 0}
SQUARE = [[10, 10], [50, 10], [50, 50], [10, 50]]


def shape(points, *, closed=True, into=None, out=None):
    zero = [[0, 0]] * len(points)
    return {"i": into or zero, "o": out or zero, "v": points, "c": closed}


def still(value):
    return {"a": 0, "k": value}


def moving(*keys, **easing):
    """`keys` are (time, value); the last one has no way on."""
    handles = {"o": {"x": [0.3], "y": [0]}, "i": {"x": [0.7], "y": [1]}} | easing
    found = [{"t": t, "s": [v] if isinstance(v, dict) else v, **handles} for t, v in keys]
    return {"a": 1, "k": found}


def path(ks):
    return {"ty": "sh", "ks": ks}


def fill(color=(1, 0, 0), opacity=100):
    return {"ty": "fl", "c": still([*color, 1]), "o": still(opacity), "r": 2}


def stroke(width=3):
    return {"ty": "st", "c": still([0, 0, 1, 1]), "o": still(100), "w": still(width)}


def group(*items, **transform):
    return {"ty": "gr", "it": [*items, {"ty": "tr", **placing(**transform)}]}


def placing(p=(0, 0), a=(0, 0), s=(100, 100), r=0, o=100):
    found = {"p": p, "a": a, "s": s, "r": r, "o": o}
    return {
        n: v if isinstance(v, dict) else still(list(v) if isinstance(v, tuple) else v) for n, v in found.items()
    }


def layer(*shapes, start=0, end=24, name="leg", **more):
    head = {"ty": 4, "nm": name, "ip": start, "op": end, "st": 0, "ks": placing()}
    return {**head, "shapes": list(shapes), **more}


def lottie(*layers, length=24, size=(100, 80), rate=24):
    """The layers from the front to the back."""
    whole = {"v": "5.7.0", "fr": rate, "ip": 0, "op": length, "w": size[0], "h": size[1], "layers": list(layers)}
    return json.dumps(whole).encode()


def points_of(film, index=0, key=0, outline=0):
    return film.layers[index].keyframes[key].drawing.outlines[outline].points


def test_a_still_path_is_a_keyframe_with_its_style():
    film = read_lottie(lottie(layer(group(path(still(shape(SQUARE))), fill((0.5, 0, 1), 50), stroke(6)))))
    (only,) = film.layers
    (keyframe,) = only.keyframes
    assert (only.name, keyframe.frame, film.length, film.rate, film.size) == (
        "leg",
        1,
        24,
        Fraction(24),
        (100, 80),
    )
    assert np.array_equal(points_of(film), SQUARE)
    style = keyframe.drawing.style
    assert (style.fill, style.stroke, style.width) == ("#8000ff80", "#0000ff", 6.0)
    assert film.left_out == ()


def test_keyframes_of_a_path_are_keyframes_with_its_easing_vertex_to_vertex():
    after = [[x + 30, y] for x, y in SQUARE]
    ks = moving((0, shape(SQUARE)), (12, shape(after)))
    document = film_document(read_lottie(lottie(layer(group(path(ks), fill())))))
    keyframes = document.layers[0].keyframes
    assert [k.frame for k in keyframes] == [1, 13]
    span = keyframes[0].span
    assert (span.method, span.easing) == ("linear", Easing(0.3, 0, 0.7, 1))
    middle = picture_at(document, document.layers[0], 7, PlanCache()).outlines[0][0]
    assert np.abs(middle - (np.add(SQUARE, (15, 0)))).max() < 1e-9


def test_curves_keep_their_vertices_from_keyframe_to_keyframe():
    handle = [[0, -20], [0, 0], [0, 0], [0, 0]]
    flat, bent = shape(SQUARE), shape(SQUARE, out=handle)
    film = read_lottie(lottie(layer(group(path(moving((0, flat), (10, bent))), fill()))))
    first, last = (points_of(film, key=i) for i in (0, 1))
    assert len(first) == len(last) > 4
    assert abs(signed_area(first)) == pytest.approx(1600)
    assert abs(signed_area(last)) > 1650


@pytest.mark.parametrize(
    ("item", "area"),
    [
        ({"ty": "el", "p": still([50, 40]), "s": still([40, 20])}, math.pi * 20 * 10),
        ({"ty": "rc", "p": still([50, 40]), "s": still([40, 20]), "r": still(0)}, 800),
        ({"ty": "rc", "p": still([50, 40]), "s": still([40, 20]), "r": still(5)}, 800 - (4 - math.pi) * 25),
    ],
)
def test_ellipses_and_rectangles_have_their_area_and_middle(item, area):
    film = read_lottie(lottie(layer(group(item, fill()))))
    points = points_of(film)
    assert abs(signed_area(points)) == pytest.approx(area, rel=0.02)
    assert np.allclose((points.min(axis=0) + points.max(axis=0)) / 2, (50, 40), atol=0.3)


def test_transforms_of_groups_layers_and_their_leaders_add_up():
    inner = group(path(still(shape(SQUARE))), fill(), stroke(2), p=(5, 0), s=(200, 200))
    leader = {"ty": 3, "ind": 7, "nm": "n", "ip": 0, "op": 24, "st": 0, "ks": placing(p=(0, 100), r=90)}
    film = read_lottie(lottie(layer(inner, parent=7), leader))
    turned = np.array([[-(2 * y), 2 * x + 5 + 100] for x, y in SQUARE])
    assert np.allclose(points_of(film), turned, atol=1e-9)
    assert film.layers[0].keyframes[0].drawing.style.width == pytest.approx(4)
    assert film.left_out == ()


def test_what_turns_has_a_keyframe_in_every_frame():
    ks = placing(p=(50, 40), a=(30, 30), r=moving((0, [0]), (8, [90])))
    film = read_lottie(lottie(layer(group(path(still(shape(SQUARE))), fill()), ks=ks)))
    keyframes = film.layers[0].keyframes
    assert [k.frame for k in keyframes] == list(range(1, 10))
    for keyframe in keyframes:
        points = keyframe.drawing.outlines[0].points
        assert abs(signed_area(points)) == pytest.approx(1600)
        assert np.allclose(points.mean(axis=0), (50, 40))


def test_the_layer_in_front_stays_in_front_and_groups_keep_their_order():
    red, blue = (group(path(still(shape(SQUARE))), fill(c)) for c in ((1, 0, 0), (0, 0, 1)))
    film = read_lottie(lottie(layer(red, blue, name="front"), layer(blue, name="back")))
    found = [(x.name, x.keyframes[0].drawing.style.fill) for x in film.layers]
    assert found == [("back", "#0000ff"), ("front", "#0000ff"), ("front", "#ff0000")]


def test_holes_are_outlines_of_one_drawing():
    hole = [[20, 20], [40, 20], [40, 40], [20, 40]]
    film = read_lottie(lottie(layer(group(path(still(shape(SQUARE))), path(still(shape(hole))), fill()))))
    assert len(film.layers) == 1
    assert len(film.layers[0].keyframes[0].drawing.outlines) == 2


def test_a_layer_that_comes_and_goes_is_empty_before_and_after():
    film = read_lottie(lottie(layer(group(path(still(shape(SQUARE))), fill()), start=4, end=10)))
    document = film_document(film)
    plans = PlanCache()
    seen = [picture_at(document, document.layers[0], f, plans) for f in range(1, 25)]
    shown = [f for f, p in enumerate(seen, start=1) if p is not None and p.outlines]
    assert shown == list(range(5, 11))


def test_a_colour_over_the_whole_picture_at_the_back_is_the_background():
    solid = {
        "ty": 1,
        "nm": "b",
        "ip": 0,
        "op": 24,
        "st": 0,
        "ks": placing(o=50),
        "sw": 100,
        "sh": 80,
        "sc": "#00FF00",
    }
    film = read_lottie(lottie(layer(group(path(still(shape(SQUARE))), fill())), solid))
    assert film.background == "#00ff0080"
    assert film_document(film).stage == Stage(100, 80, "#00ff0080")


def test_what_is_left_out_is_named():
    text = {"ty": 5, "nm": "t", "ip": 0, "op": 24, "ks": placing()}
    picture = {"ty": 2, "nm": "p", "ip": 0, "op": 24, "ks": placing()}
    trimmed = group(path(still(shape(SQUARE))), {"ty": "tm"}, fill())
    film = read_lottie(lottie(layer(trimmed, masksProperties=[{}]), text, picture, picture))
    assert set(film.left_out) == {"a text", "2 pictures", "a trimmed path", "a mask (its parts are shown whole)"}


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"", "it is no Lottie animation, or it is damaged"),
        (b"[1, 2]", "it is no Lottie animation"),
        (b'{"layers": [], "fr": 24, "op": 24, "w": 9, "h": 9}', "there is no shape in it that could be drawn"),
        (b'{"layers": [7], "fr": 24, "op": 24, "w": 9, "h": 9}', "it is no Lottie animation, or it is damaged"),
        (b'{"layers": [], "fr": 24, "op": 1e9, "w": 9, "h": 9}', "it has 1000000000 frames"),
        (b'{"layers": [], "fr": "x", "op": 24, "w": 9, "h": 9}', ""),
        (b"[" * 100_000, "it is no Lottie animation, or it is damaged"),
    ],
)
def test_what_is_no_animation_is_one_sentence(content, sentence, tmp_path):
    file = tmp_path / "a.json"
    file.write_bytes(content)
    with pytest.raises(FileFormatError, match=f"^cannot import a.json: {sentence}") as told:
        read_lottie(file)
    assert "\n" not in str(told.value)


def test_a_missing_file_is_one_sentence(tmp_path):
    with pytest.raises(StorageError, match=r"^cannot read .*none\.json: no such file"):
        read_lottie(tmp_path / "none.json")


def test_it_is_put_in_the_middle_of_the_stage_from_the_playhead_on():
    film = read_lottie(lottie(layer(group(path(still(shape(SQUARE))), fill()))))
    document = import_film(Document(Stage(200, 80), length=10), film, 5)
    assert [x.name for x in document.layers] == ["Layer 1", "leg"]
    (keyframe,) = document.layers[1].keyframes
    assert keyframe.frame == 5
    assert np.array_equal(keyframe.drawing.outlines[0].points, np.add(SQUARE, (50, 0)))
    assert document.length == 28


JSON = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-5, 30)
    | st.floats()
    | st.sampled_from(["sh", "gr", "fl", "tr", "el"]),
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(
            st.sampled_from(["ty", "ks", "k", "t", "s", "it", "v", "i", "o", "c", "p", "a", "r"]), inner
        )
    ),
    max_leaves=20,
)


@given(JSON, JSON)
def test_nothing_in_a_file_ends_in_another_error(shapes, ks):
    inside = {"ty": 4, "nm": "a", "ip": 0, "op": 9, "ks": ks, "shapes": shapes}
    for made in (inside, layer(group(path(ks), fill())), layer({"ty": "gr", "it": shapes})):
        body = json.dumps({"fr": 24, "op": 24, "w": 10, "h": 10, "layers": [made]}).replace("NaN", "0")
        try:
            film_document(read_lottie(body.replace("-Infinity", "0").replace("Infinity", "0").encode()))
        except InkbetweenError:
            continue

"""Files that want to fill the memory or the time: refused, with the place, before they can."""

import json
from pathlib import Path

import pytest

from core.errors import FileFormatError
from core.io.format import LIMITS, MOST_OBJECTS
from core.io.project import decode, encode
from core.model.document import Document, Keyframe, Layer
from core.model.drawing import Drawing, Outline
from tests.core.io.films import everything_of_version_2

HERE = "layers[1].keyframes[0]"
EVERYTHING = json.loads(encode(everything_of_version_2()))


def with_limit(monkeypatch, what, most):
    monkeypatch.setitem(LIMITS, what, most)


def counted(value, key):
    """How many things of a kind stand in a JSON value, in the order of reading."""
    if isinstance(value, list):
        return sum(counted(v, key) for v in value)
    if not isinstance(value, dict):
        return 0
    own = value.get(key)
    return (len(own) if isinstance(own, list) else 0) + sum(counted(v, key) for v in value.values())


@pytest.mark.parametrize(
    ("what", "key", "where"),
    [
        ("vertices", "points", "layers[2].keyframes[0].drawing.outlines[0].points"),
        ("outlines", "outlines", "layers[2].keyframes[0].drawing.outlines"),
        ("keyframes", "keyframes", "layers[2].keyframes"),
        ("layers", "layers", "layers"),
    ],
)
def test_exactly_as_much_as_the_limit_opens_and_one_more_is_refused_with_its_place(monkeypatch, what, key, where):
    content, there = encode(everything_of_version_2()), counted(EVERYTHING, key)
    with_limit(monkeypatch, what, there)
    assert decode(content) == everything_of_version_2()
    with_limit(monkeypatch, what, there - 1)
    with pytest.raises(FileFormatError) as error:
        decode(content)
    assert str(error.value) == f"more than {there - 1} {what} in all; a project holds no more - at `$.{where}`"


@pytest.mark.parametrize(
    ("what", "most", "where"),
    [
        ("anchors", 2, f"{HERE}.span.pairs[0].anchors"),
        ("anchors", 3, f"{HERE}.span.pairs[1].anchors"),
        ("knots", 1, f"{HERE}.span.knots"),
        ("exposures", 2, f"{HERE}.span.exposures"),
        ("positions", 2, f"{HERE}.span.pairs[0].correspondence.before"),
    ],
)
def test_lists_inside_pairs_are_counted_too(monkeypatch, what, most, where):
    content = encode(everything_of_version_2())
    with_limit(monkeypatch, what, most)
    with pytest.raises(FileFormatError, match=f"more than {most} {what}") as error:
        decode(content)
    assert f"`$.{where}`" in str(error.value)


def test_what_could_not_be_read_again_is_not_written(monkeypatch):
    document = everything_of_version_2()
    for what in ("vertices", "outlines", "keyframes", "layers", "anchors", "positions", "knots", "exposures"):
        with monkeypatch.context() as small:
            with_limit(small, what, 1)
            with pytest.raises(FileFormatError, match=f"more than 1 {what} in all"):
                encode(document)


@pytest.mark.parametrize(
    "part",
    [b"{},", b'{"before":1,"after":1},', b'{"id":1,"name":"","visible":true,"keyframes":[]},'],
)
def test_more_parts_than_any_project_has_are_refused_at_once(part):
    with pytest.raises(FileFormatError, match="more than 500,000 parts"):
        decode(b'{"format":"inkbetween","version":2,"layers":[' + part * (MOST_OBJECTS + 1))


def test_ten_thousand_outlines_with_pairs_and_one_id_twice_are_told_in_a_moment():
    outlines = [{"id": i + 1, "closed": False, "points": [[0, 0], [1, i]]} for i in range(10_000)]
    pairs = [{"before": i + 1, "after": i + 1} for i in range(10_000)]
    keyframe = EVERYTHING["layers"][2]["keyframes"][0]
    first = {**keyframe, "frame": 1, "drawing": {**keyframe["drawing"], "outlines": outlines}}
    first["span"] = {**keyframe["span"], "pairs": pairs}
    last = {**keyframe, "frame": 2, "drawing": {**keyframe["drawing"], "outlines": outlines}}
    film = {**EVERYTHING, "layers": [{"id": 1, "name": "", "visible": True, "keyframes": [first, last]}]}
    assert len(decode(json.dumps(film).encode()).layers[0].keyframes[0].span.pairs) == 10_000
    outlines[-1]["id"] = 9_999
    with pytest.raises(FileFormatError, match="two outlines of one drawing have the id 9999"):
        decode(json.dumps(film).encode())


@pytest.mark.parametrize("number", ["1e999", "-1e999", "1" * 5000])
def test_numbers_too_large_are_refused_with_their_place(number):
    content = encode(everything_of_version_2()).replace(b"[0.5,0.0]", f"[{number},0.0]".encode())
    with pytest.raises(FileFormatError) as error:
        decode(content)
    assert f"`$.{HERE}.drawing.outlines[0]" in str(error.value)


@pytest.mark.parametrize("number", ["1e-9999999999", "0." + "1" * 100_000, "0e999"])
def test_numbers_with_more_digits_than_count_are_rounded(number):
    content = encode(everything_of_version_2()).replace(b"[0.5,0.0]", f"[{number},0.0]".encode())
    first = decode(content).layers[1].keyframes[0].drawing.outlines[0].points[0]
    assert first[0] == float(number)


def test_more_muted_anchors_than_there_are_is_refused_before_they_are_read():
    content = encode(everything_of_version_2()).replace(b'"muted":[0,2]', b'"muted":[' + b"0," * 10_000 + b"0]")
    with pytest.raises(FileFormatError, match=r"there are 3 anchors; more are muted - at .*pairs\[0\].muted`"):
        decode(content)


@pytest.mark.parametrize(
    "place", [b"[[0.5,0.0]", b'"knots":[', b'"exposures":[', b'"anchors":[', b'"muted":[', b'"before":[0.0']
)
def test_deep_lists_are_refused_wherever_they_stand(place):
    content = encode(everything_of_version_2()).replace(place, place + b"," + b"[" * 100_000, 1)
    with pytest.raises(FileFormatError):
        decode(content)


def test_a_document_of_200_000_vertices_comes_back_equal():
    ring = Outline(1, [(i, i * i % 7919) for i in range(100_000)])
    keyframes = (Keyframe(1, Drawing((ring,))), Keyframe(9, Drawing((ring,))))
    document = Document(layers=(Layer(1, keyframes=keyframes),))
    assert decode(encode(document)) == document


def test_an_unknown_field_cannot_make_more_than_one_short_line_of_a_message():
    content = encode(everything_of_version_2()).replace(b'"turns"', b'"' + b"\\n" * 10_000 + b'"', 1)
    with pytest.raises(FileFormatError, match="unknown field") as error:
        decode(content)
    assert len(str(error.value)) < 500
    assert str(error.value).isprintable()


# the schema

ROOT = Path(__file__).resolve().parents[3]


def test_the_schema_is_up_to_date():
    from importlib.util import module_from_spec, spec_from_file_location

    spec = spec_from_file_location("make_schema", ROOT / "docs" / "make_schema.py")
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    kept = (ROOT / "docs" / "file-format.schema.json").read_text(encoding="utf-8")
    assert kept == module.schema(), "run docs/make_schema.py"

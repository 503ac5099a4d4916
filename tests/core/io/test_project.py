import errno
import json
import os
import stat
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.correspondence.pairing import Correspondence
from core.errors import DocumentError, FileFormatError, InkbetweenError, StorageError
from core.io.project import LARGEST_FILE, decode, encode, load, save
from core.methods.plan import METHODS
from core.model.document import PLACEMENTS, Anchor, Document, Keyframe, Layer, OutlinePair, Reference, Span, Stage
from core.model.drawing import Drawing, Outline, Style
from core.model.easing import PRESETS, Easing, Knot, through

DATA = Path(__file__).resolve().parents[2] / "data"

COORDINATE = st.floats(-1e9, 1e9, allow_subnormal=False)
POINT = st.tuples(COORDINATE, COORDINATE)
RATIO = st.floats(0, 1)
COLOR = st.none() | st.from_regex(r"#[0-9a-f]{6}([0-9a-f]{2})?", fullmatch=True)
STYLE = st.builds(Style, COLOR, COLOR, st.floats(0, 10_000), RATIO)
EASING = st.one_of(
    st.builds(Easing, RATIO, st.floats(-4, 5), RATIO, st.floats(-4, 5)),
    st.sets(st.integers(1, 99), max_size=5).map(lambda s: through([(x / 100, (x % 7) / 7) for x in sorted(s)])),
    st.just(PRESETS["bounce"]),
)


TIMING = st.fixed_dictionaries(
    {
        "placement": st.sampled_from(PLACEMENTS),
        "hold": st.booleans(),
        "step": st.integers(1, 1000),
        "exposures": st.lists(st.integers(1, 50), max_size=6).map(tuple),
    }
)


@st.composite
def outlines(draw, outline_id):
    closed = draw(st.booleans())
    points = draw(st.lists(POINT, min_size=3 if closed else 2, max_size=9))
    x, y = points[0]
    points[1] = (x + (1.0 if x < 0 else -1.0) * max(1.0, abs(x)), y)  # never all the same point
    return Outline(outline_id, np.array(points), closed)


@st.composite
def drawings(draw):
    ids = draw(st.lists(st.integers(1, 2**31 - 1), max_size=3, unique=True))
    return Drawing(tuple(draw(outlines(i)) for i in ids), draw(STYLE))


@st.composite
def pairs(draw, a, b):
    counts = (len(a.points), len(b.points))
    if not a.closed:
        return OutlinePair(a.id, b.id, (Anchor(0.0, 0.0),) if draw(st.booleans()) else ())
    share = sorted(draw(st.sets(st.integers(0, 99), max_size=4)))
    anchors = tuple(Anchor(counts[0] * s / 100, counts[1] * s / 100) for s in share)
    kept = None
    if draw(st.booleans()):
        kept = Correspondence(np.array([0.25, 1.5]), np.array([1.25, 0.5]), counts, flipped=draw(st.booleans()))
    return OutlinePair(a.id, b.id, anchors, kept)


@st.composite
def layers(draw, layer_id):
    frames = sorted(draw(st.sets(st.integers(1, 100_000), max_size=4)))
    drawn = [draw(drawings()) for _ in frames]
    keyframes = []
    for i, (frame, drawing) in enumerate(zip(frames, drawn, strict=True)):
        following = drawn[i + 1].outlines if i + 1 < len(drawn) else ()
        matching = [(a, b) for a, b in zip(drawing.outlines, following, strict=False) if a.closed == b.closed]
        fixed = tuple(draw(pairs(a, b)) for a, b in matching if draw(st.booleans()))
        method = draw(st.sampled_from(["linear", "intrinsic"]))
        span = Span(method, draw(EASING), draw(st.integers(-100, 100)), fixed, **draw(TIMING))
        keyframes.append(Keyframe(frame, drawing, span, smooth=draw(st.booleans())))
    seen = draw(st.booleans()), tuple(keyframes), draw(st.booleans()), draw(RATIO), draw(COLOR)
    return Layer(layer_id, draw(st.text(max_size=20)), *seen)


@st.composite
def documents(draw):
    side = st.integers(1, 16_384)
    stage = Stage(draw(side), draw(side), draw(COLOR))
    rate = draw(st.fractions(Fraction(1, 1000), 1000, max_denominator=1001))
    ids = draw(st.lists(st.integers(1, 2**31 - 1), min_size=1, max_size=2, unique=True))
    made = [draw(layers(i)) for i in ids]
    if len(made) > 1 and draw(st.booleans()):
        made[1] = replace(made[1], parent=made[0].id)
    return Document(stage, rate, draw(st.integers(1, 100_000)), tuple(made))


def rich():
    """One of everything."""
    wave = Outline(1, np.array([(0.5, 0), (100, -0.25), (90, 1e-7), (0, 1e9)]))
    hole = Outline(2, np.array([(10, 10), (20, 10), (15, 20.125)]))
    line = Outline(7, np.array([(0, 0), (5, 5)]), closed=False)
    kept = Correspondence(np.array([0.0, 1.5]), np.array([2.0, 0.25]), (4, 3), flipped=True)
    fixed = (OutlinePair(1, 2, (Anchor(0.0, 2.0), Anchor(1.5, 0.25)), kept), OutlinePair(7, 7))
    easing = Easing(0.25, -0.5, 0.75, 1.5, (Knot(0.5, 0.75, 0.25, 0.75, 0.625, 0.75),))
    timing = {"placement": "centroid", "hold": True, "step": 2, "exposures": (3, 1)}
    span = Span("linear", easing, -2, fixed, **timing)
    style = Style("#12345678", "#abcdef", 2.5, 0.5)
    first = Keyframe(1, Drawing((wave, hole, line), style), span, smooth=True)
    last = Keyframe(48, Drawing((hole, line), Style(None, None, 0.0)), Span("intrinsic"))
    front = Layer(3, "Flügel ✎", True, (first, last), True, 0.25, "#00ff00", 1)
    stage = Stage(1280, 720, "#101216")
    return Document(stage, Fraction(24000, 1001), 60, (Layer(1, "", False), front))


def field(path, value):
    """The file of `rich` with one field set: a path of keys and indices."""
    content = json.loads(encode(rich()))
    place = content
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    return json.dumps(content).encode()


@given(documents())
@settings(max_examples=60)
def test_any_document_comes_back_equal_and_writes_the_same_bytes(document):
    content = encode(document)
    opened = decode(content)
    assert opened == document
    assert encode(opened) == content


def test_equal_documents_write_the_same_bytes_whatever_numbers_they_were_made_of():
    square = [(0, 0), (4, 0), (4, 4)]

    def film(whole, real, points):
        outline = Outline(whole(1), points)
        pair = OutlinePair(whole(1), whole(1), (Anchor(real(1), real(2)),))
        span = Span("linear", Easing(real(0), real(0), real(1), real(1)), whole(1), (pair,))
        drawing = Drawing((outline,), Style(width=real(3)))
        keyframes = (Keyframe(whole(1), drawing, span), Keyframe(whole(9), drawing))
        stage = Stage(whole(640), whole(480))
        return Document(stage, Fraction(25), whole(9), (Layer(whole(1), keyframes=keyframes),))

    plain = film(int, float, np.array(square, float))
    for whole, real in ((int, int), (np.int64, np.float64), (np.int32, np.float32)):
        assert encode(film(whole, real, np.array(square))) == encode(plain)


def test_what_is_seldom_set_comes_back_too_and_costs_nothing_where_it_is_not():
    kept = Correspondence(np.array([0.0, 1.5]), np.array([2.0, 0.25]), (4, 3), flipped=True)
    pair = OutlinePair(1, 2, (Anchor(0.0, 2.0, muted=True), Anchor(1.5, 0.25)), kept, chosen=True)
    document = rich()
    layer = document.layers[1]
    first = replace(
        layer.keyframes[0],
        span=Span("auto", pairs=(pair,), repair=True),
        reference=Reference("sketches/arm.png", 0.25),
    )
    full = replace(document, layers=(document.layers[0], replace(layer, keyframes=(first, layer.keyframes[1]))))
    assert decode(encode(full)) == full
    for word in (b"muted", b"chosen", b"repair", b"reference"):
        assert word in encode(full)
        assert word not in encode(document)


def test_a_muted_anchor_that_is_not_there_is_refused():
    content = encode(rich()).replace(b'"correspondence"', b'"muted":[2],"correspondence"', 1)
    with pytest.raises(FileFormatError, match=r"there are 2 anchors; muted are \[2\]"):
        decode(content)


def test_every_truncation_is_refused():
    content = encode(rich())
    assert decode(content[:-1]) == rich()  # all but the last line break
    for end in range(len(content) - 1):
        with pytest.raises(FileFormatError):
            decode(content[:end])


def opens_or_says_why(content):
    try:
        opened = decode(content)
    except FileFormatError:
        return
    assert decode(encode(opened)) == opened


@given(st.data())
@settings(max_examples=300)
def test_damaged_bytes_give_a_valid_document_or_a_reason(data):
    content = bytearray(encode(rich()))
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(content) - 1))
        new = data.draw(st.sampled_from(list(b'0123456789.-eE"[]{},:nul\x00\xff')) | st.integers(0, 255))
        how = data.draw(st.sampled_from(["change", "insert", "delete"]))
        content[at : at + (how != "insert")] = b"" if how == "delete" else bytes([new])
    opens_or_says_why(bytes(content))


def places(value, path=()):
    """Every path inside a JSON value."""
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, child in inside:
        yield (*path, key)
        yield from places(child, (*path, key))


PLACES = sorted(places(json.loads(encode(rich()))), key=str)
JUNK = [
    None,
    True,
    -1,
    0,
    2,
    0.5,
    1e9,
    1e300,
    -1e300,
    2**31,
    10**400,
    "",
    "x",
    [],
    [[]],
    [0],
    [0, 0],
    {},
    {"x": 1},
]


@given(path=st.sampled_from(PLACES), junk=st.sampled_from(JUNK))
@settings(max_examples=600)
def test_any_field_with_any_value_gives_a_valid_document_or_a_reason(path, junk):
    opens_or_says_why(field(path, junk))


@given(st.binary(max_size=200) | st.text(max_size=50).map(lambda t: json.dumps(t).encode()))
def test_any_other_file_is_refused(content):
    with pytest.raises(FileFormatError):
        decode(content)


@pytest.mark.parametrize("content", [b"[" * 100_000, b'{"a":' * 100_000, b'{"format":"inkbetween","version":1}'])
def test_deep_and_empty_files_are_refused(content):
    with pytest.raises(FileFormatError):
        decode(content)


def test_a_newer_version_is_named():
    newer = b'{"format": "inkbetween", "version": 7, "something new": {}}'
    with pytest.raises(FileFormatError, match=r"newer Inkbetween \(file version 7, this one reads up to 2\)"):
        decode(newer)


@pytest.mark.parametrize("version", [0, -1])
def test_there_is_no_version_below_1(version):
    with pytest.raises(FileFormatError, match=f"its version is {version}"):
        decode(field(["version"], version))


def test_another_program_is_told_from_a_damaged_file():
    with pytest.raises(FileFormatError, match=r"it is no Inkbetween project$"):
        decode(b'{"v": "5.7.4", "layers": []}')
    with pytest.raises(FileFormatError, match="or it is damaged"):
        decode(b"GIF89a")


KEYFRAME = ["layers", 1, "keyframes", 0]
NAMED = [
    (["stage", "depth"], 1, r"unknown field `depth` - at `\$.stage`"),
    ([*KEYFRAME, "span", "speed"], 1, r"unknown field `speed` - at `\$.layers\[1\].keyframes\[0\].span`"),
    (["stage", "width"], 0, r"0 px wide.*`\$.stage`"),
    (["stage", "background"], "blue", r"'blue'.*`\$.stage`"),
    (["rate"], [0, 1], "the frame rate is 0"),
    (["rate"], [24, 0], r"lower number.*`\$.rate`"),
    (["length"], 0, "0 frames"),
    (["layers"], [], "no layer"),
    (["layers", 0, "id"], 3, "same id"),
    ([*KEYFRAME, "frame"], 48, r"at 48 after one at 48.*`\$.layers\[1\]`"),
    ([*KEYFRAME, "frame"], 0, r"frame 0.*`\$.layers\[1\].keyframes\[0\]`"),
    ([*KEYFRAME, "drawing", "style", "width"], -1, r"-1.*`\$.layers\[1\].keyframes\[0\].drawing`"),
    (
        [*KEYFRAME, "drawing", "outlines", 0, "points"],
        [[0, 0]],
        r"1 vertices.*keyframes\[0\].drawing.outlines\[0\]`",
    ),
    ([*KEYFRAME, "drawing", "outlines", 0, "points", 1], [0, 0, 0], "length 2"),
    ([*KEYFRAME, "drawing", "outlines", 0, "points", 1, 0], 1e300, r"vertex 1 .*outlines\[0\]`"),
    ([*KEYFRAME, "drawing", "outlines", 0, "id"], 2, "have the id 2"),
    ([*KEYFRAME, "span", "method"], "magic", r"'magic'.*keyframes\[0\].span`"),
    ([*KEYFRAME, "span", "step"], 0, r"for 0 frames.*keyframes\[0\].span`"),
    ([*KEYFRAME, "span", "exposures"], [3, 0], r"1 to 100000 frames.*keyframes\[0\].span`"),
    ([*KEYFRAME, "span", "placement"], "up", r"'up'.*keyframes\[0\].span`"),
    ([*KEYFRAME, "span", "knots", 0, 4], 0.25, r"0.5 and 1 reach beyond.*keyframes\[0\].span`"),
    ([*KEYFRAME, "drawing", "style", "opacity"], 2, r"opacity.*2.*keyframes\[0\].drawing`"),
    (["layers", 1, "opacity"], -1, r"opacity.*-1.*layers\[1\]`"),
    (["layers", 1, "parent"], 9, "follows layer 9, which is not there"),
    (["layers", 1, "parent"], 3, "cannot follow a layer that follows it"),
    ([*KEYFRAME, "span", "easing"], [2, 0, 1, 1], r"ratios 2.*keyframes\[0\].span`"),
    ([*KEYFRAME, "span", "pairs", 0, "before"], 5, r"no outline 5.*span.pairs\[0\]`"),
    ([*KEYFRAME, "span", "pairs", 0, "after"], 7, "closed outline is paired with an open one|in two pairs"),
    ([*KEYFRAME, "span", "pairs", 0, "anchors", 0, 0], 9.5, r"9.5.*ends at 4.*span.pairs\[0\]`"),
    ([*KEYFRAME, "span", "pairs", 0, "correspondence", "counts"], [4, 9], r"\(4, 9\) vertices.*\(4, 3\)"),
    ([*KEYFRAME, "span", "pairs", 0, "correspondence", "counts"], [0, 0], ">= 2"),
    (["layers", 1, "keyframes", 1, "span", "pairs"], [{"before": 2, "after": 2}], "span of the last keyframe"),
]


@pytest.mark.parametrize(("path", "value", "message"), NAMED)
def test_what_is_wrong_is_named_with_its_place(path, value, message):
    with pytest.raises(FileFormatError, match=message):
        decode(field(path, value))


LEFT_OUT = (
    *("correspondence", "anchors", "knots", "placement", "hold", "step", "exposures"),
    *("opacity", "smooth", "locked", "color", "parent"),
)


@pytest.mark.parametrize("path", [p for p in PLACES if isinstance(p[-1], str)])
def test_every_field_is_needed_but_those_that_have_a_usual_value(path):
    content = json.loads(encode(rich()))
    place = content
    for key in path[:-1]:
        place = place[key]
    del place[path[-1]]
    if path[-1] in LEFT_OUT:
        decode(json.dumps(content).encode())
    else:
        with pytest.raises(FileFormatError):
            decode(json.dumps(content).encode())


@pytest.mark.parametrize("word", ["NaN", "Infinity", "-Infinity", "1e999"])
def test_a_number_that_is_none_is_refused(word):
    for path in (p for p in PLACES if p[-1] in (0, "width")):
        with pytest.raises(FileFormatError):
            decode(field(path, "@").replace(b'"@"', word.encode()))


@pytest.mark.parametrize("number", [float("nan"), float("inf"), -float("inf")])
def test_no_part_of_a_document_can_hold_a_number_that_is_none(number):
    makers = [
        lambda: Outline(1, np.array([(0, 0), (1, number), (1, 1)])),
        lambda: Style(width=number),
        lambda: Easing(x1=number),
        lambda: Easing(y2=number),
        lambda: OutlinePair(1, 1, (Anchor(0.0, number),)),
    ]
    for make in makers:
        with pytest.raises(InkbetweenError):
            make()


def test_what_no_file_can_hold_is_refused_by_the_document():
    makers = [
        lambda: Layer(0),
        lambda: Layer(2**31),
        lambda: Layer(1, "x" * 1001),
        lambda: Layer(1, "\ud83d"),
        lambda: Outline(0, np.eye(3, 2)),
        lambda: Document(rate=Fraction(1, 10**30)),
    ]
    for make in makers:
        with pytest.raises(DocumentError):
            make()


# on the disk


@pytest.fixture
def project(tmp_path):
    path = tmp_path / "film.inkb"
    save(Document(), path)
    return path


def test_what_is_saved_is_what_is_loaded(project):
    save(rich(), project)
    assert load(project) == rich()
    assert load(str(project)) == rich()


def full(*_, **__):
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


@pytest.mark.parametrize("call", ["replace", "fsync", "chmod"])
def test_a_full_disk_leaves_the_old_file_whole_and_nothing_beside_it(project, monkeypatch, call):
    monkeypatch.setattr(os, call, full)
    with pytest.raises(StorageError, match=r"cannot write .*film.inkb: no space left on device"):
        save(rich(), project)
    assert load(project) == Document()
    assert [p.name for p in project.parent.iterdir()] == ["film.inkb"]


def test_an_interruption_leaves_the_old_file_whole_and_nothing_beside_it(project, monkeypatch):
    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", interrupt)
    with pytest.raises(KeyboardInterrupt):
        save(rich(), project)
    assert load(project) == Document()
    assert [p.name for p in project.parent.iterdir()] == ["film.inkb"]


def test_a_folder_that_cannot_be_synced_does_not_fail_a_file_that_is_written(project, monkeypatch):
    sync = os.fsync
    monkeypatch.setattr(os, "fsync", lambda f: full() if stat.S_ISDIR(os.fstat(f).st_mode) else sync(f))
    save(rich(), project)
    assert load(project) == rich()


@pytest.mark.skipif(os.name != "posix", reason="permissions of POSIX")
@pytest.mark.parametrize("mode", [0o600, 0o644, 0o664])
def test_a_saved_file_keeps_its_permissions(project, mode):
    project.chmod(mode)
    save(rich(), project)
    assert stat.S_IMODE(project.stat().st_mode) == mode


@pytest.mark.skipif(os.name != "posix", reason="permissions of POSIX")
def test_a_new_file_has_the_permissions_of_any_new_file(tmp_path):
    old = os.umask(0o027)
    try:
        save(rich(), tmp_path / "new.inkb")
    finally:
        os.umask(old)
    assert stat.S_IMODE((tmp_path / "new.inkb").stat().st_mode) == 0o640


@pytest.mark.skipif(os.name != "posix", reason="links need rights on Windows")
@pytest.mark.parametrize("there", [True, False])
def test_a_link_stays_a_link_and_its_target_is_written(tmp_path, there):
    target, link = tmp_path / "target.inkb", tmp_path / "link.inkb"
    link.symlink_to(target.name)
    if there:
        save(Document(), target)
    save(rich(), link)
    assert link.is_symlink()
    assert load(target) == rich()


@pytest.mark.parametrize("name", ["no such folder/film.inkb", "folder"])
def test_a_place_that_cannot_be_written_or_read_is_named(tmp_path, name):
    (tmp_path / "folder").mkdir()
    with pytest.raises(StorageError, match=f"cannot write .*{name}"):
        save(rich(), tmp_path / name)
    with pytest.raises(StorageError, match=f"cannot read .*{name}"):
        load(tmp_path / name)
    assert not any(p.is_file() for p in tmp_path.rglob("*"))


def test_a_file_name_as_long_as_the_disk_allows_can_be_saved(tmp_path):
    path = tmp_path / ("ü" * 125 + ".inkb")
    save(rich(), path)
    assert load(path) == rich()


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="no such device here")
def test_a_device_is_not_read_for_ever():
    with pytest.raises(StorageError, match="it is no file"):
        load("/dev/zero")


def test_a_file_too_large_to_be_a_project_is_not_read(project):
    with project.open("r+b") as file:
        file.truncate(LARGEST_FILE + 1)
    with pytest.raises(FileFormatError, match="larger than 128 MB"):
        load(project)


def test_a_damaged_file_is_named(project):
    project.write_bytes(b"{}")
    with pytest.raises(FileFormatError, match=r"cannot open film.inkb: it is no Inkbetween project"):
        load(project)


def test_the_smallest_file_of_the_documentation_opens():
    text = (Path(__file__).resolve().parents[3] / "docs" / "file-format.md").read_text(encoding="utf-8")
    smallest = text.partition("```json\n")[2].partition("```")[0]
    assert decode(smallest.encode()) == Document()


def test_every_field_and_method_is_documented():
    text = (Path(__file__).resolve().parents[3] / "docs" / "file-format.md").read_text(encoding="utf-8")
    for path in PLACES:
        if isinstance(path[-1], str):
            assert f"`{path[-1]}`" in text, path
    for method in METHODS:
        assert f'`"{method}"`' in text

import math
import random
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import Polygon
from svgelements import Path as ReadPath

from core.errors import CancelledError, DocumentError, FileFormatError, InkbetweenError, StorageError
from core.geometry.outline import locate, signed_area
from core.io.imported import as_drawing, fitted, import_keyframe, import_layers, painted_alike
from core.io.svg import read_svg
from core.model.document import Document, Stage
from core.model.drawing import Style

HEAD = (
    'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
    'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
)
SQUARE = "M0 0H10V10H0z"


def svg(body: str, attributes: str = 'viewBox="0 0 400 400"') -> bytes:
    return f"<svg {HEAD} {attributes}>{body}</svg>".encode()


def read(body: str, attributes: str = 'viewBox="0 0 400 400"', **options):
    return read_svg(svg(body, attributes), **options)


def only(body: str, attributes: str = 'viewBox="0 0 400 400"', **options):
    """The single outline of the single drawing."""
    imported = read(body, attributes, **options)
    (drawing,) = imported.drawings
    ((points, _),) = drawing.outlines
    return points


def box(points) -> list[float]:
    return [*points.min(axis=0).round(6).tolist(), *points.max(axis=0).round(6).tolist()]


# shapes and curves


def test_a_circle_is_round_to_the_tolerance_with_few_vertices():
    points = only('<circle cx="200" cy="200" r="100"/>')
    assert 20 <= len(points) <= 60
    radii = np.hypot(*(points - 200).T)
    middles = (points + np.roll(points, -1, axis=0)) / 2 - 200
    assert np.abs(radii - 100).max() < 0.01
    assert 100 - np.hypot(*middles.T).min() <= 0.25


@pytest.mark.parametrize(
    ("body", "count"),
    [
        (f'<path d="{SQUARE}"/>', 4),
        ('<path d="M0 0C1 0 9 0 10 0L10 10"/>', 3),
        ('<path d="M0 0L10 0 10 10 0 10 0 0"/>', 4),
        ('<path d="m0 0h10v10H0z"/>', 4),
        ('<rect width="10" height="10"/>', 4),
        ('<polygon points="0,0 10 0,10-0 10,10"/>', 3),
        ('<polygon points="0 0 10 0 10 10 0 10 7"/>', 4),
    ],
)
def test_straight_edges_stay_one_edge(body, count):
    assert len(only(body)) == count


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ('<rect x="10" y="20" width="50" height="30"/>', [10, 20, 60, 50]),
        ('<ellipse cx="100" cy="50" rx="40" ry="20"/>', [60, 30, 140, 70]),
        ('<rect x="1" width="50%" height="25%"/>', [1, 0, 201, 100]),
        ('<rect x="1in" width="25.4mm" height="72pt"/>', [96, 0, 192, 96]),
        ('<g transform="translate(10 20) scale(2)"><rect width="10" height="5"/></g>', [10, 20, 30, 30]),
        (
            '<g transform="translate(10)"><g transform="rotate(90)"><rect width="10" height="4"/></g></g>',
            [6, 0, 10, 10],
        ),
        ('<rect width="9" height="9" style="transform: translate(10px, 20px)"/>', [10, 20, 19, 29]),
        (
            '<style>@font-face{src:none} @media all {.m {x: 1}}</style><rect class="m" width="9" height="9"/>',
            [0, 0, 9, 9],
        ),
        ('<rect width="10" height="10" transform="matrix(1 0 0 -1 5 50)"/>', [5, 40, 15, 50]),
        ('<defs><rect id="r" width="10" height="10"/></defs><use xlink:href="#r" x="7" y="8"/>', [7, 8, 17, 18]),
        (
            '<defs><g id="r"><rect width="9" height="9"/></g></defs><use href="#r" transform="scale(2)"/>',
            [0, 0, 18, 18],
        ),
        (
            '<symbol id="s" viewBox="0 0 10 10"><rect width="10" height="10"/></symbol>'
            '<use href="#s" x="5" width="20" height="20"/>',
            [5, 0, 25, 20],
        ),
        (
            '<svg x="10" y="10" width="40" height="40" viewBox="0 0 4 4"><rect width="2" height="2"/></svg>',
            [10, 10, 30, 30],
        ),
    ],
)
def test_places_sizes_and_transforms_are_followed(body, expected):
    assert box(only(body, tolerance=0.001)) == pytest.approx(expected, abs=0.002)


@pytest.mark.parametrize(
    ("attributes", "size", "expected"),
    [
        ('viewBox="0 0 10 10" width="100" height="50"', (100, 50), [25, 0, 75, 50]),
        ('viewBox="0 0 10 10" width="100" height="50" preserveAspectRatio="none"', (100, 50), [0, 0, 100, 50]),
        (
            'viewBox="0 0 10 10" width="100" height="50" preserveAspectRatio="xMinYMin meet"',
            (100, 50),
            [0, 0, 50, 50],
        ),
        ('viewBox="5 5 10 10"', (10, 10), [-5, -5, 5, 5]),
        ('viewBox="0 0 10 10" width="20"', (20, 20), [0, 0, 20, 20]),
        ('width="1in" height="96"', (96, 96), [0, 0, 10, 10]),
        ("", (10, 10), [0, 0, 10, 10]),
        ('viewBox="nonsense"', (10, 10), [0, 0, 10, 10]),
    ],
)
def test_the_view_box_fills_the_size(attributes, size, expected):
    imported = read('<rect width="10" height="10"/>', attributes)
    assert imported.size == size
    assert box(imported.drawings[0].outlines[0][0]) == expected


NUMBERS = st.floats(-150, 150, allow_nan=False).map(lambda x: round(x, 2))


@settings(max_examples=40, deadline=None)
@given(
    st.lists(
        st.one_of(
            st.tuples(st.sampled_from("Ll"), NUMBERS, NUMBERS),
            st.tuples(st.sampled_from("HhVv"), NUMBERS),
            st.tuples(st.sampled_from("Qq"), *[NUMBERS] * 4),
            st.tuples(st.sampled_from("Cc"), *[NUMBERS] * 6),
            st.tuples(
                st.sampled_from("Aa"),
                st.integers(1, 90),
                st.integers(1, 90),
                st.integers(-180, 180),
                st.sampled_from([0, 1]),
                st.sampled_from([0, 1]),
                NUMBERS,
                NUMBERS,
            ),
        ),
        min_size=1,
        max_size=5,
    )
)
def test_paths_lie_where_another_reader_puts_them(commands):
    text = "M 3 4" + "".join(f"{c[0]}{' '.join(map(str, c[1:]))}" for c in commands)
    try:
        imported = read(f'<path d="{text}" fill="none" stroke="red"/>', tolerance=0.05)
    except FileFormatError:
        return  # everything on one spot
    points, closed = imported.drawings[0].outlines[0]
    for segment in list(ReadPath(text))[1:]:
        places = [segment.point(t) for t in np.linspace(0, 1, 9)]
        _, gap = locate(points, [(p.x, p.y) for p in places], closed=closed)
        assert gap.max() < 0.06


@pytest.mark.parametrize(
    ("short", "spelt_out"),
    [
        ("M0 0C0 90 90 90 90 0S180 -90 180 0", "M0 0C0 90 90 90 90 0C90 -90 180 -90 180 0"),
        ("M0 0Q50 90 90 0T180 0", "M0 0Q50 90 90 0Q130 -90 180 0"),
        ("M0 0L90 0S180 -90 180 0", "M0 0L90 0C90 0 180 -90 180 0"),
        ("M0 0Q50 90 90 0s90 -90 90 0", "M0 0Q50 90 90 0C90 0 180 -90 180 0"),
        ("M0 0c0 90 90 90 90 0t90 0", "M0 0C0 90 90 90 90 0L180 0"),
        ("M0,0a9 9 0 1110 10z", "M0 0A9 9 0 1 1 10 10L0 0z"),
        ("M0 0-9.5.5.5-.5e1", "M0 0L-9.5 0.5L.5 -5"),
    ],
)
def test_short_forms_are_what_they_stand_for(short, spelt_out):
    line = '<path fill="none" stroke="red" d="{}"/>'
    one, other = only(line.format(short)), only(line.format(spelt_out))
    assert np.allclose(one, other)


@pytest.mark.parametrize("tolerance", [1.0, 0.25, 0.02])
@given(numbers=st.lists(NUMBERS, min_size=6, max_size=6))
@settings(max_examples=25, deadline=None)
def test_a_curve_is_as_near_as_the_tolerance_says(tolerance, numbers):
    b, c, d = np.array(numbers).reshape(3, 2)
    text = f'<path fill="none" stroke="red" d="M0 0C{" ".join(map(str, numbers))}"/>'
    t = np.linspace(0, 1, 200)[:, None]
    curve = 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t * t * c + t**3 * d
    if np.ptp(curve, axis=0).max() < 1:
        return
    points, closed = read(text, tolerance=tolerance).drawings[0].outlines[0]
    assert locate(points, curve, closed=closed)[1].max() <= tolerance * 1.3 + 1e-9


def test_a_finer_tolerance_is_chosen_for_an_icon():
    icon = '<circle cx="12" cy="12" r="10"/>'
    coarse, fine = only(icon, 'viewBox="0 0 24 24"'), only(icon, 'viewBox="0 0 24 24"', tolerance=None)
    assert len(coarse) <= 24
    assert 60 < len(fine) < 160


# holes and rules of filling


def rings(body):
    imported = read(body)
    area = Polygon()
    for points, _ in imported.drawings[0].outlines:
        area = area.symmetric_difference(Polygon(points))
    return imported, area


OUTER, INNER, REVERSED = "M0 0H30V30H0z", "M10 10H20V20H10z", "M10 10V20H20V10z"


@pytest.mark.parametrize(
    ("path", "rule", "count", "area"),
    [
        (OUTER + INNER, "evenodd", 2, 800),
        (OUTER + REVERSED, "nonzero", 2, 800),
        (OUTER + INNER, "nonzero", 1, 900),
        (OUTER + REVERSED + "M12 12H18V18H12z", "nonzero", 3, 836),
        ("M0 0H9V9H0zM20 0H29V9H20z", "nonzero", 2, 162),
    ],
)
def test_holes_are_kept_and_what_bounds_nothing_is_left_out(path, rule, count, area):
    imported, covered = rings(f'<path d="{path}" fill-rule="{rule}"/>')
    assert len(imported.drawings[0].outlines) == count
    assert covered.area == pytest.approx(area)
    assert imported.left_out == ()


@pytest.mark.parametrize("path", ["M0 0H30V30H0zM20 20H50V50H20z", "M100 10L160 190L10 75L190 75L40 190z"])
def test_overlaps_that_would_become_holes_are_named(path):
    assert read(f'<path d="{path}"/>').left_out == ("an overlapping path (its overlaps are holes now)",)
    assert read(f'<path fill-rule="evenodd" d="{path}"/>').left_out == ()


def test_an_unfilled_line_stays_open_and_a_filled_one_is_closed():
    imported = read('<path d="M0 0L10 0L10 10" fill="none" stroke="red"/><path d="M0 0L10 0L10 10"/>')
    assert [d.outlines[0][1] for d in imported.drawings] == [False, True]
    (line,) = read('<line x2="10" y2="5" stroke="red"/>').drawings
    assert line.style == Style(None, "#ff0000", 1)


# paint


@pytest.mark.parametrize(
    ("attributes", "fill", "stroke", "width"),
    [
        ("", "#000000", None, 4),
        ('fill="red" stroke="none"', "#ff0000", None, 4),
        ('fill="#0f0" stroke="#0000ff" stroke-width="3"', "#00ff00", "#0000ff", 3),
        ('fill="#abcd"', "#aabbccdd", None, 4),
        ('fill="rgb(10 20 30 / 50%)"', "#0a141e80", None, 4),
        ('fill="hsl(120, 100%, 50%)"', "#00ff00", None, 4),
        ('fill="red" opacity=".5" fill-opacity="50%"', "#ff000040", None, 4),
        ('color="teal" fill="currentColor"', "#008080", None, 4),
        ('fill="currentColor"', "#000000", None, 4),
        ('style="fill: blue !important; stroke:red;stroke-width:2px" fill="green"', "#0000ff", "#ff0000", 2),
        ('class="mine" fill="green"', "#ffff00", None, 4),
        ('id="one" class="mine"', "#00ffff", None, 4),
        ('fill="none" stroke="black" transform="scale(3)"', None, "#000000", 3),
        ('fill="url(#fade)"', "#ff0000", None, 4),
        ('fill="url(#same)"', "#ff0000", None, 4),
        ('fill="url(#nowhere) blue"', "#0000ff", None, 4),
        ('fill="url(#dots)"', "#808080", None, 4),
    ],
)
def test_paint_is_taken_over(attributes, fill, stroke, width):
    body = (
        "<style>/* x */ .mine, .other {fill: yellow} #one {fill: aqua}</style>"
        '<linearGradient id="fade"><stop stop-color="red"/><stop stop-color="blue"/></linearGradient>'
        '<radialGradient id="same" xlink:href="#fade"/><pattern id="dots"><circle r="3"/></pattern>'
    )
    (drawing,) = read(f"{body}<path d='{SQUARE}' {attributes}/>").drawings
    assert drawing.style == Style(fill, stroke, width)


def test_groups_hand_their_paint_on_and_opacities_multiply():
    (drawing,) = read(f'<g fill="red" opacity=".5"><g opacity=".5"><path d="{SQUARE}"/></g></g>').drawings
    assert drawing.style.fill == "#ff000040"


@pytest.mark.parametrize(
    "hidden", ['display="none"', 'visibility="hidden"', 'style="display:none"', 'fill="none"', 'opacity="0"']
)
def test_what_is_not_seen_is_not_imported(hidden):
    imported = read(f'<g {hidden}><path d="{SQUARE}"/></g><path id="seen" d="{SQUARE}"/>')
    assert [d.name for d in imported.drawings] == ["seen"]


def test_names_come_from_labels_ids_and_groups():
    imported = read(
        f'<path id="p" d="{SQUARE}"/><path id="q" inkscape:label="Ear" d="{SQUARE}"/>'
        f'<g id="head"><path d="{SQUARE}"/></g>'
    )
    assert [d.name for d in imported.drawings] == ["p", "Ear", "head"]


def test_what_is_left_out_is_named_once_and_the_rest_imported():
    imported = read(
        '<text>a</text><text>b</text><image href="http://example.org/a.png"/>'
        '<mask id="m"><rect width="9" height="9"/></mask>'
        f'<clipPath id="c"><rect width="9" height="9"/></clipPath>'
        f'<g mask="url(#m)"><path clip-path="url(#c)" d="{SQUARE}"/></g>'
        f'<path filter="url(#f)" stroke="red" stroke-dasharray="2 3" d="{SQUARE}"/>'
    )
    assert len(imported.drawings) == 2
    assert imported.left_out == (
        "2 texts",
        "a picture",
        "a mask (its parts are shown whole)",
        "a clip (its parts are shown whole)",
        "a filter (shown without it)",
        "a dashed stroke",
    )


# what is wrong


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "damaged"),
        (b"buy ink", "damaged"),
        (b"<html/>", "no SVG"),
        (b"\x1f\x8b\x08", "compressed"),
        (b"\xff\xfe\x00", "damaged"),
        (b'<?xml version="1.0" encoding="utf-7"?><svg/>', "encoding"),
        (b'<!DOCTYPE svg [<!ENTITY a "b">]><svg>&a;</svg>', "entities"),
        (b'<!DOCTYPE s [<!ENTITY a "b"><!ENTITY b "&a;&a;&a;">]><svg>&b;</svg>', "entities"),
        (b'<!DOCTYPE svg [<!ENTITY a SYSTEM "file:///etc/passwd">]><svg>&a;</svg>', "entities"),
        (b'<!DOCTYPE svg [<!ENTITY % p SYSTEM "http://example.org/a">%p;]><svg/>', "entities"),
        (b'<?xml-stylesheet href="a.css"?><svg/>', "another file"),
        (svg("<style>@import url(a.css);</style>"), "another file"),
        (svg('<use href="other.svg#a"/>'), "another file"),
        (svg(""), "no path or shape"),
        (svg("<text>hello</text>"), "only a text"),
        (svg('<g id="a"><use href="#a"/></g>'), "repeats itself"),
        (svg('<path d="M0 0L1e300 0L10 10z"/>'), "too far away"),
        (svg('<path d="M0 0L1e999 0"/>'), "no path or shape"),
        (svg("<g>" * 5000), "deep"),
    ],
)
def test_a_bad_file_is_one_sentence(content, words):
    with pytest.raises(FileFormatError) as caught:
        read_svg(content)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_harmless_doctype_is_read():
    kind = b'<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">'
    assert len(read_svg(b'<?xml version="1.0"?>' + kind + svg(f'<path d="{SQUARE}"/>')).drawings) == 1


def test_a_billion_repetitions_end_with_a_sentence():
    body = '<g id="a0"/>'
    body += "".join(f'<g id="a{i}">' + f'<use href="#a{i - 1}"/>' * 10 + "</g>" for i in range(1, 10))
    with pytest.raises(FileFormatError, match="more than 30000 times"):
        read(body)


@pytest.mark.parametrize("number", ["nan", "inf", "-1", "1e400", "", "9" * 400, "0x10", "--3"])
def test_numbers_that_are_none_are_survived(number):
    body = (
        f'<path d="M0 0L{number} 5L10 10z" stroke="red" stroke-width="{number}" opacity="{number}"/>'
        f'<circle r="{number}" cx="{number}"/><rect width="{number}" height="3" transform="scale({number})"/>'
        f'<path d="{SQUARE}"/>'
    )
    imported = read(body, f'viewBox="0 0 {number} 10" width="{number}"')
    assert all(np.isfinite(p).all() for d in imported.drawings for p, _ in d.outlines)


def test_mutated_files_are_read_or_refused():
    body = (
        "<style>.a{fill:red}</style><defs><g id='g'><circle r='9' cx='5'/></g></defs>"
        "<linearGradient id='f'><stop offset='0' stop-color='red'/></linearGradient>"
        "<g transform='rotate(30 5 5) skewX(3)'><path class='a' d='M1 2c3 4 5 6 7 8s3 3 1 1a4 5 6 0 1 9 3z'/></g>"
        "<use href='#g' x='3'/><rect rx='2' width='9' height='8' fill='url(#f)' stroke='#123' opacity='.5'/>"
        "<polyline points='1,2 3,4 9,1'/><text>hi</text>"
    )
    whole = svg(body)
    rng = random.Random(7)
    done = {"read": 0, "refused": 0}
    for _ in range(250):
        bad = bytearray(whole)
        for _ in range(rng.randrange(1, 6)):
            at = rng.randrange(len(bad))
            kind = rng.randrange(4)
            if kind == 0:
                bad[at] = rng.choice(b"0123456789.-eMzac<>&\"'#()%\x00\xff")
            elif kind == 1:
                del bad[at : at + rng.randrange(1, 9)]
            elif kind == 2:
                bad[at:at] = rng.choice([b"1e309", b"-", b"nan", b"url(#g)", b"</g>", b"%", b"99999999999", b"A1"])
            else:
                bad[at : at + 4] = whole[(spot := rng.randrange(len(whole))) : spot + 4]
        try:
            read_svg(bytes(bad))
            done["read"] += 1
        except FileFormatError:
            done["refused"] += 1
    assert min(done.values()) > 20


# large files


def large(count: int) -> bytes:
    return svg("".join(f'<path d="M{i % 90} {i // 90}c1 2 3 4 5 6z"/>' for i in range(count)))


def test_progress_rises_to_the_end():
    seen: list[float] = []
    read_svg(large(400), progress=seen.append)
    assert seen == sorted(seen)
    assert 0 <= seen[0] < 0.05
    assert 0.9 < seen[-1] <= 1
    assert len(seen) > 20


@pytest.mark.parametrize("calls", [0, 1, 50])
def test_it_stops_when_asked(calls):
    asked: list[int] = []

    def cancelled() -> bool:
        asked.append(1)
        return len(asked) > calls

    with pytest.raises(CancelledError):
        read_svg(large(400), cancelled=cancelled)
    assert len(asked) == calls + 1


def test_files_are_read_by_their_name_and_a_missing_one_is_a_sentence(tmp_path: Path):
    (tmp_path / "a.svg").write_bytes(svg(f'<path d="{SQUARE}"/>'))
    (tmp_path / "b.svg").write_text("no")
    assert len(read_svg(tmp_path / "a.svg").drawings) == 1
    with pytest.raises(FileFormatError, match=r"^cannot import b\.svg: it is no SVG"):
        read_svg(tmp_path / "b.svg")
    with pytest.raises(StorageError, match="no such file"):
        read_svg(str(tmp_path / "c.svg"))


# into the document


def test_a_smaller_picture_keeps_its_size_and_a_larger_one_is_fitted():
    small = fitted(read(f'<path d="{SQUARE}"/>', 'viewBox="0 0 10 10"'), Stage(100, 50))
    assert box(small.drawings[0].outlines[0][0]) == [45, 20, 55, 30]
    wide = 'viewBox="0 0 10 10" width="200" height="200"'
    large_one = fitted(read(f'<path stroke="red" d="{SQUARE}"/>', wide), Stage(100, 50))
    assert box(large_one.drawings[0].outlines[0][0]) == [25, 0, 75, 50]
    assert large_one.drawings[0].style.width == pytest.approx(5)
    same = read(f'<path d="{SQUARE}"/>', 'viewBox="0 0 100 50"')
    assert fitted(same, Stage(100, 50)) is same


def test_a_keyframe_holds_all_outlines_in_the_first_style():
    imported = read(f'<path fill="red" d="{OUTER}{REVERSED}"/><path fill="blue" d="{SQUARE}"/>')
    document = import_keyframe(Document(), 1, 5, imported)
    drawing = document.layers[0].keyframes[0].drawing
    assert [o.id for o in drawing.outlines] == [1, 2, 3]
    assert drawing.style.fill == "#ff0000"
    assert drawing == as_drawing(imported)
    assert imported.styles == 2


def test_layers_hold_what_is_painted_alike_and_does_not_overlap():
    imported = read(
        '<path id="a" fill="red" d="M0 0H9V9z"/><path fill="red" d="M10 0H19V9z"/>'
        '<path fill="red" d="M5 0H15V9z"/>'
        '<path id="b" fill="blue" d="M0 0H9V9z"/><path fill="red" d="M50 0H59V9z"/>'
    )
    assert [len(g) for g in painted_alike(imported.drawings)] == [2, 1, 1, 1]
    document = import_layers(Document(), 3, imported)
    assert [x.name for x in document.layers] == ["Layer 1", "a", "Imported", "b", "Imported 2"]
    assert len({x.id for x in document.layers}) == 5
    assert [x.frames() for x in document.layers] == [(), *[(3,)] * 4]


def test_too_many_layers_are_refused_as_a_whole():
    imported = read("".join(f'<path fill="#{i:06x}" d="{SQUARE}"/>' for i in range(101)))
    with pytest.raises(DocumentError, match="101 layers, the limit is 100"):
        import_layers(Document(), 1, imported)


def test_every_refusal_is_an_error_of_ours_and_areas_keep_their_sign():
    assert issubclass(FileFormatError, InkbetweenError)
    assert math.isclose(float(signed_area(only(f'<path d="{SQUARE}"/>'))), 100)


def style_sheet(text):
    path = '<path class="a" d="M0 0h9v9z"/>'
    return f'<svg xmlns="http://www.w3.org/2000/svg"><style>{text}</style>{path}</svg>'.encode()


@pytest.mark.parametrize(
    "text",
    [
        "x" * 2_000_000,
        "/*" * 1_000_000,
        "{" * 2_000_000,
        "}" * 2_000_000,
        ".a," * 19_000 + "b{" + "fill:red;" * 9_000 + "}",
    ],
    ids=["no rule", "remarks without end", "opened", "closed", "many selectors of one rule"],
)
def test_a_style_sheet_is_read_in_time_that_grows_with_its_length_only(text):
    assert read_svg(style_sheet(text)).drawings[0].style.fill in ("#000000", "#ff0000")


@pytest.mark.parametrize(
    ("text", "fill"),
    [
        ("/* {fill:red} */ .a{fill:#123456} /* no end", "#123456"),
        ("@media print{.a{fill:#123456}}", "#123456"),
        (".a{fill:#111111}}.a{fill:#123456}", "#123456"),
        ("{fill:#111111} path.a{fill:#123456} .a{fill:#222222}", "#123456"),
    ],
)
def test_remarks_and_nested_braces_of_a_style_sheet_are_passed_over(text, fill):
    assert read_svg(style_sheet(text)).drawings[0].style.fill == fill

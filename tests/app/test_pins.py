"""Pins, driven as a person drives them: clicks, drags, keys."""

import numpy as np
import pytest
from PySide6.QtCore import Qt

from app.canvas.paths import vertex_ways
from app.session import PinRef
from core import load
from core.model.document import Document
from core.model.edits import add_outline, set_span
from core.model.pins import SpanPin

ALT = Qt.KeyboardModifier.AltModifier
U = np.linspace(0, 2 * np.pi, 24, endpoint=False)
TIP = (1460.0, 540.0)  # vertex 0 before
FREE = (60.0, 60.0)


def limb(bend):
    x, y = 500 * np.cos(U), 130 * np.sin(U)
    turn = bend * np.clip(x / 500, 0, 1)
    return np.column_stack([960 + x * np.cos(turn) - y * np.sin(turn), 540 + x * np.sin(turn) + y * np.cos(turn)])


END = tuple(limb(-1.1)[0])


@pytest.fixture
def limbs(hand, qtbot):
    """The hand with the pin tool, and two keyframes of a bending limb open."""
    document = Document()
    for frame, bend in ((1, 0.0), (25, -1.1)):
        document = add_outline(document, 1, frame, limb(bend))
    hand.session.new(set_span(document, 1, 1, method="intrinsic"))
    hand.session.go_to(13)
    hand.settle(qtbot)
    hand.key(Qt.Key.Key_K)
    return hand


def pins(hand):
    return hand.session.layer.keyframes[0].span.pins


def shown_vertex(hand, index):
    """Where a vertex of the keyframe before is in the in-between that is shown."""
    link = hand.canvas.content.plan.links[0]
    row = int(np.flatnonzero(link.before_positions == index)[0])
    return hand.canvas.content.picture.outlines[0][0][row]


def near(place, other, within=3.0):
    return np.hypot(*np.subtract(place, other)) <= within


def test_a_click_on_a_vertex_pins_it_and_its_way_is_straight(limbs) -> None:
    free = shown_vertex(limbs, 0)
    steps = limbs.session.undo_stack.count()
    limbs.click((TIP[0] + 4, TIP[1] + 4))
    assert pins(limbs) == (SpanPin(1, 0.0),)
    assert limbs.session.selection.pin == PinRef(1, 0)
    assert limbs.session.undo_stack.count() == steps + 1
    middle = np.add(TIP, END) / 2
    assert near(shown_vertex(limbs, 0), middle, 1e-6)
    assert not near(free, middle, 5)
    limbs.menu("edit.undo")
    assert pins(limbs) == ()
    assert near(shown_vertex(limbs, 0), free, 1e-9)


def test_edges_and_the_inside_can_be_pinned_and_the_paper_and_the_keyframe_after_not(limbs) -> None:
    a, b = limb(0.0)[6], limb(0.0)[7]
    limbs.click(tuple((a + b) / 2))
    limbs.click((700.0, 540.0))
    assert pins(limbs)[0].outline == 1
    assert abs(pins(limbs)[0].position - 6.5) < 0.1
    assert near(pins(limbs)[1].place, (700.0, 540.0))
    limbs.click(FREE)
    limbs.click(tuple(0.9 * np.array(END) + 0.1 * np.array((960, 540))))
    assert len(pins(limbs)) == 2
    assert "keyframe before" in limbs.message


def test_one_keyframe_has_no_point_to_pin(limbs) -> None:
    limbs.session.new(add_outline(Document(), 1, 1, limb(0.0)))
    limbs.click(TIP)
    assert "only one keyframe" in limbs.message
    assert not limbs.session.undo_stack.canUndo()


def test_dragging_from_a_point_pins_it_and_draws_the_arc_under_the_pointer_in_one_step(limbs) -> None:
    steps = limbs.session.undo_stack.count()
    over = (1500.0, 200.0)
    limbs.drag(TIP, (1480.0, 400.0), over)
    assert len(pins(limbs)) == 1
    assert limbs.session.undo_stack.count() == steps + 1
    mark = limbs.canvas.pin_marks[0]
    assert np.hypot(*(mark.way - over).T).min() < 15
    assert near(shown_vertex(limbs, 0), over, 60)  # the middle of the length, not of the parameter
    limbs.menu("edit.undo")
    assert pins(limbs) == ()


def test_a_way_and_its_handles_are_dragged(limbs) -> None:
    limbs.click(TIP)
    middle = np.add(TIP, END) / 2
    to = np.add(middle, (120, -90))
    limbs.drag(tuple(middle), tuple(np.add(middle, (40, -40))), tuple(to))
    arc = pins(limbs)[0].handles
    assert np.hypot(*(limbs.canvas.pin_marks[0].way - to).T).min() < 6
    steps = limbs.session.undo_stack.count()
    limbs.drag(arc[0], (1700.0, 600.0), (1720.0, 500.0))
    moved = pins(limbs)[0].handles
    assert near(moved[0], (1720.0, 500.0))
    assert moved[1] == arc[1]
    assert limbs.session.undo_stack.count() == steps + 1
    limbs.double_click(TIP)
    assert pins(limbs) == (SpanPin(1, 0.0),)


def test_escape_leaves_no_trace_of_a_drag(limbs) -> None:
    limbs.click(TIP)
    document, steps = limbs.session.document, limbs.session.undo_stack.count()
    for start in (TIP, tuple(limb(0.0)[12])):
        limbs.press(start)
        limbs.move((900.0, 200.0))
        assert limbs.session.document is not document
        limbs.key(Qt.Key.Key_Escape)
        limbs.release((900.0, 200.0))
        assert limbs.session.document is document
        assert limbs.session.undo_stack.count() == steps


def test_a_pin_is_moved_with_alt_and_keeps_its_arc(limbs) -> None:
    limbs.drag(TIP, (1480.0, 400.0), (1500.0, 200.0))
    arc = pins(limbs)[0].handles
    to = tuple(limb(0.0)[3])
    limbs.drag(TIP, (1400.0, 580.0), to, held=ALT)
    assert pins(limbs) == (SpanPin(1, 3.0, handles=arc),)


def test_delete_takes_the_chosen_pin_away_and_the_menu_all_of_them(limbs) -> None:
    limbs.click(TIP, tuple(limb(0.0)[12]), tuple(limb(0.0)[6]))
    limbs.click(TIP)
    assert limbs.session.selection.pin == PinRef(1, 0)
    limbs.key(Qt.Key.Key_Delete)
    assert [p.position for p in pins(limbs)] == [12.0, 6.0]
    assert limbs.session.selection.pin is None
    limbs.click(tuple(limb(0.0)[6]))
    limbs.menu("edit.delete")
    assert [p.position for p in pins(limbs)] == [12.0]
    limbs.menu("span.clear_pins")
    assert pins(limbs) == ()
    limbs.menu("edit.undo")
    assert len(pins(limbs)) == 1


def test_a_pin_that_is_gone_is_selected_no_longer(limbs) -> None:
    limbs.click(TIP)
    limbs.menu("edit.undo")
    assert limbs.session.selection.pin is None


def test_hovering_lights_up_what_a_click_would_take(limbs) -> None:
    limbs.move((TIP[0] + 3, TIP[1]), button=Qt.MouseButton.NoButton)
    spot = limbs.canvas.hover
    assert near((spot.x(), spot.y()), limbs.canvas.camera.to_view(np.array(TIP)), 0.1)
    limbs.move(FREE, button=Qt.MouseButton.NoButton)
    assert limbs.canvas.hover is None


def test_every_method_and_side_by_side_show_the_pinned_point_where_it_must_be(limbs, qtbot) -> None:
    limbs.drag(TIP, (1480.0, 400.0), (1500.0, 200.0))
    place = shown_vertex(limbs, 0)
    for method in ("linear", "rigid", "auto"):
        limbs.menu(f"span.{method}")
        assert near(shown_vertex(limbs, 0), place, 1e-6)  # what stands in for a slow plan is pinned too
        limbs.settle(qtbot)
        assert near(shown_vertex(limbs, 0), place, 1e-6)
    limbs.menu("view.side")
    assert len(limbs.canvas.pin_marks) == 1
    assert shades(limbs.picture()) > 20


def shades(image):
    small = image.scaled(160, 100)
    return len({small.pixel(x, y) for x in range(160) for y in range(0, 100, 3)})


def test_the_ways_of_pins_and_of_vertices_are_painted(limbs) -> None:
    plain = limbs.picture()
    limbs.click(TIP)
    limbs.move(FREE, button=Qt.MouseButton.NoButton)
    pinned = limbs.picture()
    assert pinned != plain
    assert limbs.canvas.pin_marks[0].dots.shape == (25, 2)  # a dot a frame
    limbs.menu("view.paths")
    assert limbs.canvas.content.options.paths
    assert limbs.picture() != pinned
    limbs.menu("view.paths")
    assert limbs.picture() == pinned


def test_the_ways_of_vertices_are_few_and_go_from_keyframe_to_keyframe(limbs) -> None:
    content = limbs.canvas.content
    ways = vertex_ways(content.motion, range(content.before.frame, content.after.frame + 1))
    assert ways.shape[0] == 25
    assert 20 < ways.shape[1] <= 40
    left = content.plan.links[0].aligned.left
    assert {tuple(p) for p in ways[0]} <= {tuple(p) for p in left}


def test_pins_are_saved_and_opened(limbs, tmp_path) -> None:
    limbs.drag(TIP, (1480.0, 400.0), (1500.0, 200.0))
    limbs.session.save(tmp_path / "pinned.inkb")
    assert load(tmp_path / "pinned.inkb") == limbs.session.document

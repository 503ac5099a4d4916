"""Which point goes where, by hand: alternatives, mute, lines made anchors, direction and start, stored answers."""

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QEnterEvent
from PySide6.QtWidgets import QApplication

from app.canvas.lines import hue_pieces, shown_rows
from core import load
from core.correspondence.by_hand import mean_shift
from core.model.document import Document, OutlinePair
from core.model.edits import add_outline, move_vertices, store_answer

U = np.linspace(0, 2 * np.pi, 40, endpoint=False)


def limb(bend):
    """A smooth limb, bent in its middle."""
    x, y = 500 * np.cos(U), 110 * np.sin(U)
    turn = bend * np.clip(x / 500, 0, 1)
    return np.column_stack([960 + x * np.cos(turn) - y * np.sin(turn), 540 + x * np.sin(turn) + y * np.cos(turn)])


@pytest.fixture
def limbs(hand, qtbot):
    """The hand, with two keyframes of a bending limb open."""
    document = Document()
    for frame, bend in ((1, 0.0), (24, -1.0)):
        document = add_outline(document, 1, frame, limb(bend))
    hand.session.new(document)
    hand.session.go_to(12)
    hand.settle(qtbot)
    hand.key(Qt.Key.Key_C)
    return hand


def alternatives(hand, qtbot):
    panel = hand.editor.window.alternatives_panel
    qtbot.waitUntil(lambda: len(panel.buttons) > 1, timeout=20_000)
    return panel


def shown(hand):
    return hand.canvas.content.picture.outlines[0][0]


def pair(hand):
    return hand.session.layer.keyframe_at(1).span.pairs[0]


def current(hand):
    before, after = hand.session.span_keyframes()
    return hand.editor.preview.correspondence(before, after, hand.session.layer.id, (1, 1))


def apart(one, other):
    return mean_shift(one, other, limb(0.0), limb(-1.0))


def test_the_alternatives_are_shown_best_first_and_a_click_takes_one(limbs, qtbot) -> None:
    panel = alternatives(limbs, qtbot)
    costs = [float(b.text()) for b in panel.buttons]
    assert costs == sorted(costs)
    assert panel.buttons[0].isChecked()
    second = limbs.editor.ranked.ranking.alternatives[1].correspondence
    limbs.press_button(panel.buttons[1])
    assert pair(limbs).chosen
    assert apart(current(limbs), second) == 0
    assert panel.buttons[1].isChecked()
    assert panel.badge.text() == "your choice"
    limbs.press_button(panel.again)
    limbs.settle(qtbot)
    assert apart(current(limbs), second) > 0.02
    limbs.menu("edit.undo")
    assert apart(current(limbs), second) == 0


def test_hovering_an_alternative_tries_it_and_leaving_takes_it_back(limbs, qtbot) -> None:
    panel, document = alternatives(limbs, qtbot), limbs.session.document
    before = shown(limbs).copy()
    button, at = panel.buttons[1], QPointF(10, 10)
    QApplication.sendEvent(button, QEnterEvent(at, at, at))
    assert not np.array_equal(shown(limbs)[: len(before)], before[: len(shown(limbs))])
    assert limbs.session.document is document
    QApplication.sendEvent(button, QEvent(QEvent.Type.Leave))
    assert np.array_equal(shown(limbs), before)


def test_a_chosen_correspondence_stays_while_vertices_are_moved(limbs, qtbot) -> None:
    panel = alternatives(limbs, qtbot)
    limbs.press_button(panel.buttons[1])
    taken = pair(limbs).correspondence
    limbs.key(Qt.Key.Key_V)
    limbs.drag(tuple(limb(0.0)[20]), (440.0, 560.0), (430.0, 570.0))
    assert pair(limbs).correspondence is taken


def test_muting_an_anchor_takes_its_effect_away_and_keeps_it(limbs, qtbot) -> None:
    automatic = current(limbs)
    limbs.drag(tuple(limb(0.0)[10]), (900.0, 400.0), tuple(limb(-1.0)[17]))
    limbs.settle(qtbot)
    anchored = current(limbs)
    assert apart(automatic, anchored) > 0.01
    limbs.key(Qt.Key.Key_M)
    limbs.settle(qtbot)
    assert pair(limbs).anchors[0].muted
    assert apart(current(limbs), automatic) < 1e-9
    limbs.key(Qt.Key.Key_M)
    limbs.settle(qtbot)
    assert apart(current(limbs), anchored) < 1e-9


def test_a_double_click_on_a_line_makes_it_an_anchor_that_changes_nothing(limbs, qtbot) -> None:
    link = limbs.canvas.content.plan.links[0]
    left, right = link.aligned.left, link.aligned.right
    gaps = np.hypot(*(right - left).T)
    rows = shown_rows(link)
    row = rows[int(gaps[rows].argmax())]
    before = current(limbs)
    limbs.double_click(tuple(0.6 * left[row] + 0.4 * right[row]))
    ((made, _),) = pair(limbs).held
    assert abs((made - link.before_positions[row] + 20) % 40 - 20) < 1  # neighbouring lines nearly touch
    limbs.settle(qtbot)
    assert apart(before, current(limbs)) < 0.02


def test_the_start_is_shifted_vertex_by_vertex_and_back_and_the_direction_flipped(limbs, qtbot) -> None:
    start = current(limbs)
    limbs.key("]")
    once = current(limbs)
    assert 0 < apart(start, once) < 0.05
    limbs.key("]")
    assert apart(start, current(limbs)) > apart(start, once)
    limbs.key("[")
    assert apart(once, current(limbs)) < 1e-9
    limbs.menu("span.flip")
    assert current(limbs).flipped != start.flipped
    for _ in range(4):
        limbs.menu("edit.undo")
    limbs.settle(qtbot)
    assert apart(start, current(limbs)) < 1e-9


def test_anchors_keep_the_start_and_the_direction(limbs) -> None:
    limbs.drag(tuple(limb(0.0)[10]), (900.0, 400.0), tuple(limb(-1.0)[10]))
    document = limbs.session.document
    limbs.key("]")
    assert limbs.session.document is document
    assert "Anchors hold" in limbs.message


def test_a_stored_answer_is_used_as_it_is_and_a_badge_tells_that_a_new_one_differs(limbs, qtbot, tmp_path) -> None:
    ranking = alternatives(limbs, qtbot) and limbs.editor.ranked.ranking
    old = ranking.alternatives[1].correspondence  # as an earlier version might have answered
    document = store_answer(limbs.session.document, 1, 1, 1, 1, old)
    limbs.session.new(document)
    limbs.session.save(tmp_path / "old.inkb")
    assert load(tmp_path / "old.inkb") == document
    limbs.editor.files.open_path(tmp_path / "old.inkb", ask=False)
    assert apart(current(limbs), old) == 0
    panel = alternatives(limbs, qtbot)
    assert panel.badge.text() == "a new solve would differ"
    limbs.press_button(panel.again)
    limbs.settle(qtbot)
    assert apart(current(limbs), old) > 0.02
    assert panel.badge.text() == ""


def test_a_stored_answer_is_given_up_when_a_vertex_moves(limbs) -> None:
    document = store_answer(limbs.session.document, 1, 1, 1, 1, current(limbs))
    assert document.layers[0].keyframes[0].span.pairs[0].correspondence is not None
    moved = move_vertices(document, 1, 24, {1: limb(-1.0) + 1})
    assert moved.layers[0].keyframes[0].span.pairs == ()


def test_outlines_of_a_drawing_are_paired_by_hand_with_an_anchor(hand, qtbot) -> None:
    small = np.array([(0.0, 0.0), (120.0, 0.0), (120.0, 120.0), (0.0, 120.0)])
    document = Document()
    for frame, shift in ((1, 0.0), (24, 40.0)):
        for x in (300.0, 900.0):
            document = add_outline(document, 1, frame, np.add(small, (x, 400 + shift)))
    hand.session.new(document)
    hand.session.go_to(12)
    assert {(k.before, k.after) for k in hand.canvas.content.plan.links} == {(1, 1), (2, 2)}
    hand.key(Qt.Key.Key_C)
    hand.drag((300.0, 400.0), (600.0, 420.0), (900.0, 440.0))
    assert hand.session.layer.keyframe_at(1).span.pairs[0].before == 1
    assert {(k.before, k.after) for k in hand.canvas.content.plan.links} == {(1, 2), (2, 1)}


def test_matching_parts_have_the_same_colour_on_both_outlines(limbs) -> None:
    limbs.key("h")
    assert limbs.canvas.content.options.hues
    link = limbs.canvas.content.plan.links[0]
    pieces = hue_pieces(link)
    assert [p[-1] for p in pieces[:-1]] == [p[0] for p in pieces[1:]]
    assert pieces[0][0] == 0
    assert pieces[-1][-1] == 0
    plain = limbs.picture()
    limbs.key("h")
    assert limbs.picture() != plain


def test_a_pair_without_anchors_or_answer_is_possible() -> None:
    assert OutlinePair(1, 2).held == ()

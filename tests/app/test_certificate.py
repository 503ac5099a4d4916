"""The certificate in the window: which spans have one, the strip, the panel, the marks on the canvas."""

from dataclasses import replace

import pytest

from core.model.edits import set_span
from tests.app.sketches import film, swing


@pytest.fixture
def crossing(hand, qtbot):
    """The hand, with a span open that crosses itself in its middle (frame 8)."""
    hand.session.new(swing(2.0))
    hand.session.go_to(5)
    hand.certify(qtbot)
    return hand


def certificate(hand):
    return hand.editor.certificates.of(*hand.session.span_keyframes())


def test_the_spans_of_the_layer_are_certified_when_the_hand_rests(hand, qtbot):
    document = film(length=12, size=(640, 480), side=200.0)
    layer = document.layers[0]
    hand.session.new(
        document.with_layer(replace(layer, keyframes=(*layer.keyframes, swing(2.0).layers[0].keyframes[1])))
    )
    assert certificate(hand) is None
    hand.certify(qtbot)
    assert certificate(hand).certificate.problems == ()
    assert hand.editor.certificates.of(*hand.session.layer.keyframes[1:]).frames == ()


def test_while_the_hand_drags_nothing_is_certified(crossing, qtbot):
    first = certificate(crossing)
    assert first.severity_at(8) == "error"
    gesture = crossing.session.begin("Change Turns")
    gesture.update(lambda d: set_span(d, 1, 3, method="intrinsic"))
    qtbot.wait(400)
    assert certificate(crossing) is None
    gesture.commit()
    crossing.certify(qtbot)
    assert certificate(crossing).severity_at(8) == ""
    crossing.menu("edit.undo")
    assert certificate(crossing) is first


def test_a_span_is_certified_again_only_when_its_plan_is_another_one(crossing, qtbot):
    first = certificate(crossing)
    crossing.editor.preview.planned.emit()
    crossing.certify(qtbot)
    assert certificate(crossing) is first


def test_a_repaired_span_is_certified_when_the_repair_is_there(crossing, qtbot):
    crossing.session.apply("Repair", set_span, 1, 3, repair=True)
    crossing.certify(qtbot)
    assert certificate(crossing).certificate.ok

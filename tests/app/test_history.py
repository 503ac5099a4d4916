"""Edits of all kinds in a row: undone to the start and redone to the end, the document is the same to the byte."""

import random
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from app.keys import Keys
from app.session import Session
from core.io.project import decode, encode
from core.model import edits, frame_edits
from core.model.document import Anchor, Document, Reference, Stage
from core.model.drawing import Drawing, Outline, Style
from core.model.easing import PRESETS
from core.model.pins import SpanPin

LAST = 60


class Anyone:
    """Names things of a document at random; most of them are there."""

    def __init__(self, document: Document, chance: random.Random) -> None:
        self.document, self.chance = document, chance
        self.layer = chance.choice(document.layers)
        keyframes = self.layer.keyframes
        self.key = chance.choice(keyframes).frame if keyframes and chance.random() < 0.95 else self.frame()
        keyframe = self.layer.keyframe_at(self.key)
        self.drawing = keyframe.drawing if keyframe else Drawing((Outline(1, self.points(4)),))
        self.outline = chance.choice(self.drawing.outlines)
        self.at = self.layer.id, self.key

    def frame(self) -> int:
        return self.chance.randint(1, LAST)

    def points(self, count: int):
        return np.array([[self.chance.uniform(0, 500) for _ in range(2)] for _ in range(count)])

    def keys(self):
        every = [(x.id, f) for x in self.document.layers for f in x.frames()]
        return self.chance.sample(every, min(len(every), self.chance.randint(1, 4))) or [self.at]

    def layer_id(self) -> int:
        return self.chance.choice(self.document.layers).id

    def color(self) -> str:
        return f"#{self.chance.randrange(1 << 24):06x}"


def _pasted(d, a):
    return frame_edits.paste_keyframes(d, frame_edits.copy_keyframes(d, a.keys()), a.layer_id(), a.frame())[0]


def _style(a):
    return Style(a.color(), a.color(), a.chance.uniform(0, 9), opacity=a.chance.random())


def _changes(a):
    return a.chance.choice(
        (
            {"name": f"row {a.frame()}"},
            {"visible": a.chance.random() < 0.5},
            {"locked": a.chance.random() < 0.5},
            {"opacity": a.chance.random()},
            {"color": a.color()},
        )
    )


def _span_changes(a):
    return a.chance.choice(
        (
            {"method": a.chance.choice(("linear", "intrinsic", "rigid", "auto"))},
            {"easing": a.chance.choice(list(PRESETS.values()))},
            {"turns": a.chance.randint(-2, 2)},
            {"repair": a.chance.random() < 0.5},
            {"placement": "centroid"},
            {"hold": a.chance.random() < 0.3},
        )
    )


KINDS = {
    "draw": lambda d, a: edits.add_outline(d, a.layer.id, a.frame(), a.points(5), closed=a.chance.random() < 0.7),
    "put a drawing": lambda d, a: edits.put_drawing(d, *a.at, Drawing((Outline(1, a.points(4)),), _style(a))),
    "move vertices": lambda d, a: edits.move_vertices(
        d, *a.at, {a.outline.id: a.outline.points + a.chance.uniform(-9, 9)}
    ),
    "insert a vertex": lambda d, a: edits.insert_vertex(d, *a.at, a.outline.id, a.chance.uniform(0, 4)),
    "delete vertices": lambda d, a: edits.delete_vertices(d, *a.at, {a.outline.id: [a.chance.randint(0, 4)]}),
    "delete an outline": lambda d, a: edits.delete_outline(d, *a.at, a.outline.id),
    "style": lambda d, a: edits.set_style(d, *a.at, _style(a)),
    "reference": lambda d, a: edits.set_reference(d, *a.at, Reference("picture.png", a.chance.random())),
    "anchor": lambda d, a: edits.add_anchor(d, *a.at, a.outline.id, 1, Anchor(*a.points(1)[0] / 200)),
    "clear anchors": lambda d, a: edits.clear_anchors(d, *a.at),
    "pin": lambda d, a: edits.add_pin(d, *a.at, SpanPin(a.outline.id, a.chance.uniform(0, 2))),
    "clear pins": lambda d, a: edits.clear_pins(d, *a.at),
    "span": lambda d, a: edits.set_span(d, *a.at, **_span_changes(a)),
    "step": lambda d, a: edits.set_step(d, *a.at, a.chance.randint(1, 6)),
    "move a tick": lambda d, a: edits.move_tick(d, *a.at, a.chance.randint(1, 3), a.chance.random()),
    "hold a tick": lambda d, a: edits.hold_tick(d, *a.at, a.chance.randint(0, 3), a.chance.randint(1, 3)),
    "divide a tick": lambda d, a: edits.divide_tick(d, *a.at, a.chance.randint(0, 3), a.chance.randint(2, 3)),
    "delete a tick": lambda d, a: edits.delete_tick(d, *a.at, a.chance.randint(1, 3)),
    "move a keyframe": lambda d, a: edits.move_keyframe(d, *a.at, a.frame()),
    "delete a keyframe": lambda d, a: edits.delete_keyframe(d, *a.at),
    "move keyframes": lambda d, a: frame_edits.move_keyframes(d, a.keys(), a.chance.randint(-9, 9)),
    "stretch keyframes": lambda d, a: frame_edits.stretch_keyframes(d, a.keys(), *sorted((a.frame(), a.frame()))),
    "delete keyframes": lambda d, a: frame_edits.delete_keyframes(d, a.keys()[:2]),
    "paste keyframes": _pasted,
    "duplicate keyframes": lambda d, a: frame_edits.duplicate_keyframes(d, a.keys())[0],
    "hold": lambda d, a: frame_edits.hold_keyframes(d, a.keys(), a.chance.random() < 0.5),
    "smooth": lambda d, a: frame_edits.smooth_keyframes(d, a.keys(), a.chance.random() < 0.5),
    "insert frames": lambda d, a: frame_edits.insert_frames(d, a.frame(), 2, [a.layer.id]),
    "insert frames everywhere": lambda d, a: frame_edits.insert_frames(d, a.frame(), 1),
    "remove frames": lambda d, a: frame_edits.remove_frames(d, f := a.frame(), f + 1, [a.layer.id]),
    "remove frames everywhere": lambda d, a: frame_edits.remove_frames(d, f := a.frame(), f),
    "add a layer": lambda d, a: edits.add_layer(d, above=a.layer.id) if len(d.layers) < 5 else d,
    "duplicate a layer": lambda d, a: edits.duplicate_layer(d, a.layer.id) if len(d.layers) < 5 else d,
    "delete a layer": lambda d, a: edits.delete_layer(d, a.layer.id),
    "reorder layers": lambda d, a: edits.move_layer(d, a.layer.id, a.chance.randint(0, 4)),
    "change a layer": lambda d, a: edits.set_layer(d, a.layer.id, **_changes(a)),
    "unlock": lambda d, a: edits.set_layer(d, a.layer.id, locked=False),
    "follow": lambda d, a: edits.set_parent(d, a.layer.id, a.chance.choice((None, a.layer_id()))),
    "length": lambda d, a: edits.set_length(d, a.frame()),
    "rate": lambda d, a: edits.set_rate(d, Fraction(a.frame() * 1000, 1001)),
    "stage": lambda d, a: edits.set_stage(d, Stage(400 + a.frame(), 300, a.color())),
}


def edit_of(kind, seed):
    """An edit that does the same to the same document every time, as a gesture asks of it."""

    def edit(document):
        return KINDS[kind](document, Anyone(document, random.Random(seed)))

    return edit


def started():
    session = Session()
    for frame in (1, 12, 24):
        document = edits.put_drawing(
            session.document,
            1,
            frame,
            Drawing((Outline(1, np.array([(frame, 0), (99, 0), (99, 99), (0, 99.0)])),)),
        )
        session.new(document)
    return session


SOME = st.sampled_from(sorted(KINDS))


class History(RuleBasedStateMachine):
    """`saved` are the bytes of every document that undo and redo lead to."""

    def __init__(self):
        super().__init__()
        self.session = started()
        self.keys = Keys(self.session)
        self.saved = [encode(self.session.document)]

    @property
    def here(self):
        return self.session.undo_stack.index()

    def _note(self, before):
        if self.session.document is not before:
            self.saved = [*self.saved[: self.here], encode(self.session.document)]

    @rule(kind=SOME, seed=st.integers(0, 1 << 30))
    def edit(self, kind, seed):
        before = self.session.document
        self.session.apply(kind, edit_of(kind, seed))
        self._note(before)

    @rule(
        kinds=st.lists(SOME, min_size=1, max_size=3),
        seed=st.integers(),
        keep=st.booleans(),
    )
    def drag(self, kinds, seed, keep):
        before, steps = self.session.document, self.here
        gesture = self.session.begin("drag")
        for i, kind in enumerate(kinds):
            gesture.update(edit_of(kind, seed + i))
        gesture.commit() if keep else gesture.cancel()
        assert keep or (self.session.document is before and self.here == steps)
        if self.here > steps:
            self._note(before)

    @rule(seed=st.integers())
    def select(self, seed):
        self.keys.choose(Anyone(self.session.document, random.Random(seed)).keys())

    @precondition(lambda self: self.here > 0)
    @rule()
    def undo(self):
        self.session.undo_stack.undo()

    @precondition(lambda self: self.session.undo_stack.canRedo())
    @rule()
    def redo(self):
        self.session.undo_stack.redo()

    @invariant()
    def the_document_is_the_one_of_this_step(self):
        assert encode(self.session.document) == self.saved[self.here]

    def teardown(self):
        stack = self.session.undo_stack
        for step in (*range(self.here, -1, -1), *range(stack.count() + 1)):
            stack.setIndex(step)
            assert encode(self.session.document) == self.saved[step]
        assert decode(self.saved[-1]) == self.session.document


TestHistory = History.TestCase
TestHistory.settings = settings(max_examples=40, stateful_step_count=40, deadline=None)


@pytest.mark.parametrize("seed", range(3))
def test_a_thousand_edits_are_undone_to_the_start_and_redone_to_the_end(qapp, seed):
    session, chance = started(), random.Random(seed)
    stack, kinds = session.undo_stack, sorted(KINDS)
    saved, used = [encode(session.document)], set()
    while stack.count() < 1000:
        kind = chance.choice(kinds)
        session.apply(kind, edit_of(kind, chance.random()))
        if stack.count() == len(saved):
            saved.append(encode(session.document))
            used.add(kind)
    assert len(used) > 0.9 * len(kinds)
    for step in (*range(999, -1, -1), *range(1, 1001)):
        stack.undo() if step < stack.index() else stack.redo()
        if step % 50 == 0:
            assert encode(session.document) == saved[step]
    assert encode(session.document) == saved[-1]
    assert decode(saved[-1]) == session.document

"""What is looked for in every frame of an outline, and between two of them."""

import numpy as np

from core.certificate.problems import Log, worst_first
from core.certificate.views import SMALL, View
from core.geometry.crossings import crossing_places, frame_crossings, frame_crossings_between
from core.geometry.outline import FloatArray, edge_vectors, signed_area

COLLAPSED = 0.1
"""An edge below this share of its length in either keyframe has collapsed."""

EXPLODED = 3.0
"""An edge beyond so many of its lengths in either keyframe has exploded."""

FOLDED = np.deg2rad(170.0)
"""A turning angle beyond this doubles back."""

NEW_FOLD = np.deg2rad(30.0)
"""By so much it must exceed the wider of both keyframes'."""

NO_AREA = 1e-6
"""Share of the smaller keyframe's area below which an area has no sign of its own."""

AREA_TOLERANCE = 0.05
"""Share by which an area may leave the range of both keyframes'."""


def look_at(view: View, log: Log) -> None:
    """Note everything that is wrong with one outline."""
    broken = np.flatnonzero(~view.finite)
    log.count("number", broken)
    for k in broken.tolist():
        text = f"{view.name}a vertex is not a finite number"
        log.add("number", "error", k, (0.0, 0.0), text, outlines=[view.index], value=1)
    _crossed(view, log)
    _folded(view, log)
    _wrong_lengths(view, log)
    if view.closed:
        _wrong_area(view, log)
    _missed_keyframes(view, log)


def _crossed(view: View, log: Log) -> None:
    rows = frame_crossings(view.frames, closed=view.closed)
    rows = rows[view.finite[rows[:, 0]]]
    log.count("crossing", rows[:, 0])
    crossed = view.crosses() if len(rows) else []
    severity = ("error", "warning", "info")[len(crossed)]
    why = f", as in {' and '.join(crossed)}" if crossed else ""
    for k, listed, count in worst_first(rows[:, 0], np.zeros(len(rows))):
        places = crossing_places(view.frames[k], rows[listed, 1:])
        for (i, j), place in zip(rows[listed, 1:].tolist(), places, strict=True):
            text = f"{view.name}edge {i} crosses edge {j}{why}"
            log.add("crossing", severity, k, place, text, edges=(i, j), outlines=[view.index] * 2, value=count)


def _turning(points: FloatArray, closed: bool) -> FloatArray:
    """Turning angles (T, n) at all vertices, radians; 0 at the ends of open outlines and beside points."""
    d = edge_vectors(points, closed=closed)
    before = np.roll(d, 1, axis=1) if closed else d[:, :-1]
    after = d if closed else d[:, 1:]
    across = before[..., 0] * after[..., 1] - before[..., 1] * after[..., 0]
    angle = np.arctan2(across, (before * after).sum(axis=2))
    return np.asarray(angle if closed else np.pad(angle, ((0, 0), (1, 1))), np.float64)


def _folded(view: View, log: Log) -> None:
    turn = np.abs(_turning(view.frames, view.closed))
    known = np.abs(_turning(view.ends, view.closed)).max(axis=0)
    frame, vertex = np.nonzero((turn > np.maximum(FOLDED, known + NEW_FOLD)) & view.finite[:, None])
    count = view.frames.shape[1]
    edges = np.stack([(vertex - 1) % count, vertex], axis=1)
    seen = view.lengths[frame[:, None], edges].min(axis=1) > SMALL * view.size
    frame, vertex, edges = frame[seen], vertex[seen], edges[seen]
    log.count("fold", frame)
    for k, listed, _ in worst_first(frame, -turn[frame, vertex]):
        for v, pair in zip(vertex[listed].tolist(), edges[listed].tolist(), strict=True):
            degrees = np.rad2deg(turn[k, v])
            text = f"{view.name}edge {pair[1]} folds back onto edge {pair[0]} (a turn of {degrees:.0f} degrees)"
            log.add(
                "fold", "warning", k, view.frames[k, v], text, edges=pair, outlines=[view.index] * 2, value=degrees
            )


def _wrong_lengths(view: View, log: Log) -> None:
    shortest, longest = view.end_lengths.min(axis=0), view.end_lengths.max(axis=0)
    floor = SMALL * view.size
    with np.errstate(divide="ignore", invalid="ignore"):
        short, long = view.lengths / shortest, view.lengths / longest
    collapsed = (short < COLLAPSED) & (shortest > floor)
    exploded = (view.lengths > EXPLODED * longest) & (view.lengths > 10 * floor)
    closing = np.zeros(view.lengths.shape[1], np.bool_)
    closing[-1:] = view.closed
    for kind, wrong, share, worst in (
        ("collapse", collapsed, short, short),
        ("explosion", exploded & ~closing, long, -long),
        ("closure", exploded & closing, long, -long),
    ):
        frame, edge = np.nonzero(wrong & view.finite[:, None])
        log.count(kind, frame)
        for k, listed, _ in worst_first(frame, worst[frame, edge]):
            for e in edge[listed].tolist():
                much = float(share[k, e])
                text = view.name + _length_text(kind, e, much)
                place = view.frames[k, [e, (e + 1) % view.frames.shape[1]]].mean(axis=0)
                log.add(kind, "warning", k, place, text, edges=[e], outlines=[view.index], value=much)


def _length_text(kind: str, edge: int, share: float) -> str:
    if kind == "collapse":
        return f"edge {edge} has shrunk to {100 * share:.0f} % of its length in either keyframe"
    much = f"{share:.3g} times" if np.isfinite(share) else "endlessly many times"
    if kind == "closure":
        return f"the outline does not close: its last edge is {much} as long as in either keyframe"
    return f"edge {edge} has grown to {much} its length in either keyframe"


def _wrong_area(view: View, log: Log) -> None:
    area, ends = view.area, np.asarray(signed_area(view.ends), np.float64)
    low, high = np.sort(np.abs(ends))
    away = np.where(np.abs(area) > NO_AREA * low, np.sign(area), 0.0)
    inverted = np.flatnonzero((away * ends[0] < 0) & (away * ends[1] < 0) & view.finite)
    log.count("inside out", inverted)
    for k in inverted.tolist():
        text = f"{view.name}the outline is turned inside out"
        log.add("inside out", "error", k, _middle(view, k), text, outlines=[view.index], value=1)
    size = np.abs(area)
    small, large = size < low * (1 - AREA_TOLERANCE), size > high * (1 + AREA_TOLERANCE)
    outside = np.flatnonzero((small | large) & view.finite)
    log.count("area", outside)
    for k in outside.tolist():
        name, bound = ("smaller", low) if small[k] else ("larger", high)
        share = size[k] / bound if bound > 0 else np.inf
        text = f"{view.name}the area is {100 * share:.0f} % of the {name} keyframe's"
        log.add("area", "warning", k, _middle(view, k), text, outlines=[view.index], value=share)


def _missed_keyframes(view: View, log: Log) -> None:
    for t, end, name in ((0.0, view.ends[0], "before"), (1.0, view.ends[1], "after")):
        for k in np.flatnonzero((log.times == t) & view.finite).tolist():
            away = np.hypot(*(view.frames[k] - end).T)
            if away.max() > 0:
                v = int(away.argmax())
                text = f"{view.name}vertex {v} is {away[v]:.3g} px off the keyframe {name}"
                place = view.frames[k, v]
                log.add("keyframe", "warning", k, place, text, outlines=[view.index], value=away[v])
                log.count("keyframe", np.array([k]))


def look_between(view: View, other: View, log: Log) -> None:
    """Note where two outlines cross each other."""
    rows = frame_crossings_between(view.frames, other.frames, closed=view.closed, others_closed=other.closed)
    rows = rows[(view.finite & other.finite)[rows[:, 0]]]
    if not len(rows):
        return
    ends = frame_crossings_between(view.ends, other.ends, closed=view.closed, others_closed=other.closed)
    crossed = [("before", "after")[k] for k in np.unique(ends[:, 0])]
    severity = ("error", "warning", "info")[len(crossed)]
    why = f", as in {' and '.join(crossed)}" if crossed else ""
    log.count("crossing", rows[:, 0])
    for k, listed, count in worst_first(rows[:, 0], np.zeros(len(rows))):
        places = crossing_places(view.frames[k], rows[listed, 1:], other.frames[k])
        for (i, j), place in zip(rows[listed, 1:].tolist(), places, strict=True):
            text = f"edge {i} of outline {view.index} crosses edge {j} of outline {other.index}{why}"
            pair = (view.index, other.index)
            log.add("crossing", severity, k, place, text, edges=(i, j), outlines=pair, value=count)


def _middle(view: View, frame: int) -> FloatArray:
    return np.asarray(view.frames[frame].mean(axis=0), np.float64)

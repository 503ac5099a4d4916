"""The certificate of a span: what is wrong with its in-betweens, by frame of the film."""

from dataclasses import dataclass
from functools import cached_property
from itertools import groupby

import numpy as np

from core.certificate import SEVERITIES, Certificate, Problem, certify_drawing
from core.certificate.views import factors
from core.geometry.outline import FloatArray, edge_lengths
from core.methods.plan import AlignedPair
from core.model.advice import advice
from core.model.motion import SpanMotion


@dataclass(frozen=True, eq=False)
class SpanCertificate:
    """What was found on the in-betweens of a span.

    Attributes
    ----------
    certificate : Certificate
    frames : tuple of int
        The frames of the film that the certificate's frames are: all between the two keyframes.
    advice : str
        Why intrinsic paths, repaired, do better than the straight ones of this span, in a sentence; "" if not.
    """

    certificate: Certificate
    frames: tuple[int, ...]
    advice: str = ""

    @cached_property
    def worst(self) -> dict[int, Problem]:
        """The worst problem of every frame that has one."""
        found: dict[int, Problem] = {}
        for p in self.certificate.problems:
            if p.frame is not None:
                found.setdefault(self.frames[p.frame], p)
        return found

    @cached_property
    def summary(self) -> tuple[Problem, ...]:
        """Of every kind of problem the worst one, errors first."""
        found: dict[tuple[str, str], Problem] = {}
        for p in self.certificate.problems:
            known = found.setdefault((p.severity, p.kind), p)
            if _badness(p) > _badness(known):
                found[p.severity, p.kind] = p
        return tuple(sorted(found.values(), key=lambda p: SEVERITIES.index(p.severity)))

    @cached_property
    def runs(self) -> tuple[tuple[int, int, str], ...]:
        """Frames that have the same worst severity: the first, the last, and it; "" where nothing was found."""
        groups = (tuple(g) for _, g in groupby(self.frames, key=self.severity_at))
        return tuple((g[0], g[-1], self.severity_at(g[0])) for g in groups)

    def frame_of(self, problem: Problem) -> int | None:
        """Return the frame of the film that a problem is on; None where it is the whole span's."""
        return None if problem.frame is None else self.frames[problem.frame]

    def severity_at(self, frame: int) -> str:
        """Return the worst severity of a frame, "" where nothing was found."""
        problem = self.worst.get(frame)
        return problem.severity if problem else ""

    def worst_near(self, frame: int) -> int:
        """Return the worst frame of the run that a frame with a problem lies in, or else the frame itself."""
        for first, last, severity in self.runs:
            if severity in SEVERITIES[:2] and first <= frame <= last:
                within = {f: self.worst[f] for f in range(first, last + 1) if f in self.worst}
                kind = within[frame].kind if frame in within else ""
                alike = [f for f, p in within.items() if p.kind == kind]
                return max(alike, key=lambda f: _badness(within[f]), default=frame)
        return frame


def certify_span(motion: SpanMotion) -> SpanCertificate:
    """Return the certificate of all in-betweens of a span, each as it is shown at its frame."""
    before, after, plan = motion.before, motion.after, motion.plan
    frames = tuple(range(before.frame + 1, after.frame))
    times = motion.times(frames)
    if not frames or not plan.links or before.span.hold:
        empty = np.zeros(len(frames))
        return SpanCertificate(Certificate((), times, empty, empty, empty + 1, {}), frames)
    pairs = [link.aligned for link in motion.shown_plan.links]
    certificate = certify_drawing(
        motion.frames(frames),
        [p.closed for p in pairs],
        [p.left for p in pairs],
        [p.right for p in pairs],
        times=times,
        notes=plan.paths.notes,
    )
    return SpanCertificate(certificate, frames, advice(before.span, plan, times, certificate))


def _badness(problem: Problem) -> float:
    """Return a number that is the larger the worse, among problems of a kind."""
    if problem.kind == "collapse":
        return -problem.value
    if problem.kind == "area":  # a half is as bad as a double
        return max(problem.value, 1 / problem.value) if problem.value > 0 else np.inf
    return problem.value


def edge_stretch(pair: AlignedPair, points: FloatArray, t: float) -> FloatArray:
    """Return how many times as long as between the keyframes each edge of an in-between is.

    Parameters
    ----------
    pair : AlignedPair
        The outline in both keyframes.
    points : (n, 2) float array
        The in-between.
    t : float
        Its eased time.
    """
    ends = np.stack([pair.left, pair.right])
    size = float(np.ptp(ends, axis=1).max())
    lengths, end_lengths = (edge_lengths(x, closed=pair.closed) for x in (points[None], ends))
    stretch: FloatArray = factors(lengths, end_lengths, np.array([t]), size)[0]
    return stretch


def finding(problem: Problem) -> str:
    """Return the sentence of a problem without its time, to stand behind the frame's number."""
    return problem.text if problem.t is None else problem.text.removeprefix(f"frame at t {problem.t:.3g}: ")

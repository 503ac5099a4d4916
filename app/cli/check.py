"""`inkbetween check`: the problems of every in-between of a project, for people and for other programs."""

import argparse
import json
import math
import sys
from collections import Counter
from dataclasses import asdict
from itertools import pairwise
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # numpy comes with core: not for a usage error
    from core.model.document import Document

CLEAN, FAULTY = 0, 1


def check_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="inkbetween check",
        description="Look at every in-between of a project: crossings, folds, edges and areas that leave the "
        "range of the keyframes. One line a problem. The exit code is 1 if one of them is an error.",
    )
    parser.add_argument("file", metavar="FILE", help="a project (.inkb)")
    parser.add_argument("--json", action="store_true", help="for other programs to read")
    parser.set_defaults(run=_check)
    return parser


def _check(parsed: argparse.Namespace) -> int:
    from core.io.project import load

    count, problems = check(load(parsed.file))
    if parsed.json:
        sys.stdout.write(json.dumps({"file": parsed.file, "frames": count, "problems": problems}, indent=2) + "\n")
    else:
        lines = [_line(p) for p in problems]
        sys.stdout.write("\n".join([*lines, _summary(count, problems)]) + "\n")
    return FAULTY if any(p["severity"] == "error" for p in problems) else CLEAN


def check(document: "Document") -> tuple[int, list[dict[str, Any]]]:
    """Return how many in-betweens there are, and all their problems: layer by layer, errors of a span first."""
    from core.model.checking import certify_span
    from core.model.motion import PlanCache

    count, found, motions = 0, [], PlanCache().motions
    for layer in document.layers:
        for before, after in pairwise(layer.keyframes):
            made = certify_span(motions.of(document, layer, before, after))
            count += len(made.frames)
            where = {"layer": layer.name, "span": [before.frame, after.frame]}
            found += [where | _facts(p, made.frame_of(p)) for p in made.certificate.problems]
    return count, found


def _facts(problem: Any, frame: int | None) -> dict[str, Any]:
    """Return a problem with the film's frame and its bare sentence; a number that no JSON can hold is null."""
    from core.model.checking import finding

    value = problem.value if math.isfinite(problem.value) else None
    return asdict(problem) | {"frame": frame, "value": value, "text": finding(problem)}


def _line(problem: dict[str, Any]) -> str:
    first, last = problem["span"]
    frames = f"frames {first} to {last}" if problem["frame"] is None else f"frame {problem['frame']}"
    return f"layer {problem['layer']!r}, {frames}: {problem['text']} ({problem['severity']})"


def _summary(count: int, problems: list[dict[str, Any]]) -> str:
    checked = f"{count} in-between{'' if count == 1 else 's'} checked"
    told = Counter(p["severity"] for p in problems)
    words = [f"{told[s]} {s}{'' if told[s] == 1 else 's'}" for s in ("error", "warning") if told[s]]
    if told["info"]:
        words.append(f"{told['info']} as in the keyframes")
    return f"{checked}: {', '.join(words) or 'no problem'}"

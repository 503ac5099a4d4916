"""What an SVG holds that drawings cannot show: counted while reading, named once."""

from collections import Counter

UNSUPPORTED = {
    "text": "text",
    "image": "picture",
    "foreignObject": "embedded page",
    "script": "script",
    "animate": "animation",
    "animateTransform": "animation",
    "animateMotion": "animation",
    "set": "animation",
    "mesh": "mesh",
}
APPLIED = {"clip-path": "clip", "mask": "mask", "filter": "filter"}

REMARKS = {
    "gradient": ("painted in its first colour", "painted in their first colours"),
    "pattern": ("painted grey", "painted grey"),
    "missing paint": ("painted grey", "painted grey"),
    "clip": ("its parts are shown whole", "their parts are shown whole"),
    "mask": ("its parts are shown whole", "their parts are shown whole"),
    "filter": ("shown without it", "shown without them"),
    "path with a mistake": ("read up to it", "read up to them"),
    "overlapping path": ("its overlaps are holes now", "their overlaps are holes now"),
}
"""What became of them: of one, of several."""

PLURALS = {
    "path with a mistake": "paths with mistakes",
    "shape too far away": "shapes too far away",
    "part that repeats itself": "parts that repeat themselves",
}


class Notes:
    """Counts by word."""

    def __init__(self) -> None:
        self._counts: Counter[str] = Counter()

    def __call__(self, what: str) -> None:
        """Count one more."""
        self._counts[what] += 1

    def names(self) -> tuple[str, ...]:
        """Return "a text", "3 gradients (painted in their first colour)" and so on."""
        return tuple(_counted(word, count) for word, count in self._counts.items())


def _counted(word: str, count: int) -> str:
    if count == 1:
        text = f"{'an' if word[0] in 'aeiou' else 'a'} {word}"
    else:
        text = f"{count} {PLURALS.get(word, word + 's')}"
    remarks = REMARKS.get(word)
    return f"{text} ({remarks[count > 1]})" if remarks else text

"""What is wrong in a file, and where: errors with the JSON path, and counts that end before the memory does."""

import re
from typing import Any, TypeVar

import msgspec

from core.errors import FileFormatError, InkbetweenError
from core.io.format import LIMITS

LONGEST_TEXT = 400
T = TypeVar("T")


class place:
    """Put the place in the file behind what is wrong there."""

    def __init__(self, where: str) -> None:
        self.where = where

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        if isinstance(error, InkbetweenError):
            path = f" - at `$.{self.where}`" if self.where else ""
            raise FileFormatError(f"{error}{path}") from None


class Budget:
    """Counts what a document holds, and refuses more than the limits."""

    def __init__(self) -> None:
        self._left = dict(LIMITS)

    def take(self, what: str, count: int) -> None:
        """Count some more; raises FileFormatError when there are too many in all."""
        self._left[what] -= count
        if self._left[what] < 0:
            raise FileFormatError(f"more than {LIMITS[what]:,} {what} in all; a project holds no more")


def decoded(content: Any, kind: type[T]) -> T:
    """Return JSON as `kind`; raises FileFormatError that names the place."""
    try:
        return msgspec.json.decode(content, type=kind)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as e:
        raise FileFormatError(_short(str(e))) from None


def _short(text: str) -> str:
    """Make one line of a text that repeats what a hostile file says, and cut out the middle of a long one."""
    if len(text) > LONGEST_TEXT:
        text = f"{text[:100]}…{text[100 - LONGEST_TEXT :]}"
    return "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)


def decoded_at(raw: msgspec.Raw, kind: type[T], where: str) -> T:
    """Return a raw part of the file, which stands at `where`, as `kind`."""
    try:
        return decoded(raw, kind)
    except FileFormatError as e:
        text = str(e)
        if "`$" in text:
            text = re.sub(r"`\$(.*)`$", lambda m: f"`$.{where}{m[1]}`", text)
        else:
            text = f"{text} - at `$.{where}`"
        raise FileFormatError(text) from None

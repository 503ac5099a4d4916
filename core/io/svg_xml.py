"""The XML of an SVG, read so that a hostile file can neither fill the memory nor reach out of itself."""

import gc
from collections.abc import Callable
from typing import Any
from xml.etree.ElementTree import Element, ParseError, TreeBuilder

from core.errors import CancelledError, FileFormatError, InkbetweenError

SVG_SPACE = "{http://www.w3.org/2000/svg}"
MOST_ELEMENTS = 1_000_000
DEEPEST = 100
"""Groups inside groups; drawing programs stay below 30."""

PIECE = 1 << 16
XML_SHARE = 0.25
"""Share of the time that goes into reading the XML, for the progress."""

Progress = Callable[[float], object]
Asked = Callable[[], bool]


class Watch:
    """Counts what is done of `total`, tells it, and raises CancelledError when asked to stop."""

    def __init__(self, total: int, progress: Progress | None, cancelled: Asked | None) -> None:
        self._total = max(total, 1)
        self._progress, self._cancelled = progress, cancelled
        self._done = self._next = self._low = 0.0
        self._high = 1.0

    def stretch(self, low: float, high: float) -> None:
        """Begin a part of the work that runs from one share of the whole to another."""
        self._low, self._high = low, high
        self._done = self._next = 0.0

    def step(self, amount: float) -> None:
        """Count some more as done."""
        self._done += amount
        if self._done < self._next:
            return
        self._next = self._done + self._total / 200
        if self._cancelled is not None and self._cancelled():
            raise CancelledError("the import was cancelled")
        if self._progress is not None:
            share = min(self._done / self._total, 1.0)
            self._progress(self._low + (self._high - self._low) * share)


class _Builder(TreeBuilder):
    """Builds the tree and counts: no deeper, no larger than a drawing is."""

    def __init__(self) -> None:
        super().__init__()
        self._depth = self._count = 0

    def start(self, tag: Any, attrs: Any, /) -> Any:
        self._depth += 1
        self._count += 1
        if self._depth > DEEPEST:
            raise FileFormatError(f"its groups lie more than {DEEPEST} deep in each other; ungroup them first")
        if self._count > MOST_ELEMENTS:
            raise FileFormatError(f"it has more than {MOST_ELEMENTS} elements; simplify it first")
        return super().start(tag, attrs)

    def end(self, tag: Any, /) -> Any:
        self._depth -= 1
        return super().end(tag)

    def pi(self, target: Any, text: Any = None) -> Any:
        """Refuse a style sheet that lies elsewhere; other remarks for programs mean nothing to us."""
        if target.startswith("xml-stylesheet"):
            raise FileFormatError("it takes its style sheet from another file; save it as a plain SVG")

    def comment(self, text: Any, /) -> Any:
        """Keep no comments."""


def parse_xml(content: bytes, watch: Watch) -> Element:
    """Return the outermost element; raises FileFormatError with one sentence for everything that is wrong."""
    from defusedxml.common import DefusedXmlException
    from defusedxml.ElementTree import DefusedXMLParser

    if content[:2] == b"\x1f\x8b":
        raise FileFormatError("it is compressed (SVGZ); save it as a plain SVG")
    watch.stretch(0.0, XML_SHARE)
    watch.step(0)
    parser = DefusedXMLParser(target=_Builder(), forbid_entities=True, forbid_external=True)
    was_on = gc.isenabled()
    gc.disable()  # nothing here is garbage, and looking for it takes half the time
    try:
        for first in range(0, len(content), PIECE):
            parser.feed(content[first : first + PIECE])
            watch.step(PIECE)
        root = parser.close()
    except DefusedXmlException:
        raise FileFormatError("it defines entities or refers to other files; save it as a plain SVG") from None
    except (ParseError, LookupError, UnicodeError, OverflowError) as e:
        raise FileFormatError(f"it is no SVG, or it is damaged ({e})") from None
    except InkbetweenError:
        raise
    except ValueError as e:  # expat cannot read all encodings that Python knows
        raise FileFormatError(f"its text encoding cannot be read ({e}); save it as UTF-8") from None
    finally:
        if was_on:
            gc.enable()
    if not isinstance(root, Element) or local_name(root) != "svg":
        raise FileFormatError("it is no SVG: its outermost element is another one")
    return root


def local_name(element: Element) -> str:
    """Return the element's name in SVG, or "" for one of another language."""
    tag = element.tag
    if not isinstance(tag, str):
        return ""
    if tag.startswith(SVG_SPACE):
        return tag[len(SVG_SPACE) :]
    return "" if tag.startswith("{") else tag

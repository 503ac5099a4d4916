"""How the canvas shows the document: remembered between runs, never saved in a file."""

from dataclasses import dataclass, fields, replace

from PySide6.QtCore import QObject, Signal

from app.settings import Settings

LINES = ("all", "anchors", "none")


@dataclass(frozen=True, slots=True)
class ViewOptions:
    """Everything that the view menu sets.

    Attributes
    ----------
    arrangement : str
        "overlaid", "side by side", or "compare": linear and intrinsic beside each other.
    lines : str
        One of LINES: which lines of the correspondence are drawn.
    onion : bool
    onion_before, onion_after : int
        Number of frames shown on either side of the playhead, 0 to 12.
    onion_strength : float
        Opacity of the nearest one, 0.05 to 1.
    hues : bool
        Both outlines are tinted along their length, matching parts alike.
    heat : bool
        The in-between's outline is coloured by the stretch of its edges.
    paths : bool
        The ways of some vertices through the span are drawn.
    sheet : bool
        The exposure sheet is open.
    final : bool
        Paint as exported, without keyframes and helpers.
    """

    arrangement: str = "overlaid"
    lines: str = "all"
    onion: bool = True
    onion_before: int = 2
    onion_after: int = 2
    onion_strength: float = 0.5
    hues: bool = False
    heat: bool = False
    paths: bool = False
    sheet: bool = False
    final: bool = False


class ViewState(QObject):
    """The current options; `changed` after each change."""

    changed = Signal()

    def __init__(self, settings: Settings, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._settings = settings
        d = ViewOptions()
        self._options = ViewOptions(
            lines=_one_of(settings.text("view/lines", d.lines), LINES),
            onion=settings.flag("view/onion", d.onion),
            hues=settings.flag("view/hues", d.hues),
            heat=settings.flag("view/heat", d.heat),
            paths=settings.flag("view/paths", d.paths),
            sheet=settings.flag("view/sheet", d.sheet),
            onion_before=int(settings.number("view/onion_before", d.onion_before, 0, 12)),
            onion_after=int(settings.number("view/onion_after", d.onion_after, 0, 12)),
            onion_strength=settings.number("view/onion_strength", d.onion_strength, 0.05, 1),
        )

    @property
    def options(self) -> ViewOptions:
        return self._options

    def set(self, **changes: object) -> None:
        """Change some options."""
        options = replace(self._options, **changes)  # type: ignore[arg-type]
        if options == self._options:
            return
        self._options = options
        for f in fields(options):
            if f.name not in ("arrangement", "final"):  # a fresh start shows the plain view
                self._settings.keep(f"view/{f.name}", getattr(options, f.name))
        self.changed.emit()


def _one_of(text: str, known: tuple[str, ...]) -> str:
    return text if text in known else known[0]

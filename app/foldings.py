"""Which sections of the side panel are folded away: remembered between runs."""

from collections.abc import Iterable

from app.panels.parts import Section
from app.settings import Settings


def remember_foldings(sections: Iterable[Section], settings: Settings) -> None:
    """Fold the sections that were folded last time, and remember what a person folds from now on."""
    for section in sections:
        key = f"folded/{section.name}"
        section.set_folded(settings.flag(key, False))
        section.folded.connect(lambda folded, key=key: settings.keep(key, folded))

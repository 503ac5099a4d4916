"""What is shipped beside the code: icons, one font, sample documents. Paths only; nothing here reads them."""

from importlib.resources import files
from pathlib import Path

DEMO = "walk"
"""The sample that the program opens to show itself."""


def folder() -> Path:
    """Return the folder of the resources, in a checkout and in an installed wheel alike."""
    return Path(str(files(__name__)))


def samples() -> tuple[Path, ...]:
    """Return the sample documents by name, the demo first."""
    found = folder().joinpath("samples").glob("*.inkb")
    return tuple(sorted(found, key=lambda path: (path.stem != DEMO, path.name)))


def icon(name: str) -> Path:
    """Return the SVG of an icon ("pen"); its lines have the colour `currentColor`, which the reader replaces.

    Raises
    ------
    FileNotFoundError
        If there is no icon of that name.
    """
    path = folder() / "icons" / f"{name}.svg"
    if not path.is_file():
        raise FileNotFoundError(f"there is no icon {name!r}")
    return path

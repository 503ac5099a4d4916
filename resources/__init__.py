"""What ships beside the code: icons, samples, the font of pictures."""

from importlib.resources import files
from pathlib import Path


def folder() -> Path:
    """Return the folder of the resources."""
    return Path(str(files(__name__)))

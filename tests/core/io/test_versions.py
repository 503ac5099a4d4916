"""Project files of every version that there ever was open to what they always did."""

from pathlib import Path

import msgspec
import pytest

from core.errors import FileFormatError
from core.io.format import ProjectFile
from core.io.format_1 import Project1
from core.io.project import VERSION, decode, encode, load
from tests.core.io import films

DATA = Path(__file__).resolve().parents[2] / "data"

KEPT = {
    "version-1.inkb": films.first_of_version_1,
    "version-1-everything.inkb": films.everything_of_version_1,
    "version-2-everything.inkb": films.everything_of_version_2,
}


@pytest.mark.parametrize("name", KEPT)
def test_a_file_of_an_earlier_version_opens_for_ever(name):
    document = KEPT[name]()
    assert load(DATA / name) == document
    assert decode(encode(document)) == document


def test_every_version_has_a_kept_file_and_the_present_one_writes_the_very_same():
    assert set(KEPT) == {p.name for p in DATA.glob("*.inkb")}
    newest = f"version-{VERSION}-everything.inkb"
    assert encode(KEPT[newest]()) == (DATA / newest).read_bytes()


def fields(struct):
    """Every field of a struct of the file and of those inside it."""
    made = msgspec.json.schema(struct)["$defs"]
    return {(name, field) for name, part in made.items() for field in part.get("properties", {})}


@pytest.mark.parametrize(
    ("name", "struct"),
    [("version-1-everything.inkb", Project1), (f"version-{VERSION}-everything.inkb", ProjectFile)],
)
def test_the_kept_files_use_every_field_of_their_version(name, struct):
    text = (DATA / name).read_text(encoding="utf-8")
    assert [f for f in fields(struct) if f'"{f[1]}":' not in text] == []


@pytest.mark.parametrize(
    ("place", "new"),
    [
        ('"pairs":[]', '"pairs":[],"hold":true'),
        ('"visible":false', '"visible":false,"locked":true'),
        ('"width":2.5', '"width":2.5,"opacity":0.5'),
        ('"frame":40', '"frame":40,"smooth":true'),
    ],
)
def test_a_file_of_version_1_has_no_field_of_version_2(place, new):
    text = (DATA / "version-1-everything.inkb").read_text(encoding="utf-8")
    assert place in text
    with pytest.raises(FileFormatError, match="unknown field"):
        decode(text.replace(place, new, 1).encode())

"""Write docs/file-format.schema.json from the structs that read and write projects.

python docs/make_schema.py
"""

import json
from pathlib import Path

import msgspec

from core.io.format import VERSION, ProjectFile

SCHEMA = Path(__file__).with_name("file-format.schema.json")


def schema() -> str:
    """Return the schema of the newest version as text."""
    made = msgspec.json.schema(ProjectFile, ref_template="#/$defs/{name}")
    head = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": f"Inkbetween project, version {VERSION}",
        "description": "The shape of the file. Rules between fields are in file-format.md.",
    }
    return json.dumps(head | made, indent=2, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    SCHEMA.write_text(schema(), encoding="utf-8")
    print(SCHEMA)

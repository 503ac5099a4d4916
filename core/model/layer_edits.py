"""Edits of layers: functions from document to document, as in edits.py."""

import itertools
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from core.errors import DocumentError
from core.model.document import Document, Layer


def add_layer(document: Document, name: str | None = None, *, above: int | None = None) -> Document:
    """Add an empty layer in front of the layer `above`, or in front of all others.

    Without a name it is called "Layer" and the first number that no other layer has.
    """
    taken = {layer.name for layer in document.layers}
    free = next(f"Layer {i}" for i in itertools.count(len(taken) + 1) if f"Layer {i}" not in taken)
    return _inserted(document, Layer(free_layer_id(document), free if name is None else name), above)


def duplicate_layer(document: Document, layer_id: int) -> Document:
    """Put a copy of a layer in front of it."""
    layer = document.layer(layer_id)
    copy = replace(layer, id=free_layer_id(document), name=f"{layer.name} copy", locked=False)
    return _inserted(document, copy, layer_id)


def delete_layer(document: Document, layer_id: int) -> Document:
    """Take a layer away; those that follow it stand on their own then. The last one stays: DocumentError."""
    document.layer(layer_id)
    if len(document.layers) == 1:
        raise DocumentError("this is the only layer; a film needs one")
    kept = (layer for layer in document.layers if layer.id != layer_id)
    freed = (replace(x, parent=None) if x.parent == layer_id else x for x in kept)
    return replace(document, layers=tuple(freed))


def move_layer(document: Document, layer_id: int, index: int) -> Document:
    """Put a layer at a place in the order, 0 for the one farthest back; a place beyond the end is the front."""
    layer = document.layer(layer_id)
    others = [x for x in document.layers if x.id != layer_id]
    others.insert(min(max(index, 0), len(others)), layer)
    return document if tuple(others) == document.layers else replace(document, layers=tuple(others))


def set_layer(document: Document, layer_id: int, **changes: Any) -> Document:
    """Change a layer's `name`, `visible`, `locked`, `opacity` or `color`; see `Layer`.

    Raises
    ------
    DocumentError
        If a value is out of its range.
    """
    return _with_changes(document, layer_id, changes, ("name", "visible", "locked", "opacity", "color"))


def set_parent(document: Document, layer_id: int, parent: int | None) -> Document:
    """Let a layer follow another one, or none; DocumentError if that one follows it."""
    return _with_changes(document, layer_id, {"parent": parent}, ("parent",))


def free_layer_id(document: Document) -> int:
    """Return the smallest id that no layer has."""
    taken = {layer.id for layer in document.layers}
    return next(i for i in itertools.count(1) if i not in taken)


def _inserted(document: Document, layer: Layer, above: int | None) -> Document:
    ids = [x.id for x in document.layers]
    i = ids.index(above) + 1 if above in ids else len(ids)
    return replace(document, layers=(*document.layers[:i], layer, *document.layers[i:]))


def _with_changes(
    document: Document, layer_id: int, changes: Mapping[str, Any], known: tuple[str, ...]
) -> Document:
    if unknown := changes.keys() - set(known):
        raise TypeError(f"a layer has no {sorted(unknown)}")
    layer = document.layer(layer_id)
    changed = replace(layer, **changes)
    return document if changed == layer else document.with_layer(changed)

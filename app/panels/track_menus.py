"""The menus of the timeline: of keyframes, of a layer, of the ruler."""

from typing import Protocol

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QColor
from PySide6.QtWidgets import QMenu, QWidget

from app.keys import Keys
from app.layercolors import LAYER_COLORS
from app.panels.parts import swatch_icon
from app.session import Session
from app.theme import Theme
from core.errors import InkbetweenError
from core.model.document import Layer
from core.model.edits import set_layer, set_parent

KEY_ACTIONS = ("edit.cut", "edit.copy", "edit.paste", "key.duplicate", "key.delete")
FRAME_ACTIONS = ("frame.insert", "frame.remove", "frame.insert_all", "frame.remove_all")
LAYER_ACTIONS = ("layer.add", "layer.rename", "layer.duplicate", "layer.delete")
SWITCHES = ("layer.show", "layer.lock", "layer.solo")
RULER_ACTIONS = ("play.range_from", "play.range_to", "play.no_range")


class Track(Protocol):
    """What the menus need of the widget."""

    session: Session
    keys: Keys
    theme: Theme
    actions_by_id: dict[str, QAction]


def _menu(track: Track, *groups: tuple[str, ...]) -> QMenu:
    menu = QMenu(track if isinstance(track, QWidget) else None)
    menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    for group in groups:
        if menu.actions():
            menu.addSeparator()
        for name in group:
            menu.addAction(track.actions_by_id[name])
    return menu


def key_menu(track: Track) -> QMenu:
    """Return the menu of the selected keyframes, or of the frame at the playhead."""
    there = bool(track.keys.keyframes())
    first = ("key.hold", "key.smooth") if there else ("key.add", "key.copy")
    return _menu(track, first, KEY_ACTIONS if there else ("edit.paste",), FRAME_ACTIONS)


def ruler_menu(track: Track) -> QMenu:
    return _menu(track, RULER_ACTIONS, ("play.loop", "play.ping_pong"), ("view.fit_film",))


def layer_menu(track: Track) -> QMenu:
    """Return the menu of the active layer."""
    menu = _menu(track, LAYER_ACTIONS, SWITCHES)
    menu.addSeparator()
    _add_follow(menu, track)
    _add_colors(menu, track)
    return menu


def _add_follow(menu: QMenu, track: Track) -> None:
    session, layer = track.session, track.session.layer
    follow = menu.addMenu("Follow")
    others = [x for x in session.document.layers[::-1] if _may_follow(session, layer, x)]
    follow.setEnabled(bool(others))
    for other in (None, *others):
        action = follow.addAction("No Other Layer" if other is None else other.name)
        parent = None if other is None else other.id
        action.setCheckable(True)
        action.setChecked(layer.parent == parent)
        action.triggered.connect(lambda _=False, p=parent: session.apply("Follow Layer", set_parent, layer.id, p))


def _may_follow(session: Session, layer: Layer, other: Layer) -> bool:
    try:
        set_parent(session.document, layer.id, other.id)
    except InkbetweenError:
        return False
    return other.id != layer.id


def _add_colors(menu: QMenu, track: Track) -> None:
    session, layer = track.session, track.session.layer
    colors = menu.addMenu("Colour")
    for name, color in LAYER_COLORS.items():
        action = colors.addAction(swatch_icon(QColor(color), track.theme.color("line")), name)
        action.triggered.connect(
            lambda _=False, c=color: session.apply("Colour Layer", set_layer, layer.id, color=c)
        )
    colors.addSeparator()
    colors.addAction("By Itself").triggered.connect(
        lambda: session.apply("Colour Layer", set_layer, layer.id, color=None)
    )

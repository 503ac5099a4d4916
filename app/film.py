"""What the timeline's menus do: keyframes, frames and layers of the film."""

from collections.abc import Callable, Iterable

from PySide6.QtCore import QObject, Signal

from app.action_table import ActionTable
from app.keys import Keys
from app.panels.track import Track
from app.playback import Flip, Playback
from app.session import Session
from core.model.document import Document
from core.model.edits import add_layer, delete_layer, duplicate_layer, set_layer
from core.model.frame_edits import insert_frames, remove_frames

Runs = dict[str, Callable[[], object]]


class Film(QObject):
    """The selected keyframes, flipping, what the actions run; `changed` tells that menus show something else."""

    changed = Signal()

    def __init__(self, session: Session, playback: Playback, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.session, self.playback = session, playback
        self.keys = Keys(session, self)
        self.flip = Flip(session, playback, self)
        for signal in (session.problem, session.soloChanged, session.rangeChanged, self.keys.changed):
            signal.connect(self._on_changed)

    def _on_changed(self, *_: object) -> None:
        self.changed.emit()

    def runs(self, others: Runs, track: Track) -> Runs:
        """Return what every action runs: `others`, and those of the timeline.

        While the timeline has the keyboard and keyframes are selected, cut, copy and the like are of keyframes.
        What was copied last is what is pasted.
        """
        keys = self.keys
        of_keys: Runs = {
            "edit.cut": keys.cut,
            "edit.copy": keys.copy,
            "edit.delete": keys.delete,
            "edit.select_all": keys.choose_all,
            "edit.select_none": lambda: keys.choose(()),
            "key.copy": keys.duplicate,
        }

        def aimed(of_key: Callable[[], object], other: Callable[[], object], *, copies: bool) -> None:
            if track.hasFocus() and keys.chosen:
                of_key()
            else:
                keys.copied = () if copies else keys.copied
                other()

        def by_focus(name: str) -> Callable[[], object]:
            copies = name in ("edit.cut", "edit.copy")
            return lambda: aimed(of_keys[name], others[name], copies=copies)

        both = {name: by_focus(name) for name in of_keys}
        both["edit.paste"] = lambda: keys.paste() if keys.copied else others["edit.paste"]()
        both["key.delete"] = lambda: keys.delete() if keys.chosen else others["key.delete"]()
        return others | both | self._key_runs() | self._layer_runs(track) | self._play_runs(track)

    def _key_runs(self) -> Runs:
        session, keys = self.session, self.keys
        return {
            "key.duplicate": keys.duplicate,
            "key.hold": lambda: keys.set_hold(not _all(k.span.hold for k in keys.keyframes())),
            "key.smooth": lambda: keys.set_smooth(not _all(k.smooth for k in keys.keyframes())),
            "frame.insert": lambda: insert_frame(session, everywhere=False),
            "frame.remove": lambda: remove_frame(session, everywhere=False),
            "frame.insert_all": lambda: insert_frame(session, everywhere=True),
            "frame.remove_all": lambda: remove_frame(session, everywhere=True),
        }

    def _layer_runs(self, track: Track) -> Runs:
        session = self.session
        return {
            "layer.add": lambda: add_new_layer(session),
            "layer.rename": lambda: track.rename(session.layer.id),
            "layer.duplicate": lambda: duplicate_current_layer(session),
            "layer.delete": lambda: session.apply("Delete Layer", delete_layer, session.layer.id),
            "layer.show": lambda: switch(session, "visible"),
            "layer.lock": lambda: switch(session, "locked"),
            "layer.solo": lambda: session.set_solo(session.solo ^ {session.layer.id}),
        }

    def _play_runs(self, track: Track) -> Runs:
        session, playback = self.session, self.playback
        return {
            "play.ping_pong": lambda: playback.set_ping_pong(not playback.ping_pong),
            "play.range_from": lambda: session.set_range((session.frame, max(session.frame, session.range[1]))),
            "play.range_to": lambda: session.set_range((min(session.frame, session.range[0]), session.frame)),
            "play.no_range": lambda: session.set_range(None),
            "flip.previous": lambda: self.flip.show(-1),
            "flip.next": lambda: self.flip.show(1),
            "view.fit_film": track.fit,
        }

    def show_in(self, table: ActionTable) -> None:
        """Show in menus and buttons how the keyframes, the layer and the playback are."""
        session, layer, keyframes = self.session, self.session.layer, self.keys.keyframes()
        for name, on in (
            ("key.hold", _all(k.span.hold for k in keyframes)),
            ("key.smooth", _all(k.smooth for k in keyframes)),
            ("layer.show", layer.visible),
            ("layer.lock", layer.locked),
            ("layer.solo", layer.id in session.solo),
            ("play.ping_pong", self.playback.ping_pong),
        ):
            table[name].setChecked(on)
        for name in ("key.hold", "key.smooth", "key.duplicate", "key.delete"):
            table[name].setEnabled(bool(keyframes))
        table["play.no_range"].setEnabled(session.has_range)


def _all(flags: Iterable[bool]) -> bool:
    return all(found) if (found := list(flags)) else False


def _layers(session: Session, *, everywhere: bool) -> list[int] | None:
    return None if everywhere else [session.layer.id]


def insert_frame(session: Session, *, everywhere: bool) -> None:
    """Hold what is shown at the playhead a frame longer."""
    layers = _layers(session, everywhere=everywhere)
    session.apply("Insert Frame", insert_frames, session.frame, 1, layers)


def remove_frame(session: Session, *, everywhere: bool) -> None:
    """Take the frame at the playhead out."""
    layers = _layers(session, everywhere=everywhere)
    session.apply("Remove Frame", remove_frames, session.frame, session.frame, layers)


def add_new_layer(session: Session) -> None:
    """Add a layer in front of the active one and draw on it."""
    _choose_new(session, "Add Layer", lambda d: add_layer(d, above=session.layer.id))


def duplicate_current_layer(session: Session) -> None:
    """Put a copy of the active layer in front of it and draw on that."""
    _choose_new(session, "Duplicate Layer", lambda d: duplicate_layer(d, session.layer.id))


def _choose_new(session: Session, label: str, edit: Callable[[Document], Document]) -> None:
    known = {x.id for x in session.document.layers}
    if session.apply(label, edit):
        made = [x.id for x in session.document.layers if x.id not in known]
        session.set_layer(made[0])


def switch(session: Session, part: str) -> None:
    """Turn the active layer's eye ("visible") or lock ("locked")."""
    layer = session.layer
    on = not getattr(layer, part)
    labels = {"visible": ("Hide Layer", "Show Layer"), "locked": ("Unlock Layer", "Lock Layer")}
    session.apply(labels[part][on], set_layer, layer.id, **{part: on})

"""The one place that builds everything and connects it."""

import sys
from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QObject, QSize, Qt
from PySide6.QtGui import QCloseEvent, QGuiApplication, QIcon
from PySide6.QtWidgets import QApplication

import resources
from app import copying, editing, matching
from app.canvas.reference import current_reference
from app.dialogs.export import ExportDialog
from app.dialogs.help import show_about
from app.dialogs.stage import StageDialog
from app.editing import Clipboard
from app.files import Files
from app.film import Film
from app.guidance import Guidance
from app.incoming import Incoming
from app.menus import fill_recent, fill_samples
from app.playback import Playback
from app.preview.alternatives import AlternativesPreview
from app.preview.certificates import CertificatePreview
from app.preview.prefetch import Prefetch
from app.preview.spans import SpanPreview
from app.recovery import state_folder
from app.safekeeping import Safekeeping
from app.session import Selection, Session
from app.settings import Settings
from app.theme import NO_BUTTON_ICONS, icon, palette, system_theme
from app.view import LINES, ViewState
from app.window import Window
from core.model.edits import clear_anchors, clear_pins, set_stage, solve_again
from core.model.motion import HasMotions

ARRANGEMENT_ACTIONS = {"overlaid": "view.overlaid", "side by side": "view.side", "compare": "view.compare"}
THEME_ACTIONS = {"system": "view.theme_system", "light": "view.theme_light", "dark": "view.theme_dark"}
SPAN_ACTIONS = (
    "span.other_way",
    "span.clear",
    "span.clear_pins",
    "span.again",
    "span.flip",
    "span.shift_on",
    "span.shift_back",
    "view.compare",
)
METHOD_ACTIONS = {method: f"span.{method}" for method in ("linear", "intrinsic", "rigid", "auto")}


class Editor(QObject):
    """Everything of one open window."""

    def __init__(self, settings: Settings | None = None, state: Path | None = None) -> None:
        """`state` is the folder for unsaved work; without one none is kept."""
        super().__init__()
        self.settings = settings or Settings()
        self.session = Session(self)
        self.preview = SpanPreview(self)
        self.view_state = ViewState(self.settings, self)
        self.playback = Playback(self.session, self)
        self.film = Film(self.session, self.playback, self)
        self.clipboard = Clipboard()
        theme = system_theme(self.settings.text("theme", "system"))
        self.ranked = AlternativesPreview(self.preview, self)
        self.certificates = CertificatePreview(self.session, self.preview, self)
        self.prefetch = Prefetch(self.session, self.preview, self)
        self.window = Window(
            self.session,
            self.preview,
            self.ranked,
            self.certificates,
            self.film.keys,
            self.view_state,
            self.playback,
            self.settings,
            theme,
        )
        self.files = Files(self.window, self.session, self.settings, self.preview.with_answers, self.window.tell)
        self.safekeeping = Safekeeping(self.window, self.session, self.files, state)
        self.incoming = Incoming(self.window, self.session, self.settings)
        self.guidance = Guidance(self.window, self.files, self.settings, self)
        self.export_dialog: ExportDialog | None = None
        self.window.table.connect_all(self._runs())
        self._connect()
        self.set_theme(self.settings.text("theme", "system"))
        self.window.choose_tool("tool.select")
        self._refresh()
        fill_samples(self.window.menus["Samples"], self.files.open_sample)
        self._restore_geometry()

    # actions

    def _runs(self):
        runs = (
            self._file_runs()
            | self._edit_runs()
            | self._insert_runs()
            | self._view_runs()
            | {name: lambda n=name: self.window.choose_tool(n) for name in self.window.tools}
            | self._key_runs()
            | self.guidance.runs
        )
        return self.film.runs(runs, self.window.timeline.track)

    def _file_runs(self):
        files, window = self.files, self.window
        return {
            "file.new": files.new,
            "file.open": files.open,
            "file.save": files.save,
            "file.save_as": files.save_as,
            "file.revert": files.reload,
            "file.backup": files.restore_backup,
            "file.recover": lambda: self.safekeeping.offer(asked=True),
            "file.stage": self.edit_stage,
            "file.import": self.incoming.import_svg,
            "file.import_layers": lambda: self.incoming.import_svg(as_layers=True),
            "file.import_folder": self.incoming.import_folder,
            "file.import_lottie": self.incoming.import_lottie,
            "file.export": self.export,
            "file.close": files.new,
            "file.quit": self.window.close,
            "help.about": lambda: show_about(window),
        }

    def _edit_runs(self):
        session, clipboard = self.session, self.clipboard
        return {
            "edit.undo": session.undo_stack.undo,
            "edit.redo": session.undo_stack.redo,
            "edit.cut": lambda: editing.cut(session, clipboard),
            "edit.copy": lambda: editing.copy(session, clipboard),
            "edit.copy_picture": lambda: self._tell_copied(copying.copy_picture, "picture"),
            "edit.copy_svg": lambda: self._tell_copied(copying.copy_svg, "SVG"),
            "edit.paste": lambda: editing.paste(session, clipboard),
            "edit.delete": lambda: editing.delete(session),
            "edit.select_all": lambda: editing.select_all(session),
            "edit.select_none": lambda: session.select(Selection()),
        }

    def _tell_copied(self, copy: Callable[[Session, HasMotions], bool], what: str) -> None:
        if copy(self.session, self.preview):
            self.window.tell(f"Frame {self.session.frame} is on the clipboard as {what}.", "info")

    def _insert_runs(self):
        return {
            "insert.letters": self.incoming.insert_letters,
            "insert.reference": self.incoming.choose_reference,
            "insert.no_reference": self.window.reference_panel.remove_reference,
        }

    def _view_runs(self):
        canvas, view = self.window.canvas, self.view_state
        runs = {
            "view.onion": lambda: view.set(onion=not view.options.onion),
            "view.lines": self._next_lines,
            "view.hues": lambda: view.set(hues=not view.options.hues),
            "view.heat": lambda: view.set(heat=not view.options.heat),
            "view.paths": lambda: view.set(paths=not view.options.paths),
            "view.sheet": lambda: view.set(sheet=not view.options.sheet),
            "view.final": lambda: view.set(final=not view.options.final),
            "view.fit": canvas.fit,
            "view.zoom_in": lambda: canvas.zoom(1.25),
            "view.zoom_out": lambda: canvas.zoom(0.8),
            "view.actual": lambda: canvas.zoom_to(1.0),
        }
        runs |= {a: lambda v=value: view.set(arrangement=v) for value, a in ARRANGEMENT_ACTIONS.items()}
        runs |= {a: lambda v=value: self.set_theme(v) for value, a in THEME_ACTIONS.items()}
        return runs

    def _key_runs(self):
        session, playback = self.session, self.playback
        runs = {
            "key.add": lambda: editing.add_keyframe(session, self.preview.motions),
            "key.copy": lambda: editing.copy_to_other_keyframe(session),
            "key.delete": lambda: editing.delete_current_keyframe(session),
            **editing.smoothing_runs(session),
            "span.other_way": lambda: matching.turn_other_way(session, self.preview),
            "span.clear": lambda: self._in_span("Clear Anchors", clear_anchors),
            "span.clear_pins": lambda: self._in_span("Clear Pins", clear_pins),
            "span.again": lambda: self._in_span("Solve Again", solve_again),
            "span.flip": lambda: matching.flip(session, self.preview),
            "span.shift_on": lambda: matching.shift(session, self.preview, 1),
            "span.shift_back": lambda: matching.shift(session, self.preview, -1),
            "play.toggle": playback.toggle,
            "play.loop": lambda: playback.set_loop(not playback.loop),
            "play.previous": lambda: self._step(-1),
            "play.next": lambda: self._step(1),
            "play.previous_key": lambda: editing.go_to_keyframe(session, -1),
            "play.next_key": lambda: editing.go_to_keyframe(session, 1),
            "play.first": lambda: session.go_to(1),
            "play.last": lambda: session.go_to(session.document.length),
        }
        runs |= {a: lambda m=method: editing.set_method(session, m) for method, a in METHOD_ACTIONS.items()}
        return runs

    def _step(self, step: int) -> None:
        self.playback.stop()
        self.session.go_to(self.session.frame + step)

    def _next_lines(self) -> None:
        now = LINES.index(self.view_state.options.lines)
        self.view_state.set(lines=LINES[(now + 1) % len(LINES)])

    def _in_span(self, label: str, edit) -> None:
        before, after = self.session.span_keyframes()
        if before is not None and after is not None:
            self.session.apply(label, edit, self.session.layer.id, before.frame)

    # connections

    def _connect(self) -> None:
        session, window = self.session, self.window
        session.problem.connect(lambda text: window.tell(text, "error"))
        session.documentChanged.connect(self._on_document_changed)
        for signal_ in (session.frameChanged, session.layerChanged):
            signal_.connect(self._refresh)
        for signal_ in (
            session.selectionChanged,
            session.gestureChanged,
            session.problem,
            self.view_state.changed,
        ):
            signal_.connect(self._refresh)
        session.fileChanged.connect(window.show_title)
        session.fileChanged.connect(self._on_file_changed)
        session.undo_stack.indexChanged.connect(self._refresh)
        self.film.changed.connect(self._refresh)
        self.playback.changed.connect(self._refresh)
        window.canvas.playPressed.connect(self.playback.toggle)
        methods = {action: method for method, action in METHOD_ACTIONS.items()}
        matching.try_methods_in(window.menus["Span"], methods, session, self.preview)
        window.closeAsked.connect(self._on_close_asked)
        window.fileDropped.connect(lambda name: self.incoming.take(Path(name), self.files.open_path))
        window.canvas.references.unreadable.connect(session.problem, Qt.ConnectionType.QueuedConnection)
        window.menus["File"].aboutToShow.connect(
            lambda: fill_recent(window.recent_menu, self.settings, self.files.open_path)
        )
        QGuiApplication.instance().applicationStateChanged.connect(self._on_application_state)
        hints = QGuiApplication.styleHints()
        hints.colorSchemeChanged.connect(self._on_color_scheme)
        window.show_title()
        self._on_file_changed()

    def _on_document_changed(self) -> None:
        if not self.session.in_gesture:  # at every step of a drag the menus can wait for its end
            self._refresh()

    def _refresh(self, *_: object) -> None:
        """Show in menus and buttons what can be done now."""
        table, session, options = self.window.table, self.session, self.view_state.options
        stack = session.undo_stack
        free = not session.in_gesture
        table["edit.undo"].setEnabled(free and stack.canUndo())
        table["edit.redo"].setEnabled(free and stack.canRedo())
        table["edit.undo"].setText(f"Undo {stack.undoText()}".rstrip())
        table["edit.redo"].setText(f"Redo {stack.redoText()}".rstrip())
        before, after = session.span_keyframes()
        there = before is not None and after is not None
        for name in (*METHOD_ACTIONS.values(), *SPAN_ACTIONS):
            table[name].setEnabled(there)
        if before is not None and there:
            table[METHOD_ACTIONS[before.span.method]].setChecked(True)
        table["key.delete"].setEnabled(session.layer.keyframe_at(session.frame) is not None)
        table["insert.no_reference"].setEnabled(current_reference(session) is not None)
        table["view.onion"].setChecked(options.onion)
        table["view.hues"].setChecked(options.hues)
        table["view.heat"].setChecked(options.heat)
        table["view.paths"].setChecked(options.paths)
        table["view.sheet"].setChecked(options.sheet)
        table["view.final"].setChecked(options.final)
        table[ARRANGEMENT_ACTIONS[options.arrangement]].setChecked(True)
        self._show_playing()
        self.film.show_in(table)

    def _show_playing(self) -> None:
        table, playing = self.window.table, self.playback.playing
        text = "Pause" if playing else "Play"
        if table["play.toggle"].text() != text:
            table.set_text("play.toggle", text)
            table["play.toggle"].setIcon(icon(text.lower(), self.window.theme))
        table["play.loop"].setChecked(self.playback.loop)

    def _on_application_state(self, state: Qt.ApplicationState) -> None:
        if (
            state == Qt.ApplicationState.ApplicationActive
        ):  # whoever comes back may have changed the file meanwhile
            self.files.look()

    def _on_file_changed(self) -> None:
        path = self.session.path
        self.window.table["file.revert"].setEnabled(path is not None and self.session.is_modified)
        self.window.table["file.backup"].setEnabled(path is not None)
        if self.session.undo_stack.count() == 0:
            self.playback.stop()

    def _on_color_scheme(self) -> None:
        if self.settings.text("theme", "system") == "system":
            self.set_theme("system")

    def set_theme(self, choice: str) -> None:
        """Use the theme "system", "light" or "dark" from now on."""
        self.settings.keep("theme", choice)
        self.window.table[THEME_ACTIONS.get(choice, "view.theme_system")].setChecked(True)
        theme = system_theme(choice)
        app = QApplication.instance()
        if isinstance(app, QApplication):
            app.setPalette(palette(theme))
        self.window.set_theme(theme)
        self._refresh()

    # dialogs

    def edit_stage(self) -> None:
        dialog = StageDialog(self.session.document.stage, self.window.theme, self.window)
        if dialog.exec():
            self.session.apply("Change Stage", set_stage, dialog.stage)

    def export(self) -> None:
        """Open the export dialog, or bring the one at work to the front."""
        if self.export_dialog is not None:
            self.export_dialog.activateWindow()
            return
        folder = self.session.path.parent if self.session.path else Path.home()
        name = self.session.name
        dialog = ExportDialog(lambda: self.session.document, name, folder, self.settings, self.window)
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.told.connect(self.window.tell)
        dialog.exported.connect(self.guidance.tour.note_export)
        dialog.destroyed.connect(self._forget_dialog)
        self.export_dialog = dialog
        dialog.show()

    def _forget_dialog(self) -> None:
        self.export_dialog = None

    # opening and closing

    def _restore_geometry(self) -> None:
        geometry = self.settings.blob("window/geometry")
        if geometry is not None:
            self.window.restoreGeometry(geometry)
            return
        screen = QGuiApplication.primaryScreen()
        if screen is not None:  # a small laptop's screen is smaller than what we would like
            room = screen.availableGeometry().size()
            self.window.resize(self.window.size().boundedTo(room - QSize(40, 80)))

    def _on_close_asked(self, event: QCloseEvent) -> None:
        if self.files.writing:
            self.files.then(self.window.close)
        if not self.files.may_leave():
            event.ignore()
            return
        if self.export_dialog is not None:
            self.export_dialog.close()
        self.incoming.stop()
        self.safekeeping.stop()
        self.files.stop()
        self.playback.stop()
        self.prefetch.stop()
        self.preview.stop()
        self.ranked.stop()
        self.certificates.stop()
        self.settings.keep("window/geometry", self.window.saveGeometry())
        event.accept()


def make_application() -> QApplication:
    """Return the application, made if there is none yet."""
    app = QApplication.instance()
    if isinstance(app, QApplication):
        return app
    app = QApplication(sys.argv[:1])
    app.setApplicationName("Inkbetween")
    app.setOrganizationName("Inkbetween")
    app.setStyle("Fusion")
    app.setStyleSheet(NO_BUTTON_ICONS)
    app.setWindowIcon(QIcon(str(resources.icon("app"))))
    return app


def run(path: str | None = None, *, sample: bool = False) -> int:
    """Open the editor on a file, or on an empty document, and return its exit code when it is closed."""
    app = make_application()
    state = state_folder()
    editor = Editor(state=state)
    editor.window.show()
    with editor.safekeeping.watching(app, state):
        if path is not None:
            if sample:
                editor.files.open_sample(Path(path))
            else:
                editor.files.open_path(Path(path))
        editor.guidance.tour.offer()
        return app.exec()

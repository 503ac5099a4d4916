"""What comes in from elsewhere: SVG files, folders of them, Lottie, letters, reference pictures."""

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QFileDialog

from app.canvas.reference import reference_keyframe
from app.dialogs.importing import ImportDialog
from app.dialogs.letters import LettersDialog
from app.session import Selection, Session
from app.settings import Settings
from app.window import Window
from core.errors import InkbetweenError
from core.io.film import ImportedFilm, film_remark, import_film
from core.io.imported import Imported, fitted, import_keyframe, import_layers, remark
from core.model.document import Document, Reference
from core.model.drawing import Drawing
from core.model.edits import add_outline, put_drawing, set_reference

LOTTIE_FILTER = "Lottie animations (*.json);;All files (*)"
SVG_FILTER = "SVG drawings (*.svg);;All files (*)"
PICTURE_FILTER = "Pictures (*.png *.jpg *.jpeg);;All files (*)"
PICTURE_SUFFIXES = frozenset({".png", ".jpg", ".jpeg"})
FIRST_OPACITY = 0.5


class Incoming(QObject):
    """Every way in, but for opening projects."""

    def __init__(self, window: Window, session: Session, settings: Settings) -> None:
        super().__init__(window)
        self._window, self._session, self._settings = window, session, settings
        self.import_dialog: ImportDialog | None = None

    def take(self, path: Path, open_project: Callable[[Path], object]) -> None:
        """Take a file that was dropped on the window, by what it is."""
        suffix = path.suffix.lower()
        if suffix in (".svg", ".json") or path.is_dir():
            self.import_path(path)
        elif suffix in PICTURE_SUFFIXES:
            self.lay_reference(path)
        else:
            open_project(path)

    # SVG

    def import_svg(self, *, as_layers: bool = False) -> None:
        """Ask for a file and import it."""
        title = "Import SVG as Layers" if as_layers else "Import SVG"
        name, _ = QFileDialog.getOpenFileName(self._window, title, self._folder(), SVG_FILTER)
        if name:
            self._settings.keep("import_folder", str(Path(name).resolve().parent))
            self.import_path(Path(name), as_layers=as_layers)

    def import_folder(self) -> None:
        """Ask for a folder of SVG files and make them the keyframes of a new layer."""
        name = QFileDialog.getExistingDirectory(self._window, "Import Folder of SVG", self._folder())
        if name:
            self._settings.keep("import_folder", str(Path(name).resolve().parent))
            self.import_path(Path(name))

    def import_lottie(self) -> None:
        """Ask for a Lottie animation and add its layers."""
        name, _ = QFileDialog.getOpenFileName(self._window, "Import Lottie", self._folder(), LOTTIE_FILTER)
        if name:
            self._settings.keep("import_folder", str(Path(name).resolve().parent))
            self.import_path(Path(name))

    def import_path(self, path: Path, *, as_layers: bool = False) -> None:
        """Read a file beside the window, then put it where the playhead stood when this was asked for."""
        if self.import_dialog is not None:
            self._session.problem.emit("Another file is being read; wait for it, or cancel it.")
            return
        place = (self._session.layer.id, self._session.frame)
        self.import_dialog = ImportDialog(path, self._window)
        self.import_dialog.told.connect(lambda result: self._on_read(result, path, place, as_layers))
        self.import_dialog.start()

    def _on_read(self, result: object, path: Path, place: tuple[int, int], as_layers: bool) -> None:
        self.import_dialog = None
        if isinstance(result, InkbetweenError):
            self._window.tell(str(result), "error")
        elif isinstance(result, Imported):
            self._put(result, path.name, place, as_layers)
        elif isinstance(result, ImportedFilm):
            self._put_film(result, path.name, place[1])
        else:
            self._window.tell(f"The import of {path.name} was cancelled.", "info")

    def _put(self, imported: Imported, name: str, place: tuple[int, int], as_layers: bool) -> None:
        layer_id, frame = place
        session = self._session

        def edit(document: Document) -> Document:
            picture = fitted(imported, document.stage)
            if as_layers:
                return import_layers(document, frame, picture)
            return import_keyframe(document, layer_id, frame, picture)

        count = len(session.document.layers)
        if not session.apply("Import SVG", edit, selection=Selection()):
            return
        made = len(session.document.layers) - count
        if made:
            session.set_layer(session.document.layers[-1].id)
        outlines = sum(len(d.outlines) for d in imported.drawings)
        what = _counted(made, "layer") if made else f"the keyframe at {frame}, {_counted(outlines, 'outline')}"
        rest = remark(imported, as_one=not as_layers)
        self._window.tell(f"Imported {name} as {what}{'; ' + rest if rest else ''}.", "info")

    def _put_film(self, imported: ImportedFilm, name: str, frame: int) -> None:
        """Add layers with keyframes, from the playhead on."""
        session = self._session
        if not session.apply(f"Import {name}", import_film, imported, frame, selection=Selection()):
            return
        session.set_layer(session.document.layers[-1].id)
        keys = _counted(sum(len(x.keyframes) for x in imported.layers), "keyframe")
        rest = film_remark(imported)
        layers = _counted(len(imported.layers), "layer")
        self._window.tell(f"Imported {name} as {layers} with {keys}{'; ' + rest if rest else ''}.", "info")

    # letters

    def insert_letters(self) -> None:
        """Ask for a text and add its outlines to the drawing at the playhead."""
        stage = self._session.document.stage
        middle = (stage.width / 2, stage.height / 2)
        dialog = LettersDialog(self._settings, self._window.theme, middle, self._window)
        if not dialog.exec() or not dialog.outlines:
            return
        layer_id, frame = self._session.layer.id, self._session.frame

        def edit(document: Document) -> Document:
            for points in dialog.outlines:
                document = add_outline(document, layer_id, frame, points)
            return document

        self._session.apply("Insert Letters", edit)

    # reference pictures

    def choose_reference(self) -> None:
        """Ask for a picture and lay it under the stage."""
        name, _ = QFileDialog.getOpenFileName(self._window, "Reference Picture", self._folder(), PICTURE_FILTER)
        if name:
            self._settings.keep("import_folder", str(Path(name).resolve().parent))
            self.lay_reference(Path(name))

    def lay_reference(self, path: Path) -> None:
        """Lay a picture under the stage for the keyframe at the playhead, or the one before it."""
        session = self._session
        keyframe = reference_keyframe(session.layer, session.frame)
        if keyframe is None:
            layer_id, frame = session.layer.id, session.frame
            session.apply("Lay Reference Picture", _empty_keyframe_with, layer_id, frame, _reference(path, None))
        else:
            reference = _reference(path, keyframe.reference)
            session.apply("Lay Reference Picture", set_reference, session.layer.id, keyframe.frame, reference)

    # small things

    def stop(self) -> None:
        """Give up what is being read: the window is closing."""
        if self.import_dialog is not None:
            self.import_dialog.stop()
            self.import_dialog = None

    def _folder(self) -> str:
        kept = Path(self._settings.text("import_folder"))
        if str(kept) != "." and kept.is_dir():
            return str(kept)
        return str(self._session.path.parent if self._session.path else Path.home())


def _counted(count: int, word: str) -> str:
    return f"{count} {word}{'' if count == 1 else 's'}"


def _reference(path: Path, before: Reference | None) -> Reference:
    return Reference(str(path.absolute()), before.opacity if before else FIRST_OPACITY)


def _empty_keyframe_with(document: Document, layer_id: int, frame: int, reference: Reference) -> Document:
    """Make a keyframe that shows nothing yet: one lays a picture down first and draws over it then."""
    return set_reference(put_drawing(document, layer_id, frame, Drawing()), layer_id, frame, reference)

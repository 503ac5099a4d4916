"""The main window: lays the parts out and joins them; what they do is elsewhere."""

from collections.abc import Sequence

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QMainWindow,
    QScrollArea,
    QSplitter,
    QStackedLayout,
    QVBoxLayout,
    QWidget,
)

from app.action_table import ActionTable
from app.actions import ACTIONS, MENUS
from app.canvas.canvas import Canvas
from app.fieldkeys import FieldKeys, fields_in
from app.foldings import remember_foldings
from app.keys import Keys
from app.panels.alternatives import AlternativesPanel
from app.panels.certificate import CertificatePanel
from app.panels.drawing import DrawingPanel
from app.panels.easing import EasingPanel
from app.panels.empty import WithoutSpan
from app.panels.hints import HintBar
from app.panels.layer import LayerPanel
from app.panels.messagebar import Choice, MessageBar
from app.panels.parts import Section, separator
from app.panels.reference import ReferencePanel
from app.panels.sheet import SheetPanel
from app.panels.span import SpanPanel
from app.panels.timeline import Timeline, action_button
from app.penoptions import PenOptions
from app.playback import Playback
from app.preview.alternatives import AlternativesPreview
from app.preview.certificates import CertificatePreview
from app.preview.spans import SpanPreview
from app.session import Session
from app.settings import Settings
from app.theme import Theme, style_sheet
from app.tools.correspond import CorrespondTool
from app.tools.pen import PenTool
from app.tools.pencil import PencilTool
from app.tools.pin import PinTool
from app.tools.select import SelectTool
from app.view import ViewState

MENU_TEXTS = {"Samples": "Sa&mples"}
"""Where the first letter opens another menu."""
SIDE_WIDTH = 312
TOOLBOX_WIDTH = 52
LEAST_TIMELINE = 480


class Window(QMainWindow):
    """See the module. `closeAsked` is answered by whoever knows about unsaved changes."""

    closeAsked = Signal(QCloseEvent)
    fileDropped = Signal(str)

    def __init__(
        self,
        session: Session,
        preview: SpanPreview,
        ranked: AlternativesPreview,
        certificates: CertificatePreview,
        keys: Keys,
        view: ViewState,
        playback: Playback,
        settings: Settings,
        theme: Theme,
    ) -> None:
        super().__init__()
        self.session, self.view_state, self.settings, self.theme = session, view, settings, theme
        self.table = ActionTable(theme, self)
        self.canvas = Canvas(session, preview, view, theme)
        self.pens = PenOptions(settings, self)
        self.tools = {
            "tool.select": SelectTool(self.canvas),
            "tool.pen": PenTool(self.canvas, self.pens),
            "tool.pencil": PencilTool(self.canvas, self.pens),
            "tool.correspond": CorrespondTool(self.canvas),
            "tool.pin": PinTool(self.canvas),
        }
        self.timeline = Timeline(session, view, playback, certificates, keys, theme, self.table.actions)
        self.alternatives_panel = AlternativesPanel(session, preview, ranked, theme)
        self.span_panel = SpanPanel(session, view, self.table.actions, preview, self.alternatives_panel)
        self.easing_panel = EasingPanel(session, theme)
        self.certificate_panel = CertificatePanel(session, certificates, theme)
        self.certificate_panel.problemChosen.connect(self.canvas.mark)
        self.timeline.track.problemChosen.connect(self.canvas.mark)
        self.drawing_panel = DrawingPanel(session, theme, self.pens)
        self.layer_panel = LayerPanel(session, theme)
        self.reference_panel = ReferencePanel(session)
        self.sheet = SheetPanel(session, theme, self.table.actions)
        self._advise()
        self.setCentralWidget(self._central())
        FieldKeys(fields_in(self.timeline, *self._panels()), self.canvas)
        self.message_bar = MessageBar(self.canvas, theme)
        self._make_status_bar()
        self._make_menus()
        self.setAcceptDrops(True)
        self.resize(1440, 900)
        self.setMinimumSize(1000, 560)

    def _advise(self) -> None:
        """Let panels that are about a span say what they are for while there is none."""
        pairings = "Between two keyframes other good pairings are shown here, as pictures to choose from."
        self.span_panel.correspondence_section.box.addWidget(WithoutSpan(self.session, pairings))
        checks = "Between two keyframes every drawing is checked here: crossings, stretch, lost area."
        self.certificate_panel.section.box.addWidget(WithoutSpan(self.session, checks))

    # laying out

    def _central(self) -> QWidget:
        central = QWidget()
        central.setObjectName("backdrop")
        row = QHBoxLayout(central)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        self.split = QSplitter(Qt.Orientation.Vertical)
        self.split.setHandleWidth(1)
        self.split.setChildrenCollapsible(False)
        self.split.addWidget(self.canvas)
        self.split.addWidget(self.timeline)
        self.split.setStretchFactor(0, 1)
        self.split.setSizes([660, 190])
        row.addWidget(self._toolbox())
        row.addWidget(self._beside_sheet(), 1)
        row.addWidget(self._side())
        return central

    def _beside_sheet(self) -> QWidget:
        """Canvas and timeline, with the exposure sheet to the right when it is open."""
        across = QSplitter(Qt.Orientation.Horizontal)
        across.setHandleWidth(1)
        across.setChildrenCollapsible(False)
        self.timeline.setMinimumWidth(LEAST_TIMELINE)  # else its fields would keep the sheet from its room
        across.addWidget(self.split)
        across.addWidget(self.sheet)
        across.setStretchFactor(0, 1)
        self.sheet.setVisible(self.view_state.options.sheet)
        self.view_state.changed.connect(lambda: self.sheet.setVisible(self.view_state.options.sheet))
        return across

    def _toolbox(self) -> QWidget:
        box = QWidget()
        box.setObjectName("toolbox")
        box.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        box.setFixedWidth(TOOLBOX_WIDTH)
        column = QVBoxLayout(box)
        column.setContentsMargins(8, 12, 8, 12)
        column.setSpacing(8)
        for name in self.tools:
            button = action_button(self.table[name])
            button.setFixedSize(36, 36)
            button.setIconSize(QSize(22, 22))
            column.addWidget(button)
        column.addStretch(1)
        for name in ("view.fit", "edit.undo", "edit.redo"):
            button = action_button(self.table[name])
            button.setFixedSize(36, 36)
            column.addWidget(button)
        return box

    def _panels(self) -> tuple[QWidget, ...]:
        first = self.span_panel, self.easing_panel, self.certificate_panel
        return *first, self.drawing_panel, self.layer_panel

    def _side(self) -> QWidget:
        side = QWidget()
        side.setObjectName("side")
        side.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        side.setFixedWidth(SIDE_WIDTH)
        outer = QStackedLayout(side)
        outer.setContentsMargins(1, 0, 0, 0)
        inner = QWidget()
        inner.setFixedWidth(SIDE_WIDTH - 12)  # room for the scroll bar, so that it never covers anything
        column = QVBoxLayout(inner)
        column.setContentsMargins(0, 4, 0, 12)
        column.setSpacing(4)
        for panel in self._panels():
            column.addWidget(panel)
            column.addWidget(separator())
        column.addWidget(self.reference_panel)
        column.addStretch(1)
        remember_foldings(inner.findChildren(Section), self.settings)
        scroll = QScrollArea()
        scroll.setWidgetResizable(True)
        scroll.setFrameShape(QFrame.Shape.NoFrame)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        scroll.setWidget(inner)
        outer.addWidget(scroll)
        return side

    def _make_status_bar(self) -> None:
        bar = self.statusBar()
        bar.setSizeGripEnabled(False)
        self.hints = HintBar(self.canvas)
        self.place_label = QLabel()
        self.place_label.setMinimumWidth(90)
        self.zoom_label = QLabel()
        self.state_label = QLabel()
        bar.addWidget(self.hints, 1)
        for widget in (self.state_label, self.place_label, self.zoom_label):
            bar.addPermanentWidget(widget)
        self.canvas.pointed.connect(self.place_label.setText)
        self.canvas.zoomed.connect(lambda scale: self.zoom_label.setText(f"{100 * scale:.0f} %"))

    def _make_menus(self) -> None:
        self.menus = {name: self.menuBar().addMenu(MENU_TEXTS.get(name, f"&{name}")) for name in MENUS}
        self.recent_menu = None
        for spec in ACTIONS:
            if not spec.menu:
                continue
            menu = self.menus[spec.menu]
            if not spec.id:
                menu.addSeparator()
            elif spec.id == "file.recent":
                self.recent_menu = menu.addMenu(spec.text)
            else:
                menu.addAction(self.table[spec.id])
        corner = QWidget(self.menuBar())
        row = QHBoxLayout(corner)
        row.setContentsMargins(0, 2, 10, 2)
        row.setSpacing(4)
        for name in ("view.overlaid", "view.side", "view.compare", "view.final"):
            button = action_button(self.table[name])
            button.setFixedSize(30, 28)
            row.addWidget(button)
        self.menuBar().setCornerWidget(corner)

    # showing

    def choose_tool(self, name: str) -> None:
        """Make a tool the active one."""
        tool = self.tools[name]
        self.table[name].setChecked(True)
        if tool is not self.canvas.tool:
            self.canvas.set_tool(tool)
        self.canvas.setFocus()

    def tell(self, text: str, kind: str = "error", choices: Sequence[Choice] = ()) -> None:
        """Show one sentence over the canvas, with buttons for what can be done about it."""
        self.message_bar.show_message(text, kind, choices)

    def show_title(self) -> None:
        """Name the file and mark unsaved changes in the title and the status bar."""
        self.setWindowTitle(f"{self.session.name}[*] – Inkbetween")
        self.setWindowModified(self.session.is_modified)
        if self.session.path is not None:
            self.setWindowFilePath(str(self.session.path))
        saved = "saved" if self.session.path is not None else ""
        self.state_label.setText("unsaved changes" if self.session.is_modified else saved)

    def set_theme(self, theme: Theme) -> None:
        """Repaint everything in another theme."""
        self.theme = theme
        self.setStyleSheet(style_sheet(theme))
        self.table.set_theme(theme)
        panels = (self.alternatives_panel, self.easing_panel, self.certificate_panel, self.drawing_panel)
        for part in (self.canvas, self.timeline, *panels, self.layer_panel, self.sheet, self.message_bar):
            part.set_theme(theme)

    def closeEvent(self, event: QCloseEvent) -> None:
        self.closeAsked.emit(event)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if any(url.isLocalFile() for url in event.mimeData().urls()):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        for url in event.mimeData().urls():
            if url.isLocalFile():
                event.acceptProposedAction()
                self.fileDropped.emit(url.toLocalFile())
                return

"""The certificate of the span under the playhead: its measures over time, and its worst problems."""

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QIcon, QPainter, QPixmap, QResizeEvent
from PySide6.QtWidgets import QFrame, QGridLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from app.panels.parts import Section, flat_button, label
from app.preview.certificates import CertificatePreview
from app.session import Session
from app.theme import Theme
from core.certificate import Problem
from core.geometry.outline import FloatArray
from core.model.checking import SpanCertificate, finding
from core.model.edits import set_span

MOST_ROWS = 5
HEIGHT = 104
CURVES = (
    ("area", "area", "good"),
    ("perimeter", "perimeter", "before"),
    ("stretch", "largest stretch", "warning"),
)
"""Attribute of the certificate, word of the legend, colour."""

LEAST_RANGE = 0.04
"""Share of a measure below which its ups and downs are drawn flatter: they would only be noise."""

SEVERITY_COLORS = {"error": "error", "warning": "warning", "info": "muted"}


class MeasuresPlot(QFrame):
    """Area, perimeter and largest stretch over the frames of the span, each in its own range."""

    def __init__(self, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("plot")
        self.setFixedHeight(HEIGHT)
        self.plot = pg.PlotWidget()
        self.plot.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.plot.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        item = self.plot.getPlotItem()
        item.hideAxis("left")
        item.hideAxis("bottom")
        item.hideButtons()
        item.setMenuEnabled(False)
        self.plot.setYRange(-0.1, 1.5, padding=0)
        self.curves = {name: self.plot.plot(antialias=True) for name, _, _ in CURVES}
        self.playhead = pg.InfiniteLine(span=(0, 0.82))
        self.plot.addItem(self.playhead)
        self.legend = QLabel(self)
        self.legend.move(10, 6)
        column = QVBoxLayout(self)
        column.setContentsMargins(4, 4, 4, 4)
        column.addWidget(self.plot)
        self.legend.raise_()
        self.set_theme(theme)

    def set_theme(self, theme: Theme) -> None:
        self.plot.setBackground(theme.color("raised"))
        self.playhead.setPen(theme.color("accent"), width=1.5)
        for name, _, token in CURVES:
            self.curves[name].setPen(theme.color(token), width=1.8)
        words = (f'<span style="color: {theme.color(token).name()}">{word}</span>' for _, word, token in CURVES)
        self.legend.setText('<span style="font-size: 10px">' + "&nbsp; ".join(words) + "</span>")
        self.legend.adjustSize()

    def show_certificate(self, made: SpanCertificate | None) -> None:
        frames = np.array(made.frames if made else (), np.float64)
        for name, curve in self.curves.items():
            curve.setData(frames, scaled(getattr(made.certificate, name)) if made and len(frames) else frames)
        if len(frames):
            self.plot.setXRange(frames[0] - 1, frames[-1] + 1, padding=0)


class ProblemRow(QPushButton):
    """A problem in one line, cut where the panel ends."""

    def __init__(self, words: str) -> None:
        super().__init__(words)
        self.words = words
        self.setProperty("problem", True)
        self.setMinimumWidth(1)
        self.setCursor(Qt.CursorShape.PointingHandCursor)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        room = self.width() - self.iconSize().width() - 26
        self.setText(self.fontMetrics().elidedText(self.words, Qt.TextElideMode.ElideRight, room))


class CertificatePanel(QWidget):
    """`problemChosen` tells the place and the colour of a problem that was clicked, after going to its frame."""

    problemChosen = Signal(object, str)

    def __init__(
        self, session: Session, certificates: CertificatePreview, theme: Theme, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.session, self.certificates, self.theme = session, certificates, theme
        self.section = Section("Certificate")
        self.plot = MeasuresPlot(theme)
        self.section.box.addWidget(self.plot)
        self.rows: list[ProblemRow] = []
        self._grid = QGridLayout()
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setSpacing(2)
        self._grid.setColumnStretch(0, 1)
        self.section.box.addLayout(self._grid)
        self.repair = flat_button(
            "repair", "Bend the in-betweens just as far as needed, so that none crosses itself"
        )
        self.repair.setFixedHeight(23)
        self.repair.clicked.connect(self._on_repair)
        self._grid.addWidget(self.repair, 0, 1)
        self.advice = label("", "muted")
        self.advice.setWordWrap(True)
        self.section.box.addWidget(self.advice)
        self.better = QPushButton("Take intrinsic, repaired")
        self.better.setToolTip("Change the method to intrinsic and repair its crossings, in one step")
        self.better.clicked.connect(self._on_better)
        self.section.box.addWidget(self.better)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.section)
        self._shown: SpanCertificate | None = None
        for signal in (session.documentChanged, session.frameChanged, session.layerChanged, certificates.changed):
            signal.connect(self._refresh)
        self._refresh()

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self.plot.set_theme(theme)
        self._show(self._shown)

    def _refresh(self, *_: object) -> None:
        before, after = self.session.span_keyframes()
        there = before is not None and after is not None
        made = self.certificates.of(before, after) if there else None
        self.plot.playhead.setPos(self.session.frame)
        self.plot.setVisible(there)
        if made is not self._shown:
            self._show(made)
        self.section.note.setVisible(there)
        advice = made.advice if made else ""
        self.advice.setText(advice)
        self.advice.setVisible(bool(advice))
        self.better.setVisible(bool(advice))
        crossed = any((p.kind, p.severity) == ("crossing", "error") for p in (made.summary if made else ()))
        self.repair.setVisible(crossed and before is not None and not before.span.repair)

    def _show(self, made: SpanCertificate | None) -> None:
        self._shown = made
        self.plot.show_certificate(made)
        text, token = note(made)
        self.section.note.setText(text)
        self.section.note.setStyleSheet(f"color: {self.theme.color(token).name()};")
        for row in self.rows:
            self._grid.removeWidget(row)
            row.hide()
            row.deleteLater()
        self.rows = [self._row(made, p) for p in made.summary[:MOST_ROWS]] if made else []
        for i, row in enumerate(self.rows):
            self._grid.addWidget(row, i, 0, 1, 2 if i else 1)  # beside the first one stands the repair

    def _row(self, made: SpanCertificate, problem: Problem) -> ProblemRow:
        frame = made.frame_of(problem)
        where = "" if frame is None else f"frame {frame}: "
        row = ProblemRow(where + brief(problem))
        row.setIcon(dot(self.theme.color(SEVERITY_COLORS[problem.severity])))
        row.setToolTip(f"{where}{finding(problem)}")
        row.clicked.connect(lambda: self._go_to(frame, problem))
        return row

    def _go_to(self, frame: int | None, problem: Problem) -> None:
        if frame is not None:
            self.session.go_to(frame)
            self.problemChosen.emit(problem.place, SEVERITY_COLORS[problem.severity])

    def _on_better(self) -> None:
        before, _ = self.session.span_keyframes()
        if before is not None:
            change = {"method": "intrinsic", "repair": True}
            self.session.apply("Repair as Intrinsic", set_span, self.session.layer.id, before.frame, **change)

    def _on_repair(self) -> None:
        before, _ = self.session.span_keyframes()
        if before is not None:
            self.session.apply("Repair Crossings", set_span, self.session.layer.id, before.frame, repair=True)


def note(made: SpanCertificate | None) -> tuple[str, str]:
    """Return what stands beside the title, and its colour."""
    if made is None:
        return "checking …", "muted"
    if not made.frames:
        return "no in-between", "muted"
    found = [p.severity for p in made.certificate.problems]
    for severity in ("error", "warning"):
        if count := found.count(severity):
            return f"{count} {severity}{'' if count == 1 else 's'}", severity
    return "no problem", "good"


def brief(problem: Problem) -> str:
    """Return a problem in a few words; its sentence is too long for the panel."""
    outline = f"outline {problem.outlines[0]}: " if "outline " in problem.text.partition(": ")[2] else ""
    if problem.kind in ("collapse", "explosion", "closure"):
        return f"{outline}edge {problem.edges[0]} × {problem.value:.2g}"
    if problem.kind == "area":
        return f"{outline}area × {problem.value:.2g}"
    if problem.kind == "crossing":
        return f"edge {problem.edges[0]} crosses {problem.edges[1]}"
    if problem.kind == "fold":
        return f"{outline}edge {problem.edges[0]} folds back"
    return finding(problem)


def scaled(values: FloatArray) -> FloatArray:
    """Return a measure in 0 to 1; one that hardly changes is a flat line in the middle."""
    low, high = float(values.min()), float(values.max())
    room = max(high - low, LEAST_RANGE * abs(high), 1e-12)
    return 0.5 + (values - (low + high) / 2) / room


def dot(color) -> QIcon:
    picture = QPixmap(20, 20)
    picture.fill(Qt.GlobalColor.transparent)
    painter = QPainter(picture)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(color)
    painter.drawEllipse(4, 4, 12, 12)
    painter.end()
    picture.setDevicePixelRatio(2)
    return QIcon(picture)

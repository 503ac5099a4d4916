"""Other ways to match the two outlines, as little pictures of the middle: hover to try one, click to take it."""

import numpy as np
from PySide6.QtCore import QEvent, QObject, QSize, Qt, Signal
from PySide6.QtGui import QIcon, QPainter, QPixmap, QTransform
from PySide6.QtWidgets import QHBoxLayout, QToolButton, QVBoxLayout, QWidget

from app.painting import paint_outlines
from app.panels.parts import flat_button, label
from app.preview.alternatives import AlternativesPreview, Ranking
from app.preview.spans import SpanPreview
from app.session import Session
from app.theme import Theme
from core.correspondence.matching import Alternative
from core.geometry.outline import FloatArray
from core.model.document import OutlinePair
from core.model.edits import choose_correspondence, solve_again
from core.repair.between import inbetween

PICTURE = QSize(44, 40)
"""So small that all stand in one row: more or fewer must not move the panels below under a person's hand."""


class AlternativesPanel(QWidget):
    """Thumbnails with their costs, a badge where a newer solve would differ, and Solve again."""

    chosen = Signal()

    def __init__(
        self,
        session: Session,
        preview: SpanPreview,
        ranked: AlternativesPreview,
        theme: Theme,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.session, self.preview, self.ranked, self.theme = session, preview, ranked, theme
        self.buttons: list[QToolButton] = []
        self._shown: Ranking | None = None
        self._shown_method = ""
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(6)
        self._pictures = QHBoxLayout()
        self._pictures.setSpacing(4)
        self._pictures.addStretch(1)
        column.addLayout(self._pictures)
        row = QHBoxLayout()
        self.badge = label("", "badge")
        self.badge.setToolTip("The stored correspondence is kept until you ask for a new one")
        self.again = flat_button("Solve again", "Forget the stored or chosen correspondence; anchors stay")
        self.again.clicked.connect(self._on_again)
        row.addWidget(self.badge)
        row.addStretch(1)
        row.addWidget(self.again)
        column.addLayout(row)
        ranked.changed.connect(self._refresh)
        preview.planned.connect(self._refresh)
        for signal in (session.documentChanged, session.frameChanged, session.layerChanged):
            signal.connect(self._refresh)
        self._refresh()

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self._shown = None
        self._refresh()

    def _pair(self, ranking: Ranking) -> OutlinePair | None:
        question = ranking.question
        layer, frame = question.span
        keyframe = self.session.layer.keyframe_at(frame) if self.session.layer.id == layer else None
        return keyframe.span.pair_of(question.before.id, question.after.id) if keyframe else None

    def _refresh(self, *_: object) -> None:
        before, after = self.session.span_keyframes()
        if not self.session.in_gesture:
            self.ranked.ask(before, after, self.session.layer.id)
        ranking = self.ranked.ranking
        # thumbnails must be there at once: the slow methods' middles look like intrinsic's at this size
        method = "linear" if before is not None and before.span.method == "linear" else "intrinsic"
        if ranking is not self._shown or method != self._shown_method:
            self._show_pictures(ranking, method)
        pair = self._pair(ranking) if ranking else None
        kept = pair is not None and pair.correspondence is not None
        self.again.setVisible(kept)
        self.badge.setText("")
        self.badge.setVisible(kept)  # an empty row would still take its place
        if ranking is None or before is None or after is None:
            return
        current = self._current(ranking)
        for i, button in enumerate(self.buttons):
            button.setChecked(i == current)
        if kept and pair is not None and current != 0:
            self.badge.setText("your choice" if pair.chosen else "a new solve would differ")

    def _current(self, ranking: Ranking) -> int | None:
        before, after = self.session.span_keyframes()
        if before is None or after is None:
            return None
        ids = ranking.question.before.id, ranking.question.after.id
        pair = before.span.pair_of(*ids)
        if pair is None or pair.correspondence is None:
            return 0
        return ranking.index_of(pair.correspondence)

    def _show_pictures(self, ranking: Ranking | None, method: str) -> None:
        self._shown, self._shown_method = ranking, method
        for button in self.buttons:
            self._pictures.removeWidget(button)
            button.hide()
            button.deleteLater()
        self.buttons = []
        for i, alternative in enumerate(ranking.alternatives if ranking else ()):
            button = self._button(ranking, alternative, method)
            self.buttons.append(button)
            self._pictures.insertWidget(i, button)

    def _button(self, ranking: Ranking, alternative: Alternative, method: str) -> QToolButton:
        button = QToolButton()
        button.setProperty("picture", True)
        button.setCheckable(True)
        button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextUnderIcon)
        button.setIconSize(PICTURE)
        button.setFixedSize(48, 64)
        button.setText(f"{alternative.cost:.3f}")
        button.setIcon(QIcon(self._picture(ranking, alternative, method)))
        button.setToolTip(
            f"Cost {alternative.cost:.3f}: stretch {alternative.stretch:.3f}, bend {alternative.bend:.3f}, "
            f"turn {alternative.turn:.3f}. Hover to try it, click to take it."
        )
        button.clicked.connect(lambda: self._take(ranking, alternative))
        button.installEventFilter(self)
        return button

    def _picture(self, ranking: Ranking, alternative: Alternative, method: str) -> QPixmap:
        question = ranking.question
        left, right = alternative.correspondence.align(question.before.points, question.after.points)
        middle = inbetween(left, right, 0.5, method, closed=question.closed)
        ratio = 2.0
        picture = QPixmap(PICTURE * ratio)
        picture.fill(Qt.GlobalColor.transparent)
        painter = QPainter(picture)
        paint_outlines(
            painter,
            [(middle, question.closed)],
            fill=self.theme.color("accent", 0.16) if question.closed else None,
            stroke=self.theme.color("inbetween"),
            width=1.4 * ratio,
            transform=_fitted(middle, PICTURE * ratio, 4 * ratio),
        )
        painter.end()
        picture.setDevicePixelRatio(ratio)
        return picture

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() in (QEvent.Type.Enter, QEvent.Type.Leave) and watched in self.buttons:
            ranking = self._shown
            if event.type() == QEvent.Type.Enter and ranking is not None:
                q = ranking.question
                alternative = ranking.alternatives[self.buttons.index(watched)]
                self.preview.try_out((q.span, q.before.id, q.after.id), alternative.correspondence)
            else:
                self.preview.try_out(None)
        return False

    def _take(self, ranking: Ranking, alternative: Alternative) -> None:
        self.preview.try_out(None)
        session, q = self.session, ranking.question
        if alternative is ranking.alternatives[0]:
            session.apply("Solve Again", solve_again, *q.span)
        else:
            ids = q.before.id, q.after.id
            session.apply(
                "Choose Correspondence",
                choose_correspondence,
                *q.span,
                *ids,
                alternative.correspondence,
            )
        self._refresh()

    def _on_again(self) -> None:
        before, after = self.session.span_keyframes()
        if before is not None and after is not None:
            self.session.apply("Solve Again", solve_again, self.session.layer.id, before.frame)


def _fitted(points: FloatArray, size: QSize, margin: float) -> QTransform:
    """Return the map that fits points into a picture."""
    low, high = np.min(points, axis=0), np.max(points, axis=0)
    wide, high_ = np.maximum(high - low, 1e-9)
    scale = min((size.width() - 2 * margin) / wide, (size.height() - 2 * margin) / high_)
    centre = (low + high) / 2
    dx, dy = size.width() / 2 - scale * centre[0], size.height() / 2 - scale * centre[1]
    return QTransform(scale, 0, 0, scale, dx, dy)

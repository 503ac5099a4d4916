"""Colours and shapes of the window: one set of tokens, light and dark."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from PySide6.QtCore import QByteArray, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QIcon, QPainter, QPalette, QPixmap
from PySide6.QtSvg import QSvgRenderer
from PySide6.QtWidgets import QApplication

import resources


@dataclass(frozen=True, slots=True)
class Theme:
    """Colours by what they mean, as #rrggbb."""

    name: str
    background: str
    panel: str
    raised: str
    line: str
    text: str
    muted: str
    stage: str
    accent: str
    accent_text: str
    before: str
    after: str
    inbetween: str
    onion_before: str
    onion_after: str
    skin_before: str
    skin_after: str
    good: str
    warning: str
    error: str
    shorter: str
    same: str
    longer: str

    def color(self, token: str, alpha: float = 1.0) -> QColor:
        """Return the colour of a token, with an alpha from 0 to 1."""
        color = QColor(getattr(self, token))
        color.setAlphaF(alpha)
        return color


DARK = Theme(
    "dark",
    background="#17191e",
    panel="#1f2229",
    raised="#262a33",
    line="#333945",
    text="#e7eaf0",
    muted="#98a1b0",
    stage="#101216",
    accent="#8b6cff",
    accent_text="#ffffff",
    before="#4c9aff",
    after="#ff9f43",
    inbetween="#f3f5f9",
    onion_before="#ff6161",
    onion_after="#3dd68c",
    skin_before="#56b4e9",
    skin_after="#e8700c",
    good="#3dd68c",
    warning="#f5c04e",
    error="#ff6161",
    shorter="#3fa9f5",
    same="#8b93a1",
    longer="#ff8c1a",
)
LIGHT = Theme(
    "light",
    background="#eef0f3",
    panel="#ffffff",
    raised="#f4f5f8",
    line="#d8dce3",
    text="#1c2128",
    muted="#5f6979",
    stage="#ffffff",
    accent="#6b4be8",
    accent_text="#ffffff",
    before="#1f6fe0",
    after="#d9720b",
    inbetween="#2a2f3a",
    onion_before="#d63b3b",
    onion_after="#1a9e5c",
    skin_before="#0072b2",
    skin_after="#d55e00",
    good="#1a9e5c",
    warning="#c98a05",
    error="#d63b3b",
    shorter="#0072b2",
    same="#a9b0bb",
    longer="#e06c00",
)


def system_theme(choice: str = "system") -> Theme:
    """Return the theme of that name, or the one that the desktop asks for."""
    if choice in ("dark", "light"):
        return DARK if choice == "dark" else LIGHT
    app = QApplication.instance()
    light = isinstance(app, QApplication) and app.styleHints().colorScheme() == Qt.ColorScheme.Light
    return LIGHT if light else DARK


def palette(theme: Theme) -> QPalette:
    """Return the palette, for everything that the style sheet does not name."""
    p = QPalette()
    role = QPalette.ColorRole
    for name, token in (
        (role.Window, "panel"),
        (role.WindowText, "text"),
        (role.Base, "raised"),
        (role.AlternateBase, "panel"),
        (role.Text, "text"),
        (role.Button, "raised"),
        (role.ButtonText, "text"),
        (role.ToolTipBase, "raised"),
        (role.ToolTipText, "text"),
        (role.PlaceholderText, "muted"),
        (role.Highlight, "accent"),
        (role.HighlightedText, "accent_text"),
        (role.Link, "accent"),
        (role.Mid, "line"),
        (role.Light, "raised"),
        (role.Dark, "line"),
    ):
        p.setColor(name, theme.color(token))
    for name in (role.Text, role.WindowText, role.ButtonText):
        p.setColor(QPalette.ColorGroup.Disabled, name, theme.color("muted", 0.55))
    return p


NO_BUTTON_ICONS = "QDialogButtonBox { dialogbuttonbox-buttons-have-icons: 0; }"
"""For the application: the buttons of a dialog ask for it before they have a window."""


def style_sheet(theme: Theme) -> str:
    """Return the style sheet of the whole window."""
    t = theme
    return f"""
* {{ font-size: 12px; }}
QMainWindow, QDialog {{ background: {t.panel}; }}
QWidget#backdrop {{ background: {t.background}; }}
QMenuBar {{ background: {t.panel}; color: {t.text}; padding: 2px 6px; border-bottom: 1px solid {t.line}; }}
QMenuBar::item {{ padding: 6px 10px; border-radius: 6px; background: transparent; }}
QMenuBar::item:selected {{ background: {t.raised}; }}
QMenu {{ background: {t.panel}; color: {t.text}; border: 1px solid {t.line}; padding: 4px; }}
QMenu::item {{ padding: 6px 28px 6px 24px; border-radius: 6px; }}
QMenu::item:selected {{ background: {t.accent}; color: {t.accent_text}; }}
QMenu::item:disabled {{ color: {t.muted}; background: transparent; }}
QMenu::separator {{ height: 1px; background: {t.line}; margin: 4px 8px; }}
QToolTip {{ background: {t.raised}; color: {t.text}; border: 1px solid {t.line}; padding: 4px 6px; }}
QStatusBar {{ background: {t.panel}; color: {t.muted}; border-top: 1px solid {t.line}; }}
QStatusBar::item {{ border: none; }}
QStatusBar QLabel {{ color: {t.muted}; padding: 0 8px; }}
QLabel {{ color: {t.text}; background: transparent; }}
QLabel[role="title"] {{ color: {t.muted}; font-size: 11px; font-weight: 600; }}
QLabel[role="muted"] {{ color: {t.muted}; }}
QLabel[role="strong"] {{ font-weight: 600; }}
QLabel[role="heading"] {{ font-size: 16px; font-weight: 600; }}
QLabel[role="key"] {{ background: {t.raised}; border: 1px solid {t.line}; border-radius: 5px; padding: 1px 6px; }}
QLabel[held="true"] {{ color: {t.accent_text}; background: {t.accent}; border-radius: 4px; }}
QFrame#card {{ background: {t.panel}; border: 1px solid {t.line}; border-radius: 10px; }}
QFrame#separator {{ background: {t.line}; border: none; }}
QWidget#side, QWidget#toolbox, QWidget#timeline {{ background: {t.panel}; }}
QWidget#side {{ border-left: 1px solid {t.line}; }}
QWidget#toolbox {{ border-right: 1px solid {t.line}; }}
QWidget#timeline {{ border-top: 1px solid {t.line}; }}
QScrollArea, QScrollArea > QWidget > QWidget {{ background: {t.panel}; border: none; }}
QToolButton {{ background: transparent; color: {t.text}; border: 1px solid transparent; border-radius: 7px;
    padding: 4px; }}
QToolButton:hover {{ background: {t.raised}; border-color: {t.line}; }}
QToolButton:pressed {{ background: {t.line}; }}
QToolButton:checked {{ background: {t.accent}; color: {t.accent_text}; border-color: {t.accent}; }}
QToolButton:disabled, QCheckBox:disabled {{ color: {t.muted}; }}
QToolButton:checked:disabled {{ background: {t.line}; border-color: {t.line}; }}
QToolButton:focus, QPushButton:focus {{ border-color: {t.accent}; }}
QToolButton[arrow="true"] {{ border: none; padding: 0; color: {t.muted}; font-size: 11px; }}
QToolButton[segment="true"] {{ padding: 5px 6px; min-height: 18px; }}
QToolButton[picture="true"] {{ background: {t.raised}; border-color: {t.line}; color: {t.muted};
    font-size: 10px; padding: 2px; }}
QToolButton[picture="true"]:hover {{ border-color: {t.muted}; }}
QToolButton[picture="true"]:checked {{ border: 1.5px solid {t.accent}; color: {t.text}; }}
QLabel[role="badge"] {{ color: {t.warning}; font-size: 11px; }}
QPushButton[problem="true"] {{ background: {t.raised}; border-color: {t.line}; text-align: left;
    padding: 2px 8px; min-height: 17px; }}
QPushButton[problem="true"]:hover {{ border-color: {t.muted}; }}
QFrame#plot {{ background: {t.raised}; border: 1px solid {t.line}; border-radius: 7px; }}
QToolButton[swatch="true"] {{ background: {t.raised}; border-color: {t.line}; padding: 3px; }}
QWidget#segments {{ background: {t.raised}; border: 1px solid {t.line}; border-radius: 8px; }}
QPushButton {{ background: {t.raised}; color: {t.text}; border: 1px solid {t.line}; border-radius: 7px;
    padding: 5px 14px; min-height: 18px; }}
QPushButton:hover {{ border-color: {t.muted}; }}
QPushButton:pressed {{ background: {t.line}; }}
QPushButton:checked {{ background: {t.accent}; color: {t.accent_text}; border-color: {t.accent}; }}
QPushButton:default {{ background: {t.accent}; color: {t.accent_text}; border-color: {t.accent}; }}
QPushButton:disabled {{ color: {t.muted}; background: {t.panel}; border-color: {t.line}; }}
QPushButton[flat="true"] {{ background: transparent; border-color: transparent; color: {t.accent};
    padding: 4px 6px; }}
QPushButton[flat="true"]:disabled {{ color: {t.muted}; }}
QLineEdit, QPlainTextEdit, QSpinBox, QDoubleSpinBox, QComboBox {{ background: {t.raised}; color: {t.text};
    border: 1px solid {t.line}; border-radius: 7px; padding: 3px 8px; min-height: 20px;
    selection-background-color: {t.accent}; selection-color: {t.accent_text}; }}
QComboBox::down-arrow {{ image: url({_drawn("down", t.muted)}); width: 12px; height: 12px; }}
QLineEdit:focus, QPlainTextEdit:focus, QSpinBox:focus, QDoubleSpinBox:focus,
QComboBox:focus {{ border-color: {t.accent}; }}
QLineEdit:disabled, QSpinBox:disabled, QDoubleSpinBox:disabled, QComboBox:disabled {{ color: {t.muted}; }}
QSpinBox::up-button, QSpinBox::down-button, QDoubleSpinBox::up-button, QDoubleSpinBox::down-button {{
    width: 0; border: none; }}
QComboBox::drop-down {{ border: none; width: 18px; }}
QComboBox QAbstractItemView {{ background: {t.panel}; color: {t.text}; border: 1px solid {t.line};
    selection-background-color: {t.accent}; selection-color: {t.accent_text}; outline: none; }}
QTreeWidget {{ background: {t.raised}; color: {t.text}; border: 1px solid {t.line}; border-radius: 7px;
    outline: none; }}
QTreeWidget#palette {{ background: {t.panel}; border: none; }}
QTreeWidget::item {{ min-height: 22px; padding: 2px 6px; }}
QTreeWidget::item:selected {{ background: {t.accent}; color: {t.accent_text}; }}
QTreeWidget::item:disabled {{ color: {t.muted}; }}
QHeaderView::section {{ background: {t.panel}; color: {t.muted}; border: none; padding: 4px 8px; }}
QCheckBox {{ color: {t.text}; spacing: 8px; }}
QCheckBox::indicator {{ width: 15px; height: 15px; border: 1px solid {t.muted}; border-radius: 4px;
    background: {t.raised}; }}
QCheckBox::indicator:checked {{ background: {t.accent}; border-color: {t.accent};
    image: url({_drawn("check", t.accent_text)}); }}
QCheckBox::indicator:disabled {{ background: {t.panel}; border-color: {t.line}; }}
QSlider::groove:horizontal {{ height: 4px; background: {t.line}; border-radius: 2px; }}
QSlider::sub-page:horizontal {{ background: {t.accent}; border-radius: 2px; }}
QSlider::handle:horizontal {{ width: 12px; height: 12px; margin: -4px 0; border-radius: 6px;
    background: {t.text}; }}
QProgressBar {{ background: {t.raised}; color: {t.text}; border: 1px solid {t.line}; border-radius: 6px;
    text-align: center; min-height: 14px; }}
QProgressBar::chunk {{ background: {t.accent}; border-radius: 5px; }}
QScrollBar:vertical {{ width: 10px; background: transparent; margin: 0; }}
QScrollBar:horizontal {{ height: 10px; background: transparent; margin: 0; }}
QScrollBar::handle {{ background: {t.line}; border-radius: 5px; min-height: 24px; min-width: 24px; }}
QScrollBar::handle:hover {{ background: {t.muted}; }}
QScrollBar::add-line, QScrollBar::sub-line, QScrollBar::add-page, QScrollBar::sub-page {{
    background: none; border: none; width: 0; height: 0; }}
QFrame#popup {{ background: {t.panel}; border: 1px solid {t.line}; border-radius: 8px; }}
QWidget#sheet {{ background: {t.panel}; border-left: 1px solid {t.line}; }}
QTableView {{ background: {t.panel}; border: none; outline: none; }}
QHeaderView, QTableCornerButton::section {{ background: {t.panel}; border: none; }}
QHeaderView::section {{ background: {t.panel}; color: {t.muted}; border: none; font-size: 11px; padding: 0 4px; }}
QHeaderView::section:horizontal {{ border-bottom: 1px solid {t.line}; border-right: 1px solid {t.line};
    padding: 4px; }}
QHeaderView::section:vertical {{ border-right: 1px solid {t.line}; }}
QHeaderView::section:checked {{ color: {t.text}; background: {t.raised}; font-weight: 600; }}
QLineEdit[cell="true"] {{ border-radius: 2px; padding: 0; min-height: 0; }}
QFrame#messagebar {{ background: {t.raised}; border: 1px solid {t.line}; border-radius: 8px; }}
QFrame#messagebar[kind="error"] {{ border-color: {t.error}; }}
QFrame#messagebar[kind="info"] {{ border-color: {t.accent}; }}
"""


def _drawn(name: str, color: str) -> str:
    """Return a file with an icon in a colour: a style sheet takes pictures from files only."""
    folder = Path(_picture_folder().name)
    path = folder / f"{name}-{color[1:]}.png"
    if not path.exists():
        pixmap(name, QColor(color), 24, 1.0).save(str(path))
    return path.as_posix()


@cache
def _picture_folder() -> TemporaryDirectory[str]:
    return TemporaryDirectory(prefix="inkbetween-")


def icon(name: str, theme: Theme) -> QIcon:
    """Return one of our icons in the theme's colours: muted when off, the accent's text colour when checked."""
    made = QIcon()
    for token, alpha, mode, state in (
        ("text", 1.0, QIcon.Mode.Normal, QIcon.State.Off),
        ("accent_text", 1.0, QIcon.Mode.Normal, QIcon.State.On),
        ("muted", 0.5, QIcon.Mode.Disabled, QIcon.State.Off),
    ):
        made.addPixmap(pixmap(name, theme.color(token, alpha), 20), mode, state)
    return made


def pixmap(name: str, color: QColor, size: int, ratio: float = 2.0) -> QPixmap:
    """Return an icon drawn in one colour, `size` logical px wide, sharp on fine screens too."""
    source = resources.icon(name).read_text(encoding="utf-8").replace("currentColor", color.name())
    picture = QPixmap(QSize(round(size * ratio), round(size * ratio)))
    picture.fill(Qt.GlobalColor.transparent)
    painter = QPainter(picture)
    painter.setOpacity(color.alphaF())
    QSvgRenderer(QByteArray(source.encode())).render(painter, QRectF(picture.rect()))
    painter.end()
    picture.setDevicePixelRatio(ratio)
    return picture

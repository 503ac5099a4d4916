"""The frame at the playhead on the clipboard, for other programs: as a picture, as SVG."""

from PySide6.QtCore import QByteArray, QMimeData, QSize
from PySide6.QtGui import QGuiApplication

from app.export.png import encode_png
from app.export.svg import frame_svg
from app.painting import render_frame
from app.session import Session
from core.errors import InkbetweenError
from core.model.motion import HasMotions, pictures_at

SVG = "image/svg+xml"
PNG = "image/png"


def copy_picture(session: Session, plans: HasMotions) -> bool:
    """Copy the frame as large as the stage, transparent where the stage is; whether that worked."""
    document = session.document
    size = QSize(document.stage.width, document.stage.height)
    try:
        image = render_frame(document, session.frame, size, plans)
    except InkbetweenError as e:
        session.problem.emit(str(e))
        return False
    data = QMimeData()
    data.setImageData(image)
    data.setData(PNG, QByteArray(encode_png(image)))  # some programs lose the alpha of the other one
    QGuiApplication.clipboard().setMimeData(data)
    return True


def copy_svg(session: Session, plans: HasMotions) -> bool:
    """Copy the frame as SVG, for drawing programs and as text; whether that worked."""
    document = session.document
    stage = document.stage
    try:
        pictures = pictures_at(document, session.frame, plans)
    except InkbetweenError as e:
        session.problem.emit(str(e))
        return False
    text = frame_svg(pictures, stage, (stage.width, stage.height), stage.background)
    data = QMimeData()
    data.setData(SVG, QByteArray(text.encode()))
    data.setText(text)
    QGuiApplication.clipboard().setMimeData(data)
    return True

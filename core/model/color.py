"""Mixing two colours so that the steps between them look even.

Source of the numbers: B. Ottosson, "A perceptual color space for image processing" (OKLab), 2020.
"""

import numpy as np

from core.geometry.outline import FloatArray
from core.model.drawing import Color

_TO_CONE = np.array(
    [
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ]
)
_TO_LAB = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)


def rgba(color: Color) -> FloatArray:
    """Return red, green, blue and alpha, each 0 to 1."""
    digits = color[1:] if len(color) == 9 else color[1:] + "ff"
    return np.array([int(digits[i : i + 2], 16) for i in (0, 2, 4, 6)]) / 255


def hex_color(channels: FloatArray) -> Color:
    """Return the colour of four channels, each clipped to 0 to 1; without its alpha where that is 1."""
    text = "".join(f"{round(255 * float(c)):02x}" for c in np.clip(channels, 0, 1))
    return "#" + text.removesuffix("ff") if len(text) == 8 and text.endswith("ff") else "#" + text


def mix_colors(before: Color | None, after: Color | None, t: float) -> Color | None:
    """Return the colour at t (clipped to 0 to 1) between two; None counts as the other one, fully transparent."""
    if before is None and after is None:
        return None
    t = min(max(t, 0.0), 1.0)
    if t in (0.0, 1.0) or before == after:
        return after if t == 1.0 else before
    p = rgba(before) if before is not None else rgba(after or "") * (1, 1, 1, 0)
    q = rgba(after) if after is not None else p * (1, 1, 1, 0)
    lab = (1 - t) * _lab(p[:3]) + t * _lab(q[:3])
    return hex_color(np.append(_rgb(lab), (1 - t) * p[3] + t * q[3]))


def _lab(rgb: FloatArray) -> FloatArray:
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    lab: FloatArray = _TO_LAB @ np.cbrt(_TO_CONE @ linear)
    return lab


def _rgb(lab: FloatArray) -> FloatArray:
    linear = np.linalg.solve(_TO_CONE, np.linalg.solve(_TO_LAB, lab) ** 3)
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)

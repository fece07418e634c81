"""Colours: written as sRGB "#rrggbb" like on the page, used as linear light in the renderer."""

import numpy as np


def srgb(colour: str) -> np.ndarray:
    """The three channels of "#rrggbb", 0..1, as the screen shows them."""
    return np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)], np.float64) / 255.0


def linear(colour: str) -> np.ndarray:
    """The three channels of "#rrggbb" as linear light, 0..1 (IEC 61966-2-1)."""
    c = srgb(colour)
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def rgb8(colour: str) -> tuple[int, int, int]:
    """The three channels of "#rrggbb", 0..255."""
    r, g, b = (int(round(c * 255)) for c in srgb(colour))
    return r, g, b


def linear8(colour: str) -> tuple[int, int, int]:
    """Linear light in 0..255: viser takes the fog's colour as linear."""
    r, g, b = (int(round(c * 255)) for c in linear(colour))
    return r, g, b

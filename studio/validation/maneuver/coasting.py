"""Coasting in neutral to a stop: calibrates air drag and rolling resistance (Long-Ia)."""

from studio.log.recording import Recording
from studio.validation import rolling

TITLE = "Coasting in neutral"
STEP = "III Long-Ia"
FED = ("speed",)
JUDGED = ("acceleration",)
HOLDS_SPEED = False
REPEATS = True
ZONES = JUDGED
UNJUDGED = ("beginning and end of the roll", "course of the speed", "way to standstill")
marks, measures = rolling.marks, rolling.measures


def find(recording: Recording) -> list[tuple[float, float]]:
    """Where it rolls in neutral and nobody brakes."""
    return rolling.find(recording, lambda each: rolling.is_neutral(each) & ~rolling.is_braked(each))

"""Coasting in neutral with a constant brake: calibrates the brake (Long-Ib)."""

from studio.log.recording import Recording
from studio.validation import rolling

TITLE = "Coasting with a constant brake"
STEP = "III Long-Ib"
FED = ("speed", "brake_torque|brake")
JUDGED = ("acceleration",)
HOLDS_SPEED = False
REPEATS = True
ZONES = JUDGED
UNJUDGED = ("beginning and end of the roll", "course of the speed", "way to standstill")
marks, measures = rolling.marks, rolling.measures


def find(recording: Recording) -> list[tuple[float, float]]:
    """Where it rolls in neutral, braked."""
    return rolling.find(recording, lambda each: rolling.is_neutral(each) & rolling.is_braked(each))

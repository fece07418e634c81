"""Applications that raise, or hang, half a second into the run."""

BROKEN = '''
"""Raises after half a second."""
from typing import NamedTuple
from pydantic import BaseModel
from studio.application.contract import LEAVE, Command

TITLE = "Broken"

class Parameters(BaseModel):
    pass

class Memory(NamedTuple):
    pass

def decide(parameters, memory, observation):
    if observation.clock.time > 0.5:
        raise RuntimeError("the idea was not so good")
    return memory, Command(LEAVE, LEAVE)
'''

# Leaves a sign beside itself before it hangs.
HANGING = BROKEN.replace("Raises", "Hangs").replace(
    'raise RuntimeError("the idea was not so good")',
    """from pathlib import Path
        Path(__file__).with_suffix(".sign").touch()
        while True:
            pass""",
)

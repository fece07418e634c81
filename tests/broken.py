"""Applications that raise, or hang, half a second into the run."""

BROKEN = '''
"""Raises after half a second."""
from typing import NamedTuple
from studio.application.contract import Clock, Command, leave
from studio.kind.settings import Part

KIND = "application"
TITLE = "Broken"
COMMANDS = 1

class Parameters(Part):
    pass

class Memory(NamedTuple):
    pass

class Sees(NamedTuple):
    clock: Clock

class Does(NamedTuple):
    command: Command

def decide(parameters, memory, sees):
    if sees.clock.time > 0.5:
        raise RuntimeError("the idea was not so good")
    return memory, Does(leave())
'''

# Leaves a sign beside itself before it hangs.
HANGING = BROKEN.replace("Raises", "Hangs").replace(
    'raise RuntimeError("the idea was not so good")',
    """from pathlib import Path
        Path(__file__).with_suffix(".sign").touch()
        while True:
            pass""",
)

"""A trial of the applications of a scenario before anything is simulated: each decides on drawn inputs, with the parameters it has there.

A wrong return value, an exception, or a number that is none is found by calling `decide`, and by nothing else.
"""

from collections.abc import Iterator

import numpy as np

from studio.errors import Problem
from studio.kind import registry
from studio.kind.registry import Kind
from studio.scenario.schema import Application, Scenario
from studio.workshop import draw
from studio.workshop.suite.application import remembered, sees
from studio.workshop.twice import flat, short
from studio.world.board.text import shaped

DRAWS = 60
TICK = 0.02  # [s]


def problems(scenario: Scenario, where: str) -> list[Problem]:
    """What the applications of a scenario do wrong when they are called."""
    found = []
    for name, group in scenario.applications.items():
        kind = registry.known("application").get(group.application)
        found += [] if kind is None else [Problem(f"{where}: applications.{name}.application", wrong, repr(kind.name), remedy=remedy)
                                          for wrong, remedy in wrongs(kind, group)]  # fmt: skip
    return found


def wrongs(kind: Kind, group: Application) -> Iterator[tuple[str, str]]:
    """The first thing that an application does wrong, and what to do about it."""
    module, seed = kind.module, np.random.default_rng(1)
    plain = getattr(module.decide, "py_func", module.decide)
    memory = module.Memory()
    parameters = draw.settings_tuple(module, module.Parameters.model_validate(group.parameters))
    for k in range(DRAWS):
        given = parameters, memory, sees(module, k * TICK, seed)
        try:
            answer, does = shaped(plain(*given), module)
        except Exception as error:
            yield f"raises {type(error).__name__} when it decides: {error}", f"it was given {short(given)}"
            return
        if not np.isfinite(list(flat((answer, does)))).all():
            yield f"gives {short((answer, does))}, in which a number is none", f"look for a division by zero; it was given {short(given)}"
            return
        memory = remembered(module, answer)

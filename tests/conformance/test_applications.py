"""Every registered application keeps the contract."""

import math
import pickle
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from studio.application import registry
from studio.application.contract import Clock, Command, Front, Message, Observation, Own
from studio.application.host import compiled_loop, first_memory, observation_rows, python_loop
from studio.errors import ApplicationError

NAMES = sorted(registry.known())
speeds, accelerations, positions = st.floats(0, 60), st.floats(-10, 10), st.floats(-1e4, 1e4)
observations = st.builds(
    Observation,
    st.builds(Clock, st.floats(0, 1e4), st.sampled_from([0.01, 0.02, 0.1])),
    st.builds(Own, speeds, accelerations, st.floats(-1, 1), st.floats(-0.6, 0.6), speeds, accelerations, positions, positions),
    st.builds(Front, st.booleans(), st.floats(0, 300), st.floats(-60, 60), st.floats(-1.6, 1.6)),
    st.builds(Message, st.booleans(), st.floats(0, 1e4), positions, positions, speeds, accelerations, accelerations),
)


@pytest.fixture(params=NAMES)
def application(request):
    return registry.find(request.param)


def defaults(application):
    return application.module.ParameterTuple(*[float(value) for value in application.parameters({}).values()])


def test_the_built_ins_are_there():
    assert {"acc", "cacc"} <= set(NAMES)


def test_parameters_have_units_ranges_and_defaults(application):
    for name, field in application.module.Parameters.model_json_schema()["properties"].items():
        assert "default" in field and "title" in field, name
        assert field.get("type") in ("boolean", "integer") or "unit" in field, name
        assert field.get("type") == "boolean" or {"minimum", "exclusiveMinimum"} & set(field), name


def test_unknown_parameters_are_refused(application):
    with pytest.raises(ValidationError):
        application.parameters({"no_such_parameter": 1})


@given(observation=observations)
@pytest.mark.parametrize("name", NAMES)
def test_any_observation_gives_a_command(name, observation):
    """Finite or left to the driver; the same question gets the same answer; memory is floats."""
    application = registry.find(name)
    memory = application.module.Memory()
    answers = [application.module.decide(defaults(application), memory, observation) for _ in range(2)]
    remembered, command = answers[0]
    assert isinstance(command, Command) and len(remembered) == len(memory)
    assert all(math.isfinite(value) for value in remembered)
    assert all(math.isnan(value) or math.isfinite(value) for value in command)
    assert pickle.dumps(answers[0]) == pickle.dumps(answers[1])


def test_compiled_and_interpreted_agree(application):
    """The loop that runs in the world, and the same `decide` called as plain Python functions, car by car."""
    if not application.compiled:
        return
    rng = np.random.default_rng(3)
    n = 50
    observed = rng.normal(size=(len(observation_rows()), n)) * 5
    observed[1] = 0.02
    flags = [observation_rows().index(name) for name in ("front.detected", "message.received")]
    observed[flags] = rng.integers(0, 2, (2, n))
    results = []
    for loop in (compiled_loop(application), python_loop(application)):
        memory = np.tile(np.array(first_memory(application))[:, None], n)
        parameters = np.tile(np.array(defaults(application))[:, None], n)
        commands = np.full((2, n), np.nan)
        for _ in range(3):
            loop(np.arange(n), parameters, memory, observed, commands)
        results.append((memory, commands))
    np.testing.assert_allclose(results[0][0], results[1][0], rtol=1e-12)
    np.testing.assert_allclose(results[0][1], results[1][1], rtol=1e-12)


def test_a_name_is_given_once(application):
    with pytest.raises(Exception, match="taken"):
        registry.register(application.name, application.module)


WRONG = {
    "COMPILED = True": "is not compiled",
    "class Memory(NamedTuple):\n    u: float": "no defaults",
    "class Parameters(BaseModel):\n    name: str = 'x'": "no number",
}


@pytest.mark.parametrize("lines", WRONG)
def test_a_broken_contract_is_told_at_once(tmp_path, lines):
    from tests.broken import BROKEN

    path = tmp_path / f"wrong_{len(lines)}.py"
    path.write_text(f"{BROKEN}\n{lines}\n")
    with pytest.raises(ApplicationError, match=WRONG[lines]):
        registry.load_file(path)


def test_many_may_ask_at_once_for_the_first_time():
    """In a process of its own: whoever comes first registers the built-ins, the others wait."""
    code = """
import threading
from studio.application import registry
start, found = threading.Barrier(8), []
def ask():
    start.wait()
    found.append(sorted(registry.known()))
threads = [threading.Thread(target=ask) for _ in range(8)]
[each.start() for each in threads]; [each.join() for each in threads]
assert len(found) == 8 and all(each == found[0] and "acc" in each for each in found), found
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr

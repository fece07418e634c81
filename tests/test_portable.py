"""What may not depend on the processor: maps, ways, files and the state of a run, with numpy's and the compiler's units turned off."""

import os
import subprocess
import sys

import numpy as np
import pytest

from studio import portable
from studio.compiled import CACHE

BITS = """
import hashlib, sys
from studio import job
from studio.road import load
from studio.road.drawn.motorway import motorway
from studio.world.build import build
from studio.world.tick import tick

digest = hashlib.sha256(motorway(grade=0.03).encode())
for path in sys.argv[2:]:
    network = load(path)
    digest.update(repr(network.connections).encode())
    for lane in network.lanes:
        digest.update(lane.centre.tobytes())
    for array in vars(network.signals).values():
        digest.update(array.tobytes())
world = build([job.prepare(job.load(sys.argv[1]))])
digest.update(world.roads.points.tobytes())
for array in world.roads.web:
    digest.update(array.tobytes())
for _ in range(100):
    tick(world)
print(digest.hexdigest(), world.digest())
"""
PLAIN = {"OPENBLAS_CORETYPE": "Haswell"}
FRESH = "compiled afresh, for another processor"
OTHERS = {
    "numpy without AVX512": {"NPY_DISABLE_CPU_FEATURES": "X86_V4 AVX512_ICL AVX512_SPR"},
    "numpy without AVX2": {"NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX512_ICL AVX512_SPR"},
    "BLAS of an old processor": {"OPENBLAS_CORETYPE": "Prescott"},
    FRESH: {"NUMBA_CPU_NAME": "haswell"},
}


def bits(root, cache, variables, *, afresh=False):
    """Digests of maps, ways and a run of two seconds, by a process with these variables; with kept machine code, or afresh."""
    maps = [root / "scenarios" / "maps" / "motorway.xodr", root / "tests" / "reference" / "maps" / "perth_peanut_roundabout_lht.osm.gz"]
    if not afresh:
        (cache / "compiled").symlink_to(CACHE)  # machine code knows its processor; maps and ways are made anew
    environment = {**os.environ, **PLAIN, **variables, "STUDIO_CACHE": str(cache)}
    command = [sys.executable, "-c", BITS, str(root / "scenarios" / "grosser_stern_platoon.yaml"), *map(str, maps)]
    done = subprocess.run(command, capture_output=True, text=True, cwd=root, env=environment)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.fixture(scope="module")
def plain(root, tmp_path_factory):
    return bits(root, tmp_path_factory.mktemp("plain"), {})


@pytest.mark.parametrize("name", OTHERS)
def test_another_processor_gives_the_same_bits(root, plain, tmp_path, name):
    """The last of them compiles everything itself, so it tells, too, that kept code and fresh code are the same."""
    assert bits(root, tmp_path, OTHERS[name], afresh=name == FRESH) == plain
    assert any((tmp_path / "compiled").iterdir())


def test_functions_are_those_of_numpy_but_for_the_last_digit():
    rng = np.random.default_rng(1)
    x, y = rng.normal(size=(2, 1000))
    np.testing.assert_allclose(portable.arctan2(y, x), np.arctan2(y, x), rtol=1e-15)
    np.testing.assert_allclose(portable.tan(x), np.tan(x), rtol=1e-13)
    np.testing.assert_allclose(portable.wrapped(7.0 * x), np.angle(np.exp(7j * x)), atol=1e-14)
    assert portable.arctan2(1.0, 1.0) == pytest.approx(np.pi / 4) and portable.arctan2(0.0, -1.0) == np.pi


def test_vectors_in_the_plane():
    a, b, c = np.array([3.0, 1.0]), np.array([-1.0, 2.0]), np.array([1.0, 5.0])
    assert portable.dot(a, b) == -1.0 and portable.cross(a, b) == 7.0
    assert portable.turn(a, b) == pytest.approx(np.arctan2(7.0, -1.0))
    m, n = portable.resolved(a, b, c)
    np.testing.assert_allclose(m * a + n * b, c)

"""The same step on a GPU, where there is none: its machine code, and its own logic executed by Python with stand-ins.

The kernel is run thread by thread on the CPU; what only a GPU does (its arithmetic, its memory) is not tested here.
"""

import re
from types import SimpleNamespace

import numpy as np
import pytest

from studio.model.tyre import Tyre
from studio.vehicle import cuda, fleet
from studio.vehicle.contact import MU
from studio.vehicle.state import V_X
from studio.vehicle.tile import LANES
from tests.conftest import ROOT
from tests.proving_ground import MODELS, Ground


@pytest.fixture(scope="module")
def code():
    """The kernel's machine code; 15 s."""
    return cuda.ptx()


def test_the_kernel_is_one_function(code):
    """One entry, for GPUs from CAPABILITY on; it calls nothing: all the mathematics is inside."""
    assert re.search(rf"^\.target sm_{cuda.CAPABILITY[0]}{cuda.CAPABILITY[1]}", code, re.MULTILINE)
    entries = re.findall(r"\.visible \.entry (\w+)", code)
    assert len(entries) == 1 and "kernel" in entries[0]
    assert not re.findall(r"^\s*(?:@\S+\s+)?call", code, re.MULTILINE)
    assert not re.findall(r"\.extern|\.func", code)


def test_the_kernel_computes_in_double_precision(code):
    """No single precision arithmetic, nothing approximate but the start of the one arc sine."""
    assert re.findall(r"\bfma\.rn\.f64\b", code)
    assert not re.findall(r"\b(?:add|sub|mul|fma|div|sqrt|sin|cos|ex2|lg2)\.(?:\w+\.)*f32\b", code)
    assert set(re.findall(r"\b\w+\.approx[\w.]*", code)) <= {"rsqrt.approx.ftz.f64"}
    assert len(re.findall(r"\brsqrt\.approx", code)) <= 1


def test_the_kernel_holds_the_whole_tyre(code):
    """Four tyres are written out, each with as many divisions as one needs at least; nothing has been optimised away."""
    assert len(re.findall(r"\bdiv\.rn\.f64\b", code)) >= 4 * 20
    assert len(re.findall(r"\bst\.global\.f64\b", code)) > 100


# --- on the CPU ----------------------------------------------------------------------------------------------------------


class Memory(np.ndarray):
    """An array on the pretended GPU."""

    def copy_to_host(self):
        return np.array(self)


def to_device(array):
    return np.array(array).view(Memory)


class Launcher:
    """kernel[blocks, threads](...) that runs thread by thread."""

    def __init__(self, function, place):
        self.function, self.place = function, place

    def __getitem__(self, shape):
        def launch(*arguments):
            plain = [np.asarray(each) if isinstance(each, np.ndarray) else each for each in arguments]
            for self.place.blockIdx.x in range(shape[0]):
                for self.place.threadIdx.x in range(shape[1]):
                    self.function(*plain)

        return launch


@pytest.fixture
def pretended(monkeypatch):
    """A GPU that is none: its indices are set in loops, its memory is the computer's, tyres are read from their table."""
    place = SimpleNamespace(
        blockIdx=SimpleNamespace(x=0), threadIdx=SimpleNamespace(x=0), to_device=to_device,
        device_array=lambda shape: np.full(shape, np.nan).view(Memory), synchronize=lambda: None,
    )  # fmt: skip
    place.jit = lambda **options: lambda function: Launcher(function, place)
    monkeypatch.setattr(cuda, "cuda", place)
    monkeypatch.setattr(cuda, "tyre_at", lambda table, k: Tyre(*table[k]))
    return place


ASYMMETRIC = str(ROOT / "tests" / "reference" / "MagicFormula52_Parameters.tir")  # left and right tyres differ


def busy(n=1, models=tuple(MODELS), changes=None) -> Ground:
    """Vehicles of several models: they steer, drive, brake; one on ice."""
    ground = Ground(models, n=n, speed=np.linspace(0.0, 30.0, n * len(models)), powertrain=True, changes=changes)
    ground.command(steering=np.linspace(-0.05, 0.05, ground.n), pedal=np.linspace(0.0, 1.0, ground.n))
    ground.command(brake=np.linspace(2000.0, 0.0, ground.n)).run(0.5)
    ground.fleet.ground[MU, :: ground.n] = 0.1
    return ground


def assert_same(one: Ground, other: Ground):
    """Bit by bit: scalar code, as here, and vector code round alike."""
    for part in ("state", "wheels"):
        assert getattr(one, part).tobytes() == getattr(other, part).tobytes(), part


@pytest.mark.parametrize("ticks", [1, 25])
def test_the_device_does_what_the_cpu_does(pretended, ticks):
    """A fleet of different models on different tyres: tiled, integrated by the kernel, fetched, as motion.integrate has it."""
    on_cpu, on_gpu = busy(), busy()
    assert on_gpu.fleet.blocks.shape[1] > 3
    check(on_cpu, on_gpu, ticks)


def test_the_device_mirrors_tyres(pretended):
    """Tyres that pull to one side, other ones at the rear: each wheel gets the coefficients and the side that it has."""
    for axle in ("front", "rear"):
        pair = [busy(models=("suv", "smart_fortwo"), changes={f"tyres.{axle}": ASYMMETRIC}) for _ in range(2)]
        check(*pair, 1)


def check(on_cpu, on_gpu, ticks):
    """Integrates one on the CPU and one on the device."""
    device = cuda.Device(on_gpu.fleet)
    assert device.count == on_gpu.fleet.blocks.shape[1]
    device.integrate(on_gpu.k, 0.02, 0.005, ticks=ticks)
    device.synchronize()
    device.fetch(on_gpu.fleet)
    for _ in range(ticks):
        fleet.integrate(on_cpu.fleet, on_cpu.k, 0.02, 0.005)
    assert (np.abs(on_cpu.state[V_X]) > 0).any() and np.isfinite(on_gpu.state).all()
    assert_same(on_cpu, on_gpu)


def test_tiles_hold_every_vehicle_once(pretended):
    """More cars than a tile has lanes: columns of tiles are those of the blocks, empty lanes are -1 and stay untouched."""
    ground = busy(13)
    device = cuda.Device(ground.fleet)
    columns = device.columns[device.columns >= 0]
    assert sorted(columns) == list(range(ground.n))
    for b, (first, count) in enumerate(ground.fleet.blocks[:2].T):
        assert (device.columns[b, :count] == ground.fleet.order[first : first + count]).all()
        assert (device.columns[b, count:] == -1).all()
    state, wheels = device.tiled(ground.state, 1), device.tiled(ground.wheels, 4)
    assert state.shape == (device.count, len(ground.state), LANES)
    for b, lane in zip(*np.nonzero(device.columns >= 0), strict=True):
        v = device.columns[b, lane]
        assert (state[b, :, lane] == ground.state[:, v]).all()
        assert (wheels[b].reshape(-1, 4, LANES)[:, :, lane] == ground.wheels.reshape(-1, 4, ground.n)[:, :, v]).all()


def test_what_is_fetched_is_what_was_sent(pretended):
    """Device and back without a step: the same bits in every column."""
    ground = busy(13)
    state, wheels = ground.state.copy(), ground.wheels.copy()
    device = cuda.Device(ground.fleet)
    ground.state[:] = ground.wheels[:] = 0.0
    device.fetch(ground.fleet)
    assert ground.state.tobytes() == state.tobytes() and ground.wheels.tobytes() == wheels.tobytes()


def test_a_thread_without_vehicle_does_nothing(pretended):
    """An empty lane leaves its rows as they were."""
    ground = busy()
    device = cuda.Device(ground.fleet)
    before = {name: np.array(part) for name, part in device.parts.items()}
    device.integrate(ground.k, 0.02)
    empty = device.columns < 0
    assert empty.any()
    for b, lanes in enumerate(empty):
        assert (np.asarray(device.parts["state"])[b][:, lanes] == before["state"][b][:, lanes]).all()
        assert (np.asarray(device.parts["state"])[b][:, ~lanes] != before["state"][b][:, ~lanes]).any()

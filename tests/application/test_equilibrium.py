"""What a platoon comes to at a steady speed: the distance that its law says, on the whole vehicle."""

import pytest

from studio.road.drawn.motorway import motorway
from studio.scenario.setup import complete
from studio.vehicle.state import V_X
from studio.world.build import build
from studio.world.passes.control import APP_ACCELERATION
from studio.world.setting import setting
from studio.world.table.mind import GAP
from studio.world.tick import tick

SPEED = 100 / 3.6
CARS = 4
EXACT = {"kind": "front_radar", "range_noise": 0.0, "rate_noise": 0.0}


def steady(folder, group):
    """Gaps [m], speeds [m/s] and what is asked of followers after 100 s behind a driver who keeps 100 km/h."""
    (folder / "motorway.xodr").write_text(motorway(length=4000.0, lanes=2, radius=20000.0))
    names = [f"car_{i}" for i in range(CARS)]
    vehicles = {
        name: {
            "route": "quicker" if i else "steady", "position": {"road": "motorway", "lane": 0, "offset": 250.0 - 40.0 * i}, "speed": SPEED,
            "sensors": {"front": EXACT}, "bus": {}, "gps": {"drift": 0.0, "noise": 0.0},
        }
        for i, name in enumerate(names)
    }  # fmt: skip
    document = {
        "title": "steady",
        "map": {"file": "motorway.xodr"},
        "routes": {name: {"roads": ["motorway"], "speeds": [{"at": 0, "speed": v}]} for name, v in (("steady", SPEED), ("quicker", 32.0))},
        "vehicles": vehicles,
        "applications": {"platoon": {"units": names[1:], **group}},
        "radio": {"kind": "ad_hoc", "loss": 0.0},
    }
    world = build([setting(complete(document, "steady"), folder, "steady")])
    for _ in range(5000):
        tick(world)
    return world.vehicles.mind[GAP], world.vehicles.state[V_X], world.vehicles.app_command


GROUPS = {
    "cacc": {"listens_to": ["car_0", "car_1", "car_2"], "parameters": {"headway": 0.5, "standstill": 2.0}},
    "cacc_leader": {"listens_to": [["car_0"], ["car_1", "car_0"], ["car_2", "car_0"]], "parameters": {"distance": 5.0}},
    "acc": {"parameters": {"headway": 1.2, "standstill": 2.0}},
}


def needed(name, commands):
    """What the law adds to the gap [m] so that the car is asked for what holds its speed: (u - u_ahead)/k_p, h u/lambda; of the one with
    a leader (a_1 u_ahead - u)/a_5, which tells that it does not accelerate."""
    ahead, u = commands[APP_ACCELERATION, 1:-1], commands[APP_ACCELERATION, 2:]
    return {"cacc": (u - ahead) / 0.2, "acc": u * 1.2 / 0.1, "cacc_leader": (u - 0.5 * ahead) / 0.04}[name]


@pytest.mark.parametrize(("name", "standstill", "headway"), [("cacc", 2.0, 0.5), ("acc", 2.0, 1.2), ("cacc_leader", 5.0, 0.0)])
def test_the_gap_is_that_of_the_law(tmp_path, name, standstill, headway):
    """r + h v: 15.889, 35.333 and 5.000 m at 100 km/h, at the speed that the cars have, for cars that are asked for nothing there."""
    gaps, speeds, commands = steady(tmp_path, {"application": name} | GROUPS[name])
    assert speeds == pytest.approx(SPEED, abs=0.02)
    assert gaps[2:] - needed(name, commands) == pytest.approx(standstill + headway * speeds[2:], abs=0.02)
    assert gaps[2:] == pytest.approx(standstill + headway * SPEED, abs=0.03)

"""Braking one after the other, on whole vehicles: what of a gap is used up, against the closed form (O2 of the checks)."""

import pytest

from docs.figures.convoy import SATELLITES, run

SPEED, GAP = 100.0 / 3.6, 150.0  # [m/s], [m] so far apart that the driver behind does not mind
# deceleration [m/s²] and lateness [s] of the follower, and what of the gap is used up [m]; the leader brakes with 6 m/s² for 1.2 s
CASES = [(6.0, 0.32, 2.304), (4.0, 0.32, 4.464), (6.0, 1.24, 8.928)]


def used_up(b1, lost, b2, late):
    """dv (t + dv/2 (1/b2 - 1/b1)) [m]: both lose dv, the follower t later; its distance when both are equally fast again."""
    return lost * (late + 0.5 * lost * (1.0 / b2 - 1.0 / b1))


def brakes(who, at, b, duration):
    """A car keeps its speed, brakes, and keeps the speed that it comes to."""
    cruise = {"kind": "hold", "vehicle": who, "speed": SPEED, "duration": round(at, 3)}
    brake = {"kind": "brake", "vehicle": who, "deceleration": b, "duration": duration}
    hold = {"kind": "hold", "vehicle": who, "speed": SPEED - b * duration, "duration": 60.0}
    when = [{"kind": "time", "at": round(time, 3)} for time in (at, at + duration)]
    return {"cruises": {"do": cruise}, "brakes": {"when": when[0], "do": brake}, "holds": {"when": when[1], "do": hold}}


def pair(deceleration, late):
    """Two cars: the first brakes at 2 s, the second so much later, until it is as fast."""
    car = {"route": "along", "model": "electric_compact", "speed": SPEED, "gps": SATELLITES}
    braking = [("ahead", 2.0, 6.0, 1.2), ("behind", 2.0 + late, deceleration, 1.2 * 6.0 / deceleration)]
    return {
        "version": 3, "title": "Two", "map": {"file": "motorway.xodr"}, "clock": {"duration": 10.0},
        "routes": {"along": {"roads": ["motorway"], "speeds": [{"at": 0, "speed": SPEED}]}},
        "vehicles": {
            "ahead": car | {"position": {"road": "motorway", "lane": 0, "offset": 300.0}},
            "behind": car | {"position": {"road": "motorway", "lane": 0, "offset": 300.0 - GAP}},
        },
        "script": {f"{who}_{turn}": entry for who, at, b, for_ in braking for turn, entry in brakes(who, at, b, round(for_, 3)).items()},
    }  # fmt: skip


def test_the_closed_form_is_that_of_the_checks():
    """dv 7.2 m/s: 2.304, 4.464, and 9.000 m for a person who is 1.25 s late."""
    for b2, late, known in [*CASES[:2], (6.0, 1.25, 9.0)]:
        assert used_up(6.0, 7.2, b2, late) == pytest.approx(known, abs=5e-4)


def test_whole_cars_use_up_as_much():
    """Both brakes are as slow as each other, so that their build-up cancels: within 4 % and 5 cm, what they really lose."""
    for (_, _, known), record in zip(CASES, run([pair(b2, late) for b2, late, _ in CASES]), strict=True):
        apart = record.trace("ahead.station") - record.trace("behind.station")
        assert apart[record.time >= 2.0][0] - apart[-1] == pytest.approx(known, rel=0.04, abs=0.05)

"""The page of a run in a real browser: whom its measures are about, and why something happened."""

import re
import shutil

import numpy as np
import pytest
import yaml
from playwright.sync_api import expect

from studio.scenario import catalogue
from tests.browser.browser import browser, pixels, watched
from tests.patience import until
from tests.server.server import served

BRAKE = {"script.hard_brake.do.deceleration": 8, "script.hard_brake.when.at": 0.2, "clock.duration": 3}


def test_whom_and_why(tmp_path, sample):
    """A leader that brakes with 8 m/s²: the least gap says behind whom, the hard brake opens and tells what was known."""
    with browser() as opened, served(tmp_path, "--scenarios", sample.parent) as (client, _, _):
        run = client.post("/api/runs", json={"scenario": sample.stem, "set": BRAKE}).json()["run"]
        until(lambda: client.get(f"/api/runs/{run}").json()["status"] == "done", "the end of the run")
        page, complaints = watched(opened, viewport={"width": 1100, "height": 900})
        page.goto(f"{client.base_url}/runs/{run}")
        expect(page.get_by_test_id("metrics")).to_contain_text("follower_1 behind leader at")
        listed = page.get_by_test_id("explanations")
        expect(listed).to_contain_text("brakes hard, with up to")
        lines = listed.get_by_text("follower 1 knew leader by front")
        expect(lines.first).to_be_hidden()
        listed.locator("summary", has_text="Follower 1").first.click()
        expect(lines.first).to_be_visible()
        in_numbers(page, client, run)
        assert complaints == []
        opened.close()


def in_numbers(page, client, run):
    """The numbers of a channel are those that REST tells, also between two times; what is no time is refused in its field."""
    page.get_by_role("combobox", name="Channel").fill("leader.speed")
    page.get_by_role("option", name="leader.speed [m/s]").click()
    page.get_by_label("From [s]").fill("1,5")
    asked = {"runs": run, "channel": "leader.speed", "begin": 1.5}
    (told,) = client.get("/api/aggregates", params=asked).raise_for_status().json()
    most = next(each["value"] for each in told["aggregates"] if each["kind"] == "max")
    row = page.get_by_role("table", name="Numbers of leader.speed").get_by_role("row", name="Maximum")
    expect(row.get_by_role("cell").first).to_have_text(f"{float(f'{most:.4g}'):g}")  # four digits, as the page writes numbers
    page.get_by_label("From [s]").fill("soon")
    expect(page.get_by_text("a number of seconds, such as 12.5")).to_be_visible()


SPAN = {"speed": [0.0, 29.5], "acceleration": [-8.0, 4.0], "lateral_acceleration": [-3.0, 3.0], "yaw_rate": [-0.5, 0.5]}
TELLS = re.compile(r"outside its validated span: Leader, speed .* m/s, validated from 0 to 29\.5 m/s", re.IGNORECASE)


@pytest.fixture
def beyond(tmp_path, sample):
    """A scenario whose leader was validated for less than it drives, and goes faster after 1 s."""
    folder = tmp_path / "scenarios"
    (folder / "maps").mkdir(parents=True)
    shutil.copy(sample.parent / "maps" / "motorway.xodr", folder / "maps")
    car = yaml.safe_load((catalogue.VEHICLES / "electric_compact.yaml").read_text(encoding="utf-8"))
    (folder / "car.yaml").write_text(yaml.safe_dump(car | {"validated": SPAN}), encoding="utf-8")
    document = yaml.safe_load((sample.parent / "cacc_step.yaml").read_text(encoding="utf-8"))
    document["vehicles"]["leader"]["model"] = "./car.yaml"
    document["script"] = {"faster": {"when": {"kind": "time", "at": 1}, "do": {"kind": "set_speed", "vehicle": "leader", "speed": 32}}}
    document["clock"] = {"duration": 4}
    (folder / "beyond.yaml").write_text(yaml.safe_dump(document), encoding="utf-8")
    return folder


def test_where_a_vehicle_was_outside_its_validated_span(tmp_path, beyond):
    """Charts of the run and of its playback show a band in the colour of their legend, which tells what led there; so does the timeline."""
    with browser() as opened, served(tmp_path, "--scenarios", beyond) as (client, _, _):
        run = client.post("/api/runs", json={"scenario": "beyond"}).json()["run"]
        until(lambda: client.get(f"/api/runs/{run}").json()["status"] == "done", "the end of the run")
        (spanned,) = client.get(f"/api/runs/{run}/beyond").json()
        assert spanned["vehicle"] == "leader" and 1.0 < spanned["stretches"][0]["begin"] < 3.0
        page, complaints = watched(opened, viewport={"width": 1280, "height": 900})
        page.goto(f"{client.base_url}/runs/{run}")
        chart = page.get_by_role("figure", name="Speed [m/s] over time")
        expect(chart).to_contain_text(TELLS)
        until(lambda: shares(chart)[1] > 0.004, "the band")
        assert shares(chart)[0] == 0.0
        page.goto(f"{client.base_url}/studio/beyond?run={run}")
        expect(page.get_by_role("region", name="Charts")).to_contain_text(TELLS)
        expect(page.get_by_role("img", name="Outside its validated span: Leader, speed")).to_be_visible()
        slow = {"scenario": "beyond", "parent": run, "set": {"script.faster.do.speed": 28.0}}
        other = client.post("/api/runs", json=slow).json()["run"]
        until(lambda: client.get(f"/api/runs/{other}").json()["status"] == "done", "the end of the slow run")
        assert not any(each["stretches"] for each in client.get(f"/api/runs/{other}/beyond").json())
        page.goto(f"{client.base_url}/compare?runs={other},{run}")
        page.get_by_role("checkbox", name="Leader").check()
        chart = page.get_by_role("figure", name="Speed [m/s] over time")
        expect(chart).to_contain_text(re.compile(rf"outside its validated span: .*#{run}.*: Leader, speed", re.IGNORECASE))
        until(lambda: shares(chart)[1] > 0.004, "the band of the faster run")
        assert shares(chart)[0] == 0.0
        assert complaints == []
        opened.close()


def shares(chart) -> tuple[float, float]:
    """Which shares of the left and the right third of a chart's plot have the colour of the band's bar."""
    seen = pixels(chart.locator("canvas").screenshot()).astype(int)[..., :3]
    is_bar = np.abs(seen - np.array([174, 62, 201])).sum(axis=-1) < 30
    third = is_bar.shape[1] // 3
    return float(is_bar[:, :third].mean()), float(is_bar[:, -third:].mean())

"""Route files of SUMO: what is in them comes onto the map, what is not used is told, what is hostile or wrong is refused."""

import gzip
import os
import subprocess
from dataclasses import replace

import numpy as np
import pytest

from studio import job
from studio.errors import StudioError
from studio.execution.event import foreseen
from studio.execution.simulation import simulation
from studio.road.formats.netconvert import NETCONVERT
from studio.world.demand.routes_file import read
from tests.conftest import ROOT

GRID = ROOT / "scenarios" / "urban_grid.yaml"
ENTRY, EXIT = "-92", "41"


@pytest.fixture
def prepared(tmp_path):
    """Makes the town with a route file beside its scenario."""
    (tmp_path / "maps").symlink_to(ROOT / "scenarios" / "maps")

    def made(text, name="town.rou.xml", seconds=300.0, **traffic):
        data = f"<routes>{text}</routes>" if isinstance(text, str) and not text.startswith("<?") else text
        (tmp_path / name).write_bytes(data if isinstance(data, bytes) else data.encode())
        (tmp_path / "town.yaml").write_bytes(GRID.read_bytes())
        loaded = job.load(tmp_path / "town.yaml", {"clock.duration": seconds})
        document = loaded.scenario.model_dump(mode="json", exclude_unset=True)
        document |= {"traffic": {"routes": name, **traffic}, "script": {}, "goals": {}, "measures": {}}
        return job.prepare(replace(loaded, scenario=type(loaded.scenario).model_validate(document)))

    return made


def told(setting):
    """What is told of the file."""
    return [each.words["what"] for each in foreseen(setting) if each.kind == "route_file"]


def due(setting):
    """All times at which somebody is due."""
    return sorted(np.concatenate([each.due for each in setting.sources]).tolist())


def ends(setting):
    """The first and the last road of every source."""
    return {(each.path.stations[0].road, each.path.stations[-1].road) for each in setting.sources}


TRIP = f'from="{ENTRY}" to="{EXIT}"'


def test_vehicles_trips_and_flows_depart_when_they_say(prepared):
    """A route with a name, one within, a trip by the router, a flow by number, by rate and by period; times also as h:m:s."""
    middle = [each.road for each in prepared(f'<trip id="t" depart="0" {TRIP}/>').sources[0].path.stations]
    route = " ".join(dict.fromkeys(middle))
    setting = prepared(f"""
        <route id="r" edges="{route}"/>
        <vehicle id="a" depart="10" route="r"/>
        <vehicle id="b" depart="0:00:20"><route edges="{route}"/></vehicle>
        <trip id="c" depart="30.5" {TRIP}/>
        <flow id="d" begin="40" end="80" number="4" {TRIP}/>
        <flow id="e" begin="100" end="160" vehsPerHour="180" route="r"/>
        <flow id="f" begin="200" end="300" period="50" route="r"/>""")
    assert due(setting) == [10, 20, 30.5, 40, 50, 60, 70, 100, 120, 140, 200, 250]
    assert ends(setting) == {(ENTRY, EXIT)}
    assert told(setting)[0].startswith("brings 12 cars on ")


def test_random_flows_are_poisson_and_hang_on_the_seed(prepared):
    """0.5 a second for 300 s: 150 within three standard deviations; the same again."""
    text = f'<flow id="p" begin="0" end="300" period="exp(0.5)" {TRIP}/>'
    one, two = prepared(text), prepared(text)
    assert len(due(one)) == pytest.approx(150, abs=37)
    assert due(one) == due(two)
    assert len(due(prepared(text.replace('period="exp(0.5)"', 'probability="0.5"')))) == len(due(one))


def test_they_come_in_and_nobody_hits_anybody(prepared):
    running = simulation(prepared(f'<flow id="f" begin="0" end="40" number="8" {TRIP}/>', seconds=60.0))
    while not running.is_over:
        running.advance(500)
    assert running.world.demand.gone.sum() == 8 and running.world.events.hits_found == 0


def test_a_type_is_what_its_drivers_are_like(prepared):
    """Acceleration, deceleration, headway, gap and the spread of speeds; the class and the length choose the model."""
    setting = prepared(f"""
        <vType id="calm" accel="1.1" decel="1.7" tau="1.6" minGap="2.6" speedFactor="normc(0.9,0.05,0.2,2)" length="2.6"/>
        <vType id="heavy" vClass="truck"/>
        <flow id="a" type="calm" begin="0" end="300" number="60" {TRIP}/>
        <flow id="b" type="heavy" begin="0" end="300" number="3" {TRIP}/>""")
    calm = [car for car in setting.cars if car.source is not None and car.model.name == "smart_fortwo"]
    assert calm and {
        (car.driver.acceleration, car.driver.deceleration, car.driver.time_headway, car.driver.standstill_gap) for car in calm
    } == {(1.1, 1.7, 1.6, 2.6)}
    factors = [car.driver.speed_factor for car in calm]
    assert np.mean(factors) == pytest.approx(0.9, abs=0.05) and 0.0 < np.std(factors) < 0.1
    assert {car.model.name for car in setting.cars if car.source is not None} == {"smart_fortwo", "truck"}


def test_a_distribution_gives_each_his_type_by_chance(prepared):
    setting = prepared(f"""
        <vTypeDistribution id="mix"><vType id="car" probability="3"/><vType id="lorry" vClass="truck" probability="1"/></vTypeDistribution>
        <flow id="f" type="mix" begin="0" end="300" number="200" {TRIP}/>""")
    by_type = {}
    for each in setting.sources:
        by_type[each.model] = by_type.get(each.model, 0) + each.due.size
    assert by_type["car"] == pytest.approx(150, abs=19) and by_type["car"] + by_type["lorry"] == 200


def test_a_type_of_the_scenario_goes_before_that_of_the_file(prepared):
    text = f'<vType id="car" accel="99"/><trip id="t" type="car" depart="0" {TRIP}/>'
    setting = prepared(text, types={"car": {"model": "suv"}})
    assert {car.model.name for car in setting.cars if car.source is not None} == {"suv"}


def test_everything_that_is_not_used_is_told(prepared):
    setting = prepared(f"""
        <vType id="car" sigma="0.5" color="1,0,0" carFollowModel="Krauss"/>
        <person id="p" depart="0"/>
        <trip id="a" type="car" depart="0" departSpeed="max" departPos="base" {TRIP}><param key="k" value="v"/></trip>
        <trip id="b" type="car" depart="triggered" {TRIP}/>
        <trip id="c" type="car" depart="400" {TRIP}/>
        <trip id="d" depart="1" from="{ENTRY}" to="nowhere" />
        <trip id="e" depart="2" type="ghost" {TRIP}/>
        <vehicle id="f" depart="3" route="lacking"/>""")
    text = "\n".join(told(setting))
    for part in ("vType.sigma: 1", "vType.color: 1", "vType.carFollowModel: 1", "<person>: 1", "trip.departSpeed: 1", "trip.departPos: 1",
                 "<param> in trip: 1", "depart='triggered': 1", "after the end of the run: 1", "edges of routes that are not on this map",
                 "type 'ghost' is not in the file", "<vehicle> without a route"):  # fmt: skip
        assert part in text, part


def test_edges_of_other_pieces_of_the_same_way_are_found(prepared):
    """A street that another program has cut more finely; what is not on the map at all is left out between."""
    setting = prepared(f'<vehicle id="a" depart="0"><route edges="{ENTRY}#3 999999 {EXIT}#1"/></vehicle>')
    assert ends(setting) == {(ENTRY, EXIT)}
    assert any("not on this map, joined by the router: 1" in each for each in told(setting))


def test_the_order_of_the_file_changes_nothing(prepared):
    parts = [f'<trip id="{name}" depart="{10 + i}" {TRIP}/>' for i, name in enumerate("abc")]
    one, two = prepared("".join(parts)), prepared("".join(parts[::-1]))
    assert [(each.stream, each.due.tolist()) for each in one.sources] == [(each.stream, each.due.tolist()) for each in two.sources]


def test_a_packed_file_is_the_same(prepared):
    text = f'<routes><trip id="t" depart="5" {TRIP}/></routes>'
    assert due(prepared(gzip.compress(text.encode()), name="town.rou.xml.gz")) == [5]


def test_another_file_is_another_scenario(prepared, tmp_path):
    """The digest of what is run covers the file's content."""
    one = prepared(f'<trip id="t" depart="5" {TRIP}/>')
    two = prepared(f'<trip id="t" depart="6" {TRIP}/>')
    assert one.routes_digest != two.routes_digest
    loaded = job.load(tmp_path / "town.yaml")
    assert job.scenario_hash(loaded, one) != job.scenario_hash(loaded, two)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (b"", "is empty"),
        (b"hello", "line 1: this is not XML"),
        (b"<routes><trip", "cut off"),
        (b"<net/>", "no route file: its root element is <net>"),
        (b'<!DOCTYPE r [<!ENTITY a "b">]><routes/>', "document type or entities is refused"),
        ('<?xml version="1.0" encoding="UTF-16"?><!DOCTYPE r [<!ENTITY a "b">]><routes/>'.encode("utf-16"), "document type"),
        ('<vType id="t" accel="fast"/>', "<vType id='t'>: accel='fast' is no number"),
        ('<vType accel="1"/>', "a <vType> has no id"),
        ('<vType id="t" accel="99"/>' + f'<trip id="a" type="t" depart="0" {TRIP}/>', "vType 't': accel is beyond.*99.*0.1 to 5"),
        ('<vType id="t" speedFactor="normc(1,0.1,2,1)"/>', "no room between its bounds"),
        (f'<flow id="f" begin="0" end="10" {TRIP}/>', "does not say how many"),
        (f'<flow id="f" begin="0" end="10" vehsPerHour="-3" {TRIP}/>', "must be above 0"),
        ('<vTypeDistribution id="d"/>', "nothing to choose from"),
        ('<trip id="t" depart="0" from="x" to="y"/>', "brings no car onto this map.*does not lead over this map: 1"),
        ('<trip id="t" depart="900" from="x" to="y"/>', "brings no car onto this map.*after the end of the run: 1"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_refused(prepared, text, said):
    with pytest.raises(StudioError, match=rf"(?s)traffic\.routes.*{said}"):
        prepared(text)


def test_a_file_that_is_not_there_is_refused(prepared, tmp_path):
    with pytest.raises(StudioError, match=r"traffic\.routes: cannot be read: No such file"):
        prepared("", name="town.rou.xml", routes="other.rou.xml")
    with pytest.raises(StudioError, match=r"traffic\.routes: not a route file"):
        prepared("", routes="town.yaml")
    os.mkfifo(tmp_path / "pipe.rou.xml")
    with pytest.raises(StudioError, match=r"traffic\.routes: is no file"):
        prepared("", routes="pipe.rou.xml")


def test_what_sumo_writes_itself_is_read(tmp_path):
    """od2trips, which comes with netconvert, writes trips of a matrix; all of them are found, with lanes left to the router."""
    (tmp_path / "taz.xml").write_text(
        f'<additional><taz id="1" edges="{ENTRY}"><tazSource id="{ENTRY}" weight="1"/></taz>'
        f'<taz id="2" edges="{EXIT}"><tazSink id="{EXIT}" weight="1"/></taz></additional>'
    )
    (tmp_path / "od.txt").write_text("$OR;D2\n0.00 0.05\n1.00\n1 2 20\n")
    od2trips = NETCONVERT.with_name("od2trips")
    out = tmp_path / "trips.rou.xml"
    subprocess.run(
        [od2trips, "-n", "taz.xml", "-d", "od.txt", "-o", out, "--xml-validation", "never"], cwd=tmp_path, check=True, capture_output=True
    )
    plan = read(out, 1, 300.0, "x")
    assert len(plan.departures) == 20 and {each.edges for each in plan.departures} == {(ENTRY, EXIT)}

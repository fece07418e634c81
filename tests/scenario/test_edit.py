"""Changes by path."""

import pytest

from studio import job
from studio.errors import ScenarioError
from studio.scenario import edit


def test_a_change_changes_that_and_nothing_else(sample):
    base, changed = job.load(sample), job.load(sample, {"applications.platoon.parameters.headway": 0.9})
    left, right = edit.flatten(base.document), edit.flatten(changed.document)
    assert {path for path in left if left[path] != right[path]} == {"applications.platoon.parameters.headway"}


def test_a_default_can_be_changed(sample):
    """The sample's file does not mention the radio."""
    assert job.load(sample, {"radio.loss": 0.3}).scenario.radio.loss == 0.3


def test_items_of_lists(sample):
    changed = job.load(sample, {"applications.platoon.units.3": "follower_3", "applications.platoon.units.2": "follower_4"})
    assert changed.scenario.applications["platoon"].units[2:] == ["follower_4", "follower_3"]


@pytest.mark.parametrize(
    ("path", "remedy"),
    [
        ("applications.platoon.parameters.hedway", "applications.platoon.parameters.headway"),
        ("application.platoon.parameters.headway", "applications"),
        ("clock.duration.seconds", ""),
        ("script.hard_brake.do.decelaration", "script.hard_brake.do.deceleration"),
        ("applications.platoon.units.9", ""),
    ],
)
def test_a_wrong_path_names_the_nearest(sample, path, remedy):
    with pytest.raises(ScenarioError) as caught:
        job.load(sample, {path: 1})
    assert path in str(caught.value) and remedy in str(caught.value)


def test_an_exchange_keeps_what_both_have(sample):
    acc = job.load(sample, {"applications.platoon.application": "acc", "applications.platoon.parameters.gap_gain": 0.2})
    parameters = acc.scenario.applications["platoon"].parameters
    assert parameters["headway"] == 0.6 and parameters["gap_gain"] == 0.2
    assert parameters["standstill"] == 2.0 and "k_p" not in parameters


CALM = '''
"""Drives as slowly as it is told to."""
from studio.compiled import compiled
from studio.kind.driver import Driver, Wish
from studio.kind.settings import number

KIND = "driver"
TITLE = "Calm driver"

class Settings(Driver):
    """How calm."""
    patience: float = number(5.0, unit="s", title="Patience", ge=0)
    time_headway: float = number(3.0, unit="s", title="Wanted headway", ge=0.3, le=5)

@compiled
def decide(settings, sees):
    return Wish(0.0, 0.0)
'''


@pytest.fixture
def calm(tmp_path, own_kinds):
    """A driver of one's own, called calm."""
    (tmp_path / "calm.py").write_text(CALM)
    own_kinds(tmp_path)


def test_a_driver_is_exchanged(calm, sample):
    """What the file gives and both have is kept; the rest is the new one's own, or what is set with it."""
    plain = job.load(sample, {"vehicles.follower_1.driver.kind": "calm"}).scenario.vehicles["follower_1"].driver
    assert (plain.kind, plain.speed_factor, plain.time_headway, plain.patience) == ("calm", 1.1, 3.0, 5.0)
    assert not hasattr(plain, "steering_gain")
    changes = {"vehicles.follower_1.driver.patience": 9, "vehicles.follower_1.driver.kind": "calm"}
    assert job.load(sample, changes).scenario.vehicles["follower_1"].driver.patience == 9
    # The file says nothing about the leader's driver, nor about the traffic's.
    for path in ("vehicles.leader.driver", "traffic.driver"):
        assert edit.get(job.load(sample, {f"{path}.kind": "calm"}).document, path)["kind"] == "calm"


def test_an_exchange_needs_what_has_to_be_given(sample):
    """An entry of the script is about something else then: what it needs is given with it, or asked for."""
    path = "script.hard_brake.when"
    passed = {f"{path}.kind": "passed", f"{path}.vehicle": "leader", f"{path}.along": 400}
    when = job.load(sample, passed).scenario.script["hard_brake"].when
    assert (when.kind, when.vehicle, when.along) == ("passed", "leader", 400)
    with pytest.raises(ScenarioError, match=r"script.hard_brake.when.along: is missing"):
        job.load(sample, {f"{path}.kind": "passed", f"{path}.vehicle": "leader"})


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"vehicles.leader.driver.kind": "atentive"}, "did you mean 'attentive'?"),
        ({"vehicles.leader.sensors.front.kind": 3}, "vehicles.leader.sensors.front"),
        ({"vehicles.leader.sensors.rear.kind": "front_radar"}, "vehicles.leader.sensors.rear"),
        ({"radio.kind": "ad_hoc", "radio.los": 0.1}, "did you mean 'radio.loss'?"),
    ],
)
def test_an_exchange_that_cannot_be(sample, changes, told):
    with pytest.raises(ScenarioError) as caught:
        job.load(sample, changes)
    assert told in str(caught.value)


@pytest.mark.parametrize(
    ("text", "path", "value"),
    [("a.b=1.5", "a.b", 1.5), ("a=true", "a", True), ("a=[x, y]", "a", ["x", "y"]), ("a=", "a", None), ("a=b=c", "a", "b=c")],
)
def test_assignments(text, path, value):
    assert edit.parse_assignment(text) == (path, value)


@pytest.mark.parametrize("text", ["headway", "=3", "a={"])
def test_what_is_no_assignment(text):
    with pytest.raises(ScenarioError, match="--set"):
        edit.parse_assignment(text)


def test_fields_that_depend_on_each_other_change_together(sample):
    assert (
        job.load(
            sample, {"clock.step": 0.003, "clock.tick": 0.03, "recording.period": 0.03, "messages.awareness.period": 0.09}
        ).scenario.clock.tick
        == 0.03
    )
    changed = job.load(sample, {"vehicles.leader.position.along": None, "vehicles.leader.position.road": "340498991"})
    assert changed.scenario.vehicles["leader"].position.road == "340498991"
    fewer = job.load(sample, {"applications.platoon.units": ["follower_1"], "applications.platoon.listens_to": ["leader"]})
    assert fewer.scenario.applications["platoon"].units == ["follower_1"]


@pytest.mark.parametrize("value", ["2020-13-45", "!!int abc", "!!bool x", "!!timestamp foo", "[" * 5000])
def test_values_that_yaml_chokes_on(value):
    with pytest.raises(ScenarioError, match="--set title"):
        edit.parse_assignment(f"title={value}")


def test_leaves_are_found_whatever_their_names_are():
    """A name may hold dots, or be none at all."""
    odd = {"a.b": {"": 1, "c": []}, "d": [{"e": 2}], "f": {}}
    assert edit.flatten(odd) == {"a.b.": 1, "a.b.c": [], "d.0.e": 2, "f": {}}


@pytest.mark.parametrize("whole", ["x", [], 5, [{}]])
@pytest.mark.parametrize("path", ["vehicles.leader.driver", "applications.platoon", "radio"])
def test_a_kind_in_what_is_none(sample, path, whole):
    """What is set as a whole before may be anything: that is refused, whatever is set in it afterwards."""
    last = "application" if path.startswith("applications") else "kind"
    with pytest.raises(ScenarioError):
        job.load(sample, {path: whole, f"{path}.{last}": "cacc"})


@pytest.mark.parametrize("changes", [{"title": "\udcff"}, {"\ud800": 1}, {"vehicles": {"a": ["\udfff"]}}, {"seed": 10**5000}])
def test_what_no_file_can_hold(sample, changes):
    """A command line hands over bytes that are no text as half characters."""
    with pytest.raises(ScenarioError, match="cannot be changed so"):
        job.load(sample, changes)


def test_a_preset_of_what_the_file_leaves_out(sample):
    """Sensors that no file names have the preset's values, not their defaults; what is set beside it counts, in whatever order."""
    front, preset = "vehicles.leader.sensors.front", {"vehicles.leader.sensors.front.preset": "short_range_radar"}
    noise = {f"{front}.rate_noise": 0.22}
    for changes in (preset | noise, noise | preset):
        sensor = job.load(sample, changes).document["vehicles"]["leader"]["sensors"]["front"]
        assert (sensor["preset"], sensor["range"], sensor["rate_noise"]) == ("short_range_radar", 80.0, 0.22)
    alone = job.load(sample, preset).document["vehicles"]["leader"]["sensors"]
    before = job.load(sample).document["vehicles"]["leader"]["sensors"]
    assert alone["front"]["rate_noise"] == 0.1 and alone.keys() == before.keys()
    radio = job.load(sample, {"radio.loss": 0.3, "radio.preset": "LTE"}).document["radio"]
    assert (radio["loss"], radio["delay"], radio["range"]) == (0.3, 0.04, 5000.0)
    whole = {"radio": {"kind": "ad_hoc", "loss": 0.2}, "radio.preset": "LTE"}
    assert job.load(sample, whole).document["radio"]["preset"] == "LTE"

"""Formats of logs: what is written by others is read with its names, units and times; what is broken is named."""

import gzip

import numpy as np
import pytest

from studio.errors import ScenarioError
from studio.log import reading

TIME = np.arange(0.0, 2.0, 0.01)
YAW = 20.0 * np.sin(TIME)


def refused(path, dbc=None):
    with pytest.raises(ScenarioError) as caught:
        reading.read(path, dbc)
    return caught.value


def rows(mark=",", decimal="."):
    return "\n".join(f"{t:.3f}{mark}{y:.6f}".replace(".", decimal) for t, y in zip(TIME, YAW, strict=True))


@pytest.mark.parametrize(
    ("head", "mark", "decimal"),
    [
        ("Time [s],Yaw rate [deg/s]\n", ",", "."),
        ("Time (s);Yaw rate (deg/s)\n", ";", ","),
        ("t\tYaw rate\ns\tdeg/s\n", "\t", ","),
        ('# "Time","Yaw rate"\n# "C1","C1"\n# "s","deg/s"\n', ",", "."),
    ],
)
def test_a_table_as_others_write_it(tmp_path, head, mark, decimal):
    path = tmp_path / "drive.csv"
    path.write_text(head + rows(mark, decimal))
    (found,) = reading.read(path).signals.values()
    assert (found.name, found.unit) == ("Yaw rate", "deg/s")
    assert np.allclose(found.time, TIME) and np.allclose(found.values, YAW, atol=1e-6)


def test_time_of_day_over_midnight_and_cells_that_are_empty(tmp_path):
    path = tmp_path / "obd.csv"
    path.write_text("Time,Speed [km/h],Engine RPM [RPM]\n23:59:59.900,10,\n00:00:00.000,11,800\n00:00:00.100,,810\n")
    log = reading.read(path)
    assert np.allclose(np.diff(log["Speed"].time), 0.1)
    assert log["Engine RPM"].values.tolist() == [800.0, 810.0]


def test_units_at_the_end_of_names_as_the_rig_writes_them(tmp_path):
    path = tmp_path / "drive.csv.gz"
    with gzip.open(path, "wt") as file:
        file.write("time_s,vx_mps,yaw_rate_radps,gear\n0,1,2,3\n0.1,1,2,3\n")
    assert {name: each.unit for name, each in reading.read(path).signals.items()} == {
        "vx_mps": "m/s",
        "yaw_rate_radps": "rad/s",
        "gear": "",
    }


def test_a_row_that_is_cut_off_is_named(tmp_path):
    path = tmp_path / "drive.csv"
    path.write_text("t,a,b\n0,1,2\n1,1,2\n2,1\n")
    assert "line 4 has 2 cells, the head 3" in str(refused(path))


@pytest.mark.parametrize("head", ["yaw_rate_radps,vx_mps", "vx [m/s],yaw"])
def test_a_table_without_times_is_not_taken_for_one_with(tmp_path, head):
    """Neither what has another unit nor what does not rise is a clock; without a name or a unit what rises is one."""
    lines = "\n".join(f"{0.1 * (i % 7)},{20.0 + i}" for i in range(100))
    (tmp_path / "a.csv").write_text(f"{head}\n{lines}")
    with pytest.raises(ScenarioError, match="has no column of time"):
        reading.read(tmp_path / "a.csv")
    (tmp_path / "b.csv").write_text("stamp,yaw\n" + "\n".join(f"{0.01 * i:.2f},{i % 7}" for i in range(100)))
    assert reading.read(tmp_path / "b.csv")["yaw"].time[-1] == pytest.approx(0.99)


@pytest.mark.parametrize(
    ("text", "at"),
    [
        ('"t","v"\n"0,00","1.234,5"\n"0,01","1.234,5"\n', (0.0, 0.01)),
        ("t;v\n0,00;1.234,5\n0,01;1.234,5\n", (0.0, 0.01)),
        ('t;v\n0.00;"1,234.5"\n0.01;"1,234.5"\n', (0.0, 0.01)),
        ("t,v\n1970-01-02T00:00:00.5Z,1234.5\n1970-01-02T01:00:01+01:00,1234.5\n", (86400.5, 86401.0)),
    ],
    ids=["quoted decimal commas", "points between thousands", "commas between thousands", "dates"],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_numbers_as_spreadsheets_write_them(tmp_path, text, at, encoding):
    (tmp_path / "a.csv").write_text(text, encoding=encoding)
    found = reading.read(tmp_path / "a.csv")["v"]
    assert found.time == pytest.approx(at) and found.values == pytest.approx([1234.5, 1234.5])


@pytest.mark.parametrize(
    ("name", "content", "what"),
    [
        ("a.csv", b"", "is empty"),
        ("a.csv", b"time,speed\n", "no row of numbers"),
        ("a.csv", b"t,a,a\n0,1,2\n1,1,2\n", "twice: a"),
        ("a.csv.gz", gzip.compress(b"t,a\n0,1\n1,2\n" * 200)[:-20], "is damaged"),
        ("a.npz", b"no archive", "is no archive"),
        ("a.mf4", b"no measurement", "is no whole MDF"),
        ("a.xyz", b"", "unknown ending"),
    ],
)
def test_files_that_are_none(tmp_path, name, content, what):
    path = tmp_path / name
    path.write_bytes(content)
    assert what in str(refused(path))
    assert "does not exist" in str(refused(tmp_path / "nowhere.csv"))


def test_arrays_with_one_clock_and_with_their_own(tmp_path):
    np.savez(tmp_path / "one.npz", time=TIME, yaw_rate=YAW, position=np.stack([TIME, YAW], axis=1), name=np.array(["x"]))
    assert list(reading.read(tmp_path / "one.npz").signals) == ["yaw_rate", "position[0]", "position[1]"]
    folder = tmp_path / "own"
    folder.mkdir()
    for name, values in {"a__t": TIME, "a__value": YAW, "pose_times": TIME[::5], "pose_speed": YAW[::5]}.items():
        np.save(folder / f"{name}.npy", values)
    log = reading.read(folder)
    assert {name: each.time.size for name, each in log.signals.items()} == {"a": 200, "pose_speed": 40}


def test_a_folder_of_columns(tmp_path):
    for name, values in {"t": TIME, "yawRate": YAW}.items():
        np.savetxt(tmp_path / f"{name}.txt", values)
    (found,) = reading.read(tmp_path).signals.values()
    assert found.name == "yawRate" and np.allclose(found.values, YAW)


def test_arrays_that_do_not_fit_their_clock(tmp_path):
    np.savez(tmp_path / "bad.npz", time=TIME, yaw_rate=YAW[:-1])
    assert "199 values, its clock time 200" in str(refused(tmp_path / "bad.npz"))


# -- formats of the trade, written by the packages of others ---------------------------------------------


@pytest.fixture
def measurement(tmp_path):
    from asammdf import MDF
    from asammdf import Signal as Channel

    path = tmp_path / "drive.mf4"
    with MDF(version="4.10") as file:
        file.append([Channel(YAW, TIME, name="YawRate", unit="deg/s")])
        file.append([Channel(np.full(20, 72.0), TIME[::10], name="Speed", unit="km/h")])
        file.save(path, overwrite=True)
    return path


def test_a_measurement(measurement):
    log = reading.read(measurement)
    assert {name: (each.unit, each.time.size) for name, each in log.signals.items()} == {"YawRate": ("deg/s", 200), "Speed": ("km/h", 20)}
    assert np.allclose(log["YawRate"].values, YAW) and np.allclose(log["Speed"].time, TIME[::10])


@pytest.mark.parametrize("share", [0.2, 0.5, 0.9])
def test_a_measurement_that_is_cut_off(measurement, share):
    whole = measurement.read_bytes()
    measurement.write_bytes(whole[: int(share * len(whole))])
    assert "cannot be read as MDF" in str(refused(measurement))


DBC = """VERSION ""
NS_ :
BS_:
BU_: CAR
BO_ 257 Motion: 8 CAR
 SG_ YawRate : 0|16@1- (0.01,0) [-327|327] "deg/s" CAR
 SG_ Speed : 16|16@1+ (0.01,0) [0|655] "km/h" CAR
"""


@pytest.fixture
def bus(tmp_path):
    (tmp_path / "car.dbc").write_text(DBC)
    return tmp_path / "car.dbc"


@pytest.mark.parametrize("ending", ["blf", "asc"])
def test_a_trace_of_the_bus(tmp_path, bus, ending):
    import can
    import cantools

    frame = cantools.database.load_file(bus).get_message_by_name("Motion")
    path = tmp_path / f"drive.{ending}"
    with can.Logger(path) as log:
        for t, y in zip(TIME, YAW, strict=True):
            data = frame.encode({"YawRate": float(y), "Speed": 72.0})
            log(can.Message(timestamp=1000.0 + t, arbitration_id=257, data=data, is_extended_id=False))
            log(can.Message(timestamp=1000.0 + t, arbitration_id=700, data=b"\1\2", is_extended_id=False))
    log = reading.read(path, bus)
    yaw = log["Motion.YawRate"]
    assert yaw.unit == "deg/s" and np.allclose(yaw.values, YAW, atol=0.0051)
    assert np.allclose(yaw.time - yaw.time[0], TIME, atol=1e-4)
    assert "name its DBC" in str(refused(path))
    other = tmp_path / "other.dbc"
    other.write_text(DBC.replace("257", "258"))
    assert "knows none of its frames (0x101, 0x2bc)" in str(refused(path, other))
    other.write_text("this is no database")
    assert "is no DBC" in str(refused(path, other)) and "no database" not in str(refused(path, other))

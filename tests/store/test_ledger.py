"""The table of runs, and what a run recorded, as files: read back by others, they say what the database says."""

import csv
import io
import json

import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner

from studio import job
from studio.cli import app
from studio.errors import UnknownError
from studio.store import trace
from studio.store.ledger import ledger
from studio.store.runs import open_runs
from studio.store.verdict import judge, remark

HEADWAY = "applications.platoon.parameters.headway"


@pytest.fixture(scope="module")
def kept(sample, tmp_path_factory):
    """A database with two runs, one of them named and judged."""
    path = tmp_path_factory.mktemp("ledger") / "runs.db"
    runs = open_runs(path)
    job.run(job.load(sample, {"clock.duration": 0.4}), runs=runs)
    job.run(job.load(sample, {"clock.duration": 0.4, HEADWAY: 0.9}), runs=runs)
    remark(runs, 2, name="=1+1", tags=["a", "b"], note="")
    judge(runs, 2, "candidate", "stays near, and brakes in time", "")
    return path, runs


def test_csv_has_a_column_for_everything_with_its_unit(kept):
    _, runs = kept
    later, first = csv.DictReader(io.StringIO(ledger(runs, "csv").decode()))
    metrics = runs.find(2).metrics
    assert [later["run"], first["run"]] == ["2", "1"] and float(later[f"parameter.{HEADWAY}"]) == 0.9
    assert float(first[f"parameter.{HEADWAY}"]) == runs.document(runs.find(1))["applications"]["platoon"]["parameters"]["headway"]
    assert float(later["metric.mean_speed [m/s]"]) == metrics["mean_speed"].value
    assert later["verdict"] == "candidate" and json.loads(later["tags"]) == ["a", "b"]
    assert later["name"] == "'=1+1"


def test_parquet_and_json_have_the_same_numbers(kept):
    _, runs = kept
    table = pq.read_table(io.BytesIO(ledger(runs, "parquet")))
    rows = json.loads(ledger(runs, "json"))
    assert table.to_pylist() == rows and table.schema.field("metric.mean_speed").metadata[b"unit"] == b"m/s"
    assert rows[0]["name"] == "=1+1"  # no spreadsheet reads these
    assert [row["run"] for row in json.loads(ledger(runs, "json", where="run = ?", values=[1]))] == [1]


def test_an_empty_table_has_its_head(tmp_path):
    runs = open_runs(tmp_path / "runs.db")
    assert ledger(runs, "csv").decode().startswith("run,scenario,") and json.loads(ledger(runs, "json")) == []
    assert pq.read_table(io.BytesIO(ledger(runs, "parquet"))).num_rows == 0


def test_channels_as_lines_keep_all_bits(kept):
    _, runs = kept
    parquet = runs.parquet(1)
    rows = list(csv.reader(io.StringIO("".join(trace.lines(parquet)))))
    names = [each["name"] for each in trace.channels(parquet)]
    assert [each.partition(" [")[0] for each in rows[0]] == ["time", *names]
    columns = trace.read(parquet, names)
    for i, name in enumerate(["time", *names]):
        for row, value in zip(rows[1:], columns[name].tolist(), strict=True):
            assert (row[i] == "" and value != value) or float(row[i]) == value
    with pytest.raises(UnknownError, match="no channel"):
        trace.lines(parquet, ["leader.sped"])


def test_the_commands_write_them(kept, tmp_path):
    db, _ = kept
    done = CliRunner().invoke(app, ["runs", "--db", str(db), "--out", str(tmp_path / "runs.parquet")])
    assert done.exit_code == 0 and pq.read_table(tmp_path / "runs.parquet").num_rows == 2
    wrong = CliRunner().invoke(app, ["runs", "--db", str(db), "--out", str(tmp_path / "runs.xls")])
    assert wrong.exit_code != 0 and ".csv, .parquet, .json" in str(wrong.exception or wrong.output)
    done = CliRunner().invoke(app, ["export", "1", "--db", str(db), "--format", "parquet", "--out", str(tmp_path / "run.parquet")])
    assert done.exit_code == 0 and pq.read_table(tmp_path / "run.parquet").column_names[0] == "time"
    done = CliRunner().invoke(app, ["export", "1", "--db", str(db), "--format", "channels", "--out", str(tmp_path / "run.csv")])
    assert done.exit_code == 0 and (tmp_path / "run.csv").read_text().startswith("time [s],")

"""The tyre bench: tables in, tables out, and the picture."""

import csv
import gzip
import struct

import numpy as np
import pytest

from studio.errors import ScenarioError
from studio.model.tyre import Tyre
from studio.rig import table
from studio.rig import tyre as rig
from studio.scenario import tir

HEAD = "kappa,alpha_rad,gamma_rad,Fz_N"


@pytest.fixture(scope="module")
def folder(root):
    return root / "tests" / "reference"


@pytest.fixture(scope="module")
def tyre_file(folder):
    return folder / "MagicFormula52_Parameters.tir"


@pytest.fixture(scope="module")
def t(tyre_file):
    return Tyre(*tir.coefficients(tir.read(tyre_file)))


def read_rows(path):
    opened = gzip.open if path.suffix == ".gz" else open
    with opened(path, "rt") as file:
        return list(csv.DictReader(file))


@pytest.fixture
def refused(tyre_file, tmp_path):
    """The problems of a table that must be refused; nothing is written then."""

    def problems_of(content, name="rows.csv"):
        (tmp_path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        with pytest.raises(ScenarioError) as caught:
            rig.bench(tyre_file, tmp_path / name, tmp_path / "out.csv")
        assert str(caught.value).startswith(name)
        assert not (tmp_path / "out.csv").exists()
        return caught.value.problems

    return problems_of


# --- tables ------------------------------------------------------------------------------------------------------------


def test_a_table_of_another_program(tyre_file, folder, tmp_path):
    """All columns pass through; given forces stay under another name, and the computed ones agree with them."""
    source = folder / "mfeval_MagicFormula52_opentire.csv.gz"
    assert rig.bench(tyre_file, source, tmp_path / "out.csv") == 495
    given, result = read_rows(source), read_rows(tmp_path / "out.csv")
    assert list(result[0]) == [
        "Fz_N", "kappa", "alpha_rad", "gamma_rad", "Fx0_N", "Fy0_N", "Fx_N_given", "Fy_N_given", "Mz_Nm_given", "Fx_N", "Fy_N", "Mz_Nm",
    ]  # fmt: skip
    for before, after in zip(given, result, strict=True):
        assert all(after[name + "_given" * (name in rig.OUTPUTS)] == value for name, value in before.items())
        assert float(after["Fx_N"]) == pytest.approx(float(before["Fx_N"]), abs=1e-3)
        assert float(after["Fy_N"]) == pytest.approx(float(before["Fy_N"]), abs=1e-3)
        assert float(after["Mz_Nm"]) == pytest.approx(float(before["Mz_Nm"]), abs=0.1)


def test_a_result_put_in_again_stays_as_it_is(tyre_file, folder, tmp_path):
    rig.bench(tyre_file, folder / "mfeval_MagicFormula52_opentire.csv.gz", tmp_path / "first.csv")
    rig.bench(tyre_file, tmp_path / "first.csv", tmp_path / "second.csv.gz")
    assert read_rows(tmp_path / "second.csv.gz") == read_rows(tmp_path / "first.csv")


def test_columns_in_any_order_and_texts(tyre_file, t, tmp_path):
    (tmp_path / "rows.csv").write_text('note,Fz_N,gamma_rad,kappa,alpha_rad\n"wet, cold",4000,0.02, 0.1 ,-0.05\n\n')
    assert rig.bench(tyre_file, tmp_path / "rows.csv", tmp_path / "out.csv") == 1
    (row,) = read_rows(tmp_path / "out.csv")
    assert row["note"] == "wet, cold"
    expected = rig.sweep(t, 0.1, -0.05, 0.02, 4000.0)[:, 0]
    assert [float(row[name]) for name in rig.OUTPUTS] == pytest.approx(expected, rel=1e-8)


def test_signs(t):
    """Positive slip drives, positive side-slip pushes to the right."""
    F_x, F_y, _ = rig.sweep(t, [0.05, -0.05, 0.0, 0.0], [0.0, 0.0, 0.05, -0.05], 0.0, 6000.0)
    assert F_x[0] > 1000.0 and F_x[1] < -1000.0
    assert F_y[2] < -1000.0 and F_y[3] > 1000.0


@pytest.mark.parametrize("n", [1, 3, 7, 8, 9, 13, 64, 1000])
def test_rows_do_not_depend_on_each_other(t, n):
    """A row gives the same bits, whatever stands around it."""
    random = np.random.default_rng(1)
    kappa, alpha, gamma = random.uniform(-0.3, 0.3, (3, 1000))
    F_z = random.uniform(0.0, 9000.0, 1000)
    whole = rig.sweep(t, kappa, alpha, gamma, F_z)
    assert np.array_equal(rig.sweep(t, kappa[-n:], alpha[-n:], gamma[-n:], F_z[-n:]), whole[:, -n:])


def test_files_that_may_be_packed(tyre_file, tmp_path):
    with gzip.open(tmp_path / "rows.csv.gz", "wt") as file:
        file.write(f"{HEAD}\n0,0.05,0,4000\n")
    rig.bench(tyre_file, tmp_path / "rows.csv.gz", tmp_path / "out.csv")
    assert float(read_rows(tmp_path / "out.csv")[0]["Fy_N"]) < 0.0


# --- tables that are refused -------------------------------------------------------------------------------------------


def test_missing_columns(refused):
    problems = refused("kappa,alpha,gamma_rad,load\n0,0,0,4000\n")
    assert [each.what for each in problems] == ["has no column alpha_rad", "has no column Fz_N"]
    assert problems[0].where == "rows.csv, line 1"
    assert "'alpha'" in problems[0].remedy


def test_a_column_twice(refused):
    (problem,) = refused(f"{HEAD},kappa\n0,0,0,4000,0\n")
    assert (problem.what, problem.value) == ("has a column twice", "kappa")


@pytest.mark.parametrize(
    ("row", "column", "what", "value"),
    [
        ("x,0,0,4000", "kappa", "is not a number", "x"),
        ("nan,0,0,4000", "kappa", "is not a number", "nan"),
        ("inf,0,0,4000", "kappa", "is out of range", "inf"),
        (",0,0,4000", "kappa", "is not a number", "nothing"),
        ("0,1.5707963267948966,0,4000", "alpha_rad", "is out of range", "1.5707963267948966"),
        ("0,-2,0,4000", "alpha_rad", "is out of range", "-2"),
        ("0,0,1.6,4000", "gamma_rad", "is out of range", "1.6"),
        ("0,0,0,-1", "Fz_N", "is out of range", "-1"),
        ("0,0,0,inf", "Fz_N", "is out of range", "inf"),
    ],
)
def test_cells(row, column, what, value, refused):
    (problem,) = refused(f"{HEAD}\n0,0,0,4000\n\n{row}\n")
    assert problem.where == f"rows.csv, line 4, column {column}"
    assert (problem.what, problem.value, problem.allowed) == (what, value, rig.ALLOWED[column][2])


def test_every_bad_cell_is_named_up_to_a_limit(refused):
    assert [each.where[-8:] for each in refused(f"{HEAD}\nx,y,0,0\n")] == ["mn kappa", "lpha_rad"]
    assert len(refused(f"{HEAD}\n" + "x,0,0,0\n" * 100)) == table.MOST


def test_a_row_of_another_length(refused):
    (problem,) = refused(f"{HEAD}\n0,0,0,4000\n0,0,4000\n")
    assert (problem.where, problem.value, problem.allowed) == ("rows.csv, line 3", "3", "4")


@pytest.mark.parametrize(
    ("content", "what"),
    [
        ("", "is empty"),
        ("\n\n", "is empty"),
        (HEAD + "\n", "has a head but no rows"),
        (b"\xff\xfe\x00", "is not a text file"),
        (HEAD.replace(",", ";") + "\n0;0;0;4000\n", "has one column only"),
    ],
)
def test_files_that_are_no_tables(content, what, refused):
    assert [each.what for each in refused(content)] == [what]


def test_a_quote_that_never_ends(refused):
    (problem,) = refused(f'{HEAD}\n"0,0,0,4000\n')
    assert problem.what.startswith("is not CSV")


def test_damaged_packing(refused):
    whole = gzip.compress(f"{HEAD}\n0,0,0,4000\n".encode() * 500)
    assert "is damaged" in refused(whole[: len(whole) // 2], "rows.csv.gz")[0].what
    assert "cannot be opened" in refused(b"no gzip at all", "rows.csv.gz")[0].what


def test_files_that_are_not_there(tyre_file, tmp_path):
    with pytest.raises(ScenarioError, match="cannot be opened: No such file"):
        rig.bench(tyre_file, tmp_path / "rows.csv", tmp_path / "out.csv")
    (tmp_path / "rows.csv").write_text(f"{HEAD}\n0,0,0,4000\n")
    with pytest.raises(ScenarioError, match="cannot be written: there is no such folder"):
        rig.bench(tyre_file, tmp_path / "rows.csv", tmp_path / "nowhere" / "out.csv")
    with pytest.raises(ScenarioError, match=r"There is no tyre|is no file"):
        rig.bench(tmp_path / "none.tir", tmp_path / "rows.csv", tmp_path / "out.csv")


# --- the picture -------------------------------------------------------------------------------------------------------


def size_of(png):
    """Width and height [pixel] of a PNG, from its first chunk."""
    data = png.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n" and data[12:16] == b"IHDR"
    return struct.unpack(">II", data[16:24])


def test_plot(tyre_file, tmp_path):
    rig.plot(tyre_file, tmp_path / "tyre.png")
    assert size_of(tmp_path / "tyre.png") == (1650, 1275)


@pytest.fixture(scope="module")
def panels(tyre_file):
    """The four diagrams as they are drawn."""
    from matplotlib.figure import Figure

    figure = Figure()
    drawn = figure.subplots(2, 2)
    rig.draw(drawn, tir.read(tyre_file))
    return drawn.ravel()


def test_axes_have_units(panels):
    for panel in panels:
        assert panel.get_xlabel()[-1] == "]" and panel.get_ylabel()[-1] == "]" and panel.get_title()


def test_lines_are_the_forces(panels, t):
    """The second line of each of the first three diagrams is the tyre at its nominal load."""
    drive, corner, align, _ = (panel.get_lines()[1] for panel in panels)
    kappa, degrees = drive.get_xdata(), corner.get_xdata()
    assert (kappa[0], kappa[-1]) == (-0.5, 0.5)
    assert (degrees[0], degrees[-1]) == pytest.approx((-20.0, 20.0))
    F_x = rig.sweep(t, kappa, 0.0, 0.0, t.FNOMIN)[0]
    _, F_y, M_z = rig.sweep(t, 0.0, np.radians(degrees), 0.0, t.FNOMIN)
    assert drive.get_ydata() == pytest.approx(F_x / 1e3)
    assert corner.get_ydata() == pytest.approx(F_y / 1e3, abs=1e-6)
    assert align.get_ydata() == pytest.approx(M_z, abs=1e-6)
    assert [text.get_text() for text in panels[1].get_legend().get_texts()] == [
        "4708 N",
        "9417 N",
        "14125 N",
        "18833 N",
    ]


def test_loads_stay_in_the_range_of_the_file(folder):
    properties = tir.read(folder / "UAZBUS_Pac02Tire.tir")
    assert rig.loads(properties) == [2000.0, 4000.0, 6000.0, 8000.0]
    properties.values["FZMAX"] = 5000.0
    assert rig.loads(properties) == [2000.0, 4000.0]
    properties.values["FZMAX"] = 100.0
    assert rig.loads(properties) == [4000.0]


def test_a_picture_that_cannot_be_written(tyre_file, tmp_path):
    with pytest.raises(ScenarioError, match="cannot be written"):
        rig.plot(tyre_file, tmp_path / "nowhere" / "tyre.png")

"""Tyre property files: what is read, what is assumed, what is refused and how that is told."""

import re

import numpy as np
import pytest

from studio.errors import ScenarioError
from studio.model.tyre import Tyre, lateral_pure
from studio.scenario import tir


@pytest.fixture(scope="module")
def whole(root):
    """The text of a file that lacks nothing."""
    return (root / "tests" / "reference" / "UAZBUS_Pac02Tire.tir").read_text()


@pytest.fixture
def read(tmp_path):
    """Reads a text, or bytes, as a property file."""

    def read_content(content):
        path = tmp_path / "some.tir"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return tir.read(path)

    return read_content


@pytest.fixture
def refused(read):
    """The problems of a text that must be refused."""

    def problems_of(content):
        with pytest.raises(ScenarioError) as caught:
            read(content)
        assert str(caught.value).startswith("some.tir ")
        return caught.value.problems

    return problems_of


def changed(text, key, value):
    """The text with another value of a key."""
    pattern = rf"(?m)^({key}\s*=)[^$\n]*"
    assert len(re.findall(pattern, text)) == 1
    return re.sub(pattern, rf"\g<1> {value} ", text)


def without(text, *keys):
    """The text without the lines of some keys."""
    for key in keys:
        text, found = re.subn(rf"(?m)^{key}\s*=.*\n", "", text)
        assert found, key
    return text


def added(text, section, line):
    """The text with one more line in a section."""
    assert text.count(f"[{section}]\n") == 1
    return text.replace(f"[{section}]\n", f"[{section}]\n{line}\n")


# --- what is read ------------------------------------------------------------------------------------------------------


def test_values(read, whole):
    file = read(whole)
    assert file.name == "some.tir"
    assert (file.values["PCY1"], file.values["LFZO"], file.values["PDX3"]) == (
        1.3223,
        1.449275362,
        -2.2142e-05,
    )
    assert (file.values["VERTICAL_STIFFNESS"], file.values["VERTICAL_DAMPING"]) == (222954.5455, 500.0)
    assert (file.values["KPUMIN"], file.values["KPUMAX"]) == (-1.5, 1.5)
    assert (file.values["ALPMIN"], file.values["ALPMAX"]) == (-1.5708, 1.5708)
    assert file.side == "left"
    assert file.notes == ()
    assert file.size == "225/75 R16"


def test_coefficients_stand_in_the_order_of_the_model(read, whole):
    file = read(whole)
    t = Tyre(*tir.coefficients(file))
    assert all(getattr(t, name) == file.values[name] for name in Tyre._fields)
    assert tir.coefficients(file, ("VERTICAL_STIFFNESS", "FNOMIN")) == [222954.5455, 4000.0]


def test_size(read, whole):
    """Half inches of trucks' rims are kept; without its three numbers there is none."""
    truck = changed(changed(whole, "RIM_RADIUS", "0.28575"), "WIDTH", "0.275")
    assert read(truck).size == "275/75 R22.5"
    assert read(without(whole, "WIDTH")).size == ""


def test_sections(read, whole):
    sections = read(whole).sections
    assert sections["LATERAL_COEFFICIENTS"]["PCY1"] == 1.3223
    assert sections["MODEL"]["PROPERTY_FILE_FORMAT"] == "PAC2002"
    assert sections["UNITS"]["LENGTH"] == "meter"


@pytest.mark.parametrize("name", ["MagicFormula52_Parameters", "Sedan_Pac02Tire", "UAZBUS_Pac02Tire", "mf_185_80R14"])
def test_files_of_others(name, root):
    assert len(tir.coefficients(tir.read(root / "tests" / "reference" / f"{name}.tir"))) == len(Tyre._fields)


@pytest.mark.parametrize(
    "line",
    ["PCY1=1.25", "PCY1 = 1.25", "  pcy1\t=\t1.25  ", "PCY1 = 1.25$ shape", "PCY1 = 1.25 ! it's the shape", "PCY1 = +12.5D-01",
     "PCY1 = 0.125E1", "PCY1 = 125.e-2", "PCY1 = '1.25'", 'PCY1 = "1.25"  $ "quoted"'],
)  # fmt: skip
def test_spellings_of_a_line(line, read, whole):
    assert read(added(without(whole, "PCY1"), "LATERAL_COEFFICIENTS", line)).values["PCY1"] == 1.25


def test_comment_marks_within_quotes(read, whole):
    file = read(added(whole, "MODEL", "COMMENT_TEXT = 'costs 5 $, really!' $ a comment"))
    assert file.sections["MODEL"]["COMMENT_TEXT"] == "costs 5 $, really!"


@pytest.mark.parametrize(
    "content",
    [
        lambda text: text.replace("\n", "\r\n").encode(),
        lambda text: text.replace("\n", "\n\n").encode(),
        lambda text: b"\xef\xbb\xbf" + text.encode(),
        lambda text: ("$ Größe 225/75\n" + text).encode("utf-8"),
        lambda text: ("$ Größe 225/75\n" + text).encode("latin-1"),
    ],
    ids=["crlf", "empty lines", "byte order mark", "utf-8", "latin-1"],
)
def test_encodings(content, read, whole):
    assert read(content(whole)).values == read(whole).values


def test_tables_and_texts_hold_no_values(read, whole):
    table = "{radial width}\n 1.0 0.0\n 0.9 1.0\n(COMMENTS)\n{comment_string}\n'Made by = nobody'\n"
    assert read(whole + "\n[SHAPE]\n" + table).values == read(whole).values


def test_the_same_key_in_another_section(read, whole):
    """A key's own section counts."""
    text = whole + "\n[ANOTHER]\nPCY1 = 7\nMASS = 9.3\nWIDTH = 3\n"
    assert read(text).values["PCY1"] == 1.3223
    assert read(text).values["WIDTH"] == 0.225
    assert read(text).sections["ANOTHER"] == {"PCY1": 7.0, "MASS": 9.3, "WIDTH": 3.0}


def test_a_key_outside_its_section(read, whole):
    """PCY1 stands in a section of its own name: taken from there."""
    assert read(without(whole, "PCY1") + "\n[ANOTHER]\nPCY1 = 1.5\n").values["PCY1"] == 1.5


def test_the_same_value_twice(read, whole):
    assert read(added(whole, "LATERAL_COEFFICIENTS", "PCY1 = 1.32230")).values["PCY1"] == 1.3223


@pytest.mark.parametrize(("text", "side"), [("'RIGHT'", "right"), ("'Left'", "left"), ("SYMMETRIC", "symmetric")])
def test_side(text, side, read, whole):
    assert read(changed(whole, "TYRESIDE", text)).side == side


@pytest.mark.parametrize("lines", [
    "PROPERTY_FILE_FORMAT = 'PAC2002'",
    "PROPERTY_FILE_FORMAT = 'MF_05'",
    "PROPERTY_FILE_FORMAT = 'USER'\nFITTYP = 6",
    "PROPERTY_FILE_FORMAT = 'MF-TYRE'\nFITTYP = 52",
    "FITTYP = 21",
])  # fmt: skip
def test_names_of_the_formula(lines, read, whole):
    file = read(added(without(whole, "PROPERTY_FILE_FORMAT"), "MODEL", lines))
    assert file.notes == ()


# --- units -------------------------------------------------------------------------------------------------------------


def test_units(read, whole):
    """Millimetres, kilonewtons, milliseconds: only what carries a unit is converted."""
    plain = read(whole).values
    text = changed(changed(whole, "UNLOADED_RADIUS", f"{1e3 * plain['UNLOADED_RADIUS']!r}"), "FNOMIN", f"{1e-3 * plain['FNOMIN']!r}")
    values = read(changed(changed(changed(text, "LENGTH", "'mm'"), "FORCE", "'kN'"), "TIME", "'millisecond'")).values
    factors = {"UNLOADED_RADIUS": 1.0, "FNOMIN": 1.0, "FZMAX": 1e3, "VERTICAL_STIFFNESS": 1e6, "VERTICAL_DAMPING": 1e3,
               "LONGVL": 1.0, "PCY1": 1.0, "ALPMAX": 1.0, "SSZ1": 1.0}  # fmt: skip
    assert {key: values[key] / plain[key] for key in factors} == pytest.approx(factors, rel=1e-12)


@pytest.mark.parametrize(
    ("quantity", "unit", "key", "factor"),
    [("LENGTH", "Inch", "UNLOADED_RADIUS", 0.0254), ("LENGTH", "foot", "UNLOADED_RADIUS", 0.3048),
     ("LENGTH", "mile", "UNLOADED_RADIUS", 1609.344), ("LENGTH", "cm", "UNLOADED_RADIUS", 0.01), ("LENGTH", "km", "WIDTH", 1e3),
     ("FORCE", "pound_force", "FNOMIN", 4.4482216152605), ("FORCE", "KG_FORCE", "FNOMIN", 9.80665),
     ("TIME", "hour", "LONGVL", 1 / 3600), ("TIME", "minute", "VERTICAL_DAMPING", 60.0), ("MASS", "slug", "MBELT", 14.593902937206365)],
)  # fmt: skip
def test_each_unit(quantity, unit, key, factor, read, whole):
    plain = read(whole).values
    text = whole
    for bounded, of in (("UNLOADED_RADIUS", "LENGTH"), ("FNOMIN", "FORCE")):
        if quantity == of:
            per_unit = tir.UNITS[of][unit.lower()]
            assert key != bounded or per_unit == factor
            text = changed(text, bounded, f"{plain[bounded] / per_unit!r}")
    converted = read(changed(text, quantity, f"'{unit}'")).values
    assert converted[key] == pytest.approx((1.0 if key in ("UNLOADED_RADIUS", "FNOMIN") else factor) * plain[key], rel=1e-12)


def test_unknown_units(refused, whole):
    problems = refused(changed(changed(whole, "LENGTH", "'furlong'"), "FORCE", "'newtons'"))
    assert [each.value for each in problems] == ["furlong", "newtons"]
    assert "[UNITS] LENGTH" in problems[0].where and "line" in problems[0].where
    assert "meter" in problems[0].allowed
    assert "'newton'" in problems[1].remedy


def test_degrees(refused, whole):
    (problem,) = refused(changed(whole, "ANGLE", "'degrees'"))
    assert "per degree or per radian" in problem.what
    assert "radian" in problem.allowed


# --- what is assumed ---------------------------------------------------------------------------------------------------


def test_notes_of_what_a_file_leaves_out(read, whole):
    text = without(whole, "LENGTH", "FORCE", "TYRESIDE", "LTR", "LGAZ", "PDX3", "QBZ10", "KPUMIN", "ALPMAX")
    file = read(text)
    assert file.notes == (
        "[UNITS] does not give LENGTH, FORCE: SI taken",
        "[MODEL] does not give TYRESIDE: left taken",
        "PDX3 not given: 0 taken",
        "QBZ10 not given: 0 taken",
        "scaling factors LTR, LGAZ not given: 1 taken",
        "limits not given: KPUMIN = -1.5, ALPMAX = 1.5708 taken",
    )
    assert (file.values["LTR"], file.values["PDX3"], file.values["KPUMIN"]) == (1.0, 0.0, -1.5)
    assert file.side == "left"


@pytest.mark.parametrize(
    ("pattern", "note"),
    [
        (r"R.X\d", "no coefficients of combined longitudinal slip: side-slip does not reduce F_x"),
        (r"R.Y\d", "no coefficients of combined lateral slip: longitudinal slip does not change F_y"),
        (r"Q[BCDEH]Z\d+", "no coefficients of the aligning moment: no trail, no residual moment"),
        (r"SSZ\d", "no coefficients of the moment arm of F_x: F_x makes no aligning moment"),
    ],
)
def test_a_whole_group_may_be_absent(pattern, note, read, whole):
    names = [name for name in Tyre._fields if re.fullmatch(pattern, name)]
    assert len(names) >= 4
    file = read(without(whole, *names))
    assert file.notes == (note,)
    assert tir.coefficients(file, names) == [0.0] * len(names)


def test_notes_of_what_is_not_used(read, whole):
    text = added(
        added(whole, "SCALING_COEFFICIENTS", "LCZ = 0.5\nLIP = 1"),
        "LATERAL_COEFFICIENTS",
        "PPY1 = 0.3\nPPY2 = 0",
    )
    text = changed(added(text, "MODEL", "FITTYP = 5"), "USE_MODE", "-4")
    assert read(text).notes == (
        "FITTYP 5 (MF-Tyre 5.0 and 5.1): computed with the equations of 5.2",
        "USE_MODE asks for a mirrored tyre: not used, the tyre stands as measured",
        "PPY1: not used, the inflation pressure is taken as the nominal one",
        "scaling factors LCZ differ from 1 and are not used",
    )


# --- what is refused ---------------------------------------------------------------------------------------------------


def test_missing_coefficients(refused, whole):
    problems = refused(without(whole, "PKY1", "PCX1", "FNOMIN"))
    assert [(each.where, each.what) for each in problems] == [
        ("some.tir, [VERTICAL]", "FNOMIN is missing"),
        ("some.tir, [LONGITUDINAL_COEFFICIENTS]", "PCX1 is missing"),
        ("some.tir, [LATERAL_COEFFICIENTS]", "PKY1 is missing"),
    ]


def test_a_part_of_a_group(refused, whole):
    problems = refused(without(whole, "RBX2", "RHX1", "QCZ1"))
    assert [each.what for each in problems] == [
        "RBX2 is missing, while other coefficients of combined longitudinal slip are there",
        "RHX1 is missing, while other coefficients of combined longitudinal slip are there",
        "QCZ1 is missing, while other coefficients of the aligning moment are there",
    ]
    assert problems[0].remedy == "add it; 0 switches its term off"


def test_numbers_that_are_wanted_but_not_there(read, whole):
    with pytest.raises(ScenarioError) as caught:
        tir.coefficients(read(without(whole, "VERTICAL_STIFFNESS")), ("VERTICAL_STIFFNESS", "VERTICAL_DAMPING", "SPEED"))
    assert [str(each) for each in caught.value.problems] == [
        "some.tir, [VERTICAL]: VERTICAL_STIFFNESS is missing; add it",
        "some.tir, [any section]: SPEED is missing; add it",
    ]


@pytest.mark.parametrize("value", ["nan", "inf", "1,5", "1.5 metres", "", "0x10", "1_0", "--1"])
def test_no_numbers(value, refused, whole):
    (problem,) = refused(changed(whole, "PCY1", value))
    assert re.fullmatch(r"some\.tir, line \d+, \[LATERAL_COEFFICIENTS\] PCY1", problem.where)
    assert problem.what == "is not a number"
    assert problem.value == (value or "nothing")


@pytest.mark.parametrize("value", ["1e999", "-1e31"])
def test_a_number_beyond_all_bounds(value, refused, whole):
    (problem,) = refused(changed(whole, "PCY1", value))
    assert (problem.what, problem.value, problem.allowed) == ("is too large", value, "at most 1e+30")


@pytest.mark.parametrize(
    ("key", "value", "allowed"),
    [("FNOMIN", "0", "> 0"), ("FNOMIN", "-4000", "> 0"), ("UNLOADED_RADIUS", "0", "> 0"), ("LFZO", "0", "> 0"),
     ("VERTICAL_STIFFNESS", "-1", "> 0"), ("VERTICAL_DAMPING", "-1", "≥ 0"), ("PKY2", "0", "not 0"), ("PKY1", "0.0", "not 0"),
     ("PCX1", "0", "not 0"), ("LMUY", "0", "> 0")],
)  # fmt: skip
def test_values_that_no_tyre_has(key, value, allowed, refused, whole):
    (problem,) = refused(changed(whole, key, value))
    assert problem.where.endswith(key) and "line" in problem.where
    assert (problem.value, problem.allowed) == (value, allowed)


@pytest.mark.parametrize(("low", "high"), tir.RANGES)
def test_ranges_that_are_none(low, high, refused, whole):
    (problem,) = refused(changed(changed(whole, low, "1.5"), high, "1"))
    assert (problem.what, problem.value, problem.allowed) == (f"is not below {high}", "1.5", "< 1")


def test_an_unknown_side(refused, whole):
    (problem,) = refused(changed(whole, "TYRESIDE", "'BOTH'"))
    assert (problem.value, problem.allowed) == ("BOTH", "left, right, symmetric")


def test_duplicates(refused, whole):
    (problem,) = refused(added(whole, "LATERAL_COEFFICIENTS", "PCY1 = 1.5"))
    assert re.search(r"line \d+", problem.where) and problem.where.endswith("PCY1")
    assert re.fullmatch(r"stands already in line \d+ as 1\.5", problem.what)
    assert problem.value == "1.3223"


def test_several_places_outside_the_own_section(refused, whole):
    (problem,) = refused(without(whole, "PCY1") + "\n[A]\nPCY1 = 1.5\n[B]\nPCY1 = 1.6\n")
    assert problem.what == "PCY1 has several values"
    assert "[LATERAL_COEFFICIENTS]" in problem.allowed


@pytest.mark.parametrize("family", ["FIALA", "PAC89", "PAC94", "UA", "MF-SWIFT", "FTIRE"])
def test_other_models(family, refused, whole):
    (problem,) = refused(changed(whole, "PROPERTY_FILE_FORMAT", f"'{family}'"))
    assert (problem.what, problem.value) == ("is another tyre model", family)
    assert "PAC2002" in problem.allowed


@pytest.mark.parametrize("version", ["60", "61", "62"])
def test_version_6(version, refused, whole):
    (problem,) = refused(changed(added(whole, "MODEL", f"FITTYP = {version}"), "PROPERTY_FILE_FORMAT", "'MF-TYRE'"))
    assert "MF-Tyre 6.x" in problem.what and "inflation pressure" in problem.what
    assert "5.2" in problem.remedy


def test_an_unknown_version(refused, whole):
    (problem,) = refused(added(whole, "MODEL", "FITTYP = 7"))
    assert (problem.what, problem.value) == ("is a version that is not known here", "7")


@pytest.mark.parametrize("family", ["USER", "MF-TYRE"])
def test_a_file_that_does_not_say_its_version(family, refused, whole):
    (problem,) = refused(changed(whole, "PROPERTY_FILE_FORMAT", f"'{family}'"))
    assert "does not say which formula" in problem.what
    assert "FITTYP = 6" in problem.remedy


def test_terms_of_version_6(refused, whole):
    problems = refused(added(whole, "LATERAL_COEFFICIENTS", "PKY4 = 2.0\nPEY5 = 0\nRBY4 = 0.1"))
    assert [each.value for each in problems] == ["2.0", "0.1"]
    assert all("MF-Tyre 6.x" in each.what for each in problems)


def test_another_pressure(read, refused, whole):
    terms = added(whole, "LATERAL_COEFFICIENTS", "PPY1 = 0.3")
    (problem,) = refused(added(terms, "MODEL", "IP = 220000\nIP_NOM = 200000"))
    assert problem.where.endswith("IP") and "PPY1" in problem.what
    assert len(read(added(terms, "MODEL", "IP = 200000\nIP_NOM = 200000")).notes) == 1


def test_lines_that_are_none(refused, whole):
    (problem,) = refused(added(whole, "SCALING_COEFFICIENTS", "LTR 0.5"))
    assert re.fullmatch(r"some\.tir, line \d+", problem.where)
    assert problem.value == "LTR 0.5"


@pytest.mark.parametrize(
    ("content", "what"),
    [(b"", "is empty"), (b" \n\n ", "is empty"), (b"\x00\x01" * 100, "is not a text file"), (b"$ x\n" * 300_000, "is too large"),
     ("FNOMIN = 3".encode("utf-16"), "is not a text file"), (b"$ nothing but a comment", "has no section with values"),
     (b"a,b\n1,2\n", "has no section with values"), (b"FNOMIN = 4000", "has no section with values")],
    ids=["empty", "blank", "binary", "huge", "utf-16", "comment", "csv", "no section"],
)  # fmt: skip
def test_files_that_are_none(content, what, refused):
    assert what in [each.what for each in refused(content)]


def test_a_missing_file(tmp_path):
    (tmp_path / "tyre_a.tir").write_text("")
    with pytest.raises(ScenarioError) as caught:
        tir.read(tmp_path / "tyre_b.tir")
    assert "tyre_b.tir" in str(caught.value) and "did you mean 'tyre_a.tir'?" in str(caught.value)


def test_a_folder(tmp_path):
    with pytest.raises(ScenarioError, match="is no file"):
        tir.read(tmp_path)


def test_a_name_that_no_file_can_have(tmp_path):
    with pytest.raises(ScenarioError):
        tir.read(tmp_path / ("x" * 5000 + ".tir"))


def test_many_problems_are_cut(refused, whole):
    assert len(refused(whole + "\nnonsense" * 1000)) == tir.MOST


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"PKY1": 19.797}, "PKY1"), ({"PKY2": -1.7999}, "PKY1"), ({"LKY": -1.0}, "PKY1"), ({"PKX1": -18.886}, "PKX1"),
        ({"LKX": -1.0}, "PKX1"), ({"PKY1": 19.797, "PKY2": -1.7999}, ""), ({"PKX1": -18.886, "LKX": -1.0}, ""),
    ],
)  # fmt: skip
def test_forces_that_point_the_wrong_way(changes, key, read, refused, whole):
    """The slopes of the formula at small slip have a sign; a set fitted in other axes would steer the car the other way."""
    text = whole
    for name, value in changes.items():
        text = (
            changed(text, name, value) if re.search(rf"(?m)^{name}\s*=", text) else added(text, "SCALING_COEFFICIENTS", f"{name} = {value}")
        )
    if not key:
        assert read(text).values["PKY1"] == float(changes.get("PKY1", -19.797))
        return
    (problem,) = refused(text)
    assert key in problem.where and "round" in problem.what and problem.remedy.startswith("change its sign")


@pytest.mark.parametrize(
    ("key", "value", "what"), [("PDY2", -2.0, "friction across"), ("PDX2", -5.0, "friction along"), ("PKX2", -60.0, "slip stiffness")]
)
def test_loads_at_which_nothing_is_left(key, value, what, read, whole):
    """Friction and stiffness fall with the load, linearly: where the file's own range goes on beyond their zero the notes say so."""
    found = read(changed(whole, key, value))
    load, nominal = found.values["FZMAX"], found.values["FNOMIN"]
    assert found.values[key[:-1] + "1"] + value * (load - nominal) / nominal <= 0.0
    assert any(f"the {what} is not above 0 at {load:g} N" in note for note in found.notes)
    assert not any("not above 0" in note for note in read(whole).notes)


HOSTILE = {
    "millimetres that are metres": ({"LENGTH": "'mm'"}, "UNLOADED_RADIUS", "m, as no tyre has it", "0.05 to 3 m"),
    "metres that are millimetres": ({"UNLOADED_RADIUS": "286"}, "UNLOADED_RADIUS", "is 286 m", "0.05 to 3 m"),
    "a load in tons": ({"FNOMIN": "0.4"}, "FNOMIN", "is 0.4 N", "20 to 1e+06 N"),
    "side-slip in degrees": ({"ALPMAX": "15"}, "ALPMAX", "is 15 rad", "-1.6 to 1.6 rad"),
    "slip in percent": ({"KPUMAX": "150"}, "KPUMAX", "is 150, as", "-10 to 10"),
    "a shift in degrees": ({"PHY1": "0.3"}, "PHY1", "shifts the side-slip", "within ±0.2 rad"),
    "friction of another sign": ({"PDY1": "-1.01"}, "PDY1", "is the friction of the side force", "above 0, up to 5"),
    "friction in percent": ({"PDX1": "110"}, "PDX1", "is the friction of the longitudinal force", "above 0, up to 5"),
    "a shape that turns back": (
        {"PCY1": "2.4"},
        "PCY1",
        "turns the side force round at large slip: C = PCY1",
        "above 0, up to 2",
    ),
    "a shape below 0": ({"LCX": "-1"}, "PCX1", "turns the longitudinal force round at large slip", "above 0, up to 2"),
    "force without slip": ({"PVY1": "5"}, "PVY1", "makes a side force of one direction whatever the slip", "the friction PDY1"),
    "no stiffness": ({"LKX": "0"}, "PKX1", "leaves no longitudinal force", "above 0"),
    "a trail before the wheel": ({"QDZ1": "-0.06"}, "QDZ1", "turns the aligning moment round", "0 or above"),
    "no speed": ({"LONGVL": "0"}, "LONGVL", "is out of range", "> 0"),
}


@pytest.mark.parametrize("case", HOSTILE)
def test_numbers_that_make_a_wrong_tyre_are_told_with_place_value_and_range(case, refused, whole):
    changes, key, what, allowed = HOSTILE[case]
    text = whole
    for name, value in changes.items():
        is_there = re.search(rf"(?m)^{name}\s*=", text)
        text = changed(text, name, value) if is_there else added(text, "SCALING_COEFFICIENTS", f"{name} = {value}")
    found = {each.where.rpartition(" ")[2]: each for each in refused(text)}
    assert what in found[key].what and allowed in found[key].allowed and found[key].remedy and "line " in found[key].where


@pytest.mark.parametrize(("C", "D", "S_V"), [(1.99, 1.0, 0.0), (0.3, 0.2, 0.19), (1.3, 4.9, -4.8)])
def test_what_is_taken_never_turns_round(C, D, S_V, read, whole):
    """At nominal load, in the file's own range of side-slip: the force goes against it from where it is greatest on, whatever the shape."""
    text = changed(changed(changed(whole, "PCY1", str(C)), "PDY1", str(D)), "PVY1", str(S_V))
    t = Tyre(*tir.coefficients(read(text)))
    alpha = np.linspace(t.PHY1 + 0.6, 1.57, 60)
    left, right = (np.array([lateral_pure(t, side * a, 0.0, t.FNOMIN, 1.0) for a in alpha]) for side in (-1.0, 1.0))
    assert (left > right).all()

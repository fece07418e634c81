"""Tyre property files (`.tir`) of the Magic Formula 5.2: read, checked, turned into SI.

A file holds sections of `KEY = value`, texts in quotes, comments after `$` or `!`, and tables under a head in braces:

    [MODEL]
    PROPERTY_FILE_FORMAT = 'PAC2002'
    [LATERAL_COEFFICIENTS]
    PCY1 = 1.3507        $ shape factor

Groups of coefficients go together. Pure slip is always needed. A file without the whole group of combined slip, of
the aligning moment or of the moment arm describes a tyre without it (zeros, see model/tyre.py), and the notes say so;
a part of a group is refused. Nothing is guessed: what was assumed stands in the notes, what cannot be told is refused.

MF-Tyre 5.0 and 5.1 (FITTYP 5) are special cases of 5.2; 6.x has terms that 5.2 lacks and is refused.
"""

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from studio.errors import Problem, ScenarioError, nearest
from studio.model.tyre import Tyre

SIZE_LIMIT = 1_000_000  # [B] of a property file; real ones have some 20 kB
LARGEST = 1e30  # no number of a tyre is larger in any unit
SHOWN = 40  # characters of a value that a message repeats
MOST = 30  # problems that a message lists; a group has at most 22 coefficients
KEY = re.compile(r"([A-Za-z]\w*)\s*=(.*)")
NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([EeDd][-+]?\d+)?")
QUOTES = "'\""
SYNTAX = "KEY = value, or a comment after $"

FITS = {5: "MF-Tyre 5.0 and 5.1", 6: "MF-Tyre 5.2", 21: "MF-Tyre 5.2", 52: "MF-Tyre 5.2"}
FORMATS_OF_52 = ("PAC2002", "MF_05")  # say by themselves which formula they are
FORMATS_WITH_FITTYP = ("MF-TYRE", "USER")  # need FITTYP for that
TERMS_OF_6 = re.compile(r"PEY5|PKY[4-7]|RBX3|RBY4|QBZ6|QDZ1[01]")
TERMS_OF_PRESSURE = re.compile(r"PP[XYZ]\d|QPZ\d")
PRESSURES = (("IP", "IP_NOM"), ("INFLPRES", "NOMPRES"))
ACCEPTED = f"{', '.join(FORMATS_OF_52)}, or {', '.join(FORMATS_WITH_FITTYP)} with FITTYP {', '.join(map(str, FITS))}"
CONVERT = "fit or convert the set as MF 5.2 (PAC2002) with the tool it comes from"

INCH = 0.0254  # [m]
SIDES = ("left", "right", "symmetric")
UNITS = {
    "LENGTH": {
        "meter": 1.0, "m": 1.0, "mm": 1e-3, "millimeter": 1e-3, "cm": 1e-2, "centimeter": 1e-2,
        "km": 1e3, "kilometer": 1e3, "inch": INCH, "foot": 0.3048, "mile": 1609.344,
    },
    "FORCE": {
        "newton": 1.0, "n": 1.0, "knewton": 1e3, "kn": 1e3, "kg_force": 9.80665, "pound_force": 4.4482216152605,
        "kpound_force": 4448.2216152605, "ounce_force": 0.27801385095378125, "dyne": 1e-5,
    },
    "ANGLE": {"radian": 1.0, "radians": 1.0, "rad": 1.0},
    "MASS": {
        "kg": 1.0, "kilogram": 1.0, "gram": 1e-3, "tonne": 1e3, "pound_mass": 0.45359237, "kpound_mass": 453.59237,
        "slug": 14.593902937206365, "ounce_mass": 0.028349523125,
    },
    "TIME": {"second": 1.0, "sec": 1.0, "s": 1.0, "millisecond": 1e-3, "ms": 1e-3, "minute": 60.0, "hour": 3600.0},
}  # fmt: skip
DEGREES = ("degree", "degrees", "deg")
# Keys that carry a unit. Angles must be radians; the coefficients of the formula relate to FNOMIN, UNLOADED_RADIUS.
EXPONENTS = {
    **{key: {"LENGTH": 1} for key in ("UNLOADED_RADIUS", "WIDTH", "RIM_RADIUS", "RIM_WIDTH")},
    **{key: {"FORCE": 1} for key in ("FNOMIN", "FZMIN", "FZMAX")},
    **{key: {"LENGTH": 1, "TIME": -1} for key in ("LONGVL", "VXLOW")},
    "VERTICAL_STIFFNESS": {"FORCE": 1, "LENGTH": -1},
    "VERTICAL_DAMPING": {"FORCE": 1, "LENGTH": -1, "TIME": 1},
    "MBELT": {"MASS": 1},
}
RANGES = (("KPUMIN", "KPUMAX"), ("ALPMIN", "ALPMAX"), ("CAMMIN", "CAMMAX"), ("FZMIN", "FZMAX"))
# What the handbooks take when a file does not say it.
USUAL_RANGE = {"KPUMIN": -1.5, "KPUMAX": 1.5, "ALPMIN": -1.5708, "ALPMAX": 1.5708}
POSITIVE = ("FNOMIN", "UNLOADED_RADIUS", "LFZO", "LMUX", "LMUY", "VERTICAL_STIFFNESS", "LONGVL")
NOT_NEGATIVE = ("VERTICAL_DAMPING",)
# In SI; what lies beyond is written in another unit than the file says.
EXTENT = {
    "UNLOADED_RADIUS": (0.05, 3.0, " m", "correct it, or LENGTH in [UNITS]"),  # of a model car, of a dump truck
    "FNOMIN": (20.0, 1e6, " N", "correct it, or FORCE in [UNITS]"),
    **dict.fromkeys(("ALPMIN", "ALPMAX", "CAMMIN", "CAMMAX"), (-1.6, 1.6, " rad", "give it in radians")),
    **dict.fromkeys(("KPUMIN", "KPUMAX"), (-10.0, 10.0, "", "give it as a ratio: 1 is 100 %")),
}
MOST_FRICTION = 5.0  # [1] of any tyre; those of racing cars have 2
LARGEST_SHIFT = 0.2  # [rad] of side-slip without force; those of the files that we know are below 0.01
# Divisors of the formula, or its slope.
NOT_ZERO = ("PCX1", "PDX1", "PKX1", "PCY1", "PDY1", "PKY1", "PKY2", "LCX", "LCY", "LKY")


def fields(pattern: str) -> tuple[str, ...]:
    """Coefficients of the model whose names match."""
    return tuple(name for name in Tyre._fields if re.fullmatch(pattern, name))


@dataclass(frozen=True)
class Group:
    """Coefficients that go together; `optional` ones are 0 when absent, `without` says what a tyre lacks then."""

    title: str
    section: str
    names: tuple[str, ...]
    without: str = ""
    optional: tuple[str, ...] = ()


SCALING = fields("L[A-Z]+")
GROUPS = (
    Group("load and size", "VERTICAL", ("FNOMIN",)),
    Group("load and size", "DIMENSION", ("UNLOADED_RADIUS",)),
    Group("pure longitudinal slip", "LONGITUDINAL_COEFFICIENTS", fields(r"P.X\d"), optional=("PDX3",)),
    Group("pure lateral slip", "LATERAL_COEFFICIENTS", fields(r"P.Y\d")),
    Group("combined longitudinal slip", "LONGITUDINAL_COEFFICIENTS", fields(r"R.X\d"), "side-slip does not reduce F_x"),
    Group("combined lateral slip", "LATERAL_COEFFICIENTS", fields(r"R.Y\d"), "longitudinal slip does not change F_y"),
    Group("the aligning moment", "ALIGNING_COEFFICIENTS", fields(r"Q.Z\d+"), "no trail, no residual moment", ("QBZ10",)),
    Group("the moment arm of F_x", "ALIGNING_COEFFICIENTS", fields(r"SSZ\d"), "F_x makes no aligning moment"),
)  # fmt: skip
HOME = {
    **{name: group.section for group in GROUPS for name in group.names},
    **dict.fromkeys(SCALING, "SCALING_COEFFICIENTS"),
    **dict.fromkeys(("VERTICAL_STIFFNESS", "VERTICAL_DAMPING"), "VERTICAL"),
    **dict.fromkeys(("WIDTH", "ASPECT_RATIO", "RIM_RADIUS", "RIM_WIDTH"), "DIMENSION"),
    **dict.fromkeys(("LONGVL", "VXLOW", "FITTYP", "PROPERTY_FILE_FORMAT", "TYRESIDE"), "MODEL"),
    **dict.fromkeys(RANGES[0], "LONG_SLIP_RANGE"),
    **dict.fromkeys(RANGES[1], "SLIP_ANGLE_RANGE"),
    **dict.fromkeys(RANGES[2], "INCLINATION_ANGLE_RANGE"),
    **dict.fromkeys(RANGES[3], "VERTICAL_FORCE_RANGE"),
    **dict.fromkeys(UNITS, "UNITS"),
}
TEXTS = ("PROPERTY_FILE_FORMAT", "TYRESIDE", *UNITS)


@dataclass(frozen=True)
class PropertyFile:
    """A tyre property file that was read.

    values    every number by its key, in SI; what the notes name as assumed is filled in
    side      which side of a vehicle it was measured for: left, right or symmetric; on the other side
              alpha, gamma, F_y and M_z change their signs
    notes     what was assumed, and what of the file is not used
    sections  what stands in the file, section by section: numbers as written, and texts
    """

    name: str
    values: dict[str, float]
    side: str
    notes: tuple[str, ...]
    sections: dict[str, dict[str, float | str]]

    @property
    def size(self) -> str:
        """Size as on the sidewall, such as 245/40 R18: width [mm], height in % of it, rim [inch]; empty if not given."""
        if not {"WIDTH", "ASPECT_RATIO", "RIM_RADIUS"} <= self.values.keys():
            return ""
        width, ratio, rim = (self.values[key] for key in ("WIDTH", "ASPECT_RATIO", "RIM_RADIUS"))
        return f"{width * 1e3:.0f}/{ratio * 100:.0f} R{round(4.0 * rim / INCH) / 2.0:g}"


def read(path: Path) -> PropertyFile:
    """The tyre property file at a path; raises ScenarioError that lists everything that is wrong with it."""
    sheet = Sheet(path.name, entries(content(path), path.name))
    check_family(sheet)
    values, notes = complete(sheet, in_si(sheet))
    check_values(sheet, values)
    check_directions(sheet, values)
    return PropertyFile(path.name, values, side(sheet), tuple(sheet_notes(sheet) + notes + load_notes(values)), sheet.sections())


def coefficients(file: PropertyFile, wanted: Iterable[str] = Tyre._fields) -> list[float]:
    """The wanted numbers in their order; raises ScenarioError that names those which are not in the file."""
    wanted = list(wanted)
    problems = [missing(file.name, key) for key in wanted if key not in file.values]
    refuse(file.name, problems, "lacks numbers that are needed here")
    return [file.values[key] for key in wanted]


# --- from bytes to entries ---------------------------------------------------------------------------------------------


def content(path: Path) -> str:
    """Text of a file, UTF-8 or Latin-1."""
    data, what = opened(path), ""
    if len(data) > SIZE_LIMIT:
        what = "is too large"
    elif b"\0" in data:
        what = "is not a text file"
    elif not data.strip():
        what = "is empty"
    if what:
        allowed = f"a text of at most {SIZE_LIMIT} bytes, UTF-8 or Latin-1"
        refuse(path.name, [Problem(str(path), what, allowed=allowed)])
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def opened(path: Path) -> bytes:
    """The first bytes of a file, one more than are allowed."""
    try:
        if not path.is_file():
            others = [other.name for other in path.parent.glob("*.tir")] if path.parent.is_dir() else []
            refuse(path.name, [Problem(str(path), "is no file", remedy=nearest(path.name, others))])
        with path.open("rb") as file:
            return file.read(SIZE_LIMIT + 1)
    except OSError as error:
        problem = Problem(str(path), f"cannot be opened: {error.strerror}")
        raise ScenarioError(f"{path.name} cannot be read.", [problem]) from None


@dataclass(frozen=True)
class Entry:
    """One `KEY = value` of a file: where it stands, its number or its text."""

    section: str
    key: str
    line: int
    text: str
    value: float | None

    @property
    def said(self) -> float | str:
        """Its number, or its text without regard to case."""
        return self.text.lower() if self.value is None else self.value

    def where(self, name: str) -> str:
        """Its place for a message."""
        return f"{name}, line {self.line}, [{self.section}] {self.key}"


def entries(text: str, name: str) -> list[Entry]:
    """All entries of a text; raises ScenarioError with the lines that are none."""
    found, problems = [], []
    section, in_table = "", False
    for number, raw in enumerate(text.splitlines(), start=1):
        line = without_comment(raw)
        if line.startswith("[") and line.endswith("]"):
            section, in_table = line[1:-1].strip().upper(), False
        elif line[:1] in ("{", "("):
            in_table = True
        elif match := KEY.fullmatch(line):
            found.append(entry(section, match[1].upper(), number, match[2].strip()))
        elif line and not in_table and line[0] not in QUOTES:
            problems.append(Problem(f"{name}, line {number}", "cannot be read", short(line), SYNTAX))
    if not any(each.section for each in found):
        problems = [Problem(name, "has no section with values", allowed="such as [LATERAL_COEFFICIENTS]")]
    problems += [each for entry_ in found for each in entry_problems(entry_, name)] + repeated(found, name)
    refuse(name, problems)
    return found


def without_comment(line: str) -> str:
    """A line up to its first `$` or `!` outside quotes."""
    quote = ""
    for i, character in enumerate(line):
        if quote:
            quote = "" if character == quote else quote
        elif character in QUOTES:
            quote = character
        elif character in "$!":
            return line[:i].strip()
    return line.strip()


def entry(section: str, key: str, line: int, text: str) -> Entry:
    """An entry; its value is None where the text is no number."""
    plain = text.strip(QUOTES).strip()
    value = float(plain.upper().replace("D", "E")) if NUMBER.fullmatch(plain) else None
    return Entry(section, key, line, plain, value)


def entry_problems(entry: Entry, name: str) -> list[Problem]:
    """What is wrong with an entry by itself: a known key must have a finite number."""
    if entry.key in TEXTS or (entry.key not in HOME and entry.value is None):
        return []
    if entry.value is None:
        allowed = "a number with a decimal point, such as 1.25 or 1.0E-3"
        return [Problem(entry.where(name), "is not a number", short(entry.text) or "nothing", allowed)]
    if abs(entry.value) > LARGEST:
        return [Problem(entry.where(name), "is too large", short(entry.text), f"at most {LARGEST:g}")]
    return []


def repeated(found: list[Entry], name: str) -> list[Problem]:
    """Keys that stand in one section with different values."""
    first: dict[tuple[str, str], Entry] = {}
    problems = []
    for each in found:
        earlier = first.setdefault((each.section, each.key), each)
        if earlier.said != each.said:
            what = f"stands already in line {earlier.line} as {short(earlier.text)}"
            problem = Problem(each.where(name), what, short(each.text), "one value", "remove one of them")
            problems.append(problem)
    return problems


class Sheet:
    """The entries of a file, found by key: a key's own section comes first."""

    def __init__(self, name: str, found: list[Entry]):
        self.name = name
        self.by_key: dict[str, list[Entry]] = defaultdict(list)
        for each in found:
            self.by_key[each.key].append(each)
        refuse(name, [problem for key in self.by_key for problem in self.ambiguous(key)])

    def candidates(self, key: str) -> list[Entry]:
        """Entries of a key in its own section, or in all when it is not there; units stand in [UNITS] only."""
        everywhere = self.by_key.get(key, [])
        own = [each for each in everywhere if each.section == HOME.get(key)]
        return own if own or key in UNITS else everywhere

    def ambiguous(self, key: str) -> list[Problem]:
        """A key that the model knows, outside its own section, with several values."""
        found = self.candidates(key)
        if key not in HOME or len({each.said for each in found}) < 2:
            return []
        places = ", ".join(f"[{each.section}] line {each.line}" for each in found)
        what, allowed = f"{key} has several values", f"one, in [{HOME[key]}]"
        return [Problem(self.name, what, places, allowed, "remove the others")]

    def find(self, key: str) -> Entry | None:
        """The entry of a key."""
        found = self.candidates(key)
        return found[0] if found else None

    def text(self, key: str) -> str:
        """Text of a key, empty when it is not there."""
        found = self.find(key)
        return found.text if found else ""

    def number(self, key: str, default: float = 0.0) -> float:
        """Number of a key as it is written."""
        found = self.find(key)
        return default if found is None or found.value is None else found.value

    def where(self, key: str) -> str:
        """Place of a key for a message."""
        found = self.find(key)
        return found.where(self.name) if found else f"{self.name}, [{HOME.get(key, '')}] {key}"

    def problem(self, key: str, what: str, allowed: str = "", remedy: str = "") -> Problem:
        """What is wrong with the value of a key."""
        return Problem(self.where(key), what, short(self.text(key)), allowed, remedy)

    def matching(self, pattern: re.Pattern) -> list[str]:
        """Keys that match and are not zero."""
        return [key for key in self.by_key if pattern.fullmatch(key) and self.number(key)]

    def sections(self) -> dict[str, dict[str, float | str]]:
        """What stands in each section."""
        plain: dict[str, dict[str, float | str]] = defaultdict(dict)
        for found in self.by_key.values():
            for each in found:
                plain[each.section][each.key] = each.text if each.value is None else each.value
        return dict(plain)


# --- which formula -----------------------------------------------------------------------------------------------------


def check_family(sheet: Sheet) -> None:
    """Refuses what is not MF 5.2: other models, MF 6.x, terms that 5.2 does not have."""
    problems = format_problems(sheet) or terms_of_6(sheet) + pressure_problems(sheet)
    refuse(sheet.name, problems, "is not a tyre of the Magic Formula 5.2")


def format_problems(sheet: Sheet) -> list[Problem]:
    """PROPERTY_FILE_FORMAT and FITTYP must say 5.2."""
    family = sheet.text("PROPERTY_FILE_FORMAT").upper()
    fit = sheet.find("FITTYP")
    if family and family not in FORMATS_OF_52 + FORMATS_WITH_FITTYP:
        return [sheet.problem("PROPERTY_FILE_FORMAT", "is another tyre model", ACCEPTED, CONVERT)]
    if fit and 60 <= (fit.value or 0.0) < 70:
        what = "is MF-Tyre 6.x; 5.2 lacks its terms of inflation pressure (PP.., QPZ.), stiffness and camber"
        return [sheet.problem("FITTYP", what, ACCEPTED, CONVERT)]
    if fit and fit.value not in FITS:
        return [sheet.problem("FITTYP", "is a version that is not known here", ACCEPTED, CONVERT)]
    if not fit and family not in FORMATS_OF_52:
        remedy = "add FITTYP = 6 there if this is a set of MF 5.2"
        what = "is missing: the file does not say which formula it is"
        return [sheet.problem("FITTYP", what, ACCEPTED, remedy)]
    return []


def terms_of_6(sheet: Sheet) -> list[Problem]:
    """Terms of MF 6.x that are not zero."""
    what = "is a term of MF-Tyre 6.x, which MF 5.2 does not have"
    return [sheet.problem(key, what, "0, or absent", CONVERT) for key in sheet.matching(TERMS_OF_6)]


def pressure_problems(sheet: Sheet) -> list[Problem]:
    """Terms of inflation pressure, when the file asks for another pressure than its nominal one."""
    terms = sheet.matching(TERMS_OF_PRESSURE)
    for actual, nominal in PRESSURES:
        pressure, reference = sheet.number(actual) * sheet.number("LIP", 1.0), sheet.number(nominal)
        if terms and pressure and reference and abs(pressure / reference - 1.0) > 1e-6:
            what = f"differs from {nominal}, and MF 5.2 lacks the terms of pressure ({', '.join(terms)})"
            return [sheet.problem(actual, what, sheet.text(nominal), CONVERT)]
    return []


def side(sheet: Sheet) -> str:
    """Side that the tyre was measured for; left when the file does not say, as is usual."""
    return sheet.text("TYRESIDE").lower() or "left"


def sheet_notes(sheet: Sheet) -> list[str]:
    """What was assumed about the file as a whole."""
    notes = []
    absent = [quantity for quantity in UNITS if not sheet.find(quantity)]
    if absent:
        notes.append(f"[UNITS] does not give {', '.join(absent)}: SI taken")
    if not sheet.find("TYRESIDE"):
        notes.append("[MODEL] does not give TYRESIDE: left taken")
    if sheet.number("FITTYP") == 5:
        notes.append("FITTYP 5 (MF-Tyre 5.0 and 5.1): computed with the equations of 5.2")
    if sheet.number("USE_MODE") < 0:
        notes.append("USE_MODE asks for a mirrored tyre: not used, the tyre stands as measured")
    if terms := sheet.matching(TERMS_OF_PRESSURE):
        notes.append(f"{', '.join(terms)}: not used, the inflation pressure is taken as the nominal one")
    if unused := [key for key in sheet.by_key if key not in HOME and scales(sheet, key)]:
        notes.append(f"scaling factors {', '.join(unused)} differ from 1 and are not used")
    return notes


def scales(sheet: Sheet, key: str) -> bool:
    """Whether a key is a scaling factor that is not 1."""
    found = sheet.find(key)
    return key.startswith("L") and found is not None and found.section == HOME["LFZO"] and sheet.number(key, 1.0) != 1.0


# --- into SI, and complete ---------------------------------------------------------------------------------------------


def in_si(sheet: Sheet) -> dict[str, float]:
    """Every number by its key, in SI."""
    factors, problems = {}, []
    for quantity, known in UNITS.items():
        name = sheet.text(quantity).lower()
        factors[quantity] = known.get(name or next(iter(known)), 0.0)
        if not factors[quantity]:
            problems.append(unit_problem(sheet, quantity, name))
    refuse(sheet.name, problems)
    numbers = {key: sheet.find(key) for key in sheet.by_key if key not in UNITS}
    given = {key: each.value for key, each in numbers.items() if each and each.value is not None}
    return {key: value * si_factor(key, factors) for key, value in given.items()}


def unit_problem(sheet: Sheet, quantity: str, name: str) -> Problem:
    """A unit that is not known; degrees have their own reason."""
    allowed = ", ".join(UNITS[quantity])
    if quantity == "ANGLE" and name in DEGREES:
        what = "leaves open whether coefficients such as PKY1, PHY1 and QBZ1 were fitted per degree or per radian"
        return sheet.problem(quantity, what, allowed, "give the file in radians")
    return sheet.problem(quantity, "is a unit that is not known here", allowed, nearest(name, UNITS[quantity]))


def si_factor(key: str, factors: dict[str, float]) -> float:
    """What turns the number of a key into SI."""
    factor = 1.0
    for quantity, exponent in EXPONENTS.get(key, {}).items():
        factor *= factors[quantity] ** exponent
    return factor


def complete(sheet: Sheet, values: dict[str, float]) -> tuple[dict[str, float], list[str]]:
    """The values with what a file may leave out, and notes of that; raises ScenarioError for what it may not."""
    notes, problems = [], []
    values = dict(values)
    for group in GROUPS:
        absent = [name for name in group.names if name not in values]
        if group.without and len(absent) == len(group.names):
            notes.append(f"no coefficients of {group.title}: {group.without}")
            values |= dict.fromkeys(absent, 0.0)
            continue
        optional = [name for name in absent if name in group.optional]
        if optional:
            notes.append(f"{', '.join(optional)} not given: 0 taken")
            values |= dict.fromkeys(optional, 0.0)
        problems += [missing(sheet.name, name, group) for name in absent if name not in group.optional]
    refuse(sheet.name, problems, "lacks coefficients")
    notes += fill(values, dict.fromkeys(SCALING, 1.0), "scaling factors")
    notes += fill(values, USUAL_RANGE, "limits")
    return values, notes


def fill(values: dict[str, float], defaults: dict[str, float], title: str) -> list[str]:
    """Puts defaults where there is no value; the note about them."""
    absent = {key: value for key, value in defaults.items() if key not in values}
    values |= absent
    if not absent:
        return []
    if len(set(absent.values())) == 1:
        return [f"{title} {', '.join(absent)} not given: {next(iter(absent.values())):g} taken"]
    return [f"{title} not given: {', '.join(f'{key} = {value:g}' for key, value in absent.items())} taken"]


def missing(name: str, key: str, group: Group | None = None) -> Problem:
    """A number that is needed and not there."""
    what = f"{key} is missing"
    if group and group.without:
        what += f", while other coefficients of {group.title} are there"
    may_be_0 = group and key[0] in "PQRS" and key not in NOT_ZERO
    remedy = "add it; 0 switches its term off" if may_be_0 else "add it"
    return Problem(f"{name}, [{HOME.get(key, 'any section')}]", what, remedy=remedy)


def check_values(sheet: Sheet, values: dict[str, float]) -> None:
    """Refuses numbers that no tyre has."""
    signs = (
        ("> 0", POSITIVE, lambda value: value > 0.0),
        ("≥ 0", NOT_NEGATIVE, lambda value: value >= 0.0),
        ("not 0", NOT_ZERO, lambda value: value != 0.0),
    )
    problems = [
        sheet.problem(key, "is out of range", allowed, "correct it")
        for allowed, keys, holds in signs
        for key in keys
        if key in values and not holds(values[key])
    ]
    problems += [
        sheet.problem(low, f"is not below {high}", f"< {sheet.text(high) or f'{values[high]:g}'}", "correct one of them")
        for low, high in RANGES
        if low in values and high in values and not values[low] < values[high]
    ]
    problems += [
        sheet.problem(key, f"is {values[key]:g}{unit}, as no tyre has it", f"{low:g} to {high:g}{unit}", remedy)
        for key, (low, high, unit, remedy) in EXTENT.items()
        if key in values and not low <= values[key] <= high and (key not in POSITIVE or values[key] > 0.0)
    ]
    if side(sheet) not in SIDES:
        problems.append(sheet.problem("TYRESIDE", "is not a side", ", ".join(SIDES)))
    refuse(sheet.name, problems)


def check_directions(sheet: Sheet, values: dict[str, float]) -> None:
    """Refuses a tyre whose forces point the wrong way at nominal load: by its slopes at small slip (Pacejka 2006, 4.E25, 4.E15)

    K_y = PKY1 F_z0 sin(2 atan(F_z / (PKY2 F_z0))) LKY    below 0 in the axes of the formula: side force against side-slip
    K_x = PKX1 F_z LKX                                    above 0: drive for turning faster than rolling

    or farther out, since D sin(C atan(…)) + S_V keeps its sign for 0 < C ≤ 2, D > 0 and |S_V| < D; and the trail D_t holds the wheel
    straight if it is not below 0.
    """
    problems = []
    if values["PKY1"] * values["PKY2"] * values["LKY"] > 0.0:
        what = "turns the side force round: PKY1 · PKY2 · LKY, the sign of the cornering stiffness, is above 0"
        problems.append(sheet.problem("PKY1", what, "below 0", "change its sign if the set is for axes in which the stiffness is positive"))
    if values["PKX1"] * values["LKX"] <= 0.0:
        turned = "turns the longitudinal force round" if values["LKX"] else "leaves no longitudinal force"
        what = f"{turned}: PKX1 · LKX, the sign of the slip stiffness, is not above 0"
        problems.append(sheet.problem("PKX1", what, "above 0", "change its sign if the set counts slip the other way"))
    for axis, force in (("X", "longitudinal force"), ("Y", "side force")):
        problems += shape_problems(sheet, values, axis, force)
    if values["QDZ1"] * values["LTR"] < 0.0:
        what = "turns the aligning moment round: QDZ1 · LTR, the sign of the pneumatic trail, is below 0"
        problems.append(sheet.problem("QDZ1", what, "0 or above", "change its sign"))
    refuse(sheet.name, problems)


def shape_problems(sheet: Sheet, values: dict[str, float], axis: str, force: str) -> Iterator[Problem]:
    """What is wrong with the shape of a force over its slip at nominal load: C, D, and the shifts S_V and, of side-slip, S_H."""
    C, D = values[f"PC{axis}1"] * values[f"LC{axis}"], values[f"PD{axis}1"]
    if not 0.0 < C <= 2.0:
        what = f"turns the {force} round at large slip: C = PC{axis}1 · LC{axis} is {C:g}"
        yield sheet.problem(f"PC{axis}1", what, "above 0, up to 2", "correct it")
    if not 0.0 < D <= MOST_FRICTION:
        remedy = "correct it" if D > 0.0 else "change its sign"
        yield sheet.problem(f"PD{axis}1", f"is the friction of the {force} at nominal load", f"above 0, up to {MOST_FRICTION:g}", remedy)
    elif abs(shift := values[f"PV{axis}1"] * values[f"LV{axis}"]) >= D:
        what = f"makes a {force} of one direction whatever the slip: PV{axis}1 · LV{axis} is {shift:g}"
        yield sheet.problem(f"PV{axis}1", what, f"within ±{D:g}, the friction PD{axis}1", "correct it")
    if axis == "Y" and abs(values["PHY1"] * values["LHY"]) > LARGEST_SHIFT:
        what = "shifts the side-slip farther than any tyre does"
        yield sheet.problem("PHY1", what, f"within ±{LARGEST_SHIFT:g} rad", "correct it; an angle in degrees is too large")


def load_notes(values: dict[str, float]) -> list[str]:
    """Loads of the file's own range at which a friction or the slip stiffness is no longer above 0: linear in the load, so at its ends."""
    nominal = values["FNOMIN"] * values["LFZO"]
    ends = [values[key] for key in ("FZMIN", "FZMAX") if key in values]
    pairs = (("PDX1", "PDX2", "friction along"), ("PDY1", "PDY2", "friction across"), ("PKX1", "PKX2", "slip stiffness"))
    return [
        f"{first}, {second}: the {what} is not above 0 at {load:g} N, within FZMIN and FZMAX"
        for first, second, what in pairs
        for load in ends
        if values[first] > 0.0 >= values[first] + values[second] * (load - nominal) / nominal
    ]


def refuse(name: str, problems: list[Problem], what: str = "cannot be used as a tyre") -> None:
    """Raises ScenarioError when there are problems; shows the first of many."""
    if problems:
        more = f" The first {MOST} of {len(problems)} problems:" if len(problems) > MOST else ""
        raise ScenarioError(f"{name} {what}.{more}", problems[:MOST])


def short(text: str) -> str:
    """A value that fits into a message."""
    return text if len(text) <= SHOWN else text[: SHOWN - 1] + "…"

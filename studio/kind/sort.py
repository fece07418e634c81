"""Sorts of kinds, and what a file must hold to be one: the contracts, part by part.

Every file of a kind says `KIND = "sensor"` (or another sort), has a docstring that tells its source, a `TITLE` for people, and the
parts below. What is optional may be left out. `problems` finds everything that does not fit.
"""

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from inspect import Parameter, signature
from pathlib import Path
from types import ModuleType
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic_core import PydanticUndefined

from studio.application import port
from studio.errors import Problem
from studio.kind import preset
from studio.kind.driver import Driver
from studio.kind.metric import Scope
from studio.kind.number import unplain
from studio.kind.quantity import quantities
from studio.kind.sensor import Sensor
from studio.kind.settings import Nested, marks, named

ENDING = re.compile(r"/?\.[a-z0-9_]+")
Test = Callable[[Any], str]  # what is wrong with a part; "" when it fits


@dataclass(frozen=True)
class Need:
    """A part of a kind's file: what it is, how it is written, whether it may be left out."""

    name: str
    meaning: str
    test: Test
    example: str
    optional: bool = False


def fits(_value: Any) -> str:
    """Whatever it is."""
    return ""


def text(value: Any) -> str:
    """A line for people."""
    return "" if isinstance(value, str) and value.strip() and "\n" not in value else f"is {value!r}, not a line of text"


def count(value: Any) -> str:
    """A whole number from 1 on."""
    return "" if isinstance(value, int) and not isinstance(value, bool) and 1 <= value <= 10_000 else f"is {value!r}, not 1 to 10000"


def direction(value: Any) -> str:
    """Which values of a metric are better."""
    return "" if value in ("lower", "higher", None) else f'is {value!r}; allowed: "lower", "higher", None'


def settings(value: Any) -> str:
    """A pydantic model whose fields all have first values."""
    if not (isinstance(value, type) and issubclass(value, BaseModel)):
        return f"is {value!r}, not a pydantic model"
    try:
        value()
    except ValidationError as error:
        first = error.errors()[0]
        return f"has no valid first value for {'.'.join(map(str, first['loc'])) or 'itself'}: {first['msg']}"
    return next((f"{name}: {what}" for name, field in value.model_fields.items() if (what := unlabelled(field))), "")


def person(value: Any) -> str:
    """Settings of a driver: numbers, and those that every driver has."""
    if what := settings(value):
        return what
    if not issubclass(value, Driver):
        return "is no Driver: write class Settings(Driver), with Driver from studio.kind.driver"
    return unplain(value)


def watch(value: Any) -> str:
    """Settings of a sensor: numbers, and those that every sensor has."""
    if what := settings(value):
        return what
    if not issubclass(value, Sensor):
        return "is no Sensor: write class Settings(Looking), or class Settings(Sensor), from studio.kind.sensor"
    return unplain(value)


def scope(value: Any) -> str:
    """Settings of a metric: those that every metric has, and perhaps more."""
    if what := settings(value):
        return what
    return "" if issubclass(value, Scope) else "is no Scope: write class Settings(Scope), with Scope from studio.kind.metric"


def measuring(module: ModuleType) -> str:
    """A metric with settings of its own is given them."""
    measure, has = getattr(module, "measure", None), hasattr(module, "Settings")
    given = len(signature(measure).parameters) if callable(measure) else 0
    if given == 2 and not has:
        return "measure(record, settings) has no Settings"
    return "measure(record) does not take the Settings" if given == 1 and has else ""


def either(*choices: Test) -> Test:
    """One of several; what is wrong is told of the first."""
    return lambda value: "" if any(not test(value) for test in choices) else choices[0](value)


def needy(value: Any) -> str:
    """A pydantic model whose fields may have to be given."""
    if not (isinstance(value, type) and issubclass(value, BaseModel)):
        return f"is {value!r}, not a pydantic model"
    return next((f"{name}: {what}" for name, field in value.model_fields.items() if (what := unlabelled(field))), "")


def plain(value: Any) -> str:
    """A pydantic model of plain numbers with first values."""
    return settings(value) or unplain(value)


def endings(value: Any) -> str:
    """Endings of files in small letters, or of those in a folder."""
    is_fine = isinstance(value, tuple) and value and all(isinstance(each, str) and ENDING.fullmatch(each) for each in value)
    return "" if is_fine else f'is {value!r}; allowed: (".csv", ".tsv"), or ("/.npy",) for a folder of such files'


def content(value: Any) -> str:
    """The bytes of a file."""
    return "" if isinstance(value, bytes) and value else f"is {type(value).__name__}, not bytes"


def flat(value: Any) -> str:
    """A NamedTuple of single numbers with units."""
    if what := record(value):
        return what
    wide = [each.name for each in quantities(value) if each.size > 1]
    return f"{wide[0]} is a tuple; a field for each number is meant" if wide else ""


def waited(value: Any) -> str:
    """A pydantic model of plain numbers, whose fields may have to be given."""
    return needy(value) or unplain(value)


def asked_or_joined(module: ModuleType) -> str:
    """A condition is asked itself, or joins others that stand in its settings."""
    fields = getattr(module, "Settings", BaseModel).model_fields.values()
    is_around, joins, holds = any(marks(field, Nested) for field in fields), hasattr(module, "joins"), hasattr(module, "holds")
    if joins == holds:
        return "has both holds and joins" if joins else "has neither holds nor joins"
    return "" if joins == is_around else "joins no conditions" if joins else "has conditions in it, and no joins"


def told_and_done(module: ModuleType) -> str:
    """An action commands a vehicle, or does something to the road."""
    if not hasattr(module, "act"):
        return "" if hasattr(module, "effects") else "has neither act nor effects"
    settings = getattr(module, "Settings", BaseModel)
    if unplain(settings):
        return f"Settings: {unplain(settings)}"
    field = settings.model_fields.get("vehicle")
    return "" if field and named(field) == "vehicle" else "has act, but no vehicle that it is about"


def unlabelled(field: Any) -> str:
    """Numbers have a unit: what a form shows without one is a riddle."""
    extra = field.json_schema_extra if isinstance(field.json_schema_extra, dict) else {}
    is_number = field.annotation is float or (field.default is not PydanticUndefined and type(field.default) is float)
    return 'is a number without unit: write number(1.0, unit="m", title="...")' if is_number and not extra.get("unit") else ""


def record(value: Any) -> str:
    """A NamedTuple of numbers with units."""
    if not (isinstance(value, type) and issubclass(value, tuple) and hasattr(value, "_fields")):
        return f"is {value!r}, not a NamedTuple"
    try:
        without = [each.name for each in quantities(value) if not each.unit and not each.is_flag]
    except (TypeError, NameError) as error:
        return str(error)
    return f'{without[0]} has no unit: write {without[0]}: Annotated[float, "m"] = 0.0' if without else ""


def remembered(value: Any) -> str:
    """A NamedTuple of numbers; one without fields remembers nothing."""
    if what := bundle(value):
        return what
    try:
        quantities(value)
    except (TypeError, NameError) as error:
        return str(error)
    return ""


def mask(value: Any) -> str:
    """A sum of bits."""
    return "" if isinstance(value, int) and not isinstance(value, bool) and 0 < value < 256 else f"is {value!r}, no actuators"


def yes(value: Any) -> str:
    """What is said of a kind by being there."""
    return "" if value is True else f"is {value!r}; leave it out where it is not so"


def hands(value: Any) -> str:
    """Pedals, wheel, or both."""
    return "" if value in (1, 2, 3) and not isinstance(value, bool) else f"is {value!r}; allowed: PEDALS, WHEEL, PEDALS | WHEEL"


def sentences(value: Any) -> str:
    """Lines for a driver."""
    is_fine = isinstance(value, tuple) and value and all(isinstance(each, str) and each.strip() for each in value)
    return "" if is_fine else f"is {value!r}, no sentences"


def bundle(value: Any) -> str:
    """A NamedTuple; its fields are looked at where ports are."""
    is_one = isinstance(value, type) and issubclass(value, tuple) and hasattr(value, "_fields")
    return "" if is_one else f"is {value!r}, not a NamedTuple"


def function(*names: str, compiled: bool = False) -> Test:
    """A function with these arguments."""

    def test(value: Any) -> str:
        plain = getattr(value, "py_func", value)
        if not callable(plain) or isinstance(plain, type):
            return f"is {value!r}, not a function"
        given = [each.name for each in signature(plain).parameters.values() if each.kind is not Parameter.VAR_KEYWORD]
        if len(given) != len(names):
            return f"takes ({', '.join(given)}); it is called with ({', '.join(names)})"
        if compiled and not hasattr(value, "py_func"):
            return "is not compiled: write @compiled (from studio.compiled) above it"
        return ""

    return test


def compiled_function(value: Any) -> str:
    """A compiled function; what it takes hangs on other parts."""
    return "" if hasattr(value, "py_func") else "is not compiled: write @compiled (from studio.compiled) above it"


def radio_parts(module: ModuleType) -> str:
    """What the parts of a radio are together: what remembers, and what it remembers."""
    if what := lacking(module, "Control", "control", "airtime") or lacking(module, "Cell", "admit") or lacking(module, "Around", "place"):
        return what
    if what := preset.unfit(module) or (hasattr(module, "admit") and hasattr(module, "wait") and "has both admit and wait"):
        return what
    arguments = ("settings", "way", "draw", *(["memory"] if hasattr(module, "Memory") else []))
    found = getattr(module, "transmit", None)
    return f"transmit {what}" if found and (what := function(*arguments)(found)) else ""


def message_parts(module: ModuleType) -> str:
    """What the parts of a message are together: what is due is a beacon, and remembers what it has sent."""
    if what := lacking(module, "Settings", "beacon") or lacking(module, "Memory", "due", "beacon"):
        return what
    arguments = ("own", "settings", *(["memory"] if hasattr(module, "Memory") else []))
    found = getattr(module, "beacon", None)
    return f"beacon {what}" if found and (what := function(*arguments)(found)) else ""


def lacking(module: ModuleType, part: str, partner: str, *others: str) -> str:
    """What is missing of two parts that come together, and of others that both need; "" when nothing is, or none is there."""
    if not hasattr(module, part) and not hasattr(module, partner):
        return ""
    missing = [each for each in (part, partner, *others) if not hasattr(module, each)]
    return f"has {partner if missing[0] == part else part}, but no {missing[0]}" if missing else ""


TITLE = Need("TITLE", "one line for people", text, 'TITLE = "Side radar"')
UNIT = Need("UNIT", "of the values", text, 'UNIT = "m"')


@dataclass(frozen=True)
class Sort:
    """A sort of kinds: its name, what it does, the parts of its files."""

    name: str
    does: str
    needs: tuple[Need, ...]
    whole: Test = fits  # what its parts must be together
    remedy: str = ""
    usual: type[BaseModel] | None = None  # what is set of a kind without Settings
    is_run: bool = True  # whether scenarios and their runs use it


SORTS = {
    each.name: each
    for each in (
        Sort("sensor", "measures what is around a unit", (
            TITLE,
            Need("Settings", "what is set per sensor, with unit and range", watch, "class Settings(Looking): ..."),
            Need("PRESETS", "named sets of settings, with their sources", preset.wrong, 'PRESETS = {"far": Preset(...)}', optional=True),
            Need("Reading", "what one target, or the one reading, consists of", flat, "class Reading(NamedTuple): ..."),
            Need("CAPACITY", "how many targets it gives at most; 1 when left out", count, "CAPACITY = 4", optional=True),
            Need("Memory", "what it remembers from tick to tick", record, "class Memory(NamedTuple): ...", optional=True),
            Need("measure", "one sensor at one tick: reports its targets, returns how many; with a Memory: how many, Memory(...)",
                 function("view", "me", "settings", "memory", "out", compiled=True), "def measure(view, me, settings, memory, out)"),
        ), preset.unfit, "give values that the Settings take"),
        Sort("radio", "decides which messages arrive, and when", (
            TITLE,
            Need("Settings", "what is set for all units of a scenario", plain, "class Settings(Part): ..."),
            Need("PRESETS", "named sets of settings, with their sources", preset.wrong, 'PRESETS = {"urban": Preset(...)}', optional=True),
            Need("longest", "the longest delay [s] that the settings allow", function("settings"), "def longest(settings)"),
            Need("reach", "the distance [m] beyond which nothing is heard", function("settings"), "def reach(settings)"),
            Need("largest", "the largest message [bytes]", function("settings"), "def largest(settings)"),
            Need("transmit", "one message on its way to one receiver: Transmission(lost, delay); with a Memory also Memory(...). Asked "
                 "without buildings first, and again with them unless it is TOO_WEAK or OUT_OF_RANGE already",
                 compiled_function, "def transmit(settings, way, draw)"),
            Need("Memory", "what it remembers of one link from message to message", record, "class Memory(NamedTuple): ...", optional=True),
            Need("airtime", "how long [s] a message of `size` bytes keeps the channel busy; left out: no channel is ever busy",
                 function("settings", "size", compiled=True), "def airtime(settings, size)", optional=True),
            Need("heard_within", "the distance [m] within which a message keeps the channel busy; left out: reach", function("settings"),
                 "def heard_within(settings)", optional=True),
            Need("minds_walls", "whether walls between two antennas count with these settings; left out: they do", function("settings"),
                 "def minds_walls(settings)", optional=True),
            Need("table", "numbers that are worked out once of the settings, as many for all: `way.table`", function("settings"),
                 "def table(settings)", optional=True),
            Need("Around", "what it keeps of what is around a unit, so that it need not be worked out anew", record,
                 "class Around(NamedTuple): ...", optional=True),
            Need("place", "one number of the place of a unit, the same for all messages: `way.from_place`, `way.to_place`; and Around(...)",
                 function("settings", "spot", "around", compiled=True), "def place(settings, spot, around)", optional=True),
            Need("wait", "how long [s] a message waits before it goes out, the same for all who hear it: `way.wait`",
                 function("settings", "sent", "draw", compiled=True), "def wait(settings, sent, draw)", optional=True),
            Need("Control", "what the congestion control of one unit remembers", record, "class Control(NamedTuple): ...",
                 optional=True),
            Need("control", "every tenth of a second, of the load of the last: the least time [s] between messages of a unit, Control(...)",
                 function("settings", "load", "control", compiled=True), "def control(settings, load, control)", optional=True),
            Need("Cell", "what the network remembers from message to message", record, "class Cell(NamedTuple): ...", optional=True),
            Need("admit", "one message on its way into the network: how long [s] it waits, Cell(...)",
                 function("settings", "sent", "cell", compiled=True), "def admit(settings, sent, cell)", optional=True),
        ), radio_parts, "write what belongs together, or none of it; with a Memory it is transmit(settings, way, draw, memory)"),
        Sort("message", "what units tell each other", (
            TITLE,
            Need("SIZE", "bytes on the channel, with everything", count, "SIZE = 200"),
            Need("Payload", "what it carries, with units", record, "class Payload(NamedTuple): ..."),
            Need("Settings", "what is set for a message that every unit sends by itself", plain, "class Settings(Part): ...",
                 optional=True),
            Need("beacon", "the payload that every unit sends once per `period` of the settings; with a Memory it is given that too",
                 compiled_function, "def beacon(own, settings)", optional=True),
            Need("Memory", "what a unit remembers of those that it has sent", record, "class Memory(NamedTuple): ...", optional=True),
            Need("due", "once per `period`: whether the beacon is sent now, Memory(...); left out: always",
                 function("own", "settings", "memory", "turn", compiled=True), "def due(own, settings, memory, turn)", optional=True),
            Need("size", "bytes of one message, SIZE at most; left out: SIZE", function("payload", compiled=True), "def size(payload)",
                 optional=True),
        ), message_parts, "write beacon(own, settings) with Settings, or due with Memory and beacon(own, settings, memory)"),
        Sort("driver", "a person at the wheel", (
            TITLE,
            Need("Settings", "what a driver is like", person, "class Settings(Driver): ..."),
            Need("decide", "pedals and steering wheel at one tick", function("settings", "sees", compiled=True),
                 "def decide(settings, sees)"),
        )),
        Sort("condition", "when something begins or ends", (
            TITLE,
            Need("Settings", "what it waits for", waited, "class Settings(Part): ..."),
            Need("holds", "whether it is so at this tick", function("view", "settings", compiled=True), "def holds(view, settings)",
                 optional=True),
            Need("joins", "of one about other conditions: whether it is so, for what is known of these", function(
                "settings", "parts", compiled=True), "def joins(settings, parts)", optional=True),
            Need("moment", "the time [s] from which on it is so, where the settings alone tell it", function("settings"),
                 "def moment(settings)", optional=True),
            Need("READS_MAIL", "that it looks at `view.mail`, which is made for those that do", yes, "READS_MAIL = True", optional=True),
            Need("never", "why it can never be so in a scenario, in words; empty when it may be", function("settings", "place"),
                 "def never(settings, place)", optional=True),
        ), asked_or_joined, "write holds, or joins with a field of the type AnyCondition (studio.kind.slot), or a list of these"),
        Sort("action", "what is done", (
            TITLE,
            Need("Settings", "what exactly", needy, "class Settings(Part): ..."),
            Need("act", "what a vehicle is told at one tick while it lasts", function("settings", "sees", compiled=True),
                 "def act(settings, sees)", optional=True),
            Need("effects", "what it does to the road", function("settings", "place"), "def effects(settings, place)", optional=True),
            Need("TAKES", "what act commands: PEDALS, WHEEL, or both where it does not say", hands, "TAKES = PEDALS", optional=True),
            Need("MOMENTARY", "that it is done at once, and does not last", yes, "MOMENTARY = True", optional=True),
            Need("told", "the action in words, for the list of events", function("settings"), "def told(settings)", optional=True),
            Need("fastest", "the greatest speed [m/s] that it asks of its vehicle", function("settings"),
                 "def fastest(settings)", optional=True),
        ), told_and_done, "write act for a vehicle that is named by vehicle: VehicleName, or effects on the road"),
        Sort("metric", "a number that a run is judged by", (
            TITLE,
            UNIT,
            Need("BETTER", "which values are better", direction, 'BETTER = "higher"'),
            Need("ABOUT", "how the vehicles that it is about are told", text, 'ABOUT = "{0} behind {1}"', optional=True),
            Need("Settings", "what is set of it besides window and vehicles", scope, "class Settings(Scope): ...", optional=True),
            Need("measure", "the number, of a record; or Found(value, subject, time)",
                 either(function("record"), function("record", "settings")), "def measure(record)"),
        ), measuring, "give measure the settings as well: def measure(record, settings), with class Settings(Scope)", Scope),
        Sort("channel", "a quantity over time that follows from others", (
            TITLE,
            UNIT,
            Need("trace", "its values, of those of other channels", function("read"), "def trace(read)"),
        )),
        Sort("logformat", "reads recorded drives of a form of files", (
            TITLE,
            Need("SUFFIXES", "endings of the files that it takes, in small letters and without .gz; with / before it, of those in a folder",
                 endings, 'SUFFIXES = (".drv",)'),
            Need("read", "all signals of a file, a Log; ScenarioError when it is none. `dbc` is the file that describes a CAN bus, or None",
                 function("path", "dbc"), "def read(path, dbc)"),
            Need("fits", "whether a file of such an ending is of this format; left out: all of them are", function("path"),
                 "def fits(path)", optional=True),
            Need("SAMPLE", "the bytes of a small log, to try it with", content, 'SAMPLE = b"0 20.1\\n"', optional=True),
        ), is_run=False),
        Sort("application", "what a developer invents", (
            TITLE,
            Need("Parameters", "what its developer tunes, with unit and range", plain, "class Parameters(Part): ..."),
            Need("PRESETS", "named sets of parameters, with their sources", preset.wrong, 'PRESETS = {"calm": Preset(...)}', optional=True),
            Need("Memory", "what it remembers from tick to tick", remembered, "class Memory(NamedTuple): ..."),
            Need("Sees", "its ports: what it sees", bundle, "class Sees(NamedTuple): ..."),
            Need("Does", "its ports: what it does", bundle, "class Does(NamedTuple): ..."),
            Need("COMMANDS", "the actuators that it may command", mask, "COMMANDS = ACCELERATION | STEERING", optional=True),
            Need("NOTICES", "the sentences that it may show to the driver", sentences, 'NOTICES = ("Brake!",)', optional=True),
            Need("decide", "one tick", function("parameters", "memory", "sees"), "def decide(parameters, memory, sees)"),
        ), preset.unfit, "give values that the Parameters take"),
    )
}  # fmt: skip


def problems(module: ModuleType, sort: Sort) -> Iterator[Problem]:
    """Everything about a module that does not fit its sort."""
    where = where_of(module)
    if not (module.__doc__ or "").strip():
        yield Problem(where, "has no docstring", remedy="say in its first lines what it does and where its figures come from")
    yield from ports(module, sort, where)
    for need in sort.needs:
        value = getattr(module, need.name, MISSING)
        if value is MISSING and not need.optional:
            yield Problem(f"{where}: {need.name}", "is missing", allowed=need.example, remedy=f"add it: {need.meaning}")
        elif value is not MISSING and (what := need.test(value)):
            yield Problem(located(where, value), f"{need.name} {what}", allowed=need.example, remedy=need.meaning)
    if what := sort.whole(module):
        yield Problem(where, what, remedy=sort.remedy)


def ports(module: ModuleType, sort: Sort, where: str) -> Iterator[Problem]:
    """What is wrong with the ports of an application."""
    if sort.name == "application" and not bundle(getattr(module, "Sees", None)) and not bundle(getattr(module, "Does", None)):
        yield from port.problems(module, where)


MISSING = object()


def where_of(module: ModuleType) -> str:
    """The file of a module, or its name."""
    file = getattr(module, "__file__", None)
    return Path(file).name if file else module.__name__


def located(where: str, value: Any) -> str:
    """With the line of a function or class."""
    from inspect import getsourcelines

    try:
        return f"{where}, line {getsourcelines(getattr(value, 'py_func', value))[1]}"
    except (OSError, TypeError):
        return where

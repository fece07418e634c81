"""Imports point down only: the floors of the house, from the ground up."""

import ast
import re
from pathlib import Path

import pytest

FLOORS = [
    {"errors", "conventions", "rows", "cache", "source", "sample", "process", "compiled", "bound", "portable"},
    {"model"},
    {"application"},
    {"kind"},
    {"road"},
    {"garage"},
    {"scenario"},
    {"vehicle"},
    {"world"},
    {"execution"},
    {"assess"},
    {"kinds"},
    {"provenance"},
    {"store"},
    {"job"},
    {"parcel"},
    {"rig"},
    {"log"},
    {"validation"},
    {"workshop"},
    {"warmup"},
    {"scene"},
    {"bench", "crowd"},
    {"doctor"},
    {"remote"},
    {"server"},
    {"cli"},
]
PACKAGE = Path(__file__).parent.parent / "studio"
FLOOR_OF = {room: height for height, rooms in enumerate(FLOORS) for room in rooms}


def imported(path: Path) -> set[str]:
    """Rooms of the package that a file imports, inside functions too."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            assert node.level == 0, f"{path}:{node.lineno} imports relatively"
            names = [f"{node.module}.{alias.name}" for alias in node.names] if node.module == "studio" else [node.module]
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        else:
            continue
        found |= {name.split(".")[1] for name in names if name.startswith("studio.")}
    return found


FILES = [path for path in sorted(PACKAGE.rglob("*.py")) if path.parent != PACKAGE or path.name != "__init__.py"]


def test_every_room_has_a_floor():
    rooms = {path.relative_to(PACKAGE).parts[0].removesuffix(".py") for path in FILES}
    assert rooms == set(FLOOR_OF)


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_imports_point_down(path):
    own = FLOOR_OF[path.relative_to(PACKAGE).parts[0].removesuffix(".py")]
    above = {room for room in imported(path) if FLOOR_OF[room] > own}
    assert not above


ROAD_FLOORS = [{"kept"}, {"network"}, {"formats", "ways"}, {"scenery"}, {"assembly"}, {"opendrive"}, {"library", "drawn"}]
ROAD_FLOOR_OF = {room: height for height, rooms in enumerate(ROAD_FLOORS) for room in rooms}


def test_rooms_of_maps_import_downwards_too():
    """Within `road`, in the same way; its door, `__init__.py`, opens what stands behind it when it is asked."""
    for path in sorted((PACKAGE / "road").rglob("*.py")):
        room = path.relative_to(PACKAGE / "road").parts[0].removesuffix(".py")
        names = set(re.findall(r"(?:from|import) studio\.road\.(\w+)", path.read_text(encoding="utf-8")))
        if room != "__init__":
            assert {name for name in names if ROAD_FLOOR_OF[name] > ROAD_FLOOR_OF[room]} == set(), path


def test_models_are_pure():
    """No arrays, no input or output, nothing from the package but the compiler and the conventions."""
    for path in sorted((PACKAGE / "model").rglob("*.py")):
        assert imported(path) <= {"compiled", "conventions", "model"}, path
        text = path.read_text(encoding="utf-8")
        assert not any(word in text for word in ("np.zeros", "np.array(", "open(", "print(")), path


ROWS = (
    *("vehicle.state", "vehicle.contact", "vehicle.command", "vehicle.parameter"),
    *("world.table.mind", "world.table.street", "world.table.unit"),
)


def test_only_vehicle_and_world_index_rows():
    """Numbers of rows are used there, by kinds, where a frame for the eye is made of them, and by rig and benchmark."""
    named = tuple(f"from studio.{module} import" for module in ROWS)
    users = {path.relative_to(PACKAGE).parts[0] for path in FILES if any(line in path.read_text(encoding="utf-8") for line in named)}
    assert users == {"vehicle", "world", "kinds", "server", "rig", "bench.py"}


def test_nothing_is_imported_by_a_star():
    """What a file uses stands at its head, where tools can check it."""
    for path in FILES:
        nodes = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        assert not any(alias.name == "*" for node in nodes if isinstance(node, ast.ImportFrom) for alias in node.names), path

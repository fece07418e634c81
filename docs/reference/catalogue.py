"""The catalogue with the provenance of every value."""

from docs.reference.table import code, filled, table
from studio.scenario import catalogue, listing

HEAD = """# Catalogue

The vehicles and tyres that come with the studio. Every value says where it comes from: published, measured or estimated, with
the source. `studio vehicles NAME` prints the same.
"""


def page() -> str:
    """The list, then every vehicle, then the tyres."""
    overview = table(listing.LIST_HEAD, [[code(name), *others] for name, *others in listing.list_rows()])
    return "\n".join([HEAD, overview, *map(vehicle, catalogue.vehicle_names()), tyres()])


def vehicle(name: str) -> str:
    """One vehicle."""
    model = catalogue.find_vehicle(name)
    rows = [[code(path), *others] for path, *others in listing.value_rows(model) if path not in ("title", "description")]
    return f"## {model.values.title}\n\n`{name}`. {filled(model.values.description)}\n\n{table(listing.VALUE_HEAD, rows)}"


def tyres() -> str:
    """The tyres by name and size, with what their files leave open."""
    found = {name: catalogue.find_tyre(name) for name in catalogue.tyre_names()}
    rows = [[code(name), each.name, each.size, "; ".join(each.notes)] for name, each in found.items()]
    return "## Tyres\n\nProperty files (`.tir`) of MF-Tyre 5.2.\n\n" + table(["name", "title", "size", "notes"], rows)

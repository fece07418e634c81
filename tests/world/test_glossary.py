"""Every table is in the glossary, every row says what it is, and what can be recorded follows from the tables."""

from importlib import import_module

import pytest

from studio.kind import registry
from studio.rows import Table
from studio.world import channel, glossary
from studio.world.glossary import TABLES
from tests.test_layers import FILES, PACKAGE


def tables_in_sources() -> set[str]:
    """Names of all tables that files of the package declare."""
    found = set()
    for path in FILES:
        if " = Table(" in path.read_text(encoding="utf-8"):
            module = import_module(".".join(["studio", *path.relative_to(PACKAGE).with_suffix("").parts]))
            found |= {value.name for value in vars(module).values() if isinstance(value, Table)}
    return found


def test_the_glossary_has_every_table():
    assert {table.name for table in TABLES} == tables_in_sources()
    assert len({table.name for table in TABLES}) == len(TABLES)


@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.name)
def test_every_row_says_what_it_is(table):
    names = [row.name for row in table]
    assert len(set(names)) == len(names) > 0
    assert all(row.unit and row.meaning for row in table)


def test_the_page_holds_every_row():
    page = glossary.markdown().splitlines()
    rows = [line for line in page if line.startswith("| `")]
    assert len(rows) == len(list(glossary.glossary())) == sum(len(table) for table in TABLES)
    assert "| `engine_speed` | rad/s | state | Engine speed | of engine or motor |" in page


def test_channels_are_the_rows_with_a_label():
    labels = {row.name: row.label for _, row in glossary.glossary() if row.label}
    assert {each.name: each.label for each in channel.CHANNELS} == labels
    assert set(channel.catalogue()) == set(labels) | set(registry.known("channel"))

"""Tables: rows are numbered in the order in which they are declared, and told apart by their names."""

import pytest

from studio.rows import Role, Table


@pytest.fixture
def table():
    made = Table("body", Role.STATE, per="vehicle")
    made.row("x", "m", "east position", label="East position")
    made.row("speed", "m/s", "along the body", role=Role.DERIVED)
    return made


def test_rows_are_numbered(table):
    assert table.row("mass", "kg", "whole vehicle") == 2
    assert table.block("curve", 3, "Nm", "full load") == 3
    assert [row.name for row in table] == ["x", "speed", "mass", "curve_0", "curve_1", "curve_2"]
    assert table[2].meaning == "whole vehicle" and len(table[3:]) == 3


def test_a_row_has_the_role_of_its_table_unless_it_has_its_own(table):
    assert [row.role for row in table] == [Role.STATE, Role.DERIVED]


def test_a_name_is_given_once(table):
    with pytest.raises(ValueError, match="table 'body' has a row 'x' already"):
        table.row("x", "m", "again")

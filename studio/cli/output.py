"""What is printed: tables and JSON on standard output."""

import json
import sys
from typing import Any

PIPED_WIDTH = 160  # columns of a table that is piped


def print_json(value: Any) -> None:
    """JSON on standard output."""
    print(json.dumps(value, ensure_ascii=False, indent=2))


def print_table(header: list[str], rows: list[list[str]]) -> None:
    """A table that survives being piped."""
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    console = Console(markup=False, highlight=False, width=None if sys.stdout.isatty() else PIPED_WIDTH)
    table = Table(box=SIMPLE_HEAD)
    for column in header:
        table.add_column(Text(column), overflow="fold")
    for row in rows:
        table.add_row(*map(Text, row))
    console.print(table)


def text(value: Any) -> str:
    """A value for people."""
    if value is None:
        return "–"
    return f"{value + 0.0:.4g}" if isinstance(value, float) else str(value)  # with zero added there is no -0


def signed(value: float | None) -> str:
    """A difference for people."""
    return "–" if value is None else f"{value:+.4g}"

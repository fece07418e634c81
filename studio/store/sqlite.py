"""sqlite-utils, and nothing that it would bring along.

It imports pandas wherever that is installed, to name columns by pandas' types. The formats of logs install it; our columns are named by
ourselves, and a command that only lists runs would wait for pandas, pyarrow and all that those import.
"""

import sys
from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["Database"]


@contextmanager
def without(name: str) -> Iterator[None]:
    """As if a package were not installed: None among the modules makes an import of it fail at once. Who has it already keeps it."""
    before = {name: sys.modules[name]} if name in sys.modules else {}
    sys.modules[name] = None  # pyrefly: ignore
    try:
        yield
    finally:
        del sys.modules[name]
        sys.modules.update(before)


with without("pandas"):
    from sqlite_utils import Database

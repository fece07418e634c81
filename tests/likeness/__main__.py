"""The long form: `python -m tests.likeness --minutes 10 --out likeness.md` makes the table of docs/pages/explanation/drivers.md."""

import argparse
from pathlib import Path

from tests.likeness.measure import figures
from tests.likeness.table import markdown


def main() -> None:
    """Measures and tells."""
    parser = argparse.ArgumentParser(prog="python -m tests.likeness", description=__doc__)
    parser.add_argument("--minutes", type=float, default=10.0, help="that are counted of each run, simulated")
    parser.add_argument("--cars", type=int, default=150, help="in the town")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=Path("likeness.md"))
    asked = parser.parse_args()
    asked.out.write_text(markdown(figures(60.0 * asked.minutes, asked.cars, asked.seed)), encoding="utf-8")
    print(asked.out.read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()

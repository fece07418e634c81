"""What the figures of the documentation count and bound, and whether the story is told as it happens."""

import re

import numpy as np
import pytest
from scipy.stats import binom

from docs.figures import celc, feasibility, story
from docs.figures.feasibility import Grid, bounds, colour, found, kept, mapped, needed, sample

GRID = Grid((50.0, 90.0), (12.0, 40.0, 60.0), 3)


def test_bounds_of_a_share():
    """All of n: 0.025^(1/n). 5 of 10: .187 and .813, by the tables of the binomial distribution; both are where the tails are 2.5 %."""
    assert bounds(12, 12) == (pytest.approx(0.025 ** (1 / 12)), 1.0) and bounds(0, 12) == (0.0, pytest.approx(1.0 - 0.025 ** (1 / 12)))
    lower, upper = bounds(5, 10)
    assert (lower, upper) == (pytest.approx(0.187, abs=5e-4), pytest.approx(0.813, abs=5e-4))
    assert binom.sf(4, 10, lower) == pytest.approx(0.025) and binom.cdf(5, 10, upper) == pytest.approx(0.025)
    assert colour(12, 12) == feasibility.SURE and colour(6, 12) == feasibility.OPEN and colour(0, 12) == feasibility.FAILS


@pytest.mark.parametrize("share", [0.03, 0.3, 0.5, 0.9])
def test_bounds_hold_as_often_as_they_say(share):
    """Over all that could come of 20 runs, the true share lies within them with 95 % or more."""
    held = [bounds(k, 20)[0] <= share <= bounds(k, 20)[1] for k in range(21)]
    assert np.sum(binom.pmf(np.arange(21), 20, share)[held]) >= 0.95


def test_how_many_runs_a_bound_takes():
    assert [needed(share) for share in (0.9, 0.95, 0.99, 0.999)] == [36, 72, 368, 3688]
    assert bounds(36, 36)[0] >= 0.9 > bounds(35, 35)[0]


def test_how_many_runs_a_width_takes():
    """So many are enough whatever comes out, and one fewer is not."""
    for width in (0.5, 0.2):
        n = sample(width)
        apart = [[upper - lower for lower, upper in (bounds(k, each) for k in range(each + 1))] for each in (n, n - 1)]
        assert max(apart[0]) <= width < max(apart[1])


def test_a_map_in_short(tmp_path, monkeypatch):
    """Nearer than tyres allow nothing is solved, farther than anybody needs all; latency solves nothing. What was run is not run again."""
    file, quick, slow = tmp_path / "kept.csv", "20 ms, no loss, dry", "latency 200 ms"
    monkeypatch.setattr(feasibility, "SLICES", {title: feasibility.SLICES[title] for title in (quick, slow)})
    mapped(GRID, file)
    maps, before = found(file), kept(file)
    assert {runs for places in maps.values() for _, runs in places.values()} == {3}
    solved = {title: {place: k for place, (k, _) in places.items()} for title, places in maps.items()}
    assert all(solved[quick][kmh, 12.0] == 0 and solved[quick][kmh, 60.0] == 3 == solved[quick][kmh, 40.0] for kmh in GRID.speeds)
    assert all(solved[slow][place] <= k for place, k in solved[quick].items()) and solved[slow][90.0, 40.0] == 0
    file.write_text("".join(file.read_text().splitlines(keepends=True)[:-2]))
    more = GRID._replace(runs=4)
    mapped(more, file)
    assert found(file)[quick][90.0, 60.0] == (4, 4) and kept(file)[: len(before) - 2] == before[:-2]
    assert sorted(each.first for each in kept(file)[len(before) - 2 :]) == [1, 1] + [4] * (len(before) - 2)
    text = file.read_text()
    mapped(more, file)
    assert file.read_text() == text


def test_the_figure_of_distances_in_short():
    """A point of it, with the numbers of an array as the script has them: 1.00 to 1.30 times the formula's way."""
    ((way,),) = celc.ways(celc.SPEEDS[2:3], (0.02,))
    assert 1.0 <= way / celc.formula(celc.SPEEDS[2] / 3.6, 0.02) <= 1.3


def test_the_story_is_told_as_it_happens():
    """Every command of the script stands in the page, in order, and the page's table is what comes of them."""
    page = (story.PAGE / "story.md").read_text(encoding="utf-8")
    assert re.findall(r"^uv run studio run .*$", page, re.MULTILINE) == [story.command(step) for step in story.STEPS]
    rows = [story.row(number, step, story.outcome(step)) for number, step in enumerate(story.STEPS, 1)]
    assert re.findall(r"^\| \d .*$", page, re.MULTILINE) == rows and len(rows) < 10

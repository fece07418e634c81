"""Stages: a page has one to itself while its scene is connected, and gets the same again; what one shows is nobody else's."""

from concurrent.futures import ThreadPoolExecutor

import pytest

from studio.errors import ConflictError
from studio.server.answer import MOST_STAGES
from studio.server.stages import Stages
from tests.server.server import served


def test_the_first_free_stage_is_given_and_none_twice():
    stages = Stages()
    assert [stages.allot() for _ in range(3)] == [1, 2, 3]
    with stages.joined(2):
        pass
    assert stages.allot() == 2  # whoever had it is gone
    assert stages.allot(3) == 4  # promised to somebody else


def test_a_page_that_is_loaded_again_gets_its_stage():
    stages = Stages()
    mine = [stages.allot(), stages.allot()][1]
    with ThreadPoolExecutor(1) as others, stages.joined(mine):
        again = others.submit(stages.allot, mine)
    assert again.result() == mine


def test_more_pages_than_stages_are_told_so():
    stages = Stages()
    for _ in range(MOST_STAGES):
        stages.allot()
    with pytest.raises(ConflictError, match="close another tab"):
        stages.allot()


@pytest.fixture(scope="module")
def client(tmp_path_factory, sample):
    with served(tmp_path_factory.mktemp("stages"), "--scenarios", sample.parent) as (found, _, _):
        yield found


def test_a_stage_that_there_is_not_is_refused(client):
    assert client.post("/api/scene", json={"stage": MOST_STAGES + 1, "scenario": "cacc_brake"}).status_code == 422
    assert client.get(f"/scene/{MOST_STAGES + 1}/").status_code == 422
    assert client.get("/scene/2/").status_code == 200
    assert client.post("/api/stages", json={"wanted": 0}).status_code == 422

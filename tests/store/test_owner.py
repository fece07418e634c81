"""Whether the process that works on a run has gone: by when it began, whatever the clock says, and only where one can know."""

import json
import os
import subprocess
import sys
import time

import psutil
import pytest

from studio.store.owner import began, is_gone, is_here, mark
from tests.patience import until


def changed(place, value):
    """The mark of this process with another value at a place."""
    known = json.loads(mark(os.getpid()))
    known[place] = value
    return json.dumps(known)


HOST, START, CONTAINER, BEGAN = range(4)


def test_who_lives_has_not_gone():
    assert not is_gone(os.getpid(), mark(os.getpid()))
    assert not is_gone(os.getpid(), None)


def test_a_beginning_is_counted_from_the_start_of_the_machine():
    """So a step of the clock changes nothing."""
    ticks = os.sysconf("SC_CLK_TCK")
    assert 0 < began(os.getpid()) / ticks <= time.clock_gettime(time.CLOCK_BOOTTIME)
    assert abs(began(os.getpid()) / ticks - psutil.Process().create_time()) > 1e6  # not seconds since 1970


@pytest.mark.parametrize("known", ["", "{", "5", "[]", "null", '["a"]', "\0", "[" * 100_000])
def test_of_a_damaged_mark_only_the_number_is_known(known):
    assert not is_gone(os.getpid(), known) and not is_here(known)
    gone = subprocess.Popen([sys.executable, "-c", "pass"])
    gone.wait()
    assert is_gone(gone.pid, known)


def test_another_process_of_the_same_number_is_another():
    assert is_gone(os.getpid(), changed(BEGAN, began(os.getpid()) - 1))


def test_who_has_ended_has_gone_even_before_anybody_asks_how():
    process = subprocess.Popen([sys.executable, "-c", "pass"])
    known = mark(process.pid)
    until(lambda: psutil.Process(process.pid).status() == psutil.STATUS_ZOMBIE, "the end of the process")
    assert is_gone(process.pid, known)
    process.wait()
    assert is_gone(process.pid, known) and is_gone(process.pid, None)


def test_a_machine_that_was_started_again_has_none_of_its_processes_left():
    assert is_gone(os.getpid(), changed(START, "another start"))


def test_of_other_machines_and_containers_nobody_knows():
    assert not is_gone(2**22 + 1, changed(CONTAINER, "pid:[1]"))
    elsewhere = json.loads(changed(START, "another start"))
    elsewhere[HOST] = "another.host"
    assert not is_gone(2**22 + 1, json.dumps(elsewhere))

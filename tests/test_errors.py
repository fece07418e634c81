"""What is told of an error has a bounded length, whatever was sent."""

from studio.errors import LONGEST, LONGEST_MESSAGE, MapError, Problem, StudioError


def test_the_parts_of_a_problem_are_cut_in_the_middle():
    long = "a" * 10_000 + "z" * 10_000
    problem = Problem(long, long, long, long, long)
    assert all(len(each) <= LONGEST and each.startswith("a") and each.endswith("z") for each in vars(problem).values())
    assert Problem("here", "is short").what == "is short"


def test_a_message_keeps_its_beginning_and_its_end():
    """A traceback has at its end what was raised."""
    told = StudioError("It does not load:\n" + "  File …\n" * 10_000 + "RecursionError").message
    assert len(told) <= LONGEST_MESSAGE and told.startswith("It does not load") and told.endswith("RecursionError")
    assert MapError("no roads").message == "no roads"


def test_of_very_many_problems_the_first_are_told():
    many = [Problem("here", "x" * 500) for _ in range(1000)]
    told = StudioError("It is wrong.", many)
    assert told.problems[:-1] == many[: len(told.problems) - 1] and len(str(told)) < 60_000
    assert told.problems[-1].what == f"there are {1001 - len(told.problems)} more problems"
    assert StudioError("It is wrong.", many[:3]).problems == many[:3]

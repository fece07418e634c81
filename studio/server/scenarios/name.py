"""Names of scenario files: what somebody calls one, checked so that it is a file of the folder on every system.

checked("Berlin, Mitte.yaml")  →  ScenarioError: the comma
checked(" berlin mitte ")      →  "berlin mitte"
"""

import re
import unicodedata
from collections.abc import Iterable

from studio.errors import ConflictError, Problem, ScenarioError, short

ENDING = ".yaml"
LONGEST = 80  # characters
MOST_BYTES = 180  # most file systems take 255, and endings are put behind it
SIGNS = " -_."
ALLOWED = "letters and digits of any script, spaces, and - _ ."
RESERVED = re.compile(r"(con|prn|aux|nul|com[0-9]|lpt[0-9])(\..*)?", re.IGNORECASE)  # devices of Windows


def checked(text: str) -> str:
    """The name without its ending; raises ScenarioError when no file may be called so."""
    name = unicodedata.normalize("NFC", text).strip()
    name = re.sub(r"\.ya?ml$", "", name, flags=re.IGNORECASE).rstrip()
    if what := wrong(name):
        problem = Problem("name", what, ascii(text[:80]), f"{ALLOWED}; at most {LONGEST} characters", "choose another name")
        raise ScenarioError("A scenario cannot be called so.", [problem])
    return name


def wrong(name: str) -> str:
    """What is wrong with a name, or nothing."""
    if not name:
        return "is empty"
    if "/" in name or "\\" in name or name.strip(".") == "":
        return "leads to another folder"
    if strange := sorted({each for each in name if unicodedata.category(each)[0] not in "LMN" and each not in SIGNS}):
        return f"holds what no file name may: {' '.join(ascii(each) for each in strange[:8])}"
    if name[0] == "." or name[-1] == ".":
        return "begins or ends with a dot"
    if RESERVED.fullmatch(name):
        return "is the name of a device on Windows"
    return "is too long" if len(name) > LONGEST or len(name.encode()) > MOST_BYTES else ""


def check_free(name: str, taken: Iterable[str]) -> None:
    """Raises ConflictError for a name that is taken; on many systems capitals make no difference."""
    known = {each.casefold(): each for each in taken}
    if (other := known.get(name.casefold())) is not None:
        problem = Problem("name", "is taken", short(other), remedy=f"choose another name, such as {free(name, taken)}")
        raise ConflictError(f"There is a scenario {other} already.", [problem])


def free(name: str, taken: Iterable[str]) -> str:
    """The name, or with a number behind it when it is taken.

    >>> free("berlin_2", ["Berlin", "berlin_2"])
    'berlin_3'
    """
    known = {each.casefold() for each in taken}
    base, number = re.sub(r"_\d+$", "", name), 1
    while name.casefold() in known:
        number += 1
        name = f"{base}_{number}"
    return name

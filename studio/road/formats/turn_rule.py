"""What a turn restriction of OpenStreetMap says to cars (wiki: Relation:restriction)."""

from collections.abc import Mapping

KEYS = ("restriction:motorcar", "restriction:motor_vehicle", "restriction")  # the more exact first
CARS = {"motorcar", "motor_vehicle", "vehicle"}
TURNS = {"left_turn", "right_turn", "straight_on", "u_turn", "slight_left_turn", "slight_right_turn", "sharp_left_turn", "sharp_right_turn"}
KINDS = {f"{word}_{turn}" for word in ("no", "only") for turn in TURNS} | {"no_entry", "no_exit"}
UNCHANGING = "restrictions do not change with time"
AT_TIMES = ("day_on", "day_off", "hour_on", "hour_off", "opening_hours")


def is_rule(tags: Mapping[str, str]) -> bool:
    """Whether a relation says which lanes or ways may follow each other."""
    kind = tags.get("type", "")
    return kind == "connectivity" or kind.partition(":")[0] == "restriction"


def kind_of(tags: Mapping[str, str]) -> str:
    """What is forbidden or the only way for cars at all times, such as "no_left_turn"; "" for nothing."""
    return "" if reason(tags) or excepts_cars(tags) else next(tags[key] for key in KEYS if key in tags)


def excepts_cars(tags: Mapping[str, str]) -> bool:
    """Whether a restriction is not for cars: it excepts them, or names other vehicles alone. Then nothing is lost."""
    named = {each.strip() for each in tags.get("except", "").split(";")}
    is_others = tags.get("type") == "restriction" and bool(others(tags)) and not any(key in tags for key in KEYS)
    return bool(CARS & named) or (is_others and not conditional(tags))


def others(tags: Mapping[str, str]) -> list[str]:
    """The other vehicles that a restriction is for."""
    return [key for key in tags if key.startswith("restriction:") and not key.endswith(":conditional") and key not in KEYS]


def conditional(tags: Mapping[str, str]) -> str:
    """The condition under which alone a restriction holds, as it is tagged, or nothing."""
    timed = next((f"{key}={tags[key]}" for key in AT_TIMES if key in tags), "")
    return next((f"{key}={value}" for key, value in tags.items() if key.startswith("restriction") and key.endswith(":conditional")), timed)


def reason(tags: Mapping[str, str]) -> str:
    """Why a relation is not kept to although it may be about cars, or nothing."""
    if excepts_cars(tags):
        return ""
    if tags.get("type") == "connectivity":
        return "lanes lead where their arrows say"
    if tags.get("type") != "restriction":
        return "restrictions of other vehicles are not looked at"
    if conditional(tags) and (not any(key in tags for key in KEYS) or any(key in tags for key in AT_TIMES)):
        return UNCHANGING
    kind = next((tags[key] for key in KEYS if key in tags), "")
    return "" if kind in KINDS else "is no kind of restriction that is known"


def told(tags: Mapping[str, str]) -> str:
    """What a restriction says, for people."""
    kind = next((tags[key] for key in KEYS if key in tags), "")
    return conditional(tags) or kind or ", ".join(f"{key}={value}" for key, value in tags.items())

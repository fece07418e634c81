"""Events: everything that can happen in a run and is told. Each kind is declared once, in one line.

    HIT = event("collision", "collision of {0} and {1} at {impact_speed:.1f} m/s", impact_speed="m/s")

The sentence names the units that it is about by their places, numbers and words by their names; numbers have units. `HIT` is a plain
integer, which compiled code writes into the table of notices (world/passes/notice.py).
"""

from typing import NamedTuple


class EventKind(NamedTuple):
    """A kind of event: its name, its sentence, the units of its numbers, and the names of its words."""

    name: str
    sentence: str
    numbers: dict[str, str]
    words: tuple[str, ...]


EVENTS: list[EventKind] = []


def event(name: str, sentence: str, *words: str, **numbers: str) -> int:
    """Declares a kind of event and returns its number. Raises ValueError."""
    if name in {each.name for each in EVENTS}:
        raise ValueError(f"there is an event {name!r} already")
    EVENTS.append(EventKind(name, sentence, numbers, words))
    return len(EVENTS) - 1


SCRIPT_BEGUN = event("script_begun", "{entry} begins: {action}", "entry", "action")
SCRIPT_ENDED = event("script_ended", "{entry} ends", "entry", "action")
SCRIPT_CUT = event("script_cut_short", "{entry} ends: {other} begins", "entry", "action", "other")
SCRIPT_VAIN = event("script_in_vain", "{entry} does nothing: {0} is not on the road", "entry", "action")
RUN_ENDED = event("run_ended", "{entry} ends the run", "entry")
HOPELESS = event("never_begins", "{entry} can never {turn}: {reason}", "entry", "turn", "reason")
OUT_OF_REACH = event(
    "speed_out_of_reach", "{0} cannot drive {speed:.1f} m/s ({what}): its top speed in the flat is {top_speed:.1f} m/s", "what",
    speed="m/s", top_speed="m/s",
)  # fmt: skip
LED_AROUND = event("led_around", "{demand} is led around {road}, which is closed: {longer:.0f} m more", "demand", "road", longer="m")
COUNTED = event(
    "counted", "traffic.counts.{count} has {rate:.0f} cars an hour on {road}, where {brought:.0f} would drive", "count", "road",
    rate="1/h", brought="1/h",
)  # fmt: skip
ROUTE_FILE = event("route_file", "traffic.routes {what}", "what")
CUT_OFF = event("cut_off", "{demand} cannot get around {road}, which is closed: its cars stop before it", "demand", "road")
HIT = event("collision", "collision of {0} and {1} at {impact_speed:.1f} m/s", impact_speed="m/s")
ROLLED_OVER = event("rolled_over", "rolled over; what it does after this is not claimed")
ARRIVED = event("arrived", "arrived at the end of its route")
COMPANY_CAME = event("company_came", "{1} is between it and {2}")
COMPANY_LEFT = event("company_left", "nobody is between it and {1} any more")
WAITS = event("waits_at_red", "waits at a red light")
RED_PASSED = event("red_light_passed", "passes a red light at {speed:.1f} m/s", speed="m/s")
TAKES_OVER = event("driver_takes_over", "driver takes over: {reason}", "reason")
COMMAND_TAKEN = event("takes_over", "{by} takes over {what} from {before}", "by", "what", "before")
COMMAND_GIVEN = event("gives_back", "{before} gives {what} back to {by}", "by", "what", "before")
MESSAGE_LOST = event("message_lost", "messages of {1} lost before the one that came: {missed:.0f}", missed="1")
NOTICE_SHOWN = event("notice_shown", "shows the driver: {sentence}", "sentence")
NEAR_MISS = event("near_miss", "comes near {1}: {ttc:.2f} s to a collision", ttc="s")
HARD_BRAKE = event("hard_brake", "brakes hard, with up to {deceleration:.1f} m/s²", deceleration="m/s²")
FAILED = event("failed", "failed: {reason}", "reason")

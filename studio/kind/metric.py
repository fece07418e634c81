"""The contract of a metric, on one page.

A metric is a file with

    KIND         "metric"
    TITLE        one line for people
    UNIT         of its values
    BETTER       which values are better: "lower", "higher", or None
    ABOUT        how the vehicles that it is about are told, "{0} behind {1}"; may be left out
    Settings     what is set of it: a `Scope`, with settings of its own; may be left out where there are none
    measure      measure(record) -> number or Found, or measure(record, settings) where it has Settings of its own

`measure` gets the record of a run, cut to the window and to the vehicles that the scenario asks for, and gives one number; not a number
where there is nothing to measure. A `Found` says besides which vehicles it is about, and when it was so; or why there was nothing.
"""

from math import nan
from typing import NamedTuple

from pydantic import Field, model_validator

from studio.kind.settings import EntryName, Name, Part, UnitName, VehicleName, number


class Found(NamedTuple):
    """What a metric has found: the value, the vehicles that it is about, and when; no time where it is about the whole run.

    Where the value is no number, because there was nothing to measure, `why` says so in words.
    """

    value: float
    subject: tuple[str, ...] = ()
    time: float = nan  # [s]
    why: str = ""


class Moment(Part):
    """A moment of a run: so long after its start, or after an event: the first one that fits. An entry of the script is named by itself."""

    at: float = number(
        0.0, unit="s", title="At", description="since the start of the run; with an event, since that", ge=-100_000, le=100_000
    )
    event: Name | None = Field(None, title="Event", description="of this kind")
    unit: UnitName | None = Field(None, title="About the unit", description="the event is about it")
    entry: EntryName | None = Field(None, title="Entry of the script", description="the event is its beginning, or what `event` says")

    @property
    def is_of_an_event(self) -> bool:
        """Whether it waits for something to happen."""
        return self.event is not None or self.entry is not None

    @model_validator(mode="after")
    def is_in_the_run(self):
        if self.at < 0.0 and not self.is_of_an_event:
            raise ValueError(f"a run begins at 0 s, not at {self.at:g} s: give a later time, or an event that it is before")
        return self

    @model_validator(mode="after")
    def unit_of_an_event(self):
        if self.unit is not None and not self.is_of_an_event:
            raise ValueError("`unit` says which event is meant: give `event` or `entry` too")
        return self


class Scope(Part):
    """What of a run a metric looks at: from a moment to a moment, some vehicles or all. Every metric has these settings."""

    begin: Moment | None = Field(
        None, title="From", description="left out: from the start; while the event never comes there is nothing to measure"
    )
    end: Moment | None = Field(None, title="To", description="left out, or an event that never comes: to the end of the run")
    vehicles: list[VehicleName] = Field([], title="Vehicles", description="none named: all that were recorded")

    @model_validator(mode="after")
    def ends_after_its_beginning(self):
        since = self.begin or Moment()
        if self.end and not since.is_of_an_event and not self.end.is_of_an_event and self.end.at <= since.at:
            raise ValueError(f"the window must end ({self.end.at:g} s) after its beginning ({since.at:g} s)")
        return self

"""Recorded channels that follow from others; the names of those that follow from none are theirs."""

from studio.kind.registry import reserve
from studio.world.channel import CHANNELS

reserve("channel", ["time", *(channel.name for channel in CHANNELS)], "a row of the world")

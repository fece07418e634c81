"""Recorded drives: read from any log format, brought to our signals, units and one clock."""

"""The passes of a tick: compiled functions over all vehicles of all worlds."""

"""Formats of recorded drives, a file each."""

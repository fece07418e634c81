"""Formats of logs, a file each: SUFFIXES that it takes ("/.npy": a folder of such files), and read(path, dbc) -> Log."""

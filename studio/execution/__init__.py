"""Running a world: as fast as possible, paced, paused, step by step; and what is kept of it."""

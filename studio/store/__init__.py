"""The run database: one SQLite file that holds every iteration."""

"""Assessing a record: metrics with unit and direction, goals, and the comparison of two runs."""

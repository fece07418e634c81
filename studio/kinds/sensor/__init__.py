"""Sensors that come with the studio."""

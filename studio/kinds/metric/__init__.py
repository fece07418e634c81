"""Metrics that come with the studio."""

"""Cooperative ADAS Studio."""

"""Drivers that come with the studio."""

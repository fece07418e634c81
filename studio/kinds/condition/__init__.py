"""Conditions that come with the studio: when something begins or ends."""

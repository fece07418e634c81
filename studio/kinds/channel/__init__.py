"""Recorded channels that follow from others."""

"""Tests of studio/garage."""

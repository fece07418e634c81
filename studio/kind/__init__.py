"""Kinds: everything that a developer may replace is one file behind one door. What a kind is, how it is found, how it is loaded."""

"""Likeness: speeds, time gaps, use of lanes and accelerations of our traffic, beside what was measured on roads."""

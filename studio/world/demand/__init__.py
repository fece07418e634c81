"""Demand: which cars of the traffic there are, who drives them, where they come in and when."""

"""Vehicles by themselves: their rows, the passes that integrate them tile by tile, and fleets of them."""

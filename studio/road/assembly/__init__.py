"""From what a file says to a network: lanes as curves, turns, heights, right of way, side of the road."""

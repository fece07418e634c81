"""The simulated world: state as arrays, the passes over it, and the tick that calls them."""

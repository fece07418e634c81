"""Pure scalar functions of the physical world: no arrays, no allocation, no input or output."""

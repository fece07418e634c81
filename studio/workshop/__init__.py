"""The workshop: where a new kind is begun, and where it is seen whether one keeps its contract."""

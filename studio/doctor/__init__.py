"""The doctor: looks whether the studio on this machine is well, and mends what can be mended without losing anything."""

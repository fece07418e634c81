"""What map files say, and what their words mean: OpenStreetMap, OpenDRIVE, countries, limits."""

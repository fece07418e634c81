"""Rush hour: much traffic for long, in five places, and whether anybody strikes anybody, breaks a rule, or waits for ever."""

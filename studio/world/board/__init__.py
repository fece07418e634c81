"""On board of units: what they know of themselves, sense, send, hear, and the applications that decide."""

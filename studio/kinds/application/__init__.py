"""Applications that come with the studio."""

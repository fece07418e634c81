"""Messages that come with the studio."""

"""Actions that come with the studio: what is done."""

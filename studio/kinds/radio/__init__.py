"""Radio models that come with the studio."""

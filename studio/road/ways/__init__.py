"""What is driven on a network: routes, smooth paths, ways around, and where they meet."""

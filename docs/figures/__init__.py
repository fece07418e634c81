"""The figures of the documentation, each made by a file of its own from real runs."""

"""What makes the documentation of the pages, the schemas and the docstrings."""

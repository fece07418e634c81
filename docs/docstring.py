"""Docstrings as Markdown: what would be taken for a link is none. `float64[n] [m]` is a shape and a unit."""

import griffe


class Brackets(griffe.Extension):
    """Escapes a bracket that follows a bracket."""

    def on_object(self, *, obj: griffe.Object, **others) -> None:
        """Called for every module, class, function and constant."""
        if obj.docstring:
            obj.docstring.value = obj.docstring.value.replace("] [", "] \\[")

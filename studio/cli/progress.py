"""Progress on standard error: a bar when somebody watches."""

import sys
from collections.abc import Callable, Generator
from contextlib import contextmanager


@contextmanager
def progress(title: str) -> Generator[Callable[[float], None]]:
    """A bar for something that tells its share, 0 to 1; none when nobody watches."""
    from rich.progress import TextColumn

    with bar(TextColumn("{task.percentage:>3.0f} %")) as shown:
        task = shown.add_task(title, total=None)
        yield lambda share: shown.update(task, description="running", total=1.0, completed=share)


def compile_first() -> int:
    """Compiles everything that has not been compiled on this machine, and shows how far it is; the number of functions."""
    from studio.warmup import Warmup

    current = Warmup().start()
    try:
        if not current.is_over:
            show(current)
    finally:
        current.close()
    return current.compiled


def show(current) -> None:
    """A warm-up until it is over: a bar for who watches, a line for a log."""
    from rich.progress import MofNCompleteColumn

    with bar(MofNCompleteColumn()) as shown:
        told("compiling once, minutes on a slow or busy machine ..." if shown.disable else "")
        task = shown.add_task("compiling once", total=None)
        current.wait(lambda now: shown.update(task, description=f"compiling once: {now.latest}", total=now.of, completed=now.done))


def bar(count):
    """A bar with a column that counts."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), count, TimeElapsedColumn())
    return Progress(*columns, console=console, transient=True, disable=not console.is_terminal)


def told(text: str) -> None:
    """A line about what goes on."""
    if text:
        print(text, file=sys.stderr)

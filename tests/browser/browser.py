"""A real browser for the tests, drawing without a graphics card and calling nobody."""

import io
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, BrowserContext, Page, expect, sync_playwright

from tests.patience import PATIENCE_MS

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
FLAGS = [
    "--headless=new",
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
]


@contextmanager
def browser() -> Iterator[Browser]:
    """The browser; skips the test, saying how to get one, when there is none."""
    found = next((path for name in NAMES if (path := shutil.which(name))), None)
    if found is None:
        pytest.skip("no browser: install one with `apt install chromium`, or put google-chrome on the PATH")
    with sync_playwright() as playwright:
        yield playwright.chromium.launch(executable_path=found, headless=True, ignore_default_args=["--headless"], args=FLAGS)


def watched(opened: Browser | BrowserContext, *, tour: bool = False, **options: Any) -> tuple[Page, list[str]]:
    """A new page that waits as long as a busy machine needs, and what its console will have complained about; the tour is over, or new."""
    page = opened.new_page(**options)
    if not tour:
        page.add_init_script("localStorage.setItem('tour', JSON.stringify('over'))")
    page.set_default_timeout(PATIENCE_MS)
    expect.set_options(timeout=PATIENCE_MS)
    complaints: list[str] = []
    page.on(
        "console", lambda message: complaints.append(f"{message.text} ({message.location['url']})") if message.type == "error" else None
    )
    page.on("pageerror", lambda error: complaints.append(str(error)))
    return page, complaints


def drawn(page: Page) -> None:
    """Until the page has drawn what it was told to before: the next frame may have begun, the one after has not."""
    page.evaluate("async () => { for (let i = 0; i < 2; i++) await new Promise(requestAnimationFrame); }")


def pixels(screenshot: bytes) -> np.ndarray:
    """A screenshot as float64[row, column, colour]."""
    return np.asarray(Image.open(io.BytesIO(screenshot)).convert("RGB"), dtype=float)

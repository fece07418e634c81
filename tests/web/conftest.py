"""Node and node_modules for the tests of the page; a missing Node is a failure, never a skip."""

import importlib.util
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = {
    "openapi-typescript": "openapi-typescript/bin/cli.js",
    "tsc": "typescript/bin/tsc",
    "vitest": "vitest/vitest.mjs",
}


def load_bundle():
    """web/bundle.py, which is no part of the package."""
    spec = importlib.util.spec_from_file_location("studio_web_bundle", ROOT / "web" / "bundle.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="session")
def bundle():
    """The builder of the page."""
    return load_bundle()


@pytest.fixture(scope="session")
def tool(bundle):
    """Call `tool("vitest", "run")`: a program of node_modules, with what it printed."""
    bundle.install()

    def call(name: str, *arguments: str) -> subprocess.CompletedProcess:
        return bundle.run([bundle.node().executable, f"node_modules/{PROGRAMS[name]}", *arguments])

    return call

"""A real server in a process of its own, as a user starts it."""

import os
import re
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import httpx

from tests.patience import PATIENCE

START_PATIENCE = 600.0  # [s] the first start compiles


@contextmanager
def served(folder: Path, *options, **variables: str):
    """Starts `studio` in a folder, with variables of the environment; gives an HTTP client, the database's path, the process; ends it."""
    log = (folder / "server.log").open("w+")
    command = [sys.executable, "-m", "studio.cli", "--port", "0", "--no-browser", *map(str, options)]
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=log, text=True, env=os.environ | variables)
    try:
        address = re.search(r"http://[^\s/]+", process.stdout.readline()).group()
        with httpx.Client(base_url=address, timeout=PATIENCE) as client:
            yield client, folder / "runs.db", process
    finally:
        process.terminate()
        process.wait(PATIENCE)
        log.close()

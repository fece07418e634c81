"""The page speaks of the API as the server has it."""

import json
from pathlib import Path

from studio.server.app import description

WEB = Path(__file__).resolve().parents[2] / "web"


def test_openapi_is_the_servers():
    """When this fails: `studio openapi > web/openapi.json`, then `npm run types` in web/."""
    assert json.loads((WEB / "openapi.json").read_text()) == json.loads(json.dumps(description()))


def test_types_are_made_from_openapi(tool, tmp_path):
    """When this fails: `npm run types` in web/."""
    made = tmp_path / "server.d.ts"
    done = tool("openapi-typescript", "openapi.json", "-o", str(made))
    assert done.returncode == 0, done.stderr
    assert made.read_text() == (WEB / "src/model/server.d.ts").read_text()

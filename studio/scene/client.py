"""The viser client as the studio serves it: viser's own file with our style, bridge, overlay and hand in its head."""

from functools import cache
from pathlib import Path

import viser

from studio.errors import ServerError

HERE = Path(__file__).parent
SCRIPTS = ("bridge.js", "overlay.js", "hand.js")
CLIENT = Path(viser.__file__).parent / "client" / "build" / "index.html"


@cache
def page() -> str:
    """The html of the scene, to be served under /scene/."""
    if not CLIENT.is_file():
        raise ServerError(f"The 3D client of viser is missing: {CLIENT}. Install viser again.")
    return injected(CLIENT.read_text(encoding="utf-8"))


def injected(html: str) -> str:
    """`html` with our style and scripts before </head>; they run before anything of the client does."""
    head, mark, body = html.partition("<head>")
    if not mark:
        raise ServerError("The 3D client of viser has no <head>: this studio needs viser 1.1.1.")
    style = (HERE / "bridge.css").read_text(encoding="utf-8")
    scripts = "".join(f"<script>\n{(HERE / name).read_text(encoding='utf-8')}</script>\n" for name in SCRIPTS)
    return f"{head}{mark}\n<style>\n{style}</style>\n{scripts}{body}"

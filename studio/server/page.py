"""The page: the bundle that the build made, for every address that is neither REST nor scene nor documentation."""

from pathlib import Path

from fastapi import FastAPI
from fastapi.responses import FileResponse, HTMLResponse, Response

from studio.server import book

BUNDLE = Path(__file__).parent.parent / "_web"
FOREVER = {"Cache-Control": "public, max-age=31536000, immutable"}  # names of assets hold a digest of their content
ALWAYS_ASK = {"Cache-Control": "no-cache"}
MISSING = """<!doctype html><title>Cooperative ADAS Studio</title>
<p>The page has not been built. Install the package again without STUDIO_SKIP_WEB; REST works:
<a href="/openapi.json">/openapi.json</a>.</p>"""

app = FastAPI(openapi_url=None)
app.include_router(book.router)


@app.get("/{path:path}")
def answer(path: str) -> Response:
    """A file of the bundle, or the page itself: it finds its place by its address."""
    wanted = book.found(BUNDLE, path)
    if path and wanted and wanted.is_file():
        return FileResponse(wanted, headers=FOREVER if path.startswith("assets/") else ALWAYS_ASK)
    if path.startswith("assets/") or wanted is None:
        return HTMLResponse("not found", status_code=404)
    index = BUNDLE / "index.html"
    if not index.is_file():
        return HTMLResponse(MISSING, status_code=503)
    return FileResponse(index, headers=ALWAYS_ASK)

"""The page of the scene: viser's client, whole, with our style and bridge before everything else."""

import re

import pytest

from studio.errors import ServerError
from studio.scene import client


def test_bridge_and_style_come_before_the_client():
    page = client.page()
    head = page[: page.index("</head>")]
    assert head.index("document.hasFocus") < head.index("data-p=")
    assert head.index("data-floating-window") < head.index("data-p=")


def test_the_client_itself_is_untouched():
    original = client.CLIENT.read_text(encoding="utf-8")
    page = client.page()
    start = page.index("<head>") + len("<head>")
    tail = original[original.index("<head>") + len("<head>") :]
    assert page.endswith(tail) and page[:start] == original[:start]


def test_neither_style_nor_bridge_ends_its_own_tag():
    for name in ("bridge.js", "bridge.css"):
        text = (client.HERE / name).read_text(encoding="utf-8")
        assert not re.search(r"</(script|style)", text, re.IGNORECASE)


def test_a_client_without_head_is_refused_with_a_reason():
    with pytest.raises(ServerError, match=r"viser 1\.1\.1"):
        client.injected("<html><body></body></html>")

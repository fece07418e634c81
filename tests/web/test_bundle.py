"""The builder of the page: which Node it takes, and when it builds."""

import json
import shutil

import pytest


@pytest.mark.parametrize(
    ("version", "good"),
    [
        ((18, 20, 0), False),
        ((20, 18, 9), False),
        ((20, 19, 0), True),
        ((21, 7, 0), False),
        ((22, 11, 0), False),
        ((22, 12, 0), True),
        ((26, 0, 0), True),
    ],
)
def test_node_is_taken_as_vite_asks_for(bundle, version, good):
    assert bundle.new_enough(version) is good


def test_node_of_the_wheel_is_found_and_starts(bundle):
    node = bundle.wheel_node()
    assert bundle.new_enough(bundle.version(node.executable))
    done = bundle.run([*node.npm, "--version"])
    assert done.returncode == 0 and done.stdout.strip()


def test_an_engine_that_does_not_start_is_no_node(bundle):
    assert bundle.version("/there/is/no/node") == (0,)


@pytest.fixture
def tree(bundle, tmp_path, monkeypatch):
    """A copy of the page's sources, without node_modules, and a place for its bundle."""
    web = tmp_path / "web"
    shutil.copytree(bundle.WEB, web, ignore=shutil.ignore_patterns("node_modules"))
    monkeypatch.setattr(bundle, "WEB", web)
    monkeypatch.setattr(bundle, "BUNDLE", tmp_path / "_web")
    return web


def test_bundle_is_current_until_a_source_changes(bundle, tree):
    bundle.BUNDLE.mkdir()
    (bundle.BUNDLE / "index.html").write_text("page")
    (bundle.BUNDLE / bundle.STAMP).write_text(bundle.digest(*bundle.SOURCES))
    assert bundle.current() and bundle.build() is False
    with (tree / "src" / "main.tsx").open("a") as file:
        file.write("// changed\n")
    assert not bundle.current()


def test_digest_notices_a_renamed_file(bundle, tree):
    before = bundle.digest("src")
    (tree / "src" / "main.tsx").rename(tree / "src" / "other.tsx")
    assert bundle.digest("src") != before


def test_failure_says_what_to_do(bundle, tree):
    package = json.loads((tree / "package.json").read_text())
    package["scripts"]["build"] = "node -e process.exit(3)"
    (tree / "package.json").write_text(json.dumps(package))
    (tree / "node_modules").mkdir()
    with pytest.raises(bundle.BundleError, match=r"STUDIO_SKIP_WEB=1"):
        bundle.replace_bundle()
    assert not bundle.BUNDLE.exists()

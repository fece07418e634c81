"""The page: its types fit together, its own tests pass, and what it is built from is honest."""

import json
import re
from pathlib import Path

WEB = Path(__file__).resolve().parents[2] / "web"


def test_types_fit_together(tool):
    done = tool("tsc", "--noEmit")
    assert done.returncode == 0, done.stdout + done.stderr


def test_vitest_passes(tool):
    done = tool("vitest", "run", "--reporter=dot")
    assert done.returncode == 0, done.stdout[-6000:] + done.stderr[-3000:]


def test_lock_file_holds_no_address():
    text = (WEB / "package-lock.json").read_text()
    assert "://" not in text
    entries = json.loads(text)["packages"]
    packages = [entry for name, entry in entries.items() if name.startswith("node_modules/")]
    assert packages and all("integrity" in entry for entry in packages)


def test_versions_are_pinned_exactly():
    package = json.loads((WEB / "package.json").read_text())
    pins = {**package["dependencies"], **package["devDependencies"]}
    assert [name for name, version in pins.items() if not re.fullmatch(r"\d+\.\d+\.\d+", version)] == []


def test_only_styles_of_components_in_use_are_imported():
    """Every Mantine component that the page imports has its style sheet, when it owns one."""
    styles = set(re.findall(r"core/styles/(\w+)\.css", (WEB / "src/app/styles.ts").read_text()))
    used = set()
    for source in (WEB / "src").rglob("*.tsx"):
        for names in re.findall(r"import \{([^}]*)\} from \"@mantine/core\"", source.read_text()):
            used |= {name.strip().removeprefix("type ") for name in names.split(",")}
    owned = {path.stem for path in (WEB / "node_modules/@mantine/core/styles").glob("[A-Z]*.css")}
    assert (used & owned) - styles == set()


IMPORT = re.compile(r"from \"(\.[^\"]+)\"")
ALLOWED = {
    "model": {"model"},
    "charts": {"charts", "model"},
    "ui": {"ui", "model"},
    "api": {"api", "model"},
    "features": {"model", "charts", "ui", "api"},
    "app": {"app", "model", "charts", "ui", "api", "features"},
}


def imported(source: Path) -> list[Path]:
    """What a file imports of ours, as paths below src/."""
    src = WEB / "src"
    targets = IMPORT.findall(source.read_text())
    return [(source.parent / target).resolve().relative_to(src.resolve()) for target in targets]


def test_rooms_import_only_what_stands_below_them():
    wrong = []
    for source in (WEB / "src").rglob("*.ts*"):
        own = source.relative_to(WEB / "src").parts
        if own[0] not in ALLOWED or ".test." in source.name:
            continue
        for target in imported(source):
            same_feature = own[0] == "features" and target.parts[:2] == own[:2]
            if target.parts[0] not in ALLOWED[own[0]] and not same_feature:
                wrong.append(f"{'/'.join(own)} imports {target}")
    assert wrong == []


def test_every_shown_control_of_the_contract_has_its_test_id():
    text = "\n".join(path.read_text() for path in (WEB / "src").rglob("*.tsx"))
    for name in (
        "run pause resume step stop pace sim-time follow scene-frame history-row nav-studio nav-runs "
        "nav-compare nav-docs compare-button compare-parameters compare-metrics runs-table theme-toggle attribution"
    ).split():
        assert re.search(rf"[\"']{name}[\"']", text), name
    assert "param-${" in text and "application-${" in text

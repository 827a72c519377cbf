"""Import contracts, light imports, and code without words of any activity."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from importlinter.api import read_configuration
from importlinter.application.use_cases import SUCCESS, lint_imports

from tangy_profiles.activity import Activity

ROOT = Path(__file__).parent.parent.parent
SOURCES = [
    path
    for floor in ("tangy_tui", "sim", "hw", "profiles")
    for path in sorted((ROOT / floor).rglob("*.py"))
]
HEAVY = {"sklearn", "cv2", "scipy", "pocketsphinx", "skimage", "numpy"}


def test_the_import_contracts_hold(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    assert lint_imports(config_filename="pyproject.toml", cache_dir=None) == SUCCESS


def test_the_contracts_name_every_layer() -> None:
    contracts = read_configuration(str(ROOT / "pyproject.toml"))["contracts_options"]
    floors = next(c for c in contracts if c["type"] == "layers" and "containers" not in c)
    assert floors["layers"] == ["tangy_tui", "tangy_sim | tangy_hw", "tangy_profiles"]
    barred: dict[str, set[str]] = {}
    for contract in contracts:
        if contract["type"] == "forbidden":
            for module in contract["forbidden_modules"]:
                barred.setdefault(module, set()).update(contract["source_modules"])
    engine = {"tangy_profiles", "tangy_sim", "tangy_hw", "tangy_tui.learning"}
    assert (
        engine | {"tangy_tui.interaction", "tangy_tui.monitoring"}
        <= barred["textual"] & barred["rich"]
    )


@pytest.mark.parametrize(
    "module", ["tangy_tui", "tangy_tui.cli", "tangy_tui.app.workspace", "tangy_tui.ui.screens.live"]
)
def test_importing_loads_nothing_heavy(module: str) -> None:
    code = f"import json, sys, {module}; print(json.dumps(sorted(sys.modules)))"
    done = subprocess.run(  # noqa: S603 - our own interpreter
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    loaded = {name.partition(".")[0] for name in json.loads(done.stdout)}
    assert "tangy_tui" in loaded
    assert not loaded & HEAVY
    if module == "tangy_tui":
        assert not loaded & {"textual", "rich", "typer"}


def test_the_engine_runs_without_a_screen() -> None:
    code = (
        "import json, sys\n"
        "import tangy_tui.learning.teaching_session, tangy_tui.learning.policy\n"
        "import tangy_tui.interaction.facilitation, tangy_tui.console.teaching\n"
        "import tangy_sim.worlds.world\n"
        "print(json.dumps(sorted(sys.modules)))\n"
    )
    done = subprocess.run(  # noqa: S603 - our own interpreter
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    loaded = {name.partition(".")[0] for name in json.loads(done.stdout)}
    assert not loaded & {"textual", "rich", "typer", *HEAVY}


def words_in_code(path: Path) -> Iterator[str]:
    """Yield the texts and names in a module, but not its docstrings and comments."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    told = {
        id(node.value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in told:
            yield node.value
        elif isinstance(node, ast.Name):
            yield node.id
        elif isinstance(node, ast.Attribute):
            yield node.attr


def test_the_code_contains_no_word_of_an_activity(activity: Activity) -> None:
    words = {
        activity.name,
        *(set(activity.behaviours) - {"encourage"}),
        *(state.name for state in activity.user_states),
        *(stage for stage in activity.stages if stage not in ("start", "end", "help")),
        *activity.strategies,
        "user1",
    }
    any_of_them = re.compile(rf"\b({'|'.join(map(re.escape, sorted(words)))})\b")
    found = {
        (path.name, word)
        for path in SOURCES
        for text in words_in_code(path)
        for word in any_of_them.findall(text.lower())
    }
    # The simulated people have a rate of that name, and sensors can be covered, whatever an unread
    # card is called.
    files = ("users.py", "world.py", "guidance.py", "injection.py", "people.py")
    assert found <= {(name, "occluded") for name in files}


def test_every_package_is_marked_as_typed() -> None:
    for package in ("tangy_tui", "sim/tangy_sim", "hw/tangy_hw", "profiles/tangy_profiles"):
        assert (ROOT / package / "py.typed").exists(), package


def test_no_handler_calls_the_one_that_it_overrides() -> None:
    # Textual calls the handlers of all base classes itself, so each would run twice.
    twice = [
        f"{path.name}:{call.lineno} {call.func.attr}"
        for path in sorted((ROOT / "tangy_tui" / "ui").rglob("*.py"))
        for call in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(call, ast.Call)
        and isinstance(call.func, ast.Attribute)
        and call.func.attr.startswith("on_")
        and call.func.attr != "on_event"  # Textual calls the handler of all events only once
        and isinstance(call.func.value, ast.Call)
        and isinstance(call.func.value.func, ast.Name)
        and call.func.value.func.id == "super"
    ]
    assert twice == []


def test_no_two_public_classes_share_a_name() -> None:
    places: dict[str, list[str]] = {}
    for path in SOURCES:
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                places.setdefault(node.name, []).append(path.name)
    assert {name: where for name, where in places.items() if len(where) > 1} == {}


def test_no_module_is_longer_than_400_lines() -> None:
    # by path: several folders have modules of the same name
    long = {str(path): path.read_text(encoding="utf-8").count("\n") for path in SOURCES}
    assert {name: lines for name, lines in long.items() if lines > 400} == {}


def test_each_test_file_has_a_unique_name() -> None:
    # pytest imports them by name alone: of two files with one name, it would miss one.
    names = sorted(path.name for path in (ROOT / "tests").rglob("test_*.py"))
    assert [name for name, after in pairwise(names) if name == after] == []

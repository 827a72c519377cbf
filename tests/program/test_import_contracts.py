"""The import contracts, each violated on a copy of the sources."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.source_copy import copy_sources, run_on


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    return copy_sources(tmp_path)


def lint(folder: Path) -> str:
    """Check the contracts of a copy; return the report on broken ones."""
    check = "from importlinter.cli import lint_imports; raise SystemExit(lint_imports())"
    done = run_on(folder, "-c", check)
    return done.stdout + done.stderr if done.returncode else ""


def adds(path: Path, line: str) -> None:
    """Add an import to a module, inside a function, where it is easiest to miss."""
    before = path.read_text(encoding="utf-8") if path.exists() else ""
    path.write_text(f"{before}\n\ndef late() -> None:\n    {line}\n", encoding="utf-8")


def test_the_sources_keep_every_contract(copy: Path) -> None:
    assert lint(copy) == ""


@pytest.mark.parametrize(
    ("module", "line", "named"),
    [
        ("tangy_tui/scoreboard.py", "import textual", "tangy_tui.scoreboard"),
        (
            "hw/tangy_hw/robot_client/client.py",
            "import numpy",
            "tangy_hw.robot_client.client -> numpy",
        ),
        (
            "hw/tangy_hw/drivers/scip_codec.py",
            "import tangy_hw.robot_client.live_world",
            "tangy_hw.drivers.scip_codec -> tangy_hw.robot_client.live_world",
        ),
        (
            "tangy_tui/ui/widgets/rows.py",
            "import tangy_tui.ui.screens.play",
            "tangy_tui.ui.widgets.rows -> tangy_tui.ui.screens.play",
        ),
    ],
)
def test_an_import_to_a_layer_above_is_refused_by_name(
    copy: Path, module: str, line: str, named: str
) -> None:
    adds(copy / module, line)
    assert named in lint(copy)


def test_an_indirect_import_by_a_new_module_is_refused(copy: Path) -> None:
    adds(copy / "tangy_tui/scoreboard.py", "import textual")
    adds(copy / "tangy_tui/learning/policy.py", "import tangy_tui.scoreboard")
    said = lint(copy)
    assert "tangy_tui.learning.policy -> tangy_tui.scoreboard" in said
    assert "tangy_tui.scoreboard -> textual" in said

"""The first screen loads no heavy package, and no part of the engine."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

HEAVY = ("sklearn", "cv2", "scipy", "pocketsphinx", "skimage", "numpy")
ENGINE = (
    "tangy_tui.language",
    "tangy_tui.learning",
    "tangy_tui.speech",
    "tangy_tui.interaction",
    "tangy_tui.monitoring",
    "tangy_tui.console",
    "tangy_tui.app.game_commands",
    "tangy_tui.app.command_grammar",
    "tangy_tui.app.teaching_grammar",
    "tangy_profiles.declared.activity",
    "tangy_profiles.game_records",
    "tangy_sim",
    "tangy_hw",
)
"""What games and teaching need, and home does not: each of these costs some ms at every start."""

PAINT = """
import asyncio, gc, json, sys
from pathlib import Path
import tangy_tui
from tangy_tui.app.workspace import Workspace
from tangy_tui.ui.program import Program

async def paint():
    with_workspace = Workspace(Path(sys.argv[1]))
    app = Program(with_workspace)
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.pause()
        strips = app.screen._compositor.render_strips()
        while not gc.isenabled():
            await pilot.pause()
        text = "\\n".join("".join(s.text for s in strip) for strip in strips)
    with_workspace.close()
    return text

gc.disable()  # as the command line does while it loads
text = asyncio.run(paint())
loaded = sorted({name.partition(".")[0] for name in sys.modules})
print(json.dumps({"text": text, "loaded": loaded, "kept": gc.get_freeze_count()}))
"""


@pytest.mark.slow
def test_the_first_screen_loads_nothing_heavy_and_collects_garbage_afterwards(
    tmp_path: Path,
) -> None:
    done = subprocess.run(  # noqa: S603 - our own interpreter
        [sys.executable, "-c", PAINT, str(tmp_path / "data")],
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    seen = json.loads(done.stdout)
    assert "Teach" in seen["text"]
    assert "textual" in seen["loaded"]
    assert not set(HEAVY) & set(seen["loaded"])
    assert seen["kept"] > 0


@pytest.mark.slow
@pytest.mark.parametrize("module", ["tangy_tui.ui.run", "tangy_tui.ui.dialogs.name"])
def test_home_and_the_name_dialog_load_no_part_of_the_engine(module: str) -> None:
    code = f"import sys, {module}; print(*sys.modules)"
    done = subprocess.run(  # noqa: S603 - our own interpreter
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    loaded = done.stdout.split()
    assert module in loaded
    assert not {*HEAVY} & set(loaded)
    assert [one for one in loaded if one.startswith(ENGINE)] == []

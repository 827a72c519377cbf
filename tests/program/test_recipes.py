"""The recipes of CONTRIBUTING.md, carried out on a copy of the sources."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from tests.support.source_copy import HOUSE, copy_sources, edit, run_on, tangy_on

pytestmark = pytest.mark.slow
CONTRIBUTING = Path(__file__).parents[2] / "CONTRIBUTING.md"


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    return copy_sources(tmp_path)


def recipe(title: str) -> str:
    """Return the section of CONTRIBUTING.md under a title."""
    _, section = CONTRIBUTING.read_text(encoding="utf-8").split(f"## {title}\n", 1)
    return section.partition("\n## ")[0]


def places(title: str, *named: str) -> None:
    """Check that a recipe names every place that the test edits."""
    missing = [place for place in named if place not in recipe(title)]
    assert not missing, f"CONTRIBUTING.md, {title!r}, does not name {missing}"


def test_the_recipe_for_an_activity_works(copy: Path, tmp_path: Path) -> None:
    source = "profiles/tangy_profiles/activities/bingo.toml"
    places("Add an activity", source, "tangy activity check FILE")
    mine = tmp_path / "mine.toml"
    text = (copy / source).read_text(encoding="utf-8")
    mine.write_text(text.replace('name = "bingo"', 'name = "mine"', 1), encoding="utf-8")
    checked = tangy_on(copy, "activity", "check", mine)
    assert checked.returncode == 0, checked.stderr
    edit(mine, 'effect = "draw"', 'effect = "drow"')
    checked = tangy_on(copy, "activity", "check", mine)
    assert checked.returncode == 2
    assert all(word in checked.stderr for word in ("mine.toml", "effect", "drow", "draw"))


def test_the_recipe_for_a_fault_works(copy: Path, taught: Path) -> None:
    rules, kinds = "profiles/tangy_profiles/faults.toml", "sim/tangy_sim/worlds/injection.py"
    robot, well = "profiles/tangy_profiles/robots/tangy.toml", "sim/tangy_sim/worlds/devices.py"
    places("Add a fault", rules, kinds, robot, well, "`KINDS`", "`READINGS`")
    edit(
        copy / robot,
        'label = "chest screen"\n',
        'label = "chest screen"\nfacts.brightness = { says = "brightness, 0 to 1", high = 1 }\n',
    )
    edit(copy / well, '"screen": {}', '"screen": {"brightness": 0.8}')
    edit(
        copy / rules,
        '[[faults]]\ncode = "arm-failed"',
        """[[faults]]
code = "screen-dim"
name = "Chest screen too dim"
criticality = "non-critical"
recovery = ["continue"]
device = "screen"
when = [{ "screen.brightness" = { below = 0.2 } }]
console = "The chest screen can hardly be read."
advice = ["Turn its brightness up."]

[[faults]]
code = "arm-failed\"""",
    )
    edit(
        copy / kinds,
        '    FaultKind("never-complies",',
        """    FaultKind("screen-dim", "the chest screen goes dim", "screen-dim", AT_ONCE,
         otherwise("screen", brightness=0.1)),
    FaultKind("never-complies",""",
    )
    assert "screen-dim" in tangy_on(copy, "play", "--inject", "help").stdout
    played = tangy_on(
        copy, "play", "--data", taught, "--seed", 4, "--inject", "screen-dim@3", "--json"
    )
    assert played.returncode == 0, played.stderr
    document = json.loads(played.stdout)
    assert [fault["code"] for fault in document["faults"]] == ["screen-dim"], played.stderr
    assert document["finished"] == 1


def test_the_recipe_for_a_method_of_persuasion_works(copy: Path, taught: Path) -> None:
    methods, names = "tangy_tui/interaction/methods.py", "profiles/tangy_profiles/persuading.py"
    words = "tangy_tui/text/people.py"
    places("Add a method of persuasion", methods, names, words, "`METHOD_TITLES`", "`_plain`")
    edit(copy / names, '["thompson", "bayes-ucb"]', '["thompson", "bayes-ucb", "turns"]')
    edit(
        copy / methods,
        "class BayesUcb(BetaBernoulliMethod):",
        """class Turns(BetaBernoulliMethod):
    words = "each in turn"

    def scores(self, beliefs, rng):
        return {name: -float(belief.trials) for name, belief in beliefs.items()}


class BayesUcb(BetaBernoulliMethod):""",
    )
    edit(
        copy / methods,
        '        case "bayes-ucb":',
        '        case "turns":\n            return Turns()\n        case "bayes-ucb":',
    )
    edit(copy / words, '    "bayes-ucb": "B', '    "turns": "each in turn",\n    "bayes-ucb": "B')
    chosen = tangy_on(copy, "people", "method", "user1", "turns", "--data", taught)
    assert chosen.returncode == 0, chosen.stderr
    shown = tangy_on(copy, "people", "show", "user1", "--data", taught)
    assert "each in turn" in shown.stdout


def test_the_recipe_for_a_kind_of_event_works(copy: Path) -> None:
    records = "profiles/tangy_profiles/people_records.py"
    places(
        "Add a kind of event", "people_records.py", "tests/support/every_kind.py", "test_events.py"
    )
    shutil.copytree(HOUSE / "tests", copy / "tests")
    told = "every_kind_of_event_is_written_and_read_by_the_program"
    tests = ["-m", "pytest", "-q", "-n", "0", "tests/profiles/test_events.py", "-k", told]
    edit(
        copy / records,
        '@kind("renamed", about="person")',
        '@kind("coffee")\nclass CoffeeBreak(EventRecord):\n    """A break."""\n\n'
        '    minutes: float = 10.0\n\n\n@kind("renamed", about="person")',
    )
    assert "CoffeeBreak ('coffee'): nothing in the program writes it" in run_on(copy, *tests).stdout
    uses = copy / "tangy_tui/app/coffee.py"
    uses.write_text(
        "from tangy_profiles.people_records import CoffeeBreak\n"
        "def begin(store): return store.append(CoffeeBreak(minutes=5.0))\n"
    )
    assert "CoffeeBreak ('coffee'): nothing in the program reads it" in run_on(copy, *tests).stdout
    with uses.open("a") as file:
        file.write("def breaks(store): return list(store.events(CoffeeBreak))\n")
    done = run_on(copy, *tests)
    assert done.returncode == 0, done.stdout


def test_mypy_names_each_place_that_lacks_a_new_effect(copy: Path) -> None:
    places("Add an effect of behaviours", "profiles/tangy_profiles/effects.py", "world.py")
    edit(
        copy / "profiles/tangy_profiles/effects.py",
        '    "finish",',
        '    "stretch",\n    "finish",',
    )
    names = copy / "profiles/tangy_profiles/persuading.py"
    edit(names, '["thompson", "bayes-ucb"]', '["thompson", "bayes-ucb", "turns"]')
    requests = copy / "hw/tangy_hw/robot_process/requests.py"
    edit(requests, '    "spin",\n', '    "spin",\n    "dance",\n')
    checked = run_on(copy, "-m", "mypy", "-p", "tangy_tui", "-p", "tangy_hw", "-p", "tangy_sim")
    for forgotten, where in (
        ("stretch", "sim/tangy_sim/worlds/world.py"),
        ("stretch", "hw/tangy_hw/robot_client/live_world.py"),
        ("turns", "tangy_tui/interaction/methods.py"),
        ("dance", "hw/tangy_hw/robot_process/process.py"),
    ):
        lines = [line for line in checked.stdout.splitlines() if where in line]
        assert any(forgotten in line for line in lines), f"{where}: {forgotten}\n{checked.stdout}"


def test_the_recipe_for_a_panel_works(copy: Path, taught: Path) -> None:
    places("Add a panel", "tangy_tui/ui/widgets/", "tangy_tui/ui/panels.py", "`compose`")
    (copy / "tangy_tui/ui/widgets/hello_panel.py").write_text(
        '''"""A panel."""

from textual.widgets import Static


class HelloPanel(Static):
    """Says hello."""
''',
        encoding="utf-8",
    )
    screen = copy / "tangy_tui/ui/screens/policy.py"
    edit(
        screen,
        "        yield panel(PolicyTable())\n",
        '        yield panel(HelloPanel("hello there"), "Greeting")\n'
        "        yield panel(PolicyTable())\n",
    )
    edit(
        screen,
        "from tangy_tui.ui.widgets.policy_table import",
        "from tangy_tui.ui.widgets.hello_panel import HelloPanel\n"
        "from tangy_tui.ui.widgets.policy_table import",
    )
    drawn = run_on(
        copy,
        "-c",
        f"""
import asyncio
from pathlib import Path
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policies import load_policy
from tangy_tui.ui.program import Program

async def main():
    workspace = Workspace(Path({str(taught)!r}))
    policy, _ = load_policy(workspace.store, workspace.activity)
    program = Program(workspace, lambda program: program.open_policy(policy))
    async with program.run_test(size=(120, 40)) as pilot:
        await pilot.pause()
        lines = program.screen._compositor.render_strips()
        print("\\n".join("".join(segment.text for segment in strip) for strip in lines))

asyncio.run(main())
""",
    )
    assert "Greeting" in drawn.stdout and "hello there" in drawn.stdout, drawn.stderr

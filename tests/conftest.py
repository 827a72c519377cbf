"""Shared fixtures: an activity, well demonstrated games, a store, the command line."""

from __future__ import annotations

import gc
import io
import os
import shutil
import signal
import sys
from collections.abc import Callable, Generator, Iterator
from functools import cache
from itertools import count
from pathlib import Path
from subprocess import CompletedProcess
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, settings

from tangy_profiles.activity import Activity, load_activity, read_activity
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.person import Person, load_people
from tangy_profiles.store import Store
from tangy_sim.worlds.users import load_users
from tangy_sim.worlds.world import SimulatedWorld
from tests.support.laws import AT_LENGTH, FEW

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.learning.policy import Policy

# The same examples in every run; HYPOTHESIS_PROFILE=explore tries new ones.
settings.register_profile(
    "tangy",
    deadline=None,
    derandomize=True,
    max_examples=FEW,  # so that the suite stays under five minutes; `explore` looks at many more
    suppress_health_check=[HealthCheck.too_slow],
)
settings.register_profile(
    "explore", settings.get_profile("tangy"), derandomize=False, max_examples=400
)
settings.register_profile(AT_LENGTH, settings.get_profile("tangy"))
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "tangy"))

# Screens and forests are many objects that live as long as their test: searching them for cycles
# after every 700 new ones, as Python does, takes a fifth of the suite's time.
gc.set_threshold(100_000, 10, 10)

# An installed program is compiled already. If the environment forbids writing compiled files, each
# of the hundreds of programs that tests start, and each worker, would compile everything again.
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# A shell's background job ignores Ctrl-C, and `nohup` makes it ignore a hang-up. Every program that
# tests start would inherit this: it would not end, and run on beside the tests that follow.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
if signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
    signal.signal(signal.SIGHUP, signal.SIG_DFL)

pytest_plugins = ["tests.support.hangs"]

TESTS = Path(__file__).parent

MEMORY, ROOM = Path("/dev/shm"), 4_000_000_000  # noqa: S108 - a disk in memory, bytes free there
if MEMORY.is_dir() and shutil.disk_usage(MEMORY).free >= ROOM:
    # The log waits for the disk after every event, and tests write tens of thousands of them.
    os.environ.setdefault("PYTEST_DEBUG_TEMPROOT", str(MEMORY))


@cache
def _activity(name: str) -> Activity:
    return load_activity(name) if name == "bingo" else read_activity(TESTS / f"{name}.toml")


@cache
def _demonstration(name: str, seed: int, users: int) -> Demonstration:
    activity = _activity(name)
    people = tuple(person.id for person in load_people(users))
    world = SimulatedWorld(activity, people, seed=seed, users=load_users().teaching())
    steps: list[Step] = []
    while not world.over:
        state = world.observe()
        behaviour = activity.behaviours[activity.expected[state.situation]]
        target = state.attended if behaviour.attends else None
        world.execute(activity.action(behaviour, target, None))
        steps.append(Step(behaviour.name, target, state, world.observe()))
    return Demonstration(f"{name}-{seed}", name, "test", seed, people, tuple(steps), True)


@pytest.fixture(scope="session", autouse=True)
def _own_cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Keep tests off the user's cache: a new name empties the cache of spoken lines."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        yield


@pytest.fixture(scope="session")
def activity() -> Activity:
    """The shipped activity."""
    return _activity("bingo")


@pytest.fixture(scope="session")
def lanterns() -> Activity:
    """A made-up activity with other words, another deck and another way to end."""
    return _activity("lanterns")


@pytest.fixture(scope="session")
def people() -> tuple[Person, ...]:
    """The four sample people."""
    return load_people(4)


@pytest.fixture(scope="session")
def ids(people: tuple[Person, ...]) -> tuple[str, ...]:
    """The ids of the four sample people."""
    return tuple(person.id for person in people)


@pytest.fixture(scope="session")
def demonstrate() -> Callable[[str, int, int], Demonstration]:
    """Demonstrate one teaching game as expected: (activity, seed, users) -> demonstration."""
    return _demonstration


@pytest.fixture(scope="session")
def cover() -> Callable[[str, int, int], tuple[Demonstration, ...]]:
    """Demonstrate games until every situation was shown: (activity, seed, users) -> games."""

    def covering(name: str, seed: int, users: int) -> tuple[Demonstration, ...]:
        missing = set(_activity(name).expected)
        shown: list[Demonstration] = []
        for game in count():
            shown.append(_demonstration(name, 1000 * seed + game, users))
            missing -= {step.state.situation for step in shown[-1].steps}
            if not missing:
                return tuple(shown)
        raise AssertionError("unreachable")

    return covering


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    """An empty log, open for writing."""
    with Store.open(tmp_path / "data") as opened:
        yield opened


@pytest.fixture(scope="session")
def _taught(tmp_path_factory: pytest.TempPathFactory) -> Path:
    from tangy_tui.app.training import learn
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.learning.scripted_teacher import ScriptedTeacher
    from tangy_tui.learning.teaching_events import Next

    folder = tmp_path_factory.mktemp("taught") / "data"
    workspace = Workspace(folder)
    teaching = workspace.teaching("scripted", 1)
    teaching.begin()
    for number in range(3):
        if number:
            teaching.apply(Next())
        list(ScriptedTeacher(teaching).demonstrate())
    learn(workspace)
    workspace.close()
    return folder


@pytest.fixture
def taught(_taught: Path, tmp_path: Path) -> Path:
    """A data folder with three demonstrations and a policy learnt from them."""
    return Path(shutil.copytree(_taught, tmp_path / "taught"))


@pytest.fixture(scope="session")
def learnt(_taught: Path, tmp_path_factory: pytest.TempPathFactory) -> Policy:
    """The policy of the taught folder, fitted once for all tests."""
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.learning.policies import load_policy

    workspace = Workspace(
        Path(shutil.copytree(_taught, tmp_path_factory.mktemp("learnt") / "data"))
    )
    try:
        return load_policy(workspace.store, workspace.activity)[0]
    finally:
        workspace.close()


@pytest.fixture
def data_folder(tmp_path: Path) -> Path:
    """The data folder of `workspace`; tests that begin with data override it."""
    return tmp_path / "data"


@pytest.fixture
def workspace(data_folder: Path) -> Iterator[Workspace]:
    """A workspace with its own data folder and no policy yet."""
    from tangy_tui.app.workspace import Workspace

    opened = Workspace(data_folder)
    yield opened
    opened.close()


@pytest.fixture
def tangy(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> Callable[..., CompletedProcess[str]]:
    """Run the command line in this process: `tangy("play", "--json", stdin="")`."""
    from tangy_tui.cli import main

    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "home"))

    def run(*arguments: object, stdin: str = "") -> CompletedProcess[str]:
        monkeypatch.setattr(sys, "argv", ["tangy", *map(str, arguments)])
        monkeypatch.setattr(sys, "stdin", io.StringIO(stdin))
        capsys.readouterr()
        with pytest.raises(SystemExit) as stop:
            main()
        status = stop.value.code
        assert isinstance(status, int)
        return CompletedProcess(sys.argv, status, *capsys.readouterr())

    return run


def pytest_xdist_auto_num_workers() -> int:
    """Use two workers more than there are cores: many tests wait for a terminal or a process."""
    return (os.cpu_count() or 1) + 2


def pytest_configure(config: pytest.Config) -> None:
    """Let workers share folders, so that each finds the files that others have compiled.

    Pytest rewrites every `assert` of a fresh checkout, which takes as long as importing everything.
    """
    about = getattr(config, "workerinput", None)
    if about is None or config.args != ["tests"]:
        return
    there = [
        at for at in sorted(TESTS.iterdir()) if at.match("test_*.py") or any(at.rglob("test_*.py"))
    ]
    number = int(str(about["workerid"]).removeprefix("gw"))
    first = number * len(there) // int(about["workercount"])
    config.args[:] = [f"tests/{at.name}" for at in there[first:] + there[:first]]
    config.pluginmanager.register(InOrder())


class InOrder:
    """Restores the order of files, which is the same on every worker."""

    @pytest.hookimpl(tryfirst=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Sort the collected tests."""
        items.sort(key=lambda item: item.path)


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Keep tests with shared costly preparations on one worker (`xdist_group`).

    From pytest 9.2 on, pytest-xdist 3.8 writes the group where nothing reads it, without a
    warning (pytest-xdist#1386): three workers then prepare, or wait for, the same thing.
    """
    for item in items if config.getoption("loadgroup", False) else ():
        groups = sorted({str(mark.args[0]) for mark in item.iter_markers("xdist_group")})
        there = getattr(item, "_id", None)  # missing before pytest 9.2, where xdist works
        if groups and there is not None:
            group = "_".join(groups)
            setattr(item, "_id", type(there).parse(f"{item.nodeid}@{group}"))  # noqa: B010
    if config.getoption("loadgroup", False):  # else one worker remains when the others are done
        items.sort(key=lambda item: item.get_closest_marker("xdist_group") is None)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Fail skipped tests if every program that tests drive is installed (`.ci/run` says so).

    Tests that need something that no package brings (`elsewhere`) may skip, with their reason.
    """
    report = yield
    elsewhere = item.get_closest_marker("elsewhere") is not None
    if report.skipped and not elsewhere and os.environ.get("TANGY_NOTHING_SKIPS"):
        report.outcome = "failed"
        report.longrepr = f"{item.nodeid} skipped, but nothing may skip here: {report.longrepr}"
    return report

"""A live robot halted by a fault: slow recoveries keep the screen responsive, and STOP works."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, cast

import pytest

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_hw.robot_process.stop_latch import FAULT, STAFF
from tangy_profiles.contacts import EXPERT, STAFF_ROLE, Contact
from tangy_profiles.faults import Remedy
from tangy_profiles.game_records import CallMade
from tangy_profiles.health import ERROR, STALE, DeviceState
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.calls import Calls
from tangy_tui.text import halts
from tangy_tui.ui.dialogs.critical import CriticalDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.help import HelpScreen
from tangy_tui.ui.widgets.log_view import LogView
from tests.pilot.live_games import HeldLink, held_world, live, live_program, paused_after
from tests.support.telephone import ANNA, STATION, Line
from tests.support.waiting import until_shown

if TYPE_CHECKING:
    from tests.pilot.conftest import Run, TangyPilot


class HeldWorld(LiveWorld):
    """A world whose recoveries wait until the test lets the robot act."""

    def recover(self, remedy: Remedy) -> float:
        if remedy.kind != "halt":
            cast(HeldLink, self.link).be_let()
        return super().recover(remedy)


@pytest.fixture
def program(workspace: Workspace, link: HeldLink, policy: Policy) -> Program:
    return live_program(workspace, held_world(workspace, link, HeldWorld), policy)


def seen(pilot: TangyPilot) -> str:
    """Return the readable text, on one line."""
    return " ".join(pilot.text().split())


async def halting(
    pilot: TangyPilot, link: HeldLink, device: str, state: DeviceState = "OK"
) -> None:
    """Pause the game, let a device fail, and wait until the dialog takes keys."""
    await paused_after(pilot, link, 2)
    if device == "link":
        link.silent = "the robot process has ended"
    if device == "navigator":
        link.state = replace(link.state, failed="its control has failed")
    link.ail(device, state, latched=True)
    await until_shown(pilot, lambda: isinstance(pilot.app.screen, CriticalDialog))
    dialog = pilot.app.screen
    assert isinstance(dialog, CriticalDialog)
    await until_shown(pilot, lambda: dialog.fresh_keys.seen)
    await pilot.pause()


async def lives(pilot: TangyPilot, link: HeldLink) -> None:
    """Wait until the screen has sent another sign of life."""
    stamps = link.stamps
    await until_shown(pilot, lambda: link.stamps > stamps + 1)


@pytest.mark.slow
@pytest.mark.parametrize(("device", "state"), [("link", STALE), ("navigator", ERROR)])
async def test_the_screen_stays_responsive_while_the_robot_process_restarts(
    run: Run, program: Program, link: HeldLink, device: str, state: DeviceState
) -> None:
    async with run(app=program, size=(120, 40)) as pilot:
        await halting(pilot, link, device, state)
        link.free = False
        try:
            await pilot.press("e")
            assert f"! {halts.RESTARTING}" in seen(pilot)
            await lives(pilot, link)
            await pilot.press("r")
            assert f"! {halts.wait_words(halts.RESTARTING)}" in seen(pilot)
            assert "^x STOP" in pilot.text() and "r all is well" not in pilot.text()
            await pilot.press("ctrl+x")
            assert link.told[-1] == "stop: staff stopped it" and "STOPPED" in pilot.lines()[0]
            link.told.append("another process")
        finally:
            link.free = True
        await until_shown(pilot, lambda: f"{halts.RESTARTED} No expert is named" in seen(pilot))
        assert link.told[-1] == "stop: staff stopped it"  # the new process gets the command as well
        assert "r all is well" in pilot.text()


@pytest.mark.slow
async def test_the_screen_stays_responsive_while_a_fault_is_checked(
    run: Run, program: Program, link: HeldLink
) -> None:
    async with run(app=program, size=(120, 40)) as pilot:
        await halting(pilot, link, "stop_button")
        link.ail("stop_button")
        link.free = False
        try:
            await pilot.press("a", "r")
            assert f"! {halts.LOOKING}" in seen(pilot)
            await lives(pilot, link)
            await pilot.press("escape")
            assert f"! {halts.wait_words(halts.LOOKING)}" in seen(pilot)
            await pilot.press("ctrl+x")
            assert "stop: staff stopped it" in link.told
        finally:
            link.free = True
        await until_shown(pilot, lambda: pilot.app.screen is live(pilot))
        assert live(pilot).control.supervision.halted is None


@pytest.mark.slow
async def test_clearing_a_fault_does_not_release_a_stop(
    run: Run, program: Program, link: HeldLink
) -> None:
    async with run(app=program, size=(120, 40)) as pilot:
        await halting(pilot, link, "stop_button")
        await pilot.press("ctrl+x")
        released = len(link.released)
        link.ail("stop_button")
        await pilot.press("a", "r")
        await until_shown(pilot, lambda: pilot.app.screen is live(pilot))
        assert live(pilot).control.supervision.halted is None
        done = len(link.done)
        await lives(pilot, link)
        assert STAFF in link.held_by and "STOPPED" in pilot.lines()[0]
        assert link.done[done:] == [] and link.released[released:] == [FAULT]
        await pilot.press("p", "y")
        assert not link.held_by


@pytest.mark.slow
async def test_a_fault_cleared_under_the_help_closes_with_it(
    run: Run, program: Program, link: HeldLink
) -> None:
    async with run(app=program) as pilot:
        await halting(pilot, link, "stop_button")
        link.ail("stop_button")
        link.free = False
        try:
            await pilot.press("a", "r", "question_mark")
            await until_shown(pilot, lambda: isinstance(pilot.app.screen, HelpScreen))
        finally:
            link.free = True
        await until_shown(pilot, lambda: live(pilot).control.supervision.halted is None)
        await pilot.pause()
        await pilot.press("escape")
        await until_shown(pilot, lambda: pilot.app.screen is live(pilot))


@pytest.mark.slow
async def test_a_lost_link_is_renamed_when_it_proves_to_be_a_freeze(
    run: Run, program: Program, link: HeldLink
) -> None:
    async with run(app=program, size=(120, 40)) as pilot:
        await halting(pilot, link, "link", STALE)
        assert "Link to the robot lost" in seen(pilot)
        link.silent = ""
        link.ail("link", frozen=4.0)
        await until_shown(pilot, lambda: "stands still: The robot's own program" in seen(pilot))
        assert "network" not in seen(pilot), "nobody is sent to the cables"


async def halted_with_an_expert(
    pilot: TangyPilot,
    link: HeldLink,
    workspace: Workspace,
    line: Line,
    staff: Contact | None = None,
) -> None:
    """Let the stop button halt a game in which Tangy itself can call the expert, and staff."""
    await paused_after(pilot, link, 2)
    supervision = live(pilot).control.supervision
    supervision.robot = replace(workspace.robot, expert=ANNA, staff=staff)
    calls = Calls(supervision.robot, workspace.store.append, line, buttons=link)
    supervision.call_by(calls)
    await halting(pilot, link, "stop_button")


async def test_the_dialog_reports_each_call_and_repeats_a_failed_one(
    run: Run,
    program: Program,
    link: HeldLink,
    workspace: Workspace,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("tangy_tui.monitoring.supervision.FIRST_SECONDS", 0.0)
    line = Line()
    async with run(app=program, size=(120, 40)) as pilot:
        await halted_with_an_expert(pilot, link, workspace, line)
        await pilot.press("e")
        await until_shown(pilot, lambda: "sending a message to Anna Berg" in seen(pilot))
        line.says("Anna Berg", "failed", "no line")
        await until_shown(pilot, lambda: "Tangy cannot reach Anna Berg (no line)" in seen(pilot))
        assert "R reached" in seen(pilot)
        await pilot.press("e")
        await until_shown(pilot, lambda: len(line.messages) == 2)
        line.says("Anna Berg", "sent")
        await until_shown(pilot, lambda: "has sent a message to Anna Berg" in seen(pilot))
        await pilot.press("e")  # that call is still unanswered
        assert len(line.messages) == 2
        line.says("Anna Berg", "answered", "I am on my way")
        await until_shown(
            pilot, lambda: "Anna Berg was reached, and answered: I am on my way." in seen(pilot)
        )
        await until_shown(pilot, lambda: "R reached" not in seen(pilot))
        sentences = live(pilot).query_one(LogView).sentences
        assert [one for one in sentences if one.startswith("The expert (http)")] == [
            "The expert (http): a message is being sent.",
            "The expert (http): could not be reached: no line.",
            "The expert (http): a message is being sent.",
            "The expert (http): a message was sent, and not answered yet.",
            "The expert (http): was reached, and answered: I am on my way.",
        ]
    calls = [e.record for e in workspace.store.events(CallMade) if e.record.role == EXPERT]
    assert [(call.stage, call.said) for call in calls] == [
        ("tried", ""),
        ("failed", "no line"),
        ("tried", ""),
        ("sent", ""),
        ("answered", "I am on my way"),
    ]


async def test_the_dialog_names_who_answered_on_the_chest_screen(
    run: Run,
    program: Program,
    link: HeldLink,
    workspace: Workspace,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("tangy_tui.monitoring.supervision.FIRST_SECONDS", 0.0)
    line = Line()
    async with run(app=program, size=(120, 40)) as pilot:
        await halted_with_an_expert(pilot, link, workspace, line, STATION)
        await until_shown(pilot, lambda: "sending a message to Station 2" in seen(pilot))
        assert list(link.offered.values()) == ["Station 2"]
        (staff,) = link.offered
        await pilot.press("e")
        await until_shown(pilot, lambda: len(link.offered) == 2)
        link.on_answer(staff)
        told = "! Station 2 was reached: they answered on the chest screen."
        await until_shown(pilot, lambda: told in seen(pilot))
        assert list(link.offered.values()) == ["Anna Berg"]
        link.ail("stop_button")
        await pilot.press("a", "r")
        await until_shown(pilot, lambda: pilot.app.screen is live(pilot))
        assert link.offered == {}  # nobody needs to come any more
    calls = [e.record for e in workspace.store.events(CallMade) if e.record.role == STAFF_ROLE]
    assert [(call.stage, call.way) for call in calls] == [
        ("tried", "command"),
        ("answered", "chest screen"),
    ]


@pytest.mark.slow
async def test_the_screen_stays_responsive_while_a_call_is_pending(
    run: Run,
    program: Program,
    link: HeldLink,
    workspace: Workspace,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("tangy_tui.monitoring.supervision.FIRST_SECONDS", 60.0)
    line = Line()
    async with run(app=program, size=(120, 40)) as pilot:
        await halted_with_an_expert(pilot, link, workspace, line)
        try:
            await pilot.press("e")
            await until_shown(pilot, lambda: "! Tangy calls Anna Berg" in seen(pilot))
            await lives(pilot, link)
            await pilot.press("ctrl+x")
            await until_shown(pilot, lambda: "stop: staff stopped it" in link.told)
        finally:
            line.says("Anna Berg", "answered")
        await until_shown(pilot, lambda: "Anna Berg was reached, and answered." in seen(pilot))

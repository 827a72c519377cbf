"""A call answered on the robot's chest screen, from the button to the log."""

from __future__ import annotations

from dataclasses import replace
from http.client import HTTPConnection
from urllib.parse import quote, urlsplit

import pytest

from tangy_profiles.contacts import EXPERT, STAFF_ROLE
from tangy_profiles.fault_file import load_faults
from tangy_profiles.game_records import CallMade
from tangy_tui.app.robot_opening import open_bench
from tangy_tui.app.simulated_devices_world import BenchedWorld
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.calls import AT_ROBOT, Calls
from tangy_tui.text.calls import staff_words
from tests.support.telephone import ANNA, STATION, Line
from tests.support.waiting import wait_until

pytestmark = pytest.mark.slow


def posted(address: str, target: str, body: str = "", cookie: str = "") -> tuple[int, str]:
    """Send a page's request as a tablet does; return the status and the new cookie."""
    place = urlsplit(address)
    page = HTTPConnection(place.hostname or "", place.port, timeout=30)
    page.request("POST", target, body, {"Cookie": cookie} if cookie else {})
    answer = page.getresponse()
    page.close()
    return answer.status, (answer.getheader("Set-Cookie") or "").partition(";")[0]


def test_a_press_on_the_chest_screen_reaches_the_console_and_the_log(
    workspace: Workspace, learnt: Policy
) -> None:
    robot = replace(workspace.robot, expert=ANNA, staff=STATION)
    book = load_faults(robot)
    game = workspace.supervision(learnt, 1, injections=["laser-disconnected@2"])
    with open_bench(workspace, seed=3, stepped=True, book=book, kind=BenchedWorld) as world:
        link = world.link
        calls = Calls(robot, workspace.store.append, Line(), buttons=link)
        game.call_by(calls)
        game.begin()
        while game.halted is None:
            game.step()
        fault, target = game.halted, f"/answer?call={quote(f'{STAFF_ROLE} {game.halted.id}')}"
        status, cookie = posted(link.screen, "/pair", link.code.replace("-", ""))
        assert status == 204

        def pressed() -> bool:  # once the page shows the call
            return posted(link.screen, target, cookie=cookie)[0] == 204

        assert posted(link.screen, target)[0] == 403  # a stranger's browser
        wait_until(pressed, "the button is there")
        wait_until(lambda: AT_ROBOT in staff_words(game), "the console says so")
        assert staff_words(game) == "Station 2 was reached: they answered on the chest screen."
        assert calls.state(EXPERT) is None
        wait_until(lambda: not pressed(), "the button has gone")
    made = [e.record for e in workspace.store.events(CallMade)]
    assert [(one.stage, one.way) for one in made] == [("tried", "command"), ("answered", AT_ROBOT)]
    assert {one.fault for one in made} == {fault.id}

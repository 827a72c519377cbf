"""`tangy live`: play games with a real robot, or on the bench."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import typer

from tangy_tui.text.hearing import LISTENING_NEEDS_SCREEN
from tangy_tui.verbs.common import takes
from tangy_tui.verbs.live_options import LiveOptions
from tangy_tui.verbs.opening import open_workspace
from tangy_tui.verbs.playing import (
    INJECT_HELP,
    check_injections,
    list_injections,
    recall,
    tell_small_room,
    who_answers,
)
from tangy_tui.verbs.resuming import past_game

if TYPE_CHECKING:
    from collections.abc import Callable

    from tangy_profiles.past_game import PastGame
    from tangy_sim.worlds.injection import Injection
    from tangy_tui.app.robot_opening import WorldOpening
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.learning.policy import Policy

PACE = 30.0  # as in tangy_hw.robot_client.live_world, which must not be imported here


@takes(LiveOptions)
def live(given: LiveOptions) -> None:
    """Play games with a robot by the policy learnt.

    The robot's file names its drivers (see docs/robots.md). With --bench the same drivers talk to
    simulated devices. Tangy monitors the devices all the time and diagnoses faults; a critical
    fault stops the robot until staff clear it. With --mic Tangy listens: "stop the robot" stops
    it at once, and you can answer its questions by voice.
    """
    if INJECT_HELP in (given.inject or ()):
        list_injections(given.as_json)
        return
    who = who_answers(given.teacher, given.expert, given.data)
    given.check()
    injections = given.injections()
    screen, sound = given.opens_screen(LISTENING_NEEDS_SCREEN)
    from tangy_tui.app.machine_load import machine_load

    with (
        machine_load(given.load),
        open_workspace(
            given.data, given.activity, given.users, robot=given.robot, room=given.room
        ) as workspace,
    ):
        games = _prepare(given, workspace, who, injections, screen=screen)
        if screen:
            raise typer.Exit(_play_on_screen(games, sound))
        from tangy_tui.verbs.live_console import GamesWithoutScreen

        if not GamesWithoutScreen(games).play():
            raise typer.Exit(1)  # so that a script knows that games stopped early


@dataclass(frozen=True)
class PreparedGames:
    """Live games before the robot is switched on."""

    given: LiveOptions
    workspace: Workspace
    who: str
    """Who answers Tangy's questions."""
    policy: Policy
    past: PastGame | None
    """An interrupted game to resume first."""
    seed: int
    opening: Callable[[int], WorldOpening]
    """Returns, for a seed, what switches the robot on."""


def _prepare(
    given: LiveOptions,
    workspace: Workspace,
    who: str,
    injections: tuple[Injection, ...],
    *,
    screen: bool,
) -> PreparedGames:
    """Choose the policy and the interrupted game; check the map, the faults and the cards.

    Raises:
        TangyError: one of them cannot be used.
        typer.Exit: staff play nothing now.
    """
    from tangy_tui.app.on_duty import take_duty
    from tangy_tui.learning.policies import need_policy

    need_policy(workspace.store, workspace.activity, given.policy)
    if given.by:
        take_duty(workspace.store.folder, given.by)
    tell_small_room(workspace)
    past = past_game(
        workspace, given.world, resume=given.resume, discard=given.discard, asks=screen,
        lines=given.plain_lines, report=given.report,
    )  # fmt: skip
    policy = recall(workspace, given.policy, quiet=given.as_json or screen)
    seed = workspace.game_seed(given.seed) if past is None else past.beginning.seed
    from tangy_tui.app.robot_opening import check_map

    if given.map_:
        check_map(workspace, given.map_)
    check_injections(injections, workspace)
    opening = _opening(given, workspace, injections)
    return PreparedGames(given, workspace, who, policy, past, seed, opening)


def _opening(
    given: LiveOptions, workspace: Workspace, injections: tuple[Injection, ...]
) -> Callable[[int], WorldOpening]:
    """Return what makes the opening of the robot for a seed.

    Raises:
        TangyError: the corners of the table or the cards of people are wrong.
    """
    from tangy_hw.perception.requests.source_names import read_corners
    from tangy_tui.app.dealing import read_dealt
    from tangy_tui.app.robot_opening import opening_of
    from tangy_tui.text.control import WAIT_EXPLANATIONS

    own = {
        "cameras": given.camera or (),
        "requests": given.requests,
        "corners": read_corners(given.table),
        "cards": read_dealt(given.card or (), workspace.people),
        "courtesies": WAIT_EXPLANATIONS,
    }
    both: dict[str, Any] = {"pace": given.pace or PACE, "map_": given.map_, "lost": given.lost}
    both |= {"injections": injections, "link": given.link}
    return lambda seed: opening_of(workspace, bench=given.bench, own=own, seed=seed, **both)


def _play_on_screen(games: PreparedGames, sound: int) -> int:
    """Play on the live screen; return the exit status.

    Args:
        games: the games.
        sound: the file descriptor of the microphone `-`.
    """
    from tangy_tui.ui.run import run_live

    given, workspace = games.given, games.workspace
    return run_live(
        workspace,
        games.opening,
        games.policy,
        games=given.games,
        seed=games.seed,
        teacher="" if given.teacher is None else games.who,
        ascii_only=given.ascii_only,
        world=given.world,
        report=given.report,
        past=games.past,
        set_up=not given.begin,
        pace=given.pace,
        ears=given.listening.ears(
            workspace, workspace.phrasebook(), games.who, sound=sound, spoken=True
        ),
    )

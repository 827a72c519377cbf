"""Shows the view for staff on the panels of a screen."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tangy_profiles.game_world import SIMULATED
from tangy_profiles.planned_game import PlannedGame, as_planned
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.game_moment import plays_on
from tangy_tui.app.readiness import battery_of
from tangy_tui.app.staff_view import PersonNow, StaffView, next_step
from tangy_tui.text import staff_view as text
from tangy_tui.text.control import claimed_words, person_wait_words, stopped_words
from tangy_tui.text.joining import sets_up_words
from tangy_tui.text.planned_time import Fact, time_facts
from tangy_tui.ui.widgets.call_board import CallBoard, column_row
from tangy_tui.ui.widgets.staff_panel import BOARD, PersonLine, StaffPanel
from tangy_tui.world import World

INKS = {"asks": "warn", "visited": "robot", "comes": "robot", "away": "dim", "plays": "text"}
BEFORE = 4
"""The number of calls beside the last one."""


@dataclass(frozen=True, slots=True)
class ViewSource:
    """What a view is shown with: the world, the controller, names.

    `said` is Tangy's last speech, "" if there is none yet.
    """

    world: World
    control: GameController
    name: Callable[[str], str]
    said: str = ""
    report: str = ""
    """How to get the report of a game that is over."""
    typed: str = ""
    """What staff have typed that Tangy does next, until it asks."""


def show_view(panel: StaffPanel, board: CallBoard, view: StaffView, shown: ViewSource) -> None:
    """Show a view on the staff panel, and its calls on the board."""
    label = shown.world.activity.deck.label
    board.show(view.called)
    call = label(view.called[-1]) if view.called else ""
    columns = () if board.display else shown.world.activity.deck.columns
    panel.show(
        call,
        next_line(shown),
        _facts(view, shown, last=not columns),
        person_lines(view.people, shown.name),
        [column_row(column, view.called, BOARD) for column in columns],
        text.said_words(shown.said) if shown.said else "",
        news_line(shown),
    )


def news_line(shown: ViewSource) -> str:
    """Tell which claims win, and the result of the last one; "" if none is news."""
    plan = shown.control.plan
    return " ".join(claimed_words(one, shown.name, plan.calling) for one in plan.claims)


def next_line(shown: ViewSource) -> str:
    """Tell what Tangy does next and why, or why it does nothing."""
    control, world = shown.control, shown.world
    if control.joined:
        return sets_up_words(control.welcomes)
    if control.beginning:
        return text.NEXT_BEGINS if control.supervision.games else text.BEGINS
    if control.supervision.over:
        if not control.supervision.games:
            return text.PAUSED if control.past is not None else ""
        won = "" if (game := as_planned(world)) is None else _won_words(game, shown.name)
        return " ".join(filter(None, (text.OVER, won, shown.report)))
    if control.stopped:
        return f"{stopped_words(control.stopped_by)}."
    if control.phase == "asking":
        return text.TANGY_WAITS
    if control.taking_over:
        return text.you_say_words(shown.typed)
    if control.welcomes:
        return text.welcomes_words(control.welcomes)
    planned = as_planned(world)
    found = next_step(world, control.supervision.policy)
    calls_first = 0 if planned is None else planned.tracker.calls_first
    pattern = "" if planned is None else plays_on(planned)
    words, _ = text.settled_words(control.plan.claim, pattern, shown.name)
    if control.obeys is not None:
        behaviour, whom = control.obeys
        words = text.obeys_words(behaviour, shown.name(whom) if whom else "")
    if waits := person_wait_words(control.robot.waits_for, shown.name):
        words = f"{words} {waits}".strip() if control.obeys is not None else waits
    if not words and planned is not None and planned.looking:
        words = text.looks_words(shown.name(planned.looking), world.activity.object)
    elif not words and found is not None:
        words = text.next_words(
            world.activity,
            *found,
            shown.name,
            calls_first,
            then="".join(map(shown.name, planned.tracker.queue[:1])) if planned else "",
            claims=planned.vouched if planned else (),
            waits=control.robot.rests(found[0]),
        )
    if control.going:
        return words
    return f"{text.PAUSES_THEN if control.stepping else text.PAUSED} {words}".strip()


def _won_words(game: PlannedGame, name: Callable[[str], str]) -> str:
    return text.won_words([name(one) for one in game.has_won])


def _facts(view: StaffView, shown: ViewSource, *, last: bool) -> list[Fact]:
    """Return the facts beside the call, with the last few calls if wanted."""
    world, label = shown.world, shown.world.activity.deck.label
    planned = shown.control.time
    now = None if world.played_in == SIMULATED else planned.clock()  # simulated time runs otherwise
    time = time_facts(view.seconds, planned.ends, view.paused, now, stopped=shown.control.stopped)
    before = "  ".join(label(number) for number in view.called[-2 : -2 - BEFORE : -1] if last)
    if not world.activity.deck.columns:  # the activity has no calls
        return [
            time,
            text.tangy_words(shown.control.autonomy.level, battery_of(world)),
        ]
    count = f"{len(view.called)} called" if view.called else text.NOTHING_CALLED
    game = as_planned(world)
    won = [] if game is None else [shown.name(one) for one in game.has_won]
    return [
        f"{count}   {before}".rstrip(),
        time,
        text.pace_words(view),
        "" if game is None else text.played_facts(game.patterns),
        text.SEVERAL_WINNERS if game is not None and game.game_plan.several else "",
        text.winners_facts(won),
        text.tangy_words(shown.control.autonomy.level, battery_of(world)),
    ]


def person_lines(people: Sequence[PersonNow], name: Callable[[str], str]) -> list[PersonLine]:
    """Format a line for each person: those who ask first, absent ones last."""
    ordered = sorted(people, key=lambda one: (not one.turn, one.turn, one.state == "away"))
    return [_person(person, name) for person in ordered]


def _person(person: PersonNow, name: Callable[[str], str]) -> PersonLine:
    turn = f"{person.turn}. " if person.turn else ""
    return f"{turn}{name(person.id)}", text.person_words(person), INKS[person.state]

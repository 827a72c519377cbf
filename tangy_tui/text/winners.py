"""Words for who has won in a running game."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_profiles.planned_game import PlannedGame, Won, as_planned
from tangy_tui.text.staff_view import HAS_WON, OVER

if TYPE_CHECKING:
    from tangy_tui.app.game_controller import GameController
    from tangy_tui.text.situations import Name

WHO_WON = "Who has won?"
"""The title of the answer."""
NO_WINNERS = "In this activity Tangy does not say who has won."


def won_lines(control: GameController, name: Name) -> list[str]:
    """Tell who has won, with which pattern and card, and at which call."""
    game = as_planned(control.supervision.world)
    if game is None:
        people = control.view().people
        counts = [
            (one, [f"{what.replace('_', ' ')} {n}" for what, n in one.counts]) for one in people
        ]
        told = [f"{name(one.id)}: {', '.join(each)}." for one, each in counts if each]
        return [NO_WINNERS, *told]
    over = control.supervision.over and control.supervision.games > 0
    told = [_one_win(game, win, name) for win in game.all_wins]
    if not over:
        told += [
            f"{name(one)}'s card wins: Tangy still has to go there."
            for one in game.tracker.queue
            if one in game.vouched
        ]
    nobody = "Nobody has won." if over else "Nobody has won yet."
    return [*([OVER] if over else []), *(told or [nobody])]


def _one_win(game: PlannedGame, win: Won, name: Name) -> str:
    card = game.known_cards.get(win.person, 0)
    called = f"call {win.calls} ({game.activity.deck.label(win.number)})" if win.calls else ""
    how = ", ".join(filter(None, (f"card {card}" if card else "", called)))
    pattern = f" with {win.pattern}" if win.pattern else ""
    return f"{name(win.person)} {HAS_WON}{pattern}{f': {how}' if how else ''}."

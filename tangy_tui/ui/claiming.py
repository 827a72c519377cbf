"""Asks staff whose card a claim is about."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from textual.app import App

from tangy_tui.app.game_commands import ClaimCard
from tangy_tui.app.plan_controls import GamePlanControls
from tangy_tui.text.typed_commands import NOBODY_KNOWS, has_card_words, whose_words
from tangy_tui.ui.dialogs.choose import ChooseDialog, Option


async def ask_whose(
    app: App[Any],
    plan: GamePlanControls,
    claim: ClaimCard,
    people: Sequence[str],
    name: Callable[[str], str],
) -> ClaimCard | None:
    """Ask which of some people (ids) has the card of a claim; None checks nothing.

    If Tangy knows another card of each of them, it says so.
    """
    known = {} if plan.world is None else plan.world.known_cards
    all_known = all(person in known for person in people)
    options = [Option(one, name(one), has_card_words(known.get(one))) for one in people]
    if not all_known:
        options.append(Option(*NOBODY_KNOWS))
    dialog = ChooseDialog(whose_words(claim.card, all_known=all_known), options)
    if (person := await app.push_screen_wait(dialog)) is None:
        return None
    return claim if person == NOBODY_KNOWS[0] else replace(claim, person=person)

"""Owners of cards on the live screen: Tangy's doubts, and the answers of staff."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from textual.app import App

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_tui.app.card_news import BY, CardNews
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.workspace import Workspace
from tangy_tui.monitoring.supervision import Event, Supervision
from tangy_tui.text.cards import KEY_HINT, LEARNT_NEXT, WHOSE, which_words
from tangy_tui.text.live_news import note_words
from tangy_tui.text.telling import TELL_HINT, card_question
from tangy_tui.ui.dialogs.choose import ChooseDialog, Option
from tangy_tui.ui.widgets.log_view import Kind

LEARN = "learn"


class LiveCards:
    """Tells staff about cards that Tangy does not judge, and asks who owns them."""

    def __init__(
        self,
        workspace: Workspace,
        supervision: Supervision,
        world: LiveWorld,
        write: Callable[[str, Kind], None],
    ) -> None:
        """Follow the cards of a world; `write` shows a line with an ink."""
        self._workspace = workspace
        self._supervision = supervision
        self._cards, self._eyes, self._asks = world.cards, world.eyes, ""
        self._write = write
        self._news = CardNews()

    def tell(self, events: Sequence[Event] = ()) -> None:
        """Show and log news."""
        for note in self._news.take(events, self._cards):
            self._supervision.note(note.did, BY, person=note.person, detail=note.detail)
            if words := note_words(note, self._workspace.name):
                self._write(f"{words} {KEY_HINT}", "warn" if note.doubt else "dim")
        self._ask()

    def _ask(self) -> None:
        """Ask staff once for the state of a card, if the robot cannot read cards."""
        asks = "" if self._eyes is None else self._eyes.asks
        if asks and asks != self._asks:
            object = self._workspace.activity.object
            question = card_question(self._workspace.name(asks), object)
            self._write(f"{question} {TELL_HINT}", "warn")
        self._asks = asks

    async def say_whose(self, app: App[Any], control: GameController) -> None:
        """Ask staff who has which card, and store the answer.

        The card is one of those last in sight, or Tangy learns the person's card again.
        """
        dealt, name = self._cards.dealt, self._workspace.name
        people = []
        for person in self._workspace.people:
            known = dealt.card_of(person.id)
            people.append(
                Option(person.id, person.name, f"has card {known}" if known else "not known yet")
            )
        whom = await app.push_screen_wait(ChooseDialog(WHOSE, people))
        if whom is None:
            return
        seen = sorted({*self._cards.in_sight})
        options = [Option(str(card), f"card {card}", "was in sight last") for card in seen]
        options.append(Option(LEARN, "another one", LEARNT_NEXT))
        told = await app.push_screen_wait(ChooseDialog(which_words(name(whom)), options))
        if told is None:
            return
        dealt.give(whom, None if told == LEARN else int(told))
        whose = "another card" if told == LEARN else f"card {told}"
        control.note("card given", person=whom, detail="" if told == LEARN else told)
        self._write(f"{name(whom)} has {whose}.", "dim")

"""Owners of cards on the live screen: Tangy's doubts, and the answers of staff."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Sequence
from typing import Any

from textual.app import App

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_tui.app.card_news import BY, CardNews
from tangy_tui.app.game_commands import GameCommand, HasCard
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.workspace import Workspace
from tangy_tui.monitoring.supervision import Event, Supervision
from tangy_tui.text.cards import (
    ANOTHER,
    BY_NUMBER,
    KEY_HINT,
    KNOWN,
    LEARNT_NEXT,
    TYPE_NUMBER,
    UNKNOWN,
    WHOSE,
    in_sight_words,
    other_card_words,
    which_words,
)
from tangy_tui.text.live_news import note_words
from tangy_tui.text.telling import TELL_HINT, card_question
from tangy_tui.ui.dialogs.card_number import CardNumberDialog
from tangy_tui.ui.dialogs.choose import ChooseDialog, Option
from tangy_tui.ui.widgets.log_view import Kind

LEARN, NUMBER = "learn", "number"


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

    def people(self) -> ChooseDialog:
        """Return the question which person's card staff want to tell of."""
        people = []
        for person in self._workspace.people:
            known = self._cards.dealt.card_of(person.id)
            note = UNKNOWN if known is None else KNOWN.format(known)
            people.append(Option(person.id, person.name, note))
        return ChooseDialog(WHOSE, people)

    async def say_whose(
        self,
        app: App[Any],
        chosen: Awaitable[str | None],
        control: GameController,
        do: Callable[[GameCommand], object],
    ) -> None:
        """Ask staff which card a chosen person has, and carry out their answer.

        The card is one of those last in sight, one whose number they type, or Tangy learns the
        person's card again.
        """
        dealt, name = self._cards.dealt, self._workspace.name
        if (whom := await chosen) is None:
            return
        options = [
            *(
                Option(str(card), f"card {card}", in_sight_words(self._owner(card)))
                for card in sorted({*self._cards.in_sight})
            ),
            Option(NUMBER, BY_NUMBER, TYPE_NUMBER),
            Option(LEARN, ANOTHER, LEARNT_NEXT),
        ]
        told = await app.push_screen_wait(ChooseDialog(which_words(name(whom)), options))
        if told == LEARN:
            dealt.give(whom, None)
            control.note("card given", person=whom)
            self._write(other_card_words(name(whom)), "dim")
        elif told is not None:
            typed = told == NUMBER
            card = await app.push_screen_wait(CardNumberDialog(name(whom))) if typed else int(told)
            if card is not None:
                do(HasCard(whom, card))

    def _owner(self, card: int) -> str:
        """Return the name of the person who has a card, "" if unknown."""
        owner = self._cards.dealt.owner(card)
        return self._workspace.name(owner) if owner else ""

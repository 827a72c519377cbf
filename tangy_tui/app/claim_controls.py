"""Claims of staff that a card wins: each is judged at once, and told to the group in its turn."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from tangy_profiles.planned_game import PlannedGame
from tangy_tui.app.fault_commands import Result
from tangy_tui.app.game_commands import ClaimCard
from tangy_tui.app.staff_notes import StaffNote

if TYPE_CHECKING:
    from tangy_tui.monitoring.supervision import Event, Supervision

ClaimKind = Literal["claim right", "claim late", "claim wrong"]
CLAIM_SECONDS, LONGEST_CLAIM = 15.0, 60.0
"""A claim that was told is shown so long at least (s), until the next call, and so long at most."""


@dataclass(frozen=True, slots=True)
class ClaimNow:
    """A claim of staff in the running game, and its result as far as it is known."""

    card: int
    person: str
    """Who has the card; "" if nobody knows."""
    kind: ClaimKind | None
    """None: the number that is just being called may decide it."""
    told: float | None = None
    """When Tangy began to tell the group (s of the world); None: it finishes its step first."""
    calls: int = 0
    """How many numbers were called by then."""
    game: str = ""
    """The id of the game."""
    resumed: bool = False
    """Whether it waits since before an interruption, until staff let the game go on."""
    goes: bool = False
    """Whether Tangy goes to the person because of it; not yet while it finishes its step."""
    later: bool = False
    """Whether the card does not win, and the group hears so only after a celebration."""


class ClaimControls:
    """The part of the plan's controls that checks claims."""

    def __init__(self, supervision: Supervision, note: Callable[..., None], by: str) -> None:
        """Check claims in the games of a supervision; `note` logs what staff (`by`) did."""
        self._supervision = supervision
        self._note = note
        self._by = by
        self._claimed: ClaimNow | None = None
        self._winning: tuple[ClaimNow, ...] = ()
        """The claims of this game that win, each until the winner is visited."""
        self._untold: list[int] = []
        """Cards that do not win, of which the group hears after the celebration, or together."""
        self._unchecked: list[ClaimCard] = []
        """The claims that were made before an interruption, and are still to be checked."""
        self._late: list[StaffNote] = []
        """The results of these, and what the group heard late, until staff are told."""

    @property
    def world(self) -> PlannedGame | None:
        """The world, if staff can plan its games."""
        return self._supervision.game.changes.world

    @property
    def _idle(self) -> bool:
        return self._supervision.over

    @property
    def calling(self) -> str:
        """The label of the number that Tangy is saying now, "" if it says none."""
        world = self.world
        return "" if world is None else "".join(map(world.activity.deck.label, world.calling))

    @property
    def _calls(self) -> int:
        """How many numbers were called, with the one that Tangy is just saying."""
        return 0 if self.world is None else len(self.world.called_now) + len(self.world.calling)

    def take_up(self, claims: Iterable[tuple[int, str]]) -> None:
        """Keep the claims of an interrupted game, to check them when it goes on."""
        self._unchecked, self._late = [], []
        self._winning, self._untold = (), []
        for card, person in claims:
            claim = ClaimCard(card, person)
            if (judged := self.judged(claim)) is not None:
                self._keep(replace(judged, resumed=True))
            self._unchecked.append(claim)

    def check_left(self) -> list[Event]:
        """Check the claims that were made before an interruption; see `late_notes`."""
        told: list[Event] = []
        world = self.world
        while world is not None and self._unchecked:
            claim = self._unchecked.pop(0)
            for one in self._claim(world, claim, more=bool(self._unchecked)):
                if isinstance(one, StaffNote):
                    self._late.append(one)
                else:
                    told.append(one)
        return told

    def tell_left(self) -> bool:
        """Tell the group of the cards that do not win, once a winner was celebrated.

        Return whether it was told something now; see `late_notes`.
        """
        world = self.world
        if world is None or not self._untold or self._celebrates(world):
            return False
        wrong = world.activity.rules.claim_wrong
        cards = [card for card in self._untold if not world.wins(card)]
        self._untold = []
        if cards and (said := joined(wrong, cards, world.patterns.label)):
            world.announce(said)
            self._late.append(StaffNote("claims told", words=said))
            return True
        return False

    def _celebrates(self, world: PlannedGame) -> bool:
        """Return whether a winner is still to be celebrated, or others may have won as well."""
        waits = any(not one.goes and self._is_news(world, one) for one in self._winning)
        tracker = world.tracker
        due = world.winner or tracker.finished or world.vouched & {*tracker.queue}
        return waits or bool(due)

    def late_notes(self) -> list[StaffNote]:
        """Return results of interrupted claims, and what the group heard late, each once."""
        told, self._late = self._late, []
        return told

    def kept(self, claim: ClaimCard) -> bool:
        """Return whether a claim was logged, and is still to be checked."""
        claimed, claim = self._claimed, self.with_card(claim)
        return claimed is not None and claimed.told is None and claimed.card == claim.card

    def _claim_early(self, claim: ClaimCard) -> None:
        """Judge and log a claim at once; it is checked, and the group told, in its turn."""
        if (judged := self.judged(claim)) is not None:
            self._keep(judged)
            self._note(
                "claim made", person=judged.person, detail=str(judged.card), calls=self._calls
            )

    def _forget_claim(self, claim: ClaimCard) -> None:
        """Forget a claim that was judged early, and refused in its turn."""
        claimed = self._claimed
        if claimed is not None and claimed.told is None:
            claim = self.with_card(claim)
            if claim.card == claimed.card and claim.person in ("", claimed.person):
                self._claimed = None
        waiting = [one for one in self._winning if one.told is None]
        gone = [one for one in waiting if one.card == self.with_card(claim).card]
        self._winning = tuple(one for one in self._winning if one not in gone)

    def _keep(self, claimed: ClaimNow) -> None:
        """Keep the last claim, and all that win."""
        self._claimed = claimed
        others = tuple(one for one in self._winning if one.card != claimed.card)
        self._winning = (*others, claimed) if claimed.kind == "claim right" else others

    def judged(self, claim: ClaimCard) -> ClaimNow | None:
        """Return the result of a claim by the numbers called so far; None if it is refused."""
        world, claim = self.world, self.with_card(claim)
        if world is None or self._idle or self._no_card(claim) is not None:
            return None
        holder, kind = self._verdict(world, claim)
        numbers = world.numbers_on(claim.card)
        if kind == "claim wrong" and numbers is not None and {*world.calling} & {*numbers}:
            return ClaimNow(claim.card, holder, None)
        later = kind == "claim wrong" and self._celebrates(world)
        return ClaimNow(claim.card, holder, kind, later=later)

    @property
    def claim(self) -> ClaimNow | None:
        """The last claim that wins, or else the last one, while it is news; or None."""
        claims = self.claims
        winning = [one for one in claims if one.kind == "claim right"]
        return (winning or (None, *claims))[-1]

    @property
    def claims(self) -> tuple[ClaimNow, ...]:
        """The claims that win and are not celebrated yet, and the last one while it is news."""
        claimed, world = self._claimed, self.world
        if claimed is None or world is None or self._idle:
            return ()
        others = [one for one in self._winning if one is not claimed]
        return tuple(one for one in (*others, claimed) if self._is_news(world, one))

    def _is_news(self, world: PlannedGame, claimed: ClaimNow) -> bool:
        """Return whether a claim is news: until the next call, and for a while.

        If it wins, it is news until the visit, however long that takes.
        """
        if claimed.told is None:
            return True
        if claimed.game != self._supervision.game.game:
            return False
        if claimed.goes:
            there = world.tracker.place == claimed.person and world.arrived
            return not there and claimed.person in world.vouched & {*world.tracker.queue}
        ago, calls = world.seconds - claimed.told, len(world.called_now)
        over = ago >= LONGEST_CLAIM or (ago >= CLAIM_SECONDS and calls > claimed.calls)
        return not over

    @staticmethod
    def _verdict(world: PlannedGame, claim: ClaimCard) -> tuple[str, ClaimKind]:
        """Return who has a card ("" if nobody knows), and its result by the numbers called."""
        holder, wins = claim.person or world.holder(claim.card), world.wins(claim.card)
        late = bool(wins and world.activity.rules.claim_late and holder)
        if late and world.is_won_before(holder):
            return holder, "claim late"
        return holder, "claim right" if wins else "claim wrong"

    def with_card(self, claim: ClaimCard) -> ClaimCard:
        """Return a claim with the number of the person's card, if it is known and was not given."""
        if claim.card or self.world is None:
            return claim
        return replace(claim, card=self.world.known_cards.get(claim.person, 0))

    def may_hold(self, claim: ClaimCard) -> tuple[str, ...]:
        """Return the people who may have the card of a claim, if nobody knows whose it is.

        These are the people here whose cards are not known, or everybody here if all are.
        """
        world = self.world
        unclear = world is not None and not self._idle and claim.card and not claim.person
        if world is None or not unclear or world.holder(claim.card):
            return ()
        if world.numbers_on(claim.card) is None:
            return ()
        here = tuple(one for one in world.people if one not in world.away)
        return tuple(one for one in here if one not in world.known_cards) or here

    def _no_card(self, claim: ClaimCard) -> StaffNote | None:
        """Return why a claim cannot be checked: there is no such card, or nobody here has it."""
        card, person = claim.card, claim.person
        if (world := self.world) is None:
            return StaffNote("no cards")
        if person and not card:
            return StaffNote("which card", person)
        known = world.known_cards
        here = {card for person, card in known.items() if person not in world.away}
        cards = ", ".join(map(str, sorted(here)))
        if world.numbers_on(card) is None:
            return StaffNote("no such card", str(card), cards)
        if person or world.holder(card):
            return None
        if set(world.people) - world.away <= set(known):  # every card here is known
            return StaffNote("whose card", str(card), cards)
        # The group is told of no win that Tangy cannot celebrate.
        return StaffNote("whose card", str(card)) if world.wins(card) else None

    def _claim(self, world: PlannedGame, claim: ClaimCard, *, more: bool = False) -> list[Result]:
        """Check a card against all calls, and tell the group the result.

        If `more` claims are still to be checked, the group hears of those that do not win at once.
        """
        claim = self.with_card(claim)
        if (refused := self._no_card(claim)) is not None:
            return [refused]
        self._unchecked = [one for one in self._unchecked if one.card != claim.card]
        card, (holder, kind) = claim.card, self._verdict(world, claim)
        self._note(kind, person=holder, detail=str(card), calls=self._calls)
        calls, game = len(world.called_now), self._supervision.game.game
        later = kind == "claim wrong" and self._celebrates(world)
        claimed = ClaimNow(card, holder, kind, world.seconds, calls, game, later=later)
        self._keep(claimed)
        if kind == "claim wrong":
            return [self._tell_wrong(world, claimed, more=more)]
        rules, wins = world.activity.rules, kind == "claim right"
        words = rules.claim_right if wins else rules.claim_late
        said = words.format(card=card, pattern=world.patterns.label)
        world.announce(said)
        told = StaffNote(kind, str(card), said, (holder,) if holder else ())
        return [told, self._go_to_winner(claimed)] if wins else [told]

    def _tell_wrong(self, world: PlannedGame, claimed: ClaimNow, *, more: bool) -> StaffNote:
        """Tell the group of the cards that do not win, unless it hears of them later."""
        card, people = claimed.card, (claimed.person,) if claimed.person else ()
        wrong = [one for one in self._untold if one != card and not world.wins(one)] + [card]
        if claimed.later or more:  # "let us play on" would deny that somebody has won
            self._untold = wrong
            return StaffNote(
                "claim wrong" if claimed.later else "claim with others", str(card), people=people
            )
        self._untold = []
        said = joined(world.activity.rules.claim_wrong, wrong, world.patterns.label)
        world.announce(said)
        return StaffNote("claim wrong", str(card), said, people)

    def _go_to_winner(self, claimed: ClaimNow) -> Event:
        """Let Tangy go to the person of a claim that wins."""
        changed = self._supervision.game.change("claimed", person=claimed.person, by=self._by)
        goes = replace(claimed, goes=True)
        self._winning = tuple(goes if one is claimed else one for one in self._winning)
        if self._claimed is claimed:  # staff may have typed another one meanwhile
            self._claimed = goes
        return changed


def joined(words: str, cards: Sequence[int], pattern: str) -> str:
    """Join the announcements of several cards; what follows the card's sentence is said once."""
    parts = re.fullmatch(r"(.*\{card\}[^.!?]*[.!?]*)\s*(.*)", words, re.DOTALL)
    each, then = parts.groups() if parts else (words, "")
    said = [each.format(card=card, pattern=pattern) for card in cards]
    return " ".join(filter(None, (*dict.fromkeys(said), then.format(card="", pattern=pattern))))

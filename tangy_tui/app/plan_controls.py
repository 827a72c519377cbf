"""What staff change in a game themselves: pace, calls, claims, patterns, who is present."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal, assert_never

from tangy_profiles.game_records import ChangeKind
from tangy_profiles.game_rules import LONGEST_PACE, SHORTEST_PACE, next_pace
from tangy_profiles.planned_game import PlannedGame
from tangy_profiles.scene import Scene
from tangy_tui.app.fault_commands import Result
from tangy_tui.app.game_commands import (
    AskFor,
    ChangePace,
    ChoosePatterns,
    ClaimCard,
    ComesIn,
    GameCommand,
    GoesAway,
    LetWin,
    PlanCommand,
    SetPace,
    TakeBackCall,
)
from tangy_tui.app.staff_notes import StaffNote

if TYPE_CHECKING:
    from tangy_tui.monitoring.supervision import Supervision


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
    goes: bool = False
    """Whether Tangy goes to the person because of it; not yet while it finishes its step."""


class GamePlanControls:
    """Changes the plan of supervised games; refuses each change if the game has no plan."""

    def __init__(self, supervision: Supervision, note: Callable[..., None], by: str) -> None:
        """Control the games of a supervision; `note` logs what staff (`by`) did."""
        self._supervision = supervision
        self._note = note
        self._by = by
        self._said: list[ComesIn | GoesAway] = []
        """Who staff said has come or left, until it takes effect after the present step."""
        self._claimed: ClaimNow | None = None

    @property
    def world(self) -> PlannedGame | None:
        """The world, if staff can plan its games."""
        return self._supervision.game.changes.world

    def do(self, command: PlanCommand) -> list[Result]:
        """Carry out a command.

        Raises:
            TangyError: it cannot be carried out or logged.
        """
        if isinstance(command, ComesIn | GoesAway):
            return [self._move(command)]
        world = self.world
        if world is None:
            return [StaffNote("no cards")]
        match command:
            case SetPace(seconds):
                return [self._pace(world, seconds)]
            case ChangePace(by):
                return [self._pace(world, next_pace(world.pace, -by))]
            case TakeBackCall(label):
                return self._take_back(world, label)
            case ClaimCard():
                return self._claim(world, command)
            case ChoosePatterns(names):
                return self._choose(world, names)
            case LetWin(several, visits):
                return self._let_win(world, several, visits)
            case forgotten:
                assert_never(forgotten)

    @property
    def _idle(self) -> bool:
        return self._supervision.over

    def _pace(self, world: PlannedGame, seconds: float) -> StaffNote:
        pace = min(LONGEST_PACE, max(SHORTEST_PACE, seconds))
        if self._idle:
            world.set_pace(pace)
        else:
            self._supervision.game.change("pace", seconds=pace, by=self._by)
        self._note("pace", detail=f"{pace:g}")
        return StaffNote("pace", f"{pace:g}")

    def called(self, label: str) -> str:
        """Return the label of the call that a label names ("": the last call), "" if none."""
        world = self.world
        number = None if world is None or self._idle else _number_called(world, label)
        return "" if world is None or number is None else world.activity.deck.label(number)

    @property
    def calling(self) -> str:
        """The label of the number that Tangy is saying now, "" if it says none."""
        world = self.world
        return "" if world is None else "".join(map(world.activity.deck.label, world.calling))

    def say_early(self, command: GameCommand) -> None:
        """Log who comes or leaves at once, unless that is refused; the game changes later.

        A claim is judged at once; the group is told later.
        """
        if isinstance(command, ClaimCard) and (judged := self.judged(command)) is not None:
            self._claimed = judged
        if self._idle or not isinstance(command, ComesIn | GoesAway):
            return
        if self._refuses_move(command, self.away) is None:
            self._note("came" if isinstance(command, ComesIn) else "left", person=command.person)
            self._said.append(command)

    def forget_early(self, command: GameCommand) -> None:
        """Forget what was logged early, once its command was carried out or failed."""
        claimed = self._claimed
        if isinstance(command, ClaimCard) and claimed is not None and claimed.told is None:
            claim = self.with_card(command)
            if claim.card == claimed.card and claim.person in ("", claimed.person):
                self._claimed = None
        if isinstance(command, ComesIn | GoesAway) and command in self._said:
            self._said.remove(command)

    def judged(self, claim: ClaimCard) -> ClaimNow | None:
        """Return the result of a claim by the numbers called so far; None if it is refused."""
        world, claim = self.world, self.with_card(claim)
        if world is None or self._idle or self._no_card(claim) is not None:
            return None
        holder, numbers = claim.person or world.holder(claim.card), world.numbers_on(claim.card)
        kind: ClaimKind | None = self._verdict(world, claim.card, holder)
        if kind == "claim wrong" and numbers is not None and {*world.calling} & {*numbers}:
            kind = None
        return ClaimNow(claim.card, holder, kind)

    @property
    def claim(self) -> ClaimNow | None:
        """The last claim, while it is news; or None.

        It is news until the next call, and for a while; a winning one at most until the visit.
        """
        claimed, world = self._claimed, self.world
        if claimed is None or world is None or self._idle:
            return None
        if claimed.told is None:
            return claimed
        ago, calls = world.seconds - claimed.told, len(world.called_now)
        over = ago >= LONGEST_CLAIM or (ago >= CLAIM_SECONDS and calls > claimed.calls)
        before = claimed.game != self._supervision.game.game
        there = world.tracker.place == claimed.person and world.arrived
        visited = claimed.goes and (there or claimed.person not in world.vouched)
        return None if over or before or visited else claimed

    @staticmethod
    def _verdict(world: PlannedGame, card: int, holder: str) -> ClaimKind:
        wins = world.wins(card)
        late = bool(wins and world.activity.rules.claim_late and holder)
        if late and world.is_won_before(holder):
            return "claim late"
        return "claim right" if wins else "claim wrong"

    @property
    def away(self) -> frozenset[str]:
        """Who is not here, by the game, and by what staff have said since."""
        changes = self._supervision.game.changes
        gathering = changes.gathering
        away = frozenset[str]() if gathering is None else gathering.away
        for said in tuple(self._said):
            away = away - {said.person} if isinstance(said, ComesIn) else away | {said.person}
        return away

    @property
    def scene(self) -> Scene:
        """The scene, with who is here by the word of staff."""
        scene, away = self._supervision.world.scene(), self.away
        if away == scene.away:
            return scene
        asking = tuple(person for person in scene.requests if person not in away)
        return replace(scene, requests=asking, away=away)

    def refuses(self, command: GameCommand) -> StaffNote | None:
        """Return why a command can never work, before its turn; None if it may."""
        match command:
            case TakeBackCall(label):
                return self._nothing_called(label)
            case ClaimCard() if not self._idle:
                return self._no_card(self.with_card(command))
            case ComesIn(person) | GoesAway(person):
                return self._nobody(person)
            case AskFor(person):
                return self._nobody(person) or self._away(person)
        return None

    def _away(self, person: str) -> StaffNote | None:
        return StaffNote("is away", person) if person in self.away else None

    def _nobody(self, person: str) -> StaffNote | None:
        gathering = self._supervision.game.changes.gathering
        plays = gathering is not None and person in gathering.people
        return None if plays else StaffNote("not playing", person)

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

    def _nothing_called(self, label: str) -> StaffNote | None:
        """Return why there is no call to take back, None if there is one.

        Otherwise it would take back the call that is still being spoken, unasked.
        """
        if self.world is None or self._idle or self.called(label):
            return None
        return StaffNote("not called", label) if label else StaffNote("nothing called")

    def _take_back(self, world: PlannedGame, label: str) -> list[Result]:
        """Take back the last call, or the one with a label, and tell the group."""
        deck, number = world.activity.deck, _number_called(world, label)
        if number is None:
            return [
                StaffNote("not called", label) if world.called_now else StaffNote("nothing called")
            ]
        changed = self._supervision.game.change("taken back", number=number, by=self._by)
        self._note("took back", detail=deck.label(number), taken_back=number)
        return [StaffNote("call taken back", deck.label(number)), changed]

    def _claim(self, world: PlannedGame, claim: ClaimCard) -> list[Result]:
        """Check a card against all calls, and tell the group the result."""
        claim = self.with_card(claim)
        if (refused := self._no_card(claim)) is not None:
            return [refused]
        card, person = claim.card, claim.person
        rules, present = world.activity.rules, world.patterns.present
        pattern = present or next(iter(rules.patterns), None)
        holder = person or world.holder(card)
        kind = self._verdict(world, card, holder)
        words = {"claim right": rules.claim_right, "claim late": rules.claim_late}.get(
            kind, rules.claim_wrong
        )
        self._note(kind, person=holder or "", detail=str(card))
        self._claimed = claimed = ClaimNow(
            card, holder, kind, world.seconds, len(world.called_now), self._supervision.game.game
        )
        said = words.format(card=card, pattern=pattern.label if pattern else "")
        world.announce(said)
        people = (holder,) if holder else ()
        told: list[Result] = [StaffNote(kind, str(card), said, people)]
        if kind != "claim right":
            return told
        told.append(self._supervision.game.change("claimed", person=holder, by=self._by))
        if self._claimed is claimed:  # staff may have typed another one meanwhile
            self._claimed = replace(claimed, goes=True)
        return told

    def _choose(self, world: PlannedGame, names: tuple[str, ...]) -> list[Result]:
        rules = world.activity.rules
        patterns = tuple(rules.pattern(name).name for name in names)
        labels, already = [rules.pattern(name).label for name in patterns], ""
        if self._idle:
            world.choose(replace(world.game_plan, patterns=patterns))
        else:
            now = world.patterns  # the game goes on for the present pattern first
            begun = [one for one in patterns if rules.pattern(one).on(now.deck) == now.played]
            follow = tuple(one for one in patterns if one not in begun)
            labels = [rules.pattern(one).label for one in follow]
            present = rules.pattern(begun[0]) if begun else now.present
            if present is not None:
                labels.insert(0, present.label)
                already = "" if patterns[0] in begun else present.label
            self._supervision.game.change("patterns chosen", patterns=follow, by=self._by)
        self._note("patterns", detail=", ".join(patterns))
        return [StaffNote("patterns", ", then ".join(labels), already)]

    def _let_win(
        self, world: PlannedGame, several: bool | None, visits: bool | None
    ) -> list[Result]:
        told, changes = list[Result](), list[ChangeKind]()
        if several is not None:
            changes.append("several winners" if several else "one winner")
            told.append(StaffNote("several" if several else "one winner"))
        if visits is not None:
            changes.append("visits on" if visits else "visits off")
            told.append(StaffNote("visits" if visits else "no visits"))
        plan = replace(
            world.game_plan,
            several=world.game_plan.several if several is None else several,
            visits=world.game_plan.visits if visits is None else visits,
        )
        if self._idle:
            world.choose(plan)
        else:
            for what in changes:
                self._supervision.game.change(what, by=self._by)
        self._note("rules", detail=", ".join(changes))
        return told

    def _move(self, command: ComesIn | GoesAway) -> StaffNote:
        """Mark a person as present or absent, in the present game or before the next one."""
        changes = self._supervision.game.changes
        gathering, person, here = changes.gathering, command.person, isinstance(command, ComesIn)
        if gathering is None:
            return StaffNote("not playing", person)
        away = frozenset(changes.plan.absent) if self._idle else gathering.away
        if refused := self._refuses_move(command, away):
            return refused
        if self._idle:
            absent = away - {person} if here else away | {person}
            gathering.choose(replace(changes.plan, absent=tuple(sorted(absent))))
        else:
            self._supervision.game.change("came" if here else "left", person=person, by=self._by)
        if command not in self._said:  # it was logged when staff said it
            self._note("came" if here else "left", person=person)
        return StaffNote("comes" if here else "goes", person)

    def _refuses_move(self, command: ComesIn | GoesAway, away: frozenset[str]) -> StaffNote | None:
        """Return why a person cannot come or leave while these people are away."""
        changes = self._supervision.game.changes
        gathering, person, here = changes.gathering, command.person, isinstance(command, ComesIn)
        if gathering is None or person not in gathering.people:
            return StaffNote("not playing", person)
        if here is (person not in away):
            return StaffNote("here before" if here else "away before", person)
        if changes.world is None and not here and not set(gathering.people) - away - {person}:
            return StaffNote("last one", person)
        return None


def _number_called(world: PlannedGame, label: str) -> int | None:
    """Return the called number with a label ("": the last one); None if there is none."""
    deck, called = world.activity.deck, world.called_now
    wanted = label.casefold()
    return next((n for n in reversed(called) if wanted in ("", deck.label(n).casefold())), None)

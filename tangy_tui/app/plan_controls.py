"""What staff change in a game themselves: pace, calls, patterns, who is present."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, assert_never

from tangy_profiles.game_records import ChangeKind
from tangy_profiles.game_rules import LONGEST_PACE, SHORTEST_PACE, next_pace
from tangy_profiles.planned_game import PlannedGame
from tangy_profiles.scene import Scene
from tangy_tui.app.claim_controls import ClaimControls
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


class GamePlanControls(ClaimControls):
    """Changes the plan of supervised games; refuses each change if the game has no plan."""

    def __init__(self, supervision: Supervision, note: Callable[..., None], by: str) -> None:
        """Control the games of a supervision; `note` logs what staff (`by`) did."""
        super().__init__(supervision, note, by)
        self._said: list[ComesIn | GoesAway] = []
        """Who staff said has come or left, until it takes effect after the present step."""
        self._early: dict[int, GameCommand] = {}
        """The commands that were logged early, and wait for their turn, by identity."""

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
                self._early.pop(id(command), None)
                early = [one for one in self._early.values() if isinstance(one, ClaimCard)]
                cards = {self.with_card(one).card for one in early if self.judged(one) is not None}
                return self._claim(
                    world, command, more=bool(cards - {self.with_card(command).card})
                )
            case ChoosePatterns(names):
                return self._choose(world, names)
            case LetWin(several, visits):
                return self._let_win(world, several, visits)
            case forgotten:
                assert_never(forgotten)

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

    def say_early(self, command: GameCommand) -> None:
        """Log who comes or leaves, and claims, at once, unless that is refused.

        The game changes later; a claim is judged at once, and the group is told later. It may be
        called again for the same command.
        """
        if id(command) in self._early:
            return
        self._early[id(command)] = command
        if isinstance(command, ClaimCard):
            self._claim_early(command)
        if self._idle or not isinstance(command, ComesIn | GoesAway):
            return
        if self._refuses_move(command, self.away) is None:
            self._note("came" if isinstance(command, ComesIn) else "left", person=command.person)
            self._said.append(command)

    def forget_early(self, command: GameCommand) -> None:
        """Forget what was logged early, once its command was carried out or failed."""
        self._early.pop(id(command), None)
        if isinstance(command, ClaimCard):
            self._forget_claim(command)
        if isinstance(command, ComesIn | GoesAway) and command in self._said:
            self._said.remove(command)

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

"""The commands of staff that need a real robot: call again, ask for help, report, cards, drive."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from math import ceil
from typing import TYPE_CHECKING

from tangy_hw.robot_process.stop_latch import STAFF
from tangy_profiles.declared.judging import CERTAIN
from tangy_profiles.declared.typed_observations import sayable
from tangy_profiles.planned_game import as_planned
from tangy_profiles.present_moment import as_present
from tangy_profiles.state import FRONT
from tangy_tui.app.game_commands import (
    LONGEST_DRIVE,
    TWISTS,
    AskFor,
    CallAgain,
    ClaimCard,
    Drive,
    HasCard,
    Tell,
)
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.waiting_on import wait_on
from tangy_tui.learning.policy import Decision
from tangy_tui.monitoring.attention import goes_to_people

if TYPE_CHECKING:
    from tangy_hw.robot_client.commands import WaitKind
    from tangy_hw.robot_client.help_requests import SignState
    from tangy_hw.robot_client.live_world import LiveWorld
    from tangy_hw.robot_client.staff_card_reports import StaffCardReports
    from tangy_profiles.store import Store

STOPPED, ENDED = "staff stopped it", "staff ended the game"
PROGRAM_ENDS = "the program ends"
UNCLEAR, UNCLEAR_SURE = "?", 0.5
"""The suffix of an answer that staff did not understand clearly, and its probability."""
DRIVE_AGAIN = 0.1  # s between two velocity commands: without them the robot stops


@dataclass(frozen=True, slots=True)
class PersonWait:
    """The robot waits for a person, by id ("": for everybody), for so many s at most."""

    kind: WaitKind
    person: str
    seconds: int


class RobotControls:
    """Controls a real robot; without one (None), its commands are refused."""

    def __init__(
        self,
        robot: LiveWorld | None,
        note: Callable[..., None],
        stopped: Callable[[], bool],
        *,
        paced: bool = True,
    ) -> None:
        """Control the robot of a world; `note` logs what staff did, `stopped` reports their STOP.

        If `paced`, people get time between two calls.
        """
        self._robot = robot
        self._note = note
        self._stopped = stopped
        self.paced = paced and robot is not None
        self.driving = False
        """Whether staff are driving it by hand."""

    @property
    def there(self) -> bool:
        """Whether there is a robot, or its bench."""
        return self._robot is not None

    @property
    def takes_reports(self) -> bool:
        """Whether staff report what people answer or do, or the state of their cards."""
        robot = self._robot
        return robot is not None and (robot.eyes is not None or as_present(robot) is not None)

    @property
    def reportable(self) -> tuple[str, ...]:
        """What staff can report now, with examples."""
        if self._robot is not None and self._robot.eyes is not None:
            return tuple(self._robot.eyes.sayable)
        now = as_present(self._robot)
        return () if now is None else tuple(sayable(now.ahead))

    def wait_on(self, store: Store) -> dict[str, float]:
        """Let people wait on who asked in vain before it was switched on; return how long (s)."""
        return {} if self._robot is None else wait_on(store, self._robot)

    def hold_calls(self, *, held: bool) -> None:
        """Hold the count-down to the next call, or let it go on."""
        if self._robot is not None:
            self._robot.hold_calls(held=held)

    def stop(self, why: str = STOPPED) -> None:
        """Stop at once, ahead of all queued commands; latched until staff release it."""
        if self._robot is not None:
            self._robot.link.stop(why, by=STAFF)

    def release(self, *, everybody: bool = False) -> None:
        """Release the stop of staff, or of everybody."""
        if self._robot is not None:
            self._robot.link.release(**({} if everybody else {"by": STAFF}))

    def go_to_front(self) -> bool:
        """Drive to the front, where the robot process starts; return whether it has arrived.

        Raises:
            DeviceError: it has to stop.
        """
        return self._robot is None or self._robot.drive(FRONT)

    @property
    def frozen(self) -> bool:
        """Whether the control loop froze and staff have not released the robot since."""
        return self._robot is not None and bool(self._robot.link.state.frozen)

    @property
    def going(self) -> str:
        """The destination it is driving to, a person's id or the front; "" if it is not driving."""
        return "" if self._robot is None else self._robot.link.state.going

    @property
    def waits_for(self) -> PersonWait | None:
        """For whom it waits now, and how long at most; None if for nobody."""
        robot = self._robot
        waits = None if robot is None else robot.commands.waits_for
        if robot is None or waits is None:
            return None
        return PersonWait(waits.kind, waits.person, max(1, ceil(waits.until - robot.link.time)))

    @property
    def lets(self) -> str:
        """For whom it waits on its way, as in `RobotState.yields_to`; "" for nobody."""
        return "" if self._robot is None else self._robot.link.state.yields_to

    def sign_of(self, person: str) -> SignState:
        """Return why a person's sign for help would not count now, "" if it would."""
        return "" if self._robot is None else self._robot.requests.sign_of(person)

    @property
    def by_staff(self) -> frozenset[str]:
        """The people who ask by word, and not by a sign."""
        if self._robot is None:
            return frozenset()
        return frozenset(self._robot.requests.by_word) - self._robot.requests.signs.keys()

    def rests(self, decision: Decision) -> bool:
        """Return whether it is too early for the next call."""
        if self._robot is None or not (self.paced and decision.sure):
            return False
        behaviour = self._robot.activity.behaviours[decision.behaviour]
        return behaviour.calls and self._robot.calls_in > 0

    def do(self, command: CallAgain | AskFor | Tell | HasCard | Drive) -> StaffNote:
        """Carry out a command that needs a real robot.

        Raises:
            TangyError: it failed.
        """
        robot = self._robot
        if robot is None:
            return StaffNote("no robot")
        match command:
            case AskFor(person):
                return self._ask_for(robot, person)
            case Tell():
                return self._tell(robot, command)
            case HasCard(person, card):
                return self._give_card(robot, person, card)
            case Drive():
                return self._drive(robot, command)
        if as_planned(robot) is None:
            return StaffNote("no cards")
        if not robot.called:
            return StaffNote("nothing called")
        label = robot.activity.deck.label(robot.called[-1])
        self._note("called again", detail=label)
        robot.call_again()
        return StaffNote("call again", label)

    def _ask_for(self, robot: LiveWorld, person: str) -> StaffNote:
        """Ask for help for a person; if they wait already, tell after whom."""
        by_word, scene = robot.requests.by_word, robot.scene()
        waiting = [*scene.requests, *(one for one in by_word if one not in scene.requests)]
        robot.requests.ask_for(person)
        if person not in by_word:
            self._note("asked for", person=person)
        if person in waiting:
            before = tuple(waiting[: waiting.index(person)])
            there = "there" if scene.place == person else ""
            return StaffNote("asked already", person, there, before)
        goes = goes_to_people(robot.activity)
        return StaffNote("asked for" if goes else "asked to help", person)

    def keep_claimed(self, claim: ClaimCard) -> None:
        """Note the card that staff say a person claims with, if nobody knew either's before.

        Otherwise the first card that a camera sees there would count as theirs, against that word.
        """
        if (robot := self._robot) is None or not (claim.person and claim.card):
            return
        dealt = robot.cards.dealt
        if dealt.card_of(claim.person) is None and not dealt.owner(claim.card):
            self._give_card(robot, claim.person, claim.card)

    def _give_card(self, robot: LiveWorld, person: str, card: int) -> StaffNote:
        """Note whose card it is, and who had it until now as far as Tangy knew."""
        if as_planned(robot) is None:
            return StaffNote("no cards")
        if person not in robot.people:
            return StaffNote("not playing", person)
        if robot.cards.numbers_on(card) is None:
            return StaffNote("no such card", str(card))
        before, had = robot.cards.dealt.owner(card), robot.cards.dealt.card_of(person)
        robot.cards.dealt.give(person, card)
        self._note("card given", person=person, detail=str(card))
        others = (before,) if before not in ("", person) else ()
        instead = str(had) if had not in (None, card) else ""
        return StaffNote("card given", person, str(card), others, instead)

    def _tell(self, robot: LiveWorld, command: Tell) -> StaffNote:
        """Report to a declared activity what a person says or does."""
        from tangy_hw.robot_client.declared_live_world import DeclaredLiveWorld

        said = command.words
        if robot.eyes is not None:
            return self._tell_of_card(robot.eyes, command)
        if not isinstance(robot, DeclaredLiveWorld):
            return StaffNote("nothing to tell")
        unclear = said.rstrip().endswith(UNCLEAR) or command.sure < CERTAIN
        sure = min(command.sure, UNCLEAR_SURE if unclear else 1.0)
        told = robot.tell(command.person, said, sure, command.source)
        if told is None:
            return StaffNote("not told", words=", ".join(sayable(robot.ahead)))
        found = told.meant
        if told.whose:
            return StaffNote("whose", robot.people[0], said)
        if not told.counts:
            return StaffNote("not asked", found.who or "", said)
        heard = command.source == "speech"
        self._note("heard" if heard else "told", person=found.who or "", detail=said)
        asked = robot.may_ask_again(found.who)
        if unclear and not asked:  # then the game asks staff instead
            return StaffNote("not told", words=", ".join(sayable(robot.ahead)))
        if unclear:
            return StaffNote("told unclear", found.who or "", said.rstrip().rstrip(UNCLEAR))
        if told.judgement:
            words = "" if told.by_staff else said
            right = told.judgement == "right"
            return StaffNote("told right" if right else "told wrong", found.who or "", words)
        return StaffNote("told", found.who or "", said)

    def _tell_of_card(self, eyes: StaffCardReports, command: Tell) -> StaffNote:
        """Report the state of the card beside a robot that cannot read cards."""
        person, said = eyes.asks, command.words
        if not person:
            return StaffNote("nothing to tell")
        if command.person not in (None, person) or not eyes.tell(said):
            return StaffNote("not told", words=", ".join(eyes.sayable))
        self._note("told", person=person, detail=said)
        return StaffNote("told", person, said)

    @property
    def asks_about(self) -> tuple[str, tuple[str, ...]]:
        """The person whose card staff are asked about, and the question; "" if none."""
        eyes = None if self._robot is None else self._robot.eyes
        return ("", ()) if eyes is None else (eyes.asks, tuple(eyes.sayable))

    def _drive(self, robot: LiveWorld, command: Drive) -> StaffNote:
        """Drive by hand for a while; a STOP ends it at once."""
        forward, turn = TWISTS[command.direction]
        until = time.monotonic() + min(command.seconds, LONGEST_DRIVE)
        self.driving = True
        try:
            while not self._stopped() and time.monotonic() < until:
                robot.link.tell("drive", forward=forward, turn=turn)
                time.sleep(DRIVE_AGAIN)
        finally:
            robot.link.tell("drive", forward=0.0, turn=0.0)
            self.driving = False
        self._note("drove")
        return StaffNote(
            "driven", robot.link.silent or robot.link.state.hazard or robot.link.state.held
        )

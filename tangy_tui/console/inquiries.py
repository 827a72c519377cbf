"""Questions of staff in the console of a game: help, situation, explanation, faults."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tangy_profiles.errors import TangyError
from tangy_profiles.game_world import SIMULATED
from tangy_profiles.planned_game import as_planned
from tangy_profiles.reading import plain
from tangy_tui.app.command_grammar import ANSWERS
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.game_questions import read_saying
from tangy_tui.app.inquiry_grammar import WHO_IS_HERE, WHOSE_CARDS, read_inquiry, read_question
from tangy_tui.app.keymap import BY_ID
from tangy_tui.app.offered import offered
from tangy_tui.app.similar_commands import nearest_commands
from tangy_tui.monitoring.earlier import EarlierPart
from tangy_tui.text.answers import answer_to
from tangy_tui.text.calls import waits_line
from tangy_tui.text.changes import cards_line, patterns_line
from tangy_tui.text.control import going_words, person_wait_words, proposal_words
from tangy_tui.text.earlier import earlier_fault_lines, earlier_lines
from tangy_tui.text.faults import HALTED
from tangy_tui.text.game_answers import to_do_lines
from tangy_tui.text.game_help import help_lines
from tangy_tui.text.games import Demonstrations, why_lines
from tangy_tui.text.messages import NONE_YET
from tangy_tui.text.planned_time import time_words
from tangy_tui.text.questions import NO_QUESTION, answer_help
from tangy_tui.text.situations import Name, state_words
from tangy_tui.text.staff_lines import (
    ACCEPTABLE,
    ANSWER_IN_WORDS,
    SAY_IN_WORDS,
    not_known,
    nothing_to,
)
from tangy_tui.text.staff_view import SEVERAL_WIN, person_words, played_words, won_words
from tangy_tui.text.whose_turn import IN_DETAIL, why_now_lines


class Inquiries:
    """Answers typed questions about the game."""

    def __init__(
        self,
        controller: GameController,
        name: Name,
        demonstrations: Demonstrations | None,
        find_person: Callable[[str], str],
        earlier: EarlierPart | None = None,
        told: Callable[[], Sequence[str]] = tuple,
    ) -> None:
        """Answer about the games of a controller.

        Args:
            controller: runs the games.
            name: returns a person's name for an id.
            demonstrations: explain decisions.
            find_person: returns the id of a person by name or id.
            earlier: what happened before the first game was interrupted.
            told: returns what was told last, with the times.
        """
        self._controller, self._earlier, self._told = controller, earlier, told
        self._game = controller.supervision
        self._name, self._demonstrations = name, demonstrations
        self._find_person = find_person

    def lines(self, text: str) -> list[str] | None:
        """Return the answer to a typed question; None if it is none."""
        try:
            asked = read_question(text, self._find_person)
        except TangyError as error:
            return [str(error)]
        if asked is not None:
            return answer_to(asked, self._controller, self._name).lines
        word = text.casefold()
        match read_inquiry(word):
            case "help" | "phrases":
                return self._help()
            case "where":
                return [self._where()]
            case "why":
                return self._why()
            case "what to do":
                return to_do_lines(self._controller, self._name)
            case "faults":
                return earlier_fault_lines(self._before, self._game.faults)
            case "patterns":
                return [patterns_line(self._game.world)]
        if word in WHO_IS_HERE:
            people = enumerate(self._controller.view().people, 1)
            told = ((seat, self._name(one.id), person_words(one)) for seat, one in people)
            return [f"{seat}. {': '.join(filter(None, words))}" for seat, *words in told]
        if word in WHOSE_CARDS:
            return [cards_line(self._game.world, self._name)]
        if word == BY_ID["messages"].word:
            before, activity = self._earlier, self._game.world.activity
            lines = earlier_lines(before, activity, self._name) if before else []
            return [*lines, *self._told()] or [NONE_YET]
        if word in ANSWERS:
            return [NO_QUESTION]
        if word in ("undo", "redo"):
            return [nothing_to(word)]
        if self._controller.asks_next:
            return None  # it may be the answer
        said = read_saying(text, self._find_person, self._game.world.activity.rules)
        return None if said is None else answer_to(said, self._controller, self._name).lines

    def unknown(self, text: str) -> str:
        """Tell that a line is nothing that can be typed here, and suggest similar commands."""
        world = self._game.world
        names, rules = [*map(self._name, world.people)], world.activity.rules
        near = nearest_commands(text, names, rules, offered(self._controller))
        return plain(not_known(text[:60], ", or ".join(near)))

    @property
    def _before(self) -> EarlierPart | None:
        """What happened before the present game was interrupted."""
        return self._earlier if self._game.games <= 1 else None

    def _why(self) -> list[str]:
        """Tell what Tangy does now and why in plain sentences, and then how it decides."""
        told = why_now_lines(self._controller, self._name)
        if self._game.over:
            return told
        details = why_lines(self._game, self._demonstrations)
        return [*told, f"{IN_DETAIL}:", *(f"  {line}" for line in details)]

    def waits_for(self, key: str = "Y") -> str:
        """Tell what Tangy waits for; "" if it does not wait; `key` says yes to a proposal."""
        proposal = self._controller.proposal
        if proposal is not None:
            return proposal_words(proposal, self._name, key)
        if self._controller.phase == "halted" and (asked := waits_line(self._game, HALTED)):
            return asked
        return ACCEPTABLE if self._game.acceptable else ""

    def _help(self) -> list[str]:
        if (verifying := self._controller.answers.verifying) is not None:
            return answer_help(verifying)
        activity, answers = self._game.world.activity, self._controller.robot.reportable
        offers = offered(self._controller)
        lines = help_lines(offers, activity.rules.claim, next(iter(answers), ""))
        if self._game.question is None:
            return [*lines, SAY_IN_WORDS]
        known = activity.behaviours.values()
        spoken = [f"  {one.question}: say {one.phrases[0]!r}" for one in known]
        return [ANSWER_IN_WORDS, *spoken, *lines]

    def _where(self) -> str:
        world = self._game.world
        state = world.observe()
        seen = state_words(world.activity, state, world.scene(), self._name)
        doing = world.activity.in_words(state.situation)
        robot = self._controller.robot
        going = going_words(robot.going, self._name, robot.lets)
        waits = person_wait_words(robot.waits_for, self._name)
        told = [f"Now: {doing}.", going, waits, f"{seen} ({self._controller.phase})"]
        told += [self._plan(), self._time()]
        return " ".join(filter(None, told))

    def _plan(self) -> str:
        """Tell what the game is played for, whether several can win, and who has won."""
        if (planned := as_planned(self._game.world)) is None:
            return ""
        words, several = played_words(planned.patterns), planned.game_plan.several
        return " ".join(
            filter(
                None,
                (
                    f"Played {words}." if words else "",
                    SEVERAL_WIN if several else "",
                    won_words([self._name(one) for one in planned.has_won]),
                ),
            )
        )

    def _time(self) -> str:
        """Tell the time of a game in which it is the time of the home, not simulated."""
        if self._game.world.played_in == SIMULATED:
            return ""
        view, time = self._controller.view(), self._controller.time
        stopped = self._controller.stopped
        told = time_words(view.seconds, time.ends, view.paused, time.clock(), stopped=stopped)
        return f"{told}."

"""Remarks about a teacher's possible mistakes, each made once and immediately.

They report a step that contradicts an earlier one, a skipped stage, a person who did not ask, a
step that changed nothing, and a game that ends too early. The teacher who knows the right answer
may have left by the time Tangy learns from the demonstrations.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from tangy_profiles.activity import Activity, StageRule
from tangy_profiles.behaviour import Behaviour
from tangy_profiles.demonstration import Step
from tangy_profiles.state import FRONT, Outcome, Situation
from tangy_profiles.store import Store
from tangy_tui.learning.conflicts import DemonstratedStep
from tangy_tui.learning.contradictions import Contradictions
from tangy_tui.learning.early_ends import due_instead, ending
from tangy_tui.learning.editing import Editor
from tangy_tui.learning.effects import progress
from tangy_tui.learning.library import read_library
from tangy_tui.learning.own_phrases import OwnPhrases
from tangy_tui.learning.teaching_events import (
    Contradicted,
    EndedEarly,
    NewWording,
    NothingChanged,
    Overlooked,
    Remark,
    RemarkAnswer,
    Settled,
    WrongPerson,
)

Kind = Literal["stage", "person", "end", "nothing"]


def answers_to(remark: Remark) -> tuple[RemarkAnswer, ...]:
    """Return the possible answers to a remark, in the order of their numbers."""
    match remark:
        case Contradicted():
            return ("this", "earlier", "both", "undo")
        case Overlooked() | NothingChanged():
            return ("undo", "this")
        case WrongPerson() | EndedEarly():
            return ("undo",)
        case NewWording():
            return ("keep",)


class Remarks:
    """Checks each step during teaching; `open` is the remark that can be answered now."""

    def __init__(self, activity: Activity, teacher: str, store: Store) -> None:
        """Prepare for a teacher; earlier demonstrations are read when first needed."""
        self.open: Remark | None = None
        self.phrases = OwnPhrases(store, activity, teacher)
        self._activity = activity
        self._teacher = teacher
        self._store = store
        self._contradictions: Contradictions | None = None
        self._told: set[tuple[Kind, Situation]] = set()
        self._settled: dict[int, int] = {}  # step id -> the edit that its answer made
        self._deferred: list[tuple[str, Remark]] = []  # demonstration, remark

    @property
    def _shown(self) -> Contradictions:
        """Earlier answers; remarks that this teacher has had are not repeated."""
        if self._contradictions is None:
            library = read_library(self._store, self._activity.name)
            self._contradictions = Contradictions(
                library.demonstrations, library.resolutions, teacher=self._teacher
            )
        return self._contradictions

    def usual(self, situation: Situation) -> tuple[str, ...]:
        """Return the behaviours shown in a situation, most frequent first."""
        return self._shown.usual(situation)

    def read(self) -> None:
        """Read earlier demonstrations unless they are cached; call it before logging a step."""
        _ = self._shown

    def reread(self) -> None:
        """Discard the cache of earlier demonstrations, because one was deleted."""
        self._contradictions, self.open = None, None

    def notice(self, shown: DemonstratedStep, outcome: Outcome, *, over: bool) -> None:
        """Check a step; a new remark about it becomes the open one.

        Args:
            shown: the step.
            outcome: what the world returned for it.
            over: whether the game is over after it.
        """
        ends = shown.step.behaviour in ending(self._activity) and outcome.completed
        over = over or ends  # a guided game goes on from an earlier moment
        known = self.usual(shown.step.state.situation)
        earlier = self._shown.found(shown)
        self.open = None
        overlooked = self._overlooked(shown, over=True) if over else None
        if isinstance(overlooked, EndedEarly):  # it comes first, because the game is over
            self.open = overlooked
        elif earlier is not None:
            own = earlier.teacher == self._teacher
            self.open = Contradicted(shown.number, shown.step, earlier, own)
        elif not known or self._goes(shown):
            self.open = overlooked if over else self._overlooked(shown, over=False)
        if self.open is None and not over:
            self.open = self._nothing_changed(shown, outcome)
        words = self.phrases.wording(shown.step.behaviour)
        if self.open is None and words:
            self.open = NewWording(shown.number, shown.step, words)

    def redone(self) -> Remark | None:
        """Close the remark on a step that was redone, and return it only if it ends a game.

        Others were made when the step was first shown.
        """
        if not isinstance(self.open, EndedEarly):
            self.open = None
        return self.open

    def put_off(self, demonstration: str) -> None:
        """Close the open remark without an answer.

        Learning asks about conflicts; other remarks are kept for `deferred`.
        """
        remark, self.open = self.open, None
        if remark is not None and not isinstance(remark, Contradicted | NewWording):
            self._deferred.append((demonstration, remark))

    def deferred(self) -> list[tuple[str, Remark]]:
        """Return remarks without an answer, each with its demonstration, and each only once.

        Remarks on games that are not finished come later.
        """
        finished = {d.id for d in read_library(self._store, self._activity.name).finished}
        due = [one for one in self._deferred if one[0] in finished]
        self._deferred = [one for one in self._deferred if one not in due]
        return due

    def answer(self, answer: RemarkAnswer, demonstration: str) -> Settled | None:
        """Log a teacher's answer to the open remark of a demonstration, or postpone it.

        Returns:
            What was settled; None if there is no open remark.
        """
        remark = self.open
        if remark is None:
            return None
        if answer == "later":
            self.put_off(demonstration)
        self.open = None
        if isinstance(remark, NewWording):
            self.phrases.note(remark.words, remark.step.behaviour, kept=answer == "keep")
            return Settled(remark, answer, ())
        situation, done = remark.step.state.situation, remark.step.behaviour
        other = remark.earlier.step.behaviour if isinstance(remark, Contradicted) else done
        answers: dict[RemarkAnswer, tuple[str, ...]] = {
            "this": (done,),
            "earlier": (other,),
            "both": (done, other),
        }
        right = answers.get(answer, ())
        if right:
            said = self._shown.resolved(situation, right, keep=answer == "both")
            editor = Editor(self._store, self._activity)
            self._settled[remark.step.id] = editor.settle(said).seq
            self._contradictions = None  # read again, with the resolution
        return Settled(remark, answer, right)

    def take_back(self, demonstration: str, number: int, step: Step) -> None:
        """Forget an undone step and undo its answer; a remark about it may be made again."""
        self.open = None
        self._deferred = [one for one in self._deferred if one[1].step.id != step.id]
        self._told = {(kind, of) for kind, of in self._told if of != step.state.situation}
        if self._contradictions is not None:
            self._contradictions.take_back(demonstration, number)
        settled = self._settled.pop(step.id, None)
        editor = Editor(self._store, self._activity)
        if settled is not None and editor.library.done and editor.library.done[-1].seq == settled:
            editor.undo()
            self._contradictions = None

    def _goes(self, shown: DemonstratedStep) -> bool:
        """Return whether a step goes to a person: it may be right for another person too."""
        return self._activity.behaviour(shown.step.behaviour).visits

    def _overlooked(self, shown: DemonstratedStep, *, over: bool) -> Remark | None:
        step, activity = shown.step, self._activity
        state, behaviour = step.state, activity.behaviour(step.behaviour)
        target = step.target
        if behaviour.visits and target is not None:
            asked = all(user.request == "AR" for user in state.users if user.id == target)
            if asked or not self._is_news("person", state.situation):
                return None
            return WrongPerson(shown.number, step, state.attended)
        if activity.expected.get(state.situation) == step.behaviour:
            return None
        rule = next(r for r in activity.stage_rules if r.stage == state.stage)
        if over and rule.condition != "after":
            ends = [r.behaviour for r in activity.stage_rules if r.condition == "after"]
            lacks = ends[0] if ends else due_instead(activity, state.situation, step.behaviour)
            if lacks and self._is_news("end", state.situation):
                return EndedEarly(shown.number, step, lacks)
            return None
        if not self._passes_over(rule, behaviour, shown):
            return None
        if not self._is_news("stage", state.situation):
            return None
        return Overlooked(shown.number, step, self._due(rule, shown))

    def _nothing_changed(self, shown: DemonstratedStep, outcome: Outcome) -> Remark | None:
        """Return the remark on a step that led nowhere, unless something explains it.

        A person, a rule, or the activity's file may: its host may wait until people do something.
        """
        step, rules = shown.step, self._activity.stage_rules
        led = progress(step.state, outcome, step.after)
        counted = any(
            step.behaviour in (r.behaviour, r.since) for r in rules if r.condition == "count"
        )
        host = self._activity.expected.get(step.state.situation) == step.behaviour
        if led in ("on", "waits") or outcome.response is not None or counted or host:
            return None
        if self._shown.called_right(step.state.situation, step.behaviour):
            return None
        if not self._is_news("nothing", step.state.situation):
            return None
        return NothingChanged(shown.number, step, led == "back")

    def _passes_over(self, rule: StageRule, behaviour: Behaviour, shown: DemonstratedStep) -> bool:
        """Return whether a behaviour skips the behaviour that is due in a stage."""
        step = shown.step
        match rule.condition:
            case "before":
                return behaviour.name != rule.behaviour
            case "count":
                return behaviour.name == rule.behaviour  # continues as if nothing were due
            case "beside requester":
                leaves = not behaviour.attends and not behaviour.returns
                return leaves or self._ends_wrongly(shown.step)
            case "requested or away":
                waits = step.state.situation.request == "AR" or step.state.place != FRONT
                return waits and not behaviour.drives
            case "after":
                return behaviour.calls
            case _:
                return False

    def _ends_wrongly(self, step: Step) -> bool:
        """Return whether a step ended a request by another behaviour than the file expects.

        A winner who is told to carry on asks no more, and nobody would notice.
        """
        due = self._activity.expected.get(step.state.situation)
        asking = {user.id for user in step.state.users if user.request == "AR"}
        after = {user.id for user in step.after.users if user.request == "AR"}
        return due not in (None, step.behaviour) and step.target in asking - after

    def _due(self, rule: StageRule, shown: DemonstratedStep) -> str | None:
        """Return the behaviour that the stage rule asks for, or None."""
        match rule.condition:
            case "before":
                return rule.behaviour
            case "count":
                return rule.since
            case "beside requester":
                return self._activity.expected.get(shown.step.state.situation)
            case "requested or away":
                asked = shown.step.state.situation.request == "AR"
                return self._first(lambda one: one.visits if asked else one.returns)
            case "after":
                return self._first(lambda one: one.ends)
            case _:
                return None

    def _first(self, wanted: Callable[[Behaviour], bool]) -> str | None:
        return next((b.name for b in self._activity.behaviours.values() if wanted(b)), None)

    def _is_news(self, kind: Kind, situation: Situation) -> bool:
        news = (kind, situation) not in self._told
        self._told.add((kind, situation))
        return news

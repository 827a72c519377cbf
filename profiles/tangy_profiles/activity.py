"""An activity, read from TOML: stages, user states, behaviours, phrasebook, deck.

Section III-A-3 of the paper models an activity as discrete stages and a robot as behaviours, each
with actions ac = f(theta, sp, im, l, ps). All words of an activity are in its TOML file; no code
names one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import product
from os.path import isdir
from pathlib import Path
from types import MappingProxyType

from tangy_profiles.activity_parts import (
    AskingLimits,
    read_asking_limits,
    read_by_request,
    read_pressing,
    read_sentence,
    read_strategies,
    read_user_states,
)
from tangy_profiles.behaviour import Action, Behaviour, read_behaviour
from tangy_profiles.cards import CardState, Deck, read_deck
from tangy_profiles.declared.vocabulary import declares
from tangy_profiles.defaults import SHIPPED
from tangy_profiles.errors import ProfileError
from tangy_profiles.extensions import activity_files
from tangy_profiles.game_rules import NO_RULES, GameRules, read_game_rules
from tangy_profiles.persuading import PAPER, PersuasionConfig, read_persuading
from tangy_profiles.phones import read_pronunciations
from tangy_profiles.reading import Table, nearest, plain, read_toml
from tangy_profiles.state import Outcome, Request, Situation

LISTENING = ("tiers", "paper")
"""How spoken words are matched: in tiers of confidence, or by n-grams and keywords alone."""
CONDITIONS = ("before", "after", "beside requester", "requested or away", "count", "otherwise")


@dataclass(frozen=True)
class StageRule:
    """One line of the stage table; the first one whose condition holds gives the stage.

    Conditions: `before`/`after` a behaviour has succeeded once; `beside requester`: the robot is
    with a person who asks for help; `requested or away`: somebody asks, or the robot is not at the
    front; `count`: `behaviour` was executed `at_least` times since `since`; `otherwise`.
    """

    stage: str
    condition: str
    behaviour: str = ""
    since: str = ""
    at_least: int = 0
    not_yet: Mapping[str, str] = field(default_factory=dict)
    """By request (ANR, AR): the words that this stage was not shown yet."""
    label: Mapping[str, str] = field(default_factory=dict)
    """By request: the name of this stage for people."""
    now: Mapping[str, str] = field(default_factory=dict)
    """By request: a sentence that says what a host might do now; {name} is the person who asks."""


@dataclass(frozen=True)
class Activity:
    """The definition of an activity, before any demonstration."""

    name: str
    title: str
    patience: float
    strategies: Mapping[str, str]
    plain_strategy: str
    deck: Deck
    user_states: tuple[CardState, ...]
    stage_rules: tuple[StageRule, ...]
    behaviours: Mapping[str, Behaviour]
    expected: Mapping[Situation, str]
    source: str
    persuasion: PersuasionConfig = PAPER
    object: str = "card"
    """The object people handle, in their words."""
    pronunciations: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Pronunciations of words in the phrases that replace those of the dictionary."""
    listening: str = LISTENING[0]
    """How spoken words are matched, one of LISTENING."""
    pressing: tuple[str, ...] = ()
    """The strategies that are not used again in a visit after the person has refused."""
    names_pressing: bool = False
    """Whether the file lists its pressing strategies (or says that it has none)."""
    asking: AskingLimits = field(default_factory=AskingLimits)
    rules: GameRules = NO_RULES
    summary: str = ""  # for how many people, how long it takes, what is needed
    file: str = ""  # its path, if it comes neither with Tangy nor with a package

    @cached_property
    def unread(self) -> str:
        """The user activity state of a person whose card has not been read."""
        return next(s.name for s in self.user_states if s.checker == "unread")

    @cached_property
    def card_states(self) -> tuple[CardState, ...]:
        """The user activity states that a read card can have, in order of precedence."""
        return tuple(s for s in self.user_states if s.checker != "unread")

    def state_label(self, user_state: str) -> str:
        """Return the name of a user activity state for people."""
        return next((s.label for s in self.user_states if s.name == user_state), user_state)

    def reads(self, stage: str) -> bool:
        """Return whether the robot reads the card beside it in a stage."""
        return any(r.stage == stage and r.condition == "beside requester" for r in self.stage_rules)

    def in_words(self, situation: Situation) -> str:
        """Describe a triple in a few words: the stage, and the attended person's state.

        In the stage of helping, that is the person's activity state, in other stages whether
        somebody asks. The activity's own label of a stage is used if it has one.
        """
        stage, request, user_state = situation
        rules = (rule for rule in self.stage_rules if rule.stage == stage)
        label = next((words for rule in rules if (words := rule.label.get(request))), "")
        if self.reads(stage) or user_state != self.unread:
            return f"{label or stage}: {self.state_label(user_state)}"
        return label or f"{stage} · {'nobody' if request == 'ANR' else 'somebody'} asks"

    def not_yet(self, situation: Situation) -> str:
        """Name a situation that has not been shown yet; an activity may have other words for it."""
        stage, request, user_state = situation
        if self.reads(stage):
            state = next((s for s in self.user_states if s.name == user_state), None)
            words = state.not_yet if state is not None else ""
        else:
            rules = (rule for rule in self.stage_rules if rule.stage == stage)
            words = next((w for rule in rules if (w := rule.not_yet.get(request))), "")
        return words or self.in_words(situation)

    def host_words(self, situation: Situation) -> str:
        """Return what a host might do in a situation, with {name} for the person; "" if unknown."""
        stage, request, user_state = situation
        if self.reads(stage):
            return next((s.now for s in self.user_states if s.name == user_state), "")
        rules = (rule for rule in self.stage_rules if rule.stage == stage)
        return next((words for rule in rules if (words := rule.now.get(request))), "")

    def behaviour_words(self, name: str) -> str:
        """Return the words for a behaviour; an unknown one keeps its name."""
        known = self.behaviours.get(name)
        return name if known is None else known.question

    def behaviour_named(self, words: str) -> str:
        """Return the name of the behaviour with these words; else the words unchanged."""
        wanted = " ".join(words.casefold().split())
        named = (b.name for b in self.behaviours.values() if b.question.casefold() == wanted)
        return words if words in self.behaviours else next(named, words)

    @cached_property
    def stages(self) -> tuple[str, ...]:
        """The stages in the order of their rules."""
        return tuple(dict.fromkeys(rule.stage for rule in self.stage_rules))

    @cached_property
    def situations(self) -> tuple[Situation, ...]:
        """All triples that the stage rules can reach, from the opening to the end.

        Before the first `before` rule has passed, nobody can have asked. Beside a requester every
        user state can occur. A `requested or away` stage occurs with and without a request, and so
        does an `after` stage, except after a win, when the winner's request is still open.
        """
        found: list[Situation] = []
        for rule in sorted(self.stage_rules, key=lambda rule: rule.condition == "after"):
            match rule.condition:
                case "beside requester":
                    found += [Situation(rule.stage, "AR", s.name) for s in self.user_states]
                case "requested or away":
                    found.append(Situation(rule.stage, "AR", self.unread))
                    found.append(Situation(rule.stage, "ANR", self.unread))
                case "after":
                    found.append(Situation(rule.stage, "AR", self.unread))
                    if not self.leaves_request(rule):
                        found.append(Situation(rule.stage, "ANR", self.unread))
                case _:
                    found.append(Situation(rule.stage, "ANR", self.unread))
        return tuple(dict.fromkeys(found))

    def imaginable(self) -> Iterable[Situation]:
        """Yield every situation for which a policy has a decision, reachable or not."""
        requests: tuple[Request, ...] = ("ANR", "AR")
        for stage, request, state in product(self.stages, requests, self.user_states):
            yield Situation(stage, request, state.name)

    def need_cards(self) -> None:
        """Raise an error unless the activity is played with cards.

        Raises:
            ProfileError: it is played without cards.
        """

    @property
    def teams(self) -> tuple[str, ...]:
        """The teams that take turns; empty if people play individually."""
        return ()

    def expected_selector(self, situation: Situation) -> str | None:
        """Return the expected selector of a behaviour's person, if one is named."""
        return None

    def leaves_request(self, rule: StageRule) -> bool:
        """Return whether an `after` stage begins beside a winner, whose request stays open."""
        behaviour = self.behaviours[rule.behaviour]
        return bool(behaviour.needs) and behaviour.closes == "never"

    def behaviour(self, name: str) -> Behaviour:
        """Return a behaviour by its name.

        Raises:
            ProfileError: there is none; the message suggests the nearest name.
        """
        try:
            return self.behaviours[name]
        except KeyError:
            raise ProfileError(
                f"{self.title} has no behaviour {name!r}: {nearest(name, self.behaviours)}"
            ) from None

    def action(self, behaviour: Behaviour, target: str | None, strategy: str | None) -> Action:
        """Return the action of a behaviour for a persuasive strategy (None: the plain one)."""
        chosen = strategy or self.plain_strategy
        return Action(
            behaviour,
            target,
            chosen,
            behaviour.posture,
            behaviour.speech[chosen],
            behaviour.image,
            behaviour.place,
        )

    def words_of(
        self, action: Action, outcome: Outcome, name: Callable[[str], str]
    ) -> tuple[str, str]:
        """Return the speech and picture text of an action; "" if numbers are missing."""
        called = name(action.target) if action.target is not None else ""
        fill, numbers = self.fill, outcome.numbers
        return fill(action.speech, called, numbers, aloud=True), fill(action.image, called, numbers)

    def fill(
        self, template: str, name: str, numbers: tuple[int, ...], *, aloud: bool = False
    ) -> str:
        """Fill name and numbers (few if said `aloud`) into a text; "" if it lacks its numbers."""
        if not numbers and ("{numbers}" in template or "{call}" in template):
            return ""
        labels = [self.deck.label(number) for number in numbers]
        said = self.rules.said(labels) if aloud else ", ".join(labels)
        return template.format(name=name, call=labels[0] if labels else "", numbers=said)


def shipped_activities() -> dict[str, Path]:
    """Return the files of the activities that come with Tangy, by name."""
    folder = SHIPPED / "activities"
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def known_activities() -> dict[str, Path]:
    """Return the files of Tangy's activities and those of other packages, by name."""
    return {**activity_files(), **shipped_activities()}


def load_activity(name: str) -> Activity:
    """Load an activity by name, or by the path of its TOML file.

    Raises:
        ProfileError: there is no such activity, or its file has a mistake; one line with file, key,
            value and the nearest valid word.
    """
    shipped = shipped_activities()
    if name in shipped:
        return read_activity(shipped[name])
    if name.endswith(".toml"):
        return replace(read_activity(Path(name)), file=str(Path(name).resolve()))
    if isdir(name):  # noqa: PTH112 - False for a name too long, where Path raises
        raise ProfileError(plain(f"{name}: is a folder; name the TOML file in it."))
    known = known_activities()
    if name in known:
        return read_activity(known[name])
    raise ProfileError(f"There is no activity {name!r}: {nearest(name, known)}")


def read_activity(path: Path) -> Activity:
    """Read and check one activity file.

    Raises:
        ProfileError: one line with file, key, value and the nearest valid word.
    """
    top = read_toml(path)
    if declares(top):
        from tangy_profiles.declared.activity import read_declared

        return read_declared(path)
    strategies = read_strategies(top.table("strategies"))
    plain_strategy = top.choice("plain_strategy", strategies)
    states = read_user_states(top)
    state_names = [s.name for s in states]
    behaviours = _behaviours(top, strategies, state_names)
    rules = _stage_rules(top, behaviours)
    listening = top.table("listening", optional=True)
    deck = read_deck(top.table("deck"))
    activity = Activity(
        name=top.text("name"),
        title=top.text("title"),
        patience=top.number("patience", 0.1, 600),
        strategies=MappingProxyType(strategies),
        plain_strategy=plain_strategy,
        deck=deck,
        user_states=states,
        stage_rules=rules,
        behaviours=MappingProxyType(behaviours),
        expected=MappingProxyType(_expected(top, rules, state_names, behaviours)),
        source=path.name,
        persuasion=read_persuading(top.table("persuasion", optional=True)),
        object=top.text("object", "card"),
        summary=top.text("summary", ""),
        pronunciations=read_pronunciations(top.table("pronunciations", optional=True)),
        listening=listening.choice("mode", LISTENING, LISTENING[0]),
        names_pressing="pressing_strategies" in top,
        pressing=read_pressing(top, strategies),
        asking=read_asking_limits(top),
        rules=read_game_rules(top, deck, tuple(strategies)),
    )
    listening.close()
    top.close()
    for situation in activity.expected:
        if situation not in activity.situations:
            raise top.wrong("expected", f"{' / '.join(situation)} can never come about.")
    return activity


def _behaviours(top: Table, strategies: dict[str, str], states: list[str]) -> dict[str, Behaviour]:
    behaviours: dict[str, Behaviour] = {}
    said: dict[str, str] = {}
    for entry in top.tables("behaviours"):
        behaviour = read_behaviour(entry, strategies, states)
        if behaviour.name in behaviours:
            raise entry.wrong("name", "stands here twice.")
        for phrase in behaviour.phrases:
            if phrase in said:
                raise entry.wrong("phrases", f"{phrase!r} belongs to {said[phrase]!r} already.")
            said[phrase] = behaviour.name
        behaviours[behaviour.name] = behaviour
        entry.close()
    if not behaviours:
        raise top.wrong("behaviours", "must hold at least one behaviour.")
    if not any(b.ends for b in behaviours.values()):
        raise top.wrong("behaviours", "one must have the effect 'finish', or no game would end.")
    return behaviours


def _stage_rules(top: Table, behaviours: dict[str, Behaviour]) -> tuple[StageRule, ...]:
    rules: list[StageRule] = []
    for entry in top.tables("stages"):
        stage = entry.text("name")
        condition = entry.choice("when", CONDITIONS)
        keys = ("not_yet", "label", "now")
        not_yet, label, now = (read_by_request(entry, key) for key in keys)
        for sentence in now.values():
            read_sentence(entry, "now", sentence)
        if condition in ("before", "after"):
            named = entry.choice("behaviour", behaviours)
            rule = StageRule(stage, condition, named, not_yet=not_yet, label=label, now=now)
        elif condition == "count":
            counted = entry.choice("behaviour", behaviours)
            since = entry.choice("since", behaviours)
            if since == counted:
                raise entry.wrong("since", "must be another behaviour than the counted one.")
            every = entry.whole("every", 1, 999)
            rule = StageRule(stage, condition, counted, since, every, not_yet, label, now)
        else:
            rule = StageRule(stage, condition, not_yet=not_yet, label=label, now=now)
        rules.append(rule)
        entry.close()
    if not rules or rules[-1].condition != "otherwise":
        raise top.wrong("stages", "the last one must be when = 'otherwise'.")
    return tuple(rules)


def _expected(
    top: Table, rules: tuple[StageRule, ...], states: list[str], behaviours: dict[str, Behaviour]
) -> dict[Situation, str]:
    stages = {rule.stage for rule in rules}
    expected: dict[Situation, str] = {}
    for entry in top.tables("expected", optional=True):
        situation = Situation(
            entry.choice("stage", stages),
            "AR" if entry.choice("request", ("AR", "ANR")) == "AR" else "ANR",
            entry.choice("user_state", states),
        )
        expected[situation] = entry.choice("behaviour", behaviours)
        entry.close()
    return expected

"""A declared activity with the interface of an `Activity`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from types import MappingProxyType

from tangy_profiles.activity import Activity, StageRule
from tangy_profiles.activity_parts import AskingLimits
from tangy_profiles.behaviour import Action, Behaviour
from tangy_profiles.cards import CardState, Deck
from tangy_profiles.declared.model import Declaration, DeclaredBehaviour, Expectation
from tangy_profiles.declared.reader import read_declaration
from tangy_profiles.declared.situation_words import situation_words, stage_words
from tangy_profiles.declared.situations import (
    NOTHING_SEEN,
    seen_facts,
    situations,
    told,
)
from tangy_profiles.declared.speech import with_names
from tangy_profiles.declared.vocabulary import SLOT, Selector
from tangy_profiles.effects import Effect
from tangy_profiles.errors import ProfileError
from tangy_profiles.state import EVERYBODY, Outcome, Situation

NO_CARDS = Deck((), 0, False, ())
MOST_SITUATIONS = 3_000


@dataclass(frozen=True)
class DeclaredActivity(Activity):
    """An activity whose facts, stages and behaviours are declared in its file."""

    declaration: Declaration = field(kw_only=True)

    @cached_property
    def situations(self) -> tuple[Situation, ...]:
        """The situations that the conditions of the stages do not rule out, in order."""
        return tuple(situations(self.declaration))

    def need_cards(self) -> None:
        """Raise an error, because the activity has no cards.

        Raises:
            ProfileError: always.
        """
        raise ProfileError(f"{self.title} has no cards, and this needs some.")

    @property
    def teams(self) -> tuple[str, ...]:
        """The teams that take turns; empty if people play individually."""
        return self.declaration.teams

    def imaginable(self) -> Iterable[Situation]:
        """Yield every situation for which a policy has a decision."""
        return self.situations

    def in_words(self, situation: Situation) -> str:
        """Describe a situation: the stage, and the facts that it sees."""
        return situation_words(self.declaration, situation)

    def told_of(self, situation: Situation, who: str) -> str:
        """Describe a situation with the person of the stage ("": anyone)."""
        return situation_words(self.declaration, situation, who)

    def in_names(self, situation: Situation) -> str:
        """Format a situation with the names in the file: the stage, and its facts."""
        facts = ", ".join(f"{fact} is {value}" for fact, value in seen_facts(situation).items())
        return f"{situation.stage} · {facts}" if facts else situation.stage

    def stage_words(self, stage: str) -> str:
        """Describe a stage."""
        return stage_words(self.declaration, stage)

    def not_yet(self, situation: Situation) -> str:
        """Describe a situation that has not been shown yet."""
        return self.in_words(situation)

    def words_of(
        self, action: Action, outcome: Outcome, name: Callable[[str], str]
    ) -> tuple[str, str]:
        """Return the world's speech and picture text, with people's names."""
        return with_names(outcome.speech, name), with_names(outcome.image, name)

    def text_in_turn(self, behaviour: str, strategy: str, times: int, *, personal: bool) -> str:
        """Return the text of a behaviour after so many times, `personal` if it is for a person.

        A text that needs a person is skipped without one, as in a game.
        """
        says = self.declaration.behaviours[behaviour].says
        texts = says.get(strategy) or next(iter(says.values()), ())
        in_turn = (texts[(times + n) % len(texts)] for n in range(len(texts)))
        return next((text for text in in_turn if personal or "{name}" not in text), "")

    def fill(
        self, template: str, name: str, numbers: tuple[int, ...], *, aloud: bool = False
    ) -> str:
        """Fill a name into a text; return "" if it has other slots."""
        text = template.replace("{name}", name)
        return "" if SLOT.search(text) else text

    def expectation(self, situation: Situation) -> Expectation | None:
        """Return the expectation that a test has in a situation, or None."""
        facts = seen_facts(situation)
        for one in self.declaration.expected:
            if one.stage == situation.stage and all(told(c, facts) for c in one.conditions):
                return one
        return None

    def expected_selector(self, situation: Situation) -> Selector | None:
        """Return the expected selector of the behaviour's person, or None."""
        found = self.expectation(situation)
        return found.to if found is not None else None


def read_declared(path: Path) -> DeclaredActivity:
    """Read and check a declared activity.

    Raises:
        ProfileError: the file has mistakes; the message has the first one, and how many more.
    """
    return build_activity(read_declaration(path))


def build_activity(declaration: Declaration) -> DeclaredActivity:
    """Make a playable activity from a declaration.

    Raises:
        ProfileError: the stages see too many facts to show all situations.
    """
    count = 1
    for stage in declaration.stages:
        product = 1
        for name in stage.sees:
            product *= len(declaration.facts[name].values)
        count += product
    if count > MOST_SITUATIONS:
        raise ProfileError(
            f"{declaration.source}: the stages see {count} situations; {MOST_SITUATIONS} at most."
        )
    bare = _with_expected(declaration, MappingProxyType({}))
    expected = {
        situation: found.behaviour
        for situation in bare.situations
        if (found := bare.expectation(situation)) is not None
    }
    return _with_expected(declaration, MappingProxyType(expected))


def _with_expected(
    declaration: Declaration, expected: MappingProxyType[Situation, str]
) -> DeclaredActivity:
    labels = dict.fromkeys(one.user_state for one in situations(declaration))
    states = [CardState(NOTHING_SEEN, NOTHING_SEEN, "unread", "")]
    states += [
        CardState(one, one, "otherwise", "") for one in sorted(labels) if one != NOTHING_SEEN
    ]
    return DeclaredActivity(
        name=declaration.name,
        title=declaration.title,
        patience=declaration.patience,
        summary=declaration.summary,
        strategies=MappingProxyType(dict(declaration.strategies)),
        plain_strategy=declaration.plain_strategy,
        deck=NO_CARDS,
        user_states=tuple(states),
        stage_rules=tuple(StageRule(stage.name, "otherwise") for stage in declaration.stages),
        behaviours=MappingProxyType(
            {name: _behaviour(declaration, one) for name, one in declaration.behaviours.items()}
        ),
        expected=expected,
        source=declaration.source,
        pronunciations=MappingProxyType(dict(declaration.pronunciations)),
        names_pressing=True,
        asking=AskingLimits(named=True),
        declaration=declaration,
    )


def _behaviour(declaration: Declaration, one: DeclaredBehaviour) -> Behaviour:
    does = {effect.does for effect in one.effects}
    effect: Effect = "none"
    if "finish" in does:
        effect = "finish"
    elif "go to whom" in does:
        effect = "go to user"
    elif "go to front" in does:
        effect = "go to front"
    texts = {name: found[0] for name, found in one.says.items()}
    first = texts.get(declaration.plain_strategy, next(iter(texts.values()), ""))
    return Behaviour(
        name=one.name,
        question=one.question,
        effect=effect,
        place="here",
        posture=one.posture,
        image=one.image or ("" if one.picture else declaration.title),
        speech=MappingProxyType({s: texts.get(s, first) for s in declaration.strategies}),
        persuades=one.invites,
        closes="always" if "close request" in does else "never",
        needs=(),
        phrases=one.phrases,
        keywords=(),
        wordings=one.wordings,
        to=tuple(EVERYBODY if selector == "group" else selector for selector in one.to),
    )

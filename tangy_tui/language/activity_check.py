"""Check of an activity: stages that cannot be reached, and phrases that cannot be understood."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from tangy_profiles.activity import Activity, StageRule
from tangy_profiles.activity_parts import GAME, VISIT
from tangy_profiles.behaviour import Behaviour
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.person import Person
from tangy_profiles.reading import plain
from tangy_profiles.robot import Robot
from tangy_tui.language.answers import PLAIN
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.lexicon import Lexicon, SoundAlike, distinct_word
from tangy_tui.language.phrasebook import Phrase
from tangy_tui.language.pronunciation import can_look_up
from tangy_tui.language.stop_sentence import stops
from tangy_tui.language.words import words_of


@dataclass(frozen=True, slots=True)
class CheckedFile:
    """A checked file: its mistakes and its warnings, a line each.

    `notes` say what was checked.
    """

    file: str
    mistakes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


At: TypeAlias = Callable[[str], str]
"""Returns the file of a behaviour, by name, with its line if it is known: "quiz.toml:12"."""


def check_activity(
    activity: Activity,
    robot: Robot,
    people: Sequence[Person],
    lines: Mapping[str, int] | None = None,
) -> CheckedFile:
    """Check an activity that could be read.

    Phrases that are confused with others, or cannot be recognised, are mistakes; the game can be
    played without them, so the file still loads.

    Args:
        activity: the activity.
        robot: the robot that has to do it.
        people: whose names its phrases contain.
        lines: the line of each behaviour in its file, if they are known.
    """
    mistakes: list[str] = []

    def at(behaviour: str) -> str:
        line = (lines or {}).get(behaviour)
        return activity.source if line is None else f"{activity.source}:{line}"

    if (missing := robot.missing_posture(activity)) is not None:
        mistakes.append(f"{at(missing.behaviour)}: {missing}")
    phrasebook = Phrasebook(activity, people)
    mistakes += [*_phrases(activity, phrasebook, at), *_reserved(activity, phrasebook, at)]
    mistakes += _fillers(activity, phrasebook, at)
    mistakes += _sounds(activity, phrasebook, at)
    warnings = [
        *_pressing(activity),
        *_asking(activity),
        *_stages(activity),
        *_unused(activity, phrasebook),
        *_near(activity, phrasebook, at),
    ]
    return CheckedFile(activity.source, tuple(map(plain, mistakes)), tuple(map(plain, warnings)))


def _pressing(activity: Activity) -> Iterator[str]:
    """Report strategies that may press people, if the file does not list the pressing ones."""
    used = [
        s for s in activity.strategies if s not in (*activity.pressing, activity.plain_strategy)
    ]
    if used and not activity.names_pressing:
        yield (
            f"{activity.source}: pressing_strategies is not there: after a refusal Tangy still uses"
            f" {', '.join(used)}. Name those that press people, or [] if none does."
        )


def _asking(activity: Activity) -> Iterator[str]:
    """Report the default limits of requests, if the file does not set them."""
    if not activity.asking.named:
        asking = activity.asking
        yield f"{activity.source}: {VISIT}, {GAME}: not given, so {asking.visit} and {asking.game}"


def _stages(activity: Activity) -> Iterator[str]:
    """Report each stage whose rules can never apply."""
    reasons: dict[str, list[str | None]] = {}
    for place, rule in enumerate(
        () if isinstance(activity, DeclaredActivity) else activity.stage_rules
    ):
        reason = _never(rule, activity.stage_rules[:place], activity)
        reasons.setdefault(rule.stage, []).append(reason)
    for stage, found in reasons.items():
        if None not in found:
            yield f"{activity.source}: stages[{stage}]: can never be reached: {found[0]}."


def _never(rule: StageRule, earlier: Sequence[StageRule], activity: Activity) -> str | None:
    """Return why a rule can never apply, or None."""
    for other in earlier:
        if other.condition == "otherwise":
            return f"{other.stage!r} stands before it with when = 'otherwise'"
        if other.condition == "after" and any(
            one.condition == "before" and one.behaviour == other.behaviour for one in earlier
        ):
            return f"it is always before or after {other.behaviour!r}, which comes first"
        if _covers(other, rule):
            return f"{other.stage!r} always holds first"
    if rule.condition == "after" and activity.behaviours[rule.behaviour].ends:
        return f"after {rule.behaviour!r} the activity is over"
    return None


def _covers(other: StageRule, rule: StageRule) -> bool:
    """Return whether an earlier rule holds whenever this one does."""
    if (other.condition, rule.condition) == ("requested or away", "beside requester"):
        return True
    return (
        (other.condition, other.behaviour, other.since)
        == (rule.condition, rule.behaviour, rule.since)
        and other.at_least <= rule.at_least
    )  # fmt: skip


def _phrases(activity: Activity, phrasebook: Phrasebook, at: At) -> Iterator[str]:
    """Report phrases that are understood as another behaviour than their own."""
    for behaviour in activity.behaviours.values():
        heard = {phrase: _heard(phrasebook, phrase) for phrase in _ways(behaviour)}
        lost = {phrase: as_ for phrase, as_ in heard.items() if as_ != behaviour.name}
        where = f"{at(behaviour.name)}: behaviours[{behaviour.name}].phrases"
        if len(lost) == len(heard):
            yield f"{where}: nobody can ask for it: " + "; ".join(map(_as, lost.items())) + "."
        else:
            yield from (f"{where} = {phrase!r}: {_as((phrase, as_))}; ask for it otherwise here."
                        for phrase, as_ in lost.items())  # fmt: skip


def _ways(behaviour: Behaviour) -> tuple[str, ...]:
    return tuple(dict.fromkeys((*behaviour.phrases, behaviour.name)))


def _heard(phrasebook: Phrasebook, phrase: str) -> str | None:
    command = phrasebook.understand(phrase)
    return None if command is None else command.behaviour


def _as(lost: tuple[str, str | None]) -> str:
    phrase, heard = lost
    return f"{phrase!r} is " + ("not understood" if heard is None else f"heard as {heard!r}")


def _reserved(activity: Activity, phrasebook: Phrasebook, at: At) -> Iterator[str]:
    """Report phrases with a fixed meaning: stop commands and answers."""
    for phrase in phrasebook.table.all():
        stop, said = stops(phrase.said), phrase.said
        if phrase.heard and (stop or said in PLAIN):
            why = "always stops the robot" if stop else "is an answer to Tangy's questions"
            word = distinct_word(phrasebook, phrase.behaviour, phrase)
            such = f", such as {word!r}" if word else ""
            if phrase.words == words_of(phrase.behaviour):
                place, change = f"behaviours[{phrase.behaviour}]", "give it another name"
                such = such.replace(", such as", ", with a word such as")
                yield f"{at(phrase.behaviour)}: {place}: this name {why}; {change}{such}."
                continue
            yield (
                f"{at(phrase.behaviour)}: {_place(activity, phrase)}: "
                f"it {why}; ask for it with another word{such}."
            )


def _fillers(activity: Activity, phrasebook: Phrasebook, at: At) -> Iterator[str]:
    """Report phrases that differ only in filler words."""
    first: dict[str, Phrase] = {}
    for phrase in phrasebook.table.all():
        if phrase.user is None and phrase.heard and phrase.bare:
            other = first.setdefault(" ".join(phrase.bare), phrase)
            if other.behaviour != phrase.behaviour:
                little = "only small words tell it from"
                yield _collision(activity, phrasebook, SoundAlike(phrase, other), little, at)


def _sounds(activity: Activity, phrasebook: Phrasebook, at: At) -> Iterator[str]:
    """Report phrases that sound like others, and words without a pronunciation."""
    if not can_look_up():
        return
    lexicon = Lexicon(phrasebook)
    for alike in lexicon.alike:
        if alike.phrase.bare != alike.other.bare:
            yield _collision(activity, phrasebook, alike, "it sounds like", at)
    for said in lexicon.unknown:
        if said.word in phrasebook.table.own_words:
            phones = said.phones[0] if said.phones else "..."
            hear = f" (hear it: tangy activity hear {phones!r})" if said.phones else ""
            yield (
                f"{activity.source}: pronunciations: {said.word!r} has no pronunciation; "
                f'add: {said.word} = "{phones}"{hear}'
            )


def _near(activity: Activity, phrasebook: Phrasebook, at: At) -> Iterator[str]:
    """Report phrases that differ from others in one phone."""
    if can_look_up():
        for alike in Lexicon(phrasebook).confusable_phrases():
            if alike.phrase.bare != alike.other.bare:
                yield _collision(activity, phrasebook, alike, "one sound alone tells it from", at)


def _collision(
    activity: Activity, phrasebook: Phrasebook, alike: SoundAlike, how: str, at: At
) -> str:
    """Return a sentence about two confusable phrases, with their places and a suggestion."""
    phrase, other = alike.phrase, alike.other
    word = distinct_word(phrasebook, phrase.behaviour, phrase)
    such = f", such as {word!r}" if word else ""
    return (
        f"{at(phrase.behaviour)}: {_place(activity, phrase)}: {how} {_place(activity, other)}; "
        f"put another word into one of them{such}."
    )


def _place(activity: Activity, phrase: Phrase) -> str:
    """Return the location of a phrase in the file, as written there."""
    behaviour = activity.behaviours[phrase.behaviour]
    where = f"behaviours[{behaviour.name}]"
    for text in behaviour.phrases:
        if words_of(text) == phrase.words:
            return f"{where}.phrases = {text!r}"
    if words_of(behaviour.question) == phrase.words:
        return f"{where}.question = {behaviour.question!r}"
    return f"{where}.phrases, with a person = {phrase.said!r}"


def _unused(activity: Activity, phrasebook: Phrasebook) -> Iterator[str]:
    """Report pronunciations of words that occur in no phrase."""
    table = phrasebook.table
    known = {word for phrase in (*table.all(), *table.keywords) for word in phrase.words}
    for word in activity.pronunciations:
        if word not in known:
            yield f"{activity.source}: pronunciations.{word}: the word is in no phrase."

"""The meaning of spoken words in tiers: a question, up to three choices, or nothing.

Three tiers: *sure* words are asked about at once, *unsure* ones are offered as choices (each of
which is asked about in its turn), and of others it is only said what was heard. Words that stop the
robot do so in every mode. In the paper's mode there is one tier: n-gram and keywords.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from difflib import SequenceMatcher
from types import MappingProxyType

from tangy_tui.language.answers import NO, YES, choice_in, choice_phrases, yes_or_no
from tangy_tui.language.commands import MOST_ALTERNATIVES, Command, Phrasebook
from tangy_tui.language.steering import (
    IN_GAMES,
    WHILE_TEACHING,
    Steering,
    steering_of,
    steering_texts,
)
from tangy_tui.language.stop_phrases import other_stop_texts, stop_texts
from tangy_tui.language.stop_sentence import STOPS, stops
from tangy_tui.language.words import clean
from tangy_tui.learning.verification import Reply, Say, StopCommand
from tangy_tui.speech.evidence import AcousticEvidence, EvidenceSettings, Wanted
from tangy_tui.speech.hearing_notes import HearingKind

# How likely words are to be the command they come nearest to: a logistic over the confidence of
# the phrasebook, over how many telling words it knows, and over how much better words explain the
# sound than the grammar or any phones do. Fitted, and the limits set, by tests/bench/speech.py on
# voices and sentences that no figure is quoted for.
CONFIDENCE_WEIGHT, KNOWN_WEIGHT, MARGIN_WEIGHT, OFFSET = 14.98, 0.39, 1.51, -12.98
LEAST_MARGIN, MOST_MARGIN = -1.5, 1.0
MOST_KNOWN = 3
SURE = 0.6
UNSURE = 0.35
DOUBT_WEIGHT, DOUBTED = 4.5, 0.0
"""How much less likely a paraphrase is, in logits a unit of the margin, below some margin."""
NO_TALK = 0.9  # likelihood of a near phrase from which words are no other talk, whatever was learnt
SMALL_MARGIN = -0.25  # below it a whole phrase explains the sound better than other words do
SAME_SOUND = 0.75  # likeness of letters from which such words are taken for the phrase, misheard
UNDERSTOOD = 0.35
"""The confidence below which the paper's mode takes nothing for a command."""

OWN_NAME = {"tangy": ("T AE NG IY",)}
LEAST_ANSWER, LEAST_ALONE = -1.2, -0.6
"""The margins from which words are an answer: where the grammar finds it too, and where not."""

BOTH_HEARD, ONE_HEARD = 0.95, 0.5
"""How likely an answer of people is that both decoders hear, and one that only one of them hears.

Chosen, not fitted: the first is judged, and the second is below what is judged.
"""

LEAST_STEERING = -0.6
"""The margin from which words steer the program where the grammar does not find them, too."""

SOUND_ALIKE = {"to": "two", "too": "two", "for": "four", "won": "one", "ate": "eight"}


def wanted(
    phrasebook: Phrasebook, settings: EvidenceSettings, phrases: Sequence[str] | None = None
) -> Wanted:
    """Return the vocabulary: phrases, stop commands, and answers.

    Args:
        phrasebook: has the pronunciations, and all phrases as they are said.
        settings: how it is listened.
        phrases: those that can be told apart by their sound, if that is known.
    """
    learnt = settings.mode != "paper"  # which has phrases and keywords alone
    teaching, games = (
        steering_texts(ways) if learnt else () for ways in (WHILE_TEACHING, IN_GAMES)
    )
    given = tuple(phrasebook.table.answers) if learnt else ()
    answers = (*YES, *NO, *choice_phrases(MOST_ALTERNATIVES), *phrasebook.table.questions)
    return Wanted(
        (*(phrasebook.spoken() if phrases is None else phrases), *STOPS, *teaching),
        (*answers, *STOPS, *games, *given),
        STOPS,
        {**OWN_NAME, **phrasebook.pronunciations()},
        settings,
        stop_texts(),
        other_stop_texts(),
        tuple(sorted(phrasebook.game)),
    )


def sounds_of(phrasebook: Phrasebook) -> tuple[object, ...]:
    """Return the spoken content of a phrasebook: phrasebooks that share it can share a decoder."""
    return phrasebook.spoken(), phrasebook.pronunciations(), tuple(phrasebook.table.answers)


def understand(
    evidence: AcousticEvidence, phrasebook: Phrasebook, settings: EvidenceSettings
) -> Say | StopCommand:
    """Return what an utterance commands: it may be several things, or (no commands) nothing."""
    if settings.mode == "paper":
        if stops(evidence.words, phrasebook.game):
            return StopCommand(evidence.words)
        return _as_in_the_paper(evidence, phrasebook)
    text, margin = best_words(evidence, phrasebook)
    if stops(text, phrasebook.game):
        return StopCommand(text)
    steers = text not in phrasebook.phrases and _steers(text, evidence, settings, WHILE_TEACHING)
    if steers and (not evidence.stop or steering_of(evidence.phrase) == steering_of(text)):
        return Say(text, 1.0, None)
    near, confidence = _nearest(text, margin, phrasebook, settings)
    if confidence >= SURE and near[0].confidence >= 1:
        return _said(text, confidence, near)
    if evidence.stop:
        return StopCommand(evidence.stop)
    learnt = tuple(
        replace(c, confidence=sounded(c.confidence, margin, settings.shift))
        for c in phrasebook.paraphrased(text)
    )
    if phrasebook.learns and not learnt and confidence < NO_TALK:
        return Say(text, min(confidence, UNSURE), ())
    if learnt and (learnt[0].confidence >= SURE or learnt[0].confidence >= confidence):
        near, learnt, confidence = learnt, near, learnt[0].confidence
    if confidence < UNSURE:
        return Say(text, confidence, ())
    named = {c.behaviour: c for c in (*reversed(learnt), *reversed(near))}
    rest = [c for c in (*near, *learnt) if c is named[c.behaviour]]
    return _said(text, confidence, rest[:MOST_ALTERNATIVES])


def _steers(
    text: str, evidence: AcousticEvidence, settings: EvidenceSettings, ways: Collection[Steering]
) -> bool:
    """Say whether an utterance asks the program itself for something, by words and by sound."""
    way = steering_of(text)
    least = LEAST_ANSWER if steering_of(evidence.phrase) == way else LEAST_STEERING
    return way in ways and evidence.margin - settings.shift >= least


def _nearest(
    text: str, margin: float, phrasebook: Phrasebook, settings: EvidenceSettings
) -> tuple[tuple[Command, ...], float]:
    """Return the commands with the nearest phrases, and the probability of the first."""
    found = phrasebook.choices(text)
    if not found:
        return (), 0.0
    return found, likelihood(found[0].confidence, phrasebook.known(text), margin, settings.shift)


def _said(text: str, confidence: float, commands: Sequence[Command]) -> Say:
    told = round(confidence, 3)
    alike = tuple(replace(command, confidence=told) for command in commands)
    return Say(text, told, alike, sure=confidence >= SURE)


def clearly_heard(text: str) -> AcousticEvidence:
    """Return the evidence of words that leave no doubt that they were said."""
    return AcousticEvidence(clean(text), "", MOST_MARGIN, 1.0)


def commanded(
    evidence: AcousticEvidence, phrasebook: Phrasebook, settings: EvidenceSettings, *, live: bool
) -> tuple[Say | StopCommand | None, HearingKind | None]:
    """Return the command of an utterance, and a hearing note; None if there is none."""
    if evidence.words or evidence.stop:
        return understand(evidence, phrasebook, settings), None
    return None, "no words" if live and evidence.seconds else None


def replied(
    evidence: AcousticEvidence,
    settings: EvidenceSettings,
    choices: Sequence[str] = (),
    steering: Collection[Steering] = (),
    people: Mapping[str, str] = MappingProxyType({}),
    *,
    answers: bool,
) -> tuple[Reply | Say | StopCommand | None, HearingKind | None]:
    """Return the answer of an utterance to a question, and a hearing note, if any.

    Where no `answers` are taken, only what stops the robot counts, and what steers the program in
    one of the ways of `steering`; `choices` are the words of what can be chosen instead, and
    `people` what people may answer in a game, by how it is spoken.
    """
    said = answer(evidence, settings, choices)
    if not isinstance(said, StopCommand) and _steers(evidence.words, evidence, settings, steering):
        return Say(evidence.words, 1.0, None), None
    if answers and said is None and (given := answered(evidence, settings, people)) is not None:
        return given, None
    none = answers and said is None and evidence.seconds
    told: HearingKind | None = "no answer" if none else None
    return (said if answers or isinstance(said, StopCommand) else None), told


def answered(
    evidence: AcousticEvidence, settings: EvidenceSettings, people: Mapping[str, str]
) -> Say | None:
    """Return which of the possible answers of people an utterance is, and how sure that is.

    The grammar knows whole answers only, so that its phrase counts where the words are another
    answer or none; then the answer is never sure, and the person is asked again.
    """
    phrase, words = evidence.phrase, evidence.words
    text = words if words in people else phrase
    quiet = evidence.margin - settings.shift < LEAST_ANSWER
    if text not in people or quiet or yes_or_no(words) is not None:
        return None
    return Say(people[text], BOTH_HEARD if words == phrase else ONE_HEARD, None)


def best_words(evidence: AcousticEvidence, phrasebook: Phrasebook) -> tuple[str, float]:
    """Return the best words, and their margin (a log-likelihood per frame).

    Mostly those are the words of the n-gram model. Where they end as a number sounds, and the
    number makes a phrase of them, it was the number. Where they are no phrase, but sound like the
    one that the grammar has found, and that explains the sound better, it was the phrase.
    """
    words, phrase = evidence.words, evidence.phrase
    begun, _, last = words.rpartition(" ")
    if (numbered := f"{begun} {SOUND_ALIKE.get(last)}") in phrasebook.phrases:
        words = numbered
    doubtful = phrase and words not in phrasebook.phrases and evidence.margin < SMALL_MARGIN
    if doubtful and SequenceMatcher(None, words, phrase).ratio() >= SAME_SOUND:
        return phrase, 0.0
    return words, evidence.margin


def answer(
    evidence: AcousticEvidence, settings: EvidenceSettings, choices: Sequence[str] = ()
) -> Reply | StopCommand | None:
    """Return the answer to a question that an utterance gives, if it gives one.

    A yes moves the robot: the grammar, in which any phones can be said instead, has to find such
    an answer as well, or the words to explain the sound nearly as well as any phones do. The
    paper's mode has nothing that other speech could be, so it hears no answers.
    """
    said = evidence.words
    if stops(said):
        return StopCommand(said)
    if settings.mode == "paper":
        return None
    reply, phrase = _reply(said, choices), _reply(evidence.phrase, choices)
    if evidence.stop and (reply is None or (reply == Reply(True) and phrase != reply)):
        return StopCommand(evidence.stop)  # a yes would move the robot
    if reply is None and phrase == Reply(False) and evidence.margin < SMALL_MARGIN:
        reply = phrase  # a no that was misheard moves nothing
    if reply is None:
        return None
    least = LEAST_ANSWER if phrase == reply else LEAST_ALONE if not evidence.phrase else math.inf
    return reply if evidence.margin - settings.shift >= least else None


def _reply(said: str, choices: Sequence[str]) -> Reply | None:
    yes = yes_or_no(said)
    if yes is not None:
        return Reply(yes)
    number = choice_in(said, choices)
    return None if number is None else Reply(yes=False, alternative=number)


def likelihood(confidence: float, known: int, margin: float, shift: float = 0.0) -> float:
    """Return how likely words are to be the command they come nearest to, 0 to 1.

    Args:
        confidence: of the phrasebook, 0 to 1.
        known: how many telling words it knows.
        margin: see `AcousticEvidence`.
        shift: see `EvidenceSettings`.
    """
    told = OFFSET - shift + CONFIDENCE_WEIGHT * confidence + KNOWN_WEIGHT * min(known, MOST_KNOWN)
    told += MARGIN_WEIGHT * min(MOST_MARGIN, max(LEAST_MARGIN, margin))
    return 1 / (1 + math.exp(-told))


def sounded(likelihood: float, margin: float, shift: float = 0.0) -> float:
    """Return how likely words are meant so, where they may also have been misheard, 0 to 1.

    Args:
        likelihood: of the meaning, if the words were said, 0 to 1.
        margin: see `AcousticEvidence`.
        shift: see `EvidenceSettings`.
    """
    sure = min(max(likelihood, 1e-6), 1 - 1e-6)
    told = math.log(sure / (1 - sure)) - shift
    told += DOUBT_WEIGHT * min(0.0, margin - DOUBTED)
    return 1 / (1 + math.exp(-told))


def _as_in_the_paper(evidence: AcousticEvidence, phrasebook: Phrasebook) -> Say:
    """Match the n-gram model's words by phrases and keywords; there is one tier."""
    command: Command | None = phrasebook.understand(evidence.words)
    if command is None:
        return Say(evidence.words, evidence.confidence, ())
    confidence = round(command.confidence * evidence.confidence, 3)
    if confidence < UNDERSTOOD:
        return Say(evidence.words, confidence, ())
    return Say(evidence.words, confidence, (replace(command, confidence=confidence),))

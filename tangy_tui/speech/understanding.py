"""The meaning of spoken words in tiers: a question, up to three choices, or nothing.

*Sure* words are asked about at once. *Unsure* ones are offered as choices, each of which is asked
about in turn. For others, only the words are shown. Phrases are found in the best words. Free
wordings are judged by the intent model in all guesses at the sentence, so words that each guess
hears in another way are not sure. Words that stop the robot do so in every mode. The paper's mode
has one tier: n-gram and keywords.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import asdict, replace
from difflib import SequenceMatcher
from types import MappingProxyType

from tangy_tui.language.answers import NO, YES, choice_in, choice_phrases, yes_or_no
from tangy_tui.language.commands import MOST_ALTERNATIVES, Command, Phrasebook
from tangy_tui.language.paraphrases import SURE as SURE_OF_PARAPHRASE
from tangy_tui.language.steering import (
    IN_GAMES,
    WHILE_TEACHING,
    Steering,
    steering_of,
    steering_texts,
)
from tangy_tui.language.stop_patterns import CRIES
from tangy_tui.language.stop_phrases import other_stop_texts, stop_texts
from tangy_tui.language.stop_sentence import STOPS, stops, stops_by_rules
from tangy_tui.language.words import clean
from tangy_tui.learning.verification import Reply, Say, StopCommand
from tangy_tui.speech.evidence import AcousticEvidence, DecoderVocabulary, EvidenceSettings
from tangy_tui.speech.hearing_notes import HearingKind

# Probability that words are the nearest command: a logistic regression over the phrasebook's
# confidence, the number of known content words, and the margin of the words over the grammar or any
# phones. Fitted, and the thresholds set, by tests/bench/speech.py on voices and sentences for which
# no figure is quoted.
CONFIDENCE_WEIGHT, KNOWN_WEIGHT, MARGIN_WEIGHT, OFFSET = 14.98, 0.39, 1.51, -12.98
LEAST_MARGIN, MOST_MARGIN = -1.5, 1.0
MOST_KNOWN = 3
SURE = 0.6
UNSURE = 0.25
AGREED = 0.45
"""Probability over all guesses from which a free wording is offered.

Of 120 requests by sound (`staff_sayings.toml`) 69 were right or offered then, of 92 sentences of
talk 2 were offered, and of 24 coughs and knocks none. With .35 it was 71, 3 and 2.
"""
DOUBT_WEIGHT, DOUBTED = 4.5, 0.0
"""Reduction of a paraphrase's logit per unit of the margin, below some margin."""
NO_TALK = 0.9  # probability of a near phrase that overrules the intent model's talk class
SMALL_MARGIN = -0.25  # below it a whole phrase explains the sound better than other words
SAME_SOUND = 0.75  # similarity of letters from which such words count as the phrase, misheard
UNDERSTOOD = 0.35
"""The confidence below which the paper's mode rejects a command."""

MOST_ANSWERS = 4
"""The most numbered answers of a question: those to a step that contradicts an earlier one."""

OWN_NAME = {"tangy": ("T AE NG IY",)}
LEAST_ANSWER, LEAST_ALONE = -1.2, -0.6
"""The lowest margins of an answer: if the grammar finds it too, and if not."""

BOTH_HEARD, ONE_HEARD = 0.95, 0.5
"""Probabilities of a person's answer that both decoders hear, and that only one hears.

They are chosen, not fitted: the first is judged, the second is too low to be judged.
"""

WORDED = 3  # how often each wording counts among the sentences that do not stop the robot
LEAST_STEERING = -0.6
"""The lowest margin of a steering request that the grammar does not find."""

ANSWER_ALIKE = {"know": "no"}
"""How an answer is misheard as everyday words while commands are expected."""

SOUND_ALIKE = {"to": "two", "too": "two", "for": "four", "won": "one", "ate": "eight"}


def wanted(
    phrasebook: Phrasebook, settings: EvidenceSettings, phrases: Sequence[str] | None = None
) -> DecoderVocabulary:
    """Return the vocabulary: phrases, stop commands, and answers.

    Args:
        phrasebook: the phrases and their pronunciations.
        settings: the recognition settings.
        phrases: the phrases that are distinguishable by sound, if known.
    """
    learnt = settings.mode != "paper"  # the paper's mode has only phrases and keywords
    teaching, games = (
        steering_texts(ways) if learnt else () for ways in (WHILE_TEACHING, IN_GAMES)
    )
    given = tuple(phrasebook.table.answers) if learnt else ()
    answers = (*YES, *NO, *choice_phrases(MOST_ANSWERS), *phrasebook.table.questions)
    said = tuple(phrasebook.spoken() if phrases is None else phrases)
    return DecoderVocabulary(
        (*said, *STOPS, *teaching),
        (*answers, *STOPS, *games, *given),
        STOPS,
        {**OWN_NAME, **phrasebook.pronunciations()},
        settings,
        stop_texts(),
        (*other_stop_texts(), *said, *phrasebook.table.wordings * WORDED, *given * WORDED),
        tuple(sorted(phrasebook.game)),
        phrasebook.table.sentences if learnt and phrasebook.learns else (),
    )


def sounds_of(phrasebook: Phrasebook) -> tuple[object, ...]:
    """Return all that `wanted` reads: phrasebooks that share it can share a decoder."""
    table = phrasebook.table
    people = tuple(table.numbers), tuple(table.names), tuple(table.seats)
    return table.activity, people, phrasebook.pronunciations(), phrasebook.learns


def understand(
    evidence: AcousticEvidence, phrasebook: Phrasebook, settings: EvidenceSettings
) -> Say | StopCommand:
    """Return the meaning of an utterance: one or more commands, none, or a stop.

    If the means of other voices fit better, their words count. They are sure only if the usual ones
    are sure of the same command, and stop the robot only if another search heard a stop, too.
    """
    said = _understood(evidence, phrasebook, settings)
    if evidence.other is None:
        return said
    heard = replace(evidence, **asdict(evidence.other), other=None)
    other = _understood(heard, phrasebook, settings)
    if isinstance(other, StopCommand) and (evidence.stop or isinstance(said, StopCommand)):
        return other
    if isinstance(other, StopCommand) or (other.commands is None and said != other):
        return Say(other.text, 0.0, ())
    return replace(other, sure=other.sure and _is_sure_of(said, other))


def _is_sure_of(said: Say | StopCommand, other: Say) -> bool:
    """Return whether what was said is sure, and the same as the first of other commands."""
    if not isinstance(said, Say) or not said.sure:
        return False
    first, second = (one.commands[:1] if one.commands else () for one in (said, other))
    return [(c.behaviour, c.arguments) for c in first] == [
        (c.behaviour, c.arguments) for c in second
    ]


def _understood(
    evidence: AcousticEvidence, phrasebook: Phrasebook, settings: EvidenceSettings
) -> Say | StopCommand:
    """Return the meaning of an utterance by the words of one search."""
    if settings.mode == "paper":
        if stops(evidence.words, phrasebook.game):
            return StopCommand(evidence.words)
        return _as_in_the_paper(evidence, phrasebook)
    text, margin = best_words(evidence, phrasebook)
    if _stops(text, evidence, phrasebook.game):
        return StopCommand(text)
    steers = text not in phrasebook.phrases and _steers(text, evidence, settings, WHILE_TEACHING)
    if steers and (not evidence.stop or steering_of(evidence.phrase) == steering_of(text)):
        return Say(text, 1.0, None)
    near, confidence = _nearest(text, margin, phrasebook, settings)
    if confidence >= SURE and near[0].confidence >= 1:
        return _said(text, confidence, near, SURE)
    if evidence.stop:
        return StopCommand(evidence.stop)
    guesses = evidence.guesses or (text,)
    doubt = 0.0 if evidence.guesses else margin  # what is misheard differs in each guess
    learnt = tuple(
        replace(c, confidence=sounded(c.confidence, doubt, settings.shift))
        for c in phrasebook.paraphrased(*guesses)
    )
    if evidence.guesses and learnt and learnt[0].confidence < AGREED:
        learnt = ()
    if phrasebook.learns and not learnt and confidence < NO_TALK:
        return Say(text, min(confidence, UNSURE), ())
    least = SURE
    if phrasebook.learns and near and not _supports(learnt, near[0]):
        least = NO_TALK
    if learnt and learnt[0].confidence >= min(SURE_OF_PARAPHRASE, confidence):
        near, learnt, confidence = learnt, near, learnt[0].confidence
        text, least = guesses[0], SURE_OF_PARAPHRASE
    if confidence < UNSURE:
        return Say(text, confidence, ())
    named = {c.behaviour: c for c in (*reversed(learnt), *reversed(near))}
    rest = [c for c in (*near, *learnt) if c is named[c.behaviour]]
    return _said(text, confidence, rest[:MOST_ALTERNATIVES], least)


def _supports(learnt: Sequence[Command], near: Command) -> bool:
    """Return whether the intent model, too, finds the command of a near phrase likely."""
    return any(c.behaviour == near.behaviour and c.confidence >= AGREED for c in learnt[:1])


def _stops(text: str, evidence: AcousticEvidence, game: Collection[str] = ()) -> bool:
    """Return whether words stop the robot; those that are perhaps misheard, by the rules alone.

    The stop decoder has judged the sound by what was learnt.
    """
    return stops_by_rules(text, game) if evidence.margin < DOUBTED else stops(text, game)


def _steers(
    text: str, evidence: AcousticEvidence, settings: EvidenceSettings, ways: Collection[Steering]
) -> bool:
    """Return whether an utterance steers the program, by words and by sound."""
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


def _said(text: str, confidence: float, commands: Sequence[Command], least: float) -> Say:
    told = round(confidence, 3)
    alike = tuple(replace(command, confidence=told) for command in commands)
    return Say(text, told, alike, sure=confidence >= least)


def clearly_heard(text: str) -> AcousticEvidence:
    """Return the evidence of words as if they had been recognised without doubt."""
    return AcousticEvidence(clean(text), "", MOST_MARGIN, 1.0)


def commanded(
    evidence: AcousticEvidence, phrasebook: Phrasebook, settings: EvidenceSettings, *, live: bool
) -> tuple[Say | Reply | StopCommand | None, HearingKind | None]:
    """Return the command of an utterance, and a hearing note; None if there is none.

    A yes or no is a reply, also if nothing was asked.
    """
    if evidence.words or evidence.stop:
        said = understand(evidence, phrasebook, settings)
        return _reply_instead(said, settings) or said, None
    return None, "no words" if live and evidence.seconds else None


def _reply_instead(said: Say | StopCommand, settings: EvidenceSettings) -> Reply | None:
    """Return the yes or no that was said instead of a command, or None."""
    if settings.mode == "paper" or not isinstance(said, Say) or said.commands != ():
        return None
    yes = yes_or_no(" ".join(ANSWER_ALIKE.get(word, word) for word in said.text.split()))
    return None if yes is None else Reply(yes)


def replied(
    evidence: AcousticEvidence,
    settings: EvidenceSettings,
    choices: Sequence[str] = (),
    steering: Collection[Steering] = (),
    people: Mapping[str, str] = MappingProxyType({}),
    options: Collection[str] = (),
    *,
    answers: bool,
) -> tuple[Reply | Say | StopCommand | None, HearingKind | None]:
    """Return the answer of an utterance to a question, and a hearing note, if any.

    Without `answers`, only stop commands and the requests in `steering` count. `choices` are the
    words of the alternatives, and `people` the possible answers of people in a game, by spoken
    form; `options` are those of the question that people are asked now.

    Words that are hardly more than one of these options, without a verb of stopping, stop the robot
    by the rules alone: what was learnt of stops takes short answers for them.
    """
    given = answered(evidence, settings, people) if answers else None
    if given is not None and given.confidence >= BOTH_HEARD:
        evidence = replace(evidence, stop="")  # both other decoders hear an answer
    open_now = (said for said, text in people.items() if text in options)
    offered = any(_is_hardly_more(evidence.words, said) for said in open_now)
    cries = not CRIES.isdisjoint(f"{evidence.words} {evidence.stop}".split())
    if offered and not cries and not stops_by_rules(evidence.stop):
        evidence = replace(evidence, stop="")
    said = answer(evidence, settings, choices)
    if not isinstance(said, StopCommand) and _steers(evidence.words, evidence, settings, steering):
        return Say(evidence.words, 1.0, None), None
    if said is None and given is not None:
        return given, None
    none = answers and said is None and evidence.seconds
    told: HearingKind | None = "no answer" if none else None
    return (said if answers or isinstance(said, StopCommand) else None), told


def _is_hardly_more(words: str, option: str) -> bool:
    """Return whether words are an option, with at most one word beside it."""
    beside = len(words.split()) - len(option.split())
    return f" {option} " in f" {words} " and beside <= 1


def answered(
    evidence: AcousticEvidence, settings: EvidenceSettings, people: Mapping[str, str]
) -> Say | None:
    """Return the possible answer of a person that an utterance is, with its probability.

    The grammar knows whole answers only, so its phrase is used if the words are another answer or
    none; then the answer is not sure, and the question is repeated.
    """
    phrase, words = evidence.phrase, evidence.words
    text = words if words in people else phrase
    quiet = evidence.margin - settings.shift < LEAST_ANSWER
    if text not in people or quiet or yes_or_no(words) is not None:
        return None
    return Say(people[text], BOTH_HEARD if words == phrase else ONE_HEARD, None)


def best_words(evidence: AcousticEvidence, phrasebook: Phrasebook) -> tuple[str, float]:
    """Return the best words, and their margin (a log-likelihood per frame).

    Usually these are the words of the n-gram model. If the last word sounds like a number that
    makes them a phrase, the number is used. If they are no phrase, but sound like the one found by
    the grammar, and that explains the sound better, the phrase is used.
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
    """Return the answer to a question that an utterance gives, or None.

    A yes moves the robot: the grammar, with its garbage branch, has to find an answer too, or the
    words must explain the sound nearly as well as any phones. The paper's mode has no model of
    other speech, so it recognises no answers.
    """
    said = evidence.words
    if _stops(said, evidence):
        return StopCommand(said)
    if settings.mode == "paper":
        return None
    reply, phrase = _reply(said, choices), _reply(evidence.phrase, choices)
    if evidence.stop and (reply is None or (reply == Reply(True) and phrase != reply)):
        return StopCommand(evidence.stop)  # a yes would move the robot
    if reply is None and phrase == Reply(False) and evidence.margin < SMALL_MARGIN:
        reply = phrase  # a misheard no moves nothing
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
    """Return the probability, 0 to 1, that words are the nearest command.

    Args:
        confidence: the phrasebook's confidence, 0 to 1.
        known: the number of known content words.
        margin: see `AcousticEvidence`.
        shift: see `EvidenceSettings`.
    """
    told = OFFSET - shift + CONFIDENCE_WEIGHT * confidence + KNOWN_WEIGHT * min(known, MOST_KNOWN)
    told += MARGIN_WEIGHT * min(MOST_MARGIN, max(LEAST_MARGIN, margin))
    return 1 / (1 + math.exp(-told))


def sounded(likelihood: float, margin: float, shift: float = 0.0) -> float:
    """Return the probability, 0 to 1, of a meaning, given that words may be misheard.

    Args:
        likelihood: the probability of the meaning if the words were said, 0 to 1.
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

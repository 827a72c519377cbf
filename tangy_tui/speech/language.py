"""What the decoder listens for, as text: a dictionary, a grammar and n-gram models.

All of it is made of the phrases of one phrasebook. Two things stand for speech that is none of
them: in the grammar a branch of any phones (garbage), and in the n-gram model everyday words.
"""

from __future__ import annotations

import io
import math
from collections.abc import Iterable, Mapping, Sequence

from tangy_profiles.phones import PHONES

EVERYDAY = 3_000
"""How many everyday words are known beside those of the phrases.

Of 75 other sentences, 9, 13 and 16 were taken for commands with 2,500, 1,000 and no such words.
"""
DISCOUNT = 0.5  # probability mass that n-grams of phrases leave for sequences no phrase has
LEAST_PROBABILITY = 1e-99  # below it a logarithm is none that a decoder reads
GARBAGE = "_"  # begins the name of a phone among the words


def dictionary(pronunciations: Mapping[str, Sequence[str]], *, phones: bool = False) -> str:
    """Return a pronouncing dictionary as the decoder reads it.

    Args:
        pronunciations: for each word at least one, in ARPAbet.
        phones: also have every phone as a word, for the garbage branch.
    """
    lines = [
        f"{word}{f'({number})' if number > 1 else ''} {phones_of_it}\n"
        for word, ways in sorted(pronunciations.items())
        for number, phones_of_it in enumerate(ways, 1)
    ]
    if phones:
        lines += [f"{GARBAGE}{phone.lower()} {phone}\n" for phone in sorted(PHONES)]
    return "".join(lines)


def grammar(phrases: Sequence[str], garbage: float) -> str:
    """Return a JSGF grammar: one of the phrases, or any phones (by a probability).

    The weight stands on the branch: JSGF normalises weights within each alternative, so those of
    single phones would be divided by their number.

    Args:
        phrases: what can be said.
        garbage: the weight of the branch for anything else, against 1 for all phrases together.
    """
    commands = "\n  | ".join(phrases)
    phones = " | ".join(GARBAGE + phone.lower() for phone in sorted(PHONES))
    return (
        "#JSGF V1.0;\n"
        "grammar commands;\n"
        f"public <said> = /1/ <command> | /{garbage:g}/ <garbage>;\n"
        f"<command> = {commands};\n"
        "<garbage> = (<phone>)+;\n"
        f"<phone> = {phones};\n"
    )


def phrase_model(phrases: Sequence[str]) -> str:
    """Return a trigram model of the phrases alone, in ARPA format (the paper's)."""
    from pocketsphinx.lm import ArpaBoLM

    model = ArpaBoLM(text="\n".join(phrases), add_start=True, discount_mass=DISCOUNT)
    model.compute()
    written = io.StringIO()
    model.write(written)
    return written.getvalue()


def open_model(phrases: Sequence[str], everyday: Mapping[str, float], share: float) -> str:
    """Return a trigram model of the phrases in which everyday words can stand anywhere.

    Its unigrams are mixed: those of the phrases and those of everyday speech. After the words of
    a phrase anything else can follow, by the mass that the discount leaves.

    Args:
        phrases: what can be said.
        everyday: the probabilities of everyday words.
        share: the part of the everyday words in the mixture, 0 to 1.
    """
    head, rest = phrase_model(phrases).split("\\1-grams:\n")
    unigrams, rest = rest.split("\n\n\\2-grams:", 1)
    whole = sum(everyday.values())
    lines: list[str] = []
    own: set[str] = set()
    for line in unigrams.splitlines():
        score, word, backoff = line.split()
        own.add(word)
        if word != "<s>":  # which is never said; the end of a phrase shares with everyday words
            mixed = (1 - share) * 10 ** float(score) + share * everyday.get(word, 0.0) / whole
            score = f"{math.log10(max(mixed, LEAST_PROBABILITY)):.4f}"
        lines.append(f"{score} {word} {backoff}")
    lines += [
        f"{math.log10(max(share * probability / whole, LEAST_PROBABILITY)):.4f} {word} 0.0000"
        for word, probability in everyday.items()
        if word not in own and share > 0
    ]
    counted = "\n".join(
        f"ngram 1={len(lines)}" if line.startswith("ngram 1=") else line
        for line in head.splitlines()
    )
    return f"{counted}\n\n\\1-grams:\n{chr(10).join(lines)}\n\n\\2-grams:{rest}"


def words_of(phrases: Iterable[str]) -> set[str]:
    """Return the words of some phrases."""
    return {word for phrase in phrases for word in phrase.split()}

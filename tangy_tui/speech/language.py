"""The decoder's language models as text: a dictionary, a grammar and n-gram models.

They are made from the phrases of one phrasebook. Other speech is modelled in two ways: in the
grammar by a branch of any phones (garbage), in the n-gram model by everyday words.
"""

from __future__ import annotations

import io
import math
from collections.abc import Iterable, Mapping, Sequence

from tangy_profiles.phones import PHONES

EVERYDAY = 3_000
"""The number of everyday words besides those of the phrases.

Of 75 other sentences, 9, 13 and 16 were taken for commands with 2,500, 1,000 and no such words.
"""
DISCOUNT = 0.5  # probability mass that phrase n-grams leave for other sequences
LEAST_PROBABILITY = 1e-99  # the decoder cannot read smaller logarithms
GARBAGE = "_"  # prefix of a phone used as a word


def dictionary(pronunciations: Mapping[str, Sequence[str]], *, phones: bool = False) -> str:
    """Return a pronouncing dictionary in the decoder's format.

    Args:
        pronunciations: one or more for each word, in ARPAbet.
        phones: also add every phone as a word, for the garbage branch.
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

    The weight is on the branch: JSGF normalises weights within each alternative, so weights of
    single phones would be divided by their number.

    Args:
        phrases: the phrases.
        garbage: the weight of the garbage branch, against 1 for all phrases together.
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
    """Return a trigram model of the phrases in which everyday words can occur anywhere.

    Its unigrams are a mixture of phrases and everyday speech. After the words of a phrase any other
    word can follow, with the mass that the discount leaves.

    Args:
        phrases: the phrases.
        everyday: the probabilities of everyday words.
        share: the share of everyday words in the mixture, 0 to 1.
    """
    head, rest = phrase_model(phrases).split("\\1-grams:\n")
    unigrams, rest = rest.split("\n\n\\2-grams:", 1)
    whole = sum(everyday.values())
    lines: list[str] = []
    own: set[str] = set()
    for line in unigrams.splitlines():
        score, word, backoff = line.split()
        own.add(word)
        if word != "<s>":  # never spoken; the end of a phrase is mixed too
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

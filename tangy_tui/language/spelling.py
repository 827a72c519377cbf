"""A guess at a word's pronunciation, from known words with similar spelling."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from functools import lru_cache

MOST_ALIKE = 40  # words compared for each letter
ENOUGH_ALIKE = 3  # words that are enough for a majority vote
WINDOWS = (
    *((4, 4), (3, 4), (4, 3), (3, 3), (2, 3), (3, 2), (2, 2), (1, 2), (2, 1), (1, 1)),
    *((0, 1), (1, 0), (0, 0)),
)  # letters before and after: longest context first

# Phones of each letter in English, the most usual first; a letter may also be silent.
SOUNDS = {
    "a": "AE EY AH AA AO EH IH AW ER",
    "b": "B",
    "c": "K S CH SH",
    "d": "D JH T",
    "e": "EH IY AH IH ER EY AA UW OW",
    "f": "F V",
    "g": "G JH ZH NG",
    "h": "HH",
    "i": "IH AY IY AH ER Y",
    "j": "JH HH Y ZH",
    "k": "K",
    "l": "L",
    "m": "M",
    "n": "N NG",
    "o": "AA OW AH AO UW UH AW OY ER W",
    "p": "P F",
    "q": "K",
    "r": "R ER",
    "s": "S Z SH ZH",
    "t": "T TH DH SH CH",
    "u": "AH UW UH ER W IH Y",
    "v": "V F",
    "w": "W V AW OW UW",
    "x": "K Z",
    "y": "IY AY Y IH",
    "z": "Z S ZH T",
    "'": "",
}
PAIRS = {"x": "K S|G Z", "u": "Y UW|Y ER|Y UH|Y AH", "l": "AH L", "o": "W AH", "z": "T S"}
"""Letters that can stand for two phones: ("box", "music", "little", "one", "pizza")."""

_SOUNDS = {letter: frozenset(phones.split()) for letter, phones in SOUNDS.items()}
_PAIRS = {letter: frozenset(phones.split("|")) for letter, phones in PAIRS.items()}
FIT, MISFIT, SILENT = 2.0, -2.0, -0.4

Parts = tuple[str, ...]
"""The phones of each letter of a word: none, one or two."""


def guess(word: str, dictionary: str) -> str:
    """Return the likeliest phones of a word (a to z and ').

    Args:
        word: the word in lower case.
        dictionary: known words, each as a line break, the word, a space, its phones; "" for none.
    """
    padded = f"\n{word} "
    phones = (_letter(padded, place, dictionary) for place in range(1, len(padded) - 1))
    return " ".join(filter(None, phones))


def _letter(padded: str, place: int, dictionary: str) -> str:
    """Return the phones of one letter, by a vote of words with the same context."""
    tried = set()
    votes: Counter[str] = Counter()
    for before, after in WINDOWS:
        start = max(0, place - before)
        window = padded[start : place + after + 1]
        if window in tried:
            continue
        tried.add(window)
        for known, phones, at in _alike(window, dictionary):
            votes[align(known, phones)[at + place - start]] += 1
        if votes.total() >= ENOUGH_ALIKE:
            break
    usual = SOUNDS[padded[place]].partition(" ")[0]
    return max(votes, key=lambda one: votes[one]) if votes else usual


def _alike(window: str, dictionary: str) -> Iterator[tuple[str, Parts, int]]:
    """Yield known words that contain some letters, their phones, and the position."""
    found, seen = dictionary.find(window), 0
    while found >= 0 and seen < MOST_ALIKE:
        start = dictionary.rfind("\n", 0, found + 1) + 1
        gap, end = dictionary.index(" ", start), dictionary.find("\n", start)
        known = dictionary[start:gap]
        if all(letter in SOUNDS for letter in known):
            yield known, tuple(dictionary[gap + 1 : end].split()), found - start
            seen += 1
        found = dictionary.find(window, max(end, found + 1))


@lru_cache(maxsize=4096)
def align(word: str, phones: Parts) -> Parts:
    """Align the phones of a word with its letters, in order, by the best total score."""
    best: dict[int, tuple[float, Parts]] = {0: (0.0, ())}
    for letter in word:
        longer: dict[int, tuple[float, Parts]] = {}
        for used, (score, parts) in best.items():
            for count in range(min(2, len(phones) - used) + 1):
                part = phones[used : used + count]
                total = score + _fit(letter, part)
                if used + count not in longer or total > longer[used + count][0]:
                    longer[used + count] = (total, (*parts, " ".join(part)))
        best = longer
    return best[len(phones)][1] if len(phones) in best else ("",) * len(word)


def _fit(letter: str, part: Parts) -> float:
    if not part:
        return SILENT
    if len(part) == 1:
        return FIT if part[0] in _SOUNDS[letter] else MISFIT
    return FIT if " ".join(part) in _PAIRS.get(letter, ()) else 2 * MISFIT

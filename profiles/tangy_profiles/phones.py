"""Pronunciations, written in the 39 phones of ARPAbet: `B IH NG G OW`."""

from __future__ import annotations

import re

from tangy_profiles.errors import ProfileError
from tangy_profiles.reading import Table, nearest, plain

VOWELS = (
    *("AA", "AE", "AH", "AO", "AW", "AY", "EH", "ER", "EY", "IH", "IY", "OW", "OY", "UH", "UW"),
)
CONSONANTS = (
    *("B", "CH", "D", "DH", "F", "G", "HH", "JH", "K", "L", "M", "N", "NG", "P", "R", "S", "SH"),
    *("T", "TH", "V", "W", "Y", "Z", "ZH"),
)
PHONES = frozenset(VOWELS + CONSONANTS)
LONGEST = 40  # phones of a word

MEANT = {
    **{"A": "AE", "E": "EH", "I": "IH", "O": "OW", "U": "AH", "AX": "AH", "IX": "IH"},
    **{"OH": "OW", "OO": "UW", "EE": "IY", "AI": "AY", "EI": "EY", "AU": "AW", "OU": "AW"},
    **{"OI": "OY", "UR": "ER", "AR": "AA R", "OR": "AO R", "UU": "UW", "II": "IY", "EW": "Y UW"},
    **{"AXR": "ER", "UX": "UW", "DX": "D", "C": "K", "H": "HH", "J": "JH", "Q": "K", "X": "K S"},
}
"""The most likely phones for letters and phones outside the 39."""


def read_phones(text: str) -> str:
    """Return a word's phones in capitals, separated by single spaces, without stress marks.

    Raises:
        ProfileError: there are none, or more than 40, or one is invalid; the message names it and
            the nearest valid one.
    """
    phones = [re.sub("[0-2]$", "", phone) for phone in text.upper().split()]
    for phone in phones:
        if phone not in PHONES:
            meant = f"did you mean {MEANT[phone]!r}?" if phone in MEANT else nearest(phone, PHONES)
            raise ProfileError(plain(f"there is no phone {phone[:20]!r}; {meant}"))
    if not 1 <= len(phones) <= LONGEST:
        raise ProfileError(f"a word has from 1 to {LONGEST} phones, such as B IH NG G OW.")
    return " ".join(phones)


def read_name_phones(text: str) -> str:
    """Return the phones of a name of one or more words, with commas between the words.

    Raises:
        ProfileError: as for `read_phones`.
    """
    return ", ".join(read_phones(word) for word in text.split(","))


def read_pronunciations(table: Table) -> dict[str, tuple[str, ...]]:
    """Read a table of words, each with its pronunciation or a list of them.

    Raises:
        ProfileError: one line with file, key, value and the nearest valid phone.
    """
    found: dict[str, tuple[str, ...]] = {}
    for word in table:
        if not re.fullmatch("[a-z']+", word):
            raise table.wrong(word, "must be one lower-case word, as it stands in the phrases.")
        texts = table.texts(word)
        try:
            found[word] = tuple(dict.fromkeys(map(read_phones, texts)))
        except ProfileError as error:
            raise table.wrong(word, str(error)) from None
        if not found[word]:
            raise table.wrong(word, "must have at least one pronunciation.")
    return found

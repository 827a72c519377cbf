"""Conversion between ARPAbet and the phones of espeak-ng."""
# ruff: noqa: RUF001 - these letters are IPA

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable

from tangy_profiles.phones import VOWELS

PROGRAM = "espeak-ng"
VOICE = "en-us"
SECONDS = 5.0  # timeout; 8 ms on an idle machine

FROM_IPA = {
    **{"ɑ": "AA", "ɒ": "AA", "a": "AA", "æ": "AE", "ʌ": "AH", "ə": "AH", "ɐ": "AH", "ɔ": "AO"},
    **{"aʊ": "AW", "aɪ": "AY", "ɛ": "EH", "e": "EY", "ɚ": "ER", "ɜ": "ER", "ɜɹ": "ER", "ɝ": "ER"},
    **{"eɪ": "EY", "ɪ": "IH", "ᵻ": "IH", "i": "IY", "iə": "IY AH", "o": "AO", "oʊ": "OW"},
    **{"ɔɪ": "OY", "ʊ": "UH", "u": "UW", "y": "UW", "ø": "ER", "œ": "ER", "n̩": "AH N"},
    **{"l̩": "AH L", "m̩": "AH M", "b": "B", "tʃ": "CH", "d": "D", "ð": "DH", "f": "F", "ɡ": "G"},
    **{"g": "G", "h": "HH", "ç": "HH", "dʒ": "JH", "k": "K", "x": "K", "l": "L", "ɫ": "L"},
    **{"ɬ": "L", "m": "M", "n": "N", "ɲ": "N Y", "ŋ": "NG", "p": "P", "ɹ": "R", "r": "R"},
    **{"ʁ": "R", "s": "S", "ʃ": "SH", "t": "T", "ɾ": "T", "θ": "TH", "v": "V", "β": "V", "w": "W"},
    **{"ʍ": "W", "j": "Y", "z": "Z", "ʒ": "ZH", "ʔ": "T"},
}
"""The phones of espeak-ng's English voice, and some of foreign words."""

TO_ESPEAK = {
    **{"AA": "A:", "AE": "a", "AH": "V", "AO": "O:", "AW": "aU", "AY": "aI", "EH": "E"},
    **{"ER": "3:", "EY": "eI", "IH": "I", "IY": "i:", "OW": "oU", "OY": "OI", "UH": "U"},
    **{"UW": "u:", "B": "b", "CH": "tS", "D": "d", "DH": "D", "F": "f", "G": "g", "HH": "h"},
    **{"JH": "dZ", "K": "k", "L": "l", "M": "m", "N": "n", "NG": "N", "P": "p", "R": "r"},
    **{"S": "s", "SH": "S", "T": "t", "TH": "T", "V": "v", "W": "w", "Y": "j", "Z": "z"},
    "ZH": "Z",
}
UNSTRESSED = {"AH": "@", "ER": "3"}

_MARKS = re.compile("[ˈˌː‍\u0361]")
_LONGEST = max(map(len, FROM_IPA))


def espeak_phones(word: str, which: Callable[[str], str | None] = shutil.which) -> str:
    """Return the ARPAbet phones by espeak-ng for a word; "" if it is absent or fails."""
    program = which(PROGRAM)
    if program is None:
        return ""
    try:
        done = subprocess.run(  # noqa: S603 - found on the path; the word goes to its stdin
            [program, "-q", "--ipa", "--sep=_", "-v", VOICE, "-b", "1", "--stdin"],
            input=word.encode(),
            capture_output=True,
            timeout=SECONDS,
            start_new_session=True,
            check=True,
        )
    except (OSError, subprocess.SubprocessError):
        return ""
    return from_ipa(done.stdout.decode(errors="replace"))


def from_ipa(text: str) -> str:
    """Convert IPA of espeak-ng, with underscores between phones, to ARPAbet."""
    phones: list[str] = []
    for part in re.split(r"[_\s]+", _MARKS.sub("", text)):
        while part:
            for length in range(_LONGEST, 0, -1):
                if part[:length] in FROM_IPA:
                    phones += FROM_IPA[part[:length]].split()
                    break
            part = part[length:]  # skip phones that English does not have
    return _by_convention(phones)


def _by_convention(phones: list[str]) -> str:
    """Merge a vowel and r into one phone, as the dictionary does: "bird" is B ER D."""
    text = f" {' '.join(phones)} "
    for theirs, ours in ((" AH R ", " ER "), (" ER R ", " ER ")):
        text = text.replace(theirs, ours)
    return text.strip()


def to_espeak(phones: str) -> str:
    """Convert ARPAbet phones (a comma between words) to espeak-ng's phoneme input.

    The phones have no stress marks: the first vowel other than AH gets the stress.
    """
    return " ".join(f"[[{_word(word.split())}]]" for word in phones.split(","))


def _word(phones: list[str]) -> str:
    vowels = [place for place, phone in enumerate(phones) if phone in VOWELS]
    full = [place for place in vowels if phones[place] != "AH"]
    stressed = (full or vowels or [-1])[0]
    said = [
        f"'{TO_ESPEAK[phone]}" if place == stressed else UNSTRESSED.get(phone, TO_ESPEAK[phone])
        for place, phone in enumerate(phones)
    ]
    return "|".join(said)

"""How the words of an activity's author are read: names of files, numbers, lists, plain lines."""

from __future__ import annotations

import re
import unicodedata
from pathlib import Path

from tangy_profiles.reading import plain
from tangy_tui.language.words import NUMBERS as NUMBER_WORDS

LATIN = str.maketrans(
    {"ä": "ae", "ö": "oe", "ü": "ue", "ß": "ss", "æ": "ae", "œ": "oe", "ø": "oe", "ł": "l"}
)
"""Letters of file names that are more than a plain letter with an accent."""
CURLY = "\N{LEFT DOUBLE QUOTATION MARK}\\1\N{RIGHT DOUBLE QUOTATION MARK}"
TENS = ("thirty", "forty", "fifty", "sixty", "hundred")


def name_of(title: str) -> str:
    """Return the file name of a title, without a suffix: in plain letters and digits."""
    latin = unicodedata.normalize("NFC", title.lower()).translate(LATIN)
    bare = (c for c in unicodedata.normalize("NFKD", latin) if not unicodedata.combining(c))
    kept_ = "".join(c if c.isascii() and c.isalnum() else " " for c in bare)
    return "-".join(kept_.split())


def has_number(text: str) -> bool:
    """Return whether a text holds a number, in digits or in words."""
    words = text.lower().replace("-", " ").split()
    return any(c.isdecimal() for c in text) or bool({*NUMBER_WORDS, *TENS}.intersection(words))


def listed_answers(text: str) -> list[str]:
    """Return the parts of an answer between commas, each once."""
    return list(dict.fromkeys(one for part in text.split(",") if (one := part.strip())))


def kept(text: str, quotes: bool) -> str:
    """Return a line without the characters that mean something in the activity's files.

    Without `quotes`, straight ones become curly, which mean nothing there.
    """
    line = "".join(c for c in plain(text) if c not in "\\{}|")
    if not quotes:
        line = re.sub(r'"([^"]*)"', CURLY, line).replace('"', "")
    return " ".join(line.split())


def is_file(path: Path) -> bool:
    """Return whether there is such a file; not if its name is too long for one."""
    try:
        return path.is_file()
    except OSError:
        return False

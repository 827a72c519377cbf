"""TOML, read key by key: every mistake is one line with file, key, value and nearest word."""

from __future__ import annotations

import difflib
import math
import os
import re
import reprlib
import tomllib
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from string import Formatter
from typing import Any

from tangy_profiles.errors import ProfileError
from tangy_profiles.given_file import lines_of, read_given
from tangy_profiles.plain_text import plain as plain  # re-exported
from tangy_profiles.toml_lines import KeyPath, line_of

LARGEST_PROFILE = 1_000_000  # bytes; the largest of ours is 20 kB

_SHORT = reprlib.Repr()
_SHORT.maxlevel, _SHORT.maxstring, _SHORT.maxlong, _SHORT.maxother = 2, 100, 40, 40

_MET = {
    "illegal character '\\n'": "this text has no quotation mark at its end",
    "invalid value": "this is no value; a text needs quotation marks around it",
    "invalid initial character for a key part": "a key should stand here; look for a comma too many"
    " before it, or for {...} that goes on in the next line",
    "unclosed array": "a comma or ] is missing before this",
    "unclosed inline table": "a comma or } is missing before this",
    "expected ']' at the end of a table declaration": "a name of several words needs quotation"
    ' marks, as in [behaviours."give hint"]',
    "expected ']]' at the end of an array declaration": "a name of several words needs quotation"
    ' marks, as in [[behaviours."give hint"]]',
    "expected '=' after a key in a key/value pair": "after a key = is missing",
    "expected newline or end of document after a statement": "something else follows this value; a"
    " decimal number has a point, as in 0.5",
}
"""What the TOML parser says of the commonest mistakes (in any case), in words for authors."""

_INSIDE = re.compile(r'"[^"]*"\s*[^\s",\]}#=.]')
"""A text, and what follows it that cannot stand there: it had a quotation mark inside."""


def nearest(word: str, words: Iterable[str], given: Container[str] = ()) -> str:
    """Return the tail of an error sentence: the words probably meant, or all valid words.

    Args:
        word: the wrong word.
        words: the valid words.
        given: words that are there already, so others that are as near are rather meant.
    """
    known = sorted(words)
    if meant := did_you_mean(word, known, given):
        return meant
    if not known:
        return "there is none to choose from."
    return "choose one of: " + ", ".join(known) + "."


def did_you_mean(word: str, words: Iterable[str], given: Container[str] = ()) -> str:
    """Return the tail of an error sentence: the words probably meant; "" if none is near.

    The arguments are those of `nearest`.
    """
    known = sorted(words)
    close = difflib.get_close_matches(word, known, n=3, cutoff=0.5)
    if close:  # prefer words not given yet, then transposed letters, which difflib rates low
        ratios = [difflib.SequenceMatcher(None, one, word).ratio() for one in close]
        equal = [one for one, ratio in zip(close, ratios, strict=True) if ratio == ratios[0]]
        letters = sorted(word)
        equal += [one for one in known if sorted(one) == letters and one not in equal]
        ranks = [(one not in given, sorted(one) == letters) for one in equal]
        meant = [one for one, rank in zip(equal, ranks, strict=True) if rank == max(ranks)]
        return f"did you mean {' or '.join(map(repr, sorted(meant)))}?"
    return ""


def _short(text: str, most: int = 60) -> str:
    """Shorten a text in the middle to fit one line."""
    if len(text) <= most:
        return text
    return f"{text[: most // 2]}\N{HORIZONTAL ELLIPSIS}{text[-(most // 2) :]}"


class Table:
    """One TOML table. Reading a key checks it; `close` rejects keys that were not read.

    Every reader raises a `ProfileError` with file, line and key if the value is missing and has no
    default, or is invalid.
    """

    def __init__(
        self,
        values: Mapping[str, Any],
        file: str,
        path: str = "",
        *,
        text: str = "",
        at: KeyPath = (),
    ) -> None:
        """Wrap the values of a table.

        Args:
            values: the values by key.
            file: the name of the file.
            path: the path of the table for error sentences.
            text: the text of the file, to find the lines of mistakes.
            at: the path of the table in the text.
        """
        self._values = values
        self._file = file
        self._path = path
        self._text = text
        self._at = at
        self._taken: set[str] = set()

    def where(self, key: str) -> str:
        """Return the location of a key: file and dotted path."""
        return f"{self._file}: {self._path}{_short(key)}"

    def wrong(self, key: str, problem: str) -> ProfileError:
        """Return the error for a key, with its value and line."""
        shown = f" = {_short(_SHORT.repr(self._values[key]), 120)}" if key in self._values else ""
        if (line := line_of(self._text, (*self._at, key))) is not None:
            shown += f" (line {line})"
        return ProfileError(plain(f"{self.where(key)}{shown}: {_short(problem, 400)}"))

    def __contains__(self, key: str) -> bool:
        return key in self._values

    def _take(self, key: str, kind: type | tuple[type, ...], noun: str, default: Any) -> Any:
        self._taken.add(key)
        if key not in self._values:
            if default is None:
                meant = self._misspelt(key)
                raise self.wrong(
                    key,
                    f"is missing; it must be {noun}." + (f" Do you mean {meant}?" * bool(meant)),
                )
            return default
        value = self._values[key]
        kinds = kind if isinstance(kind, tuple) else (kind,)
        if not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds):
            raise self.wrong(key, f"must be {noun}.")
        return value

    def _misspelt(self, key: str) -> str:
        """Return a similar key that was not read, quoted and with its line; "" if there is none."""
        others = [other for other in self._values if other not in self._taken]
        close = difflib.get_close_matches(key, others, n=1)
        if not close:
            return ""
        line = line_of(self._text, (*self._at, close[0]))
        return f"{close[0]!r}" + ("" if line is None else f" (line {line})")

    def text(self, key: str, default: str | None = None) -> str:
        """Read a line of text (not empty unless that is the default)."""
        value: str = self._take(key, str, "text in quotes", default)
        if not value.strip() and value != default:
            raise self.wrong(key, "must not be empty.")
        if plain(value) != value:
            raise self.wrong(key, "holds a character that cannot be shown.")
        return value

    def check_slots(self, key: str, text: str, slots: Sequence[str]) -> None:
        """Check that each pair of braces in a text holds just the name of a slot.

        Raises:
            ProfileError: a brace has no partner, or a slot is unknown or has a format.
        """
        try:
            found = [part[1:] for part in Formatter().parse(text) if part[1] is not None]
        except ValueError:
            raise self.wrong(key, "has an unpaired brace.") from None
        for slot, form, conversion in found:
            if slot not in slots:
                raise self.wrong(key, f"cannot fill in {{{slot}}}; {nearest(slot or '', slots)}")
            if form or conversion:
                raise self.wrong(key, f"must hold just {{{slot}}}, without ':' or '!'.")

    def flag(self, key: str, default: bool | None = None) -> bool:
        """Read true or false."""
        value: bool = self._take(key, bool, "true or false", default)
        return value

    def number(
        self,
        key: str,
        low: float = -math.inf,
        high: float = math.inf,
        default: float | None = None,
        *,
        unit: str = "",
    ) -> float:
        """Read a finite number within [low, high]; an error names its `unit`."""
        value = self._take(key, (int, float), "a number", default)
        if not low <= value <= high or value in (math.inf, -math.inf):  # also rejects NaN
            raise self.wrong(
                key, f"must be a number from {low:g} to {high:g}{unit and f' {unit}'}."
            )
        return float(value)

    def word_or_number(self, key: str) -> str | float | bool:
        """Read a text, a finite number, or true or false."""
        value = self._take(key, (str, int, float, bool), "a text, a number, true or false", None)
        if isinstance(value, str):
            return self.text(key)
        if isinstance(value, bool):
            return value
        return self.number(key)

    def whole(self, key: str, low: int, high: int, default: int | None = None) -> int:
        """Read a whole number within [low, high]."""
        value: int = self._take(key, int, "a whole number", default)
        if not low <= value <= high:
            raise self.wrong(key, f"must be a whole number from {low} to {high}.")
        return value

    def numbers(self, key: str, count: int, low: float, high: float) -> tuple[float, ...]:
        """Read exactly `count` finite numbers within [low, high]."""
        values = self._take(key, list, f"a list of {count} numbers", None)
        right = len(values) == count and all(
            isinstance(v, int | float) and not isinstance(v, bool) and low <= v <= high
            for v in values
        )
        if not right:
            raise self.wrong(key, f"must be a list of {count} numbers from {low:g} to {high:g}.")
        return tuple(float(v) for v in values)

    def length(self, key: str) -> int:
        """Return the length of the list under a key, before reading it."""
        values: list[Any] = self._take(key, list, "a list", None)
        return len(values)

    def words(
        self, key: str, known: Iterable[str] | None = None, default: tuple[str, ...] | None = None
    ) -> tuple[str, ...]:
        """Read a list of texts, each one of `known` if that is given."""
        values = self._take(key, list, "a list of texts", default)
        allowed = None if known is None else set(known)
        for value in values:
            if not isinstance(value, str) or not value.strip() or plain(value) != value:
                raise self.wrong(key, "must be a list of texts, none of them empty.")
            if allowed is not None and value not in allowed:
                raise self.wrong(key, f"{value!r} is not known; {nearest(value, allowed)}")
        return tuple(values)

    def texts(self, key: str) -> tuple[str, ...]:
        """Read one text, or a list of them."""
        if isinstance(self._values.get(key), str):
            return (self.text(key),)
        return self.words(key)

    def choice(self, key: str, known: Iterable[str], default: str | None = None) -> str:
        """Read one word out of `known`."""
        value = self.text(key, default)
        allowed = set(known)
        if value not in allowed and value != default:
            raise self.wrong(key, f"is not known; {nearest(value, allowed)}")
        return value

    def table(self, key: str, *, optional: bool = False) -> Table:
        """Read a table; a missing optional one reads as empty."""
        value = self._take(key, dict, "a table", {} if optional else None)
        return self._inner(value, f"{_short(key)}.", key)

    def tables(self, key: str, *, optional: bool = False) -> Iterator[Table]:
        """Read an array of tables, in order."""
        values = self._take(key, list, "a list of tables ([[...]])", [] if optional else None)
        for place, value in enumerate(values, 1):
            if not isinstance(value, dict):
                raise self.wrong(key, "must be a list of tables ([[...]]).")
            name = value.get("name")
            label = _short(name) if isinstance(name, str) else place
            yield self._inner(value, f"{key}[{label}].", key, place - 1)

    def _inner(self, values: Mapping[str, Any], path: str, *at: str | int) -> Table:
        """Wrap a table within this one."""
        where = (*self._at, *at)
        return Table(values, self._file, f"{self._path}{path}", text=self._text, at=where)

    def items(self) -> Iterator[tuple[str, Table]]:
        """Read every key as a table, in order."""
        for key in self._values:
            yield key, self.table(key)

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def close(self, also: Iterable[str] = ()) -> None:
        """Reject keys that were not read: mostly spelling mistakes.

        Args:
            also: further valid keys.

        Raises:
            ProfileError: names the key and the nearest valid one.
        """
        for key in self._values:
            if key not in self._taken:
                meant = nearest(key, self._taken.union(also), self._values)
                raise self.wrong(key, f"is not a key here; {meant}")


def _in_words(error: tomllib.TOMLDecodeError, text: str) -> str:
    """Return a hint for the author if the parser names only the text it met."""
    told = str(error)
    at = re.search(r"at line (\d+)", told)
    lines = text.split("\n")
    line = lines[int(at[1]) - 1] if at and int(at[1]) <= len(lines) else ""
    for met, words in _MET.items():
        told = re.sub(re.escape(met), words, told, flags=re.IGNORECASE)
    return told + ('; write a quotation mark inside a text as \\"' if _INSIDE.search(line) else "")


def read_toml(path: Path) -> Table:
    """Read a TOML file.

    Raises:
        ProfileError: the file is missing, a folder, unreadable, empty, too large or not TOML.
    """
    name = plain(path.name)
    if os.path.isdir(path):  # noqa: PTH112 - False for an invalid name
        raise ProfileError(plain(f"{path}: is a folder; name the TOML file in it."))
    content = read_given(path, LARGEST_PROFILE, ProfileError, called=name)
    try:
        text = lines_of(content)
        values = tomllib.loads(text)
    except UnicodeDecodeError:
        raise ProfileError(f"{name}: is not UTF-8 text.") from None
    except tomllib.TOMLDecodeError as error:
        raise ProfileError(plain(f"{name}: is not TOML: {_in_words(error, text)}.")) from None
    except ValueError:  # an integer with too many digits
        raise ProfileError(f"{name}: holds a number of thousands of digits.") from None
    except RecursionError:
        raise ProfileError(f"{name}: is nested too deeply.") from None
    if not values:
        raise ProfileError(f"{name}: is empty: it has no entries.")
    return Table(values, name, text=text)

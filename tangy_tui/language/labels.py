"""The label of a recording, from the name of its file or folder: an intent, or none."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.stop_sentence import STOPS
from tangy_tui.language.words import Words, words_of

STOP = "stop"
"""The intent of stop commands."""
NO_COMMAND = frozenset(
    (
        *("none", "other", "others", "noise", "noises", "far", "near", "garbage", "silence"),
        *("speech", "babble", "background", "nothing"),
    )
)
"""Names of recordings or folders without a command."""
SUFFIXES = (".wav", ".wave")

TAKE = "#"  # stands for the number of a recording: with a leading zero, or three digits or more
_TAKE = re.compile(r"(?<!\d)(?:0\d*|\d{3,})(?!\d)")


@dataclass(frozen=True, slots=True)
class UtteranceLabel:
    """A label: a behaviour (or STOP), and the person it names; None: no command.

    `named` is False if the name gives no label; such a recording is not used.
    """

    behaviour: str | None
    user: str | None = None
    named: bool = True

    @property
    def words(self) -> str:
        """The name of the label in a report."""
        return " ".join(filter(None, (self.behaviour, self.user))) or "no command"


NOBODY_KNOWS = UtteranceLabel(None, named=False)


@dataclass(frozen=True, slots=True)
class LabelledRecordings:
    """The labelled recordings below a folder, and those left out with the reason.

    `unnamed` are the recordings whose names give no label; they are left out too.
    """

    folder: Path
    recordings: tuple[tuple[Path, UtteranceLabel], ...]
    left_out: tuple[tuple[Path, str], ...]
    unnamed: tuple[Path, ...] = ()


class Labels:
    """Derives labels from names of recordings, by a phrasebook's behaviours, phrases and people.

    Case, underscores, hyphens and dots are ignored. The longest intent at the beginning of a name
    counts; the rest (a number, a voice, a date) is ignored.
    """

    def __init__(self, phrasebook: Phrasebook) -> None:
        """Index the intents of a phrasebook."""
        phrases = phrasebook.table.by_words
        self._intents = {words: UtteranceLabel(p.behaviour, p.user) for words, p in phrases.items()}
        self._intents |= {
            (*words_of(p.behaviour),): UtteranceLabel(p.behaviour) for p in phrases.values()
        }
        self._intents |= {words_of(phrase): UtteranceLabel(STOP) for phrase in STOPS}
        self._longest = max(map(len, self._intents))
        names = [phrase.behaviour for phrase in phrases.values()]
        self._example = next((name for name in names if " " in name), names[0])
        self._to_people = frozenset(phrasebook.nouns)
        self._ids = {words_of(id): id for id in phrasebook.people}
        self._numbers = phrasebook.table.numbers

    def of(self, file: Path, folder: Path) -> UtteranceLabel:
        """Return the label of a recording below a folder.

        The name of its folder has priority, then its own name, then the folders further up.
        """
        stem = _words(file.stem)
        above = [file.parent, *file.parent.parents]
        above = above[: above.index(folder) + 1]
        label = self._of_folder(above[0], below=above[0] != folder)
        label = label or self._intent(stem) or _no_command(stem[:1])
        for one in above[1:] if label is None else ():
            label = label or self._of_folder(one, below=one != folder)
        if label is None:
            return NOBODY_KNOWS
        if label.behaviour in self._to_people and label.user is None:
            return UtteranceLabel(label.behaviour, self._id_in(stem))
        return label

    def find(self, folder: Path) -> LabelledRecordings:
        """Find the recordings below a folder, without following symbolic links.

        Raises:
            TangyError: it is not a folder, or has no labelled recordings.
        """
        shown = plain(str(folder))
        if not folder.is_dir():
            is_file = folder.exists()
            raise TangyError(
                f"{shown}: is a file; give the folder in which it lies." if is_file
                else f"{shown}: there is no such folder."
            )  # fmt: skip
        top = folder.absolute()
        found: list[tuple[Path, UtteranceLabel]] = []
        left_out: list[tuple[Path, str]] = []
        unnamed: list[Path] = []
        for file, why in _files(top):
            label = NOBODY_KNOWS if why else self.of(file, top)
            if why:
                left_out.append((file.relative_to(top), why))
            elif not label.named:
                unnamed.append(file.relative_to(top))
            else:
                found.append((file.relative_to(top), label))
        if unnamed and not found:
            which = f"none of its {len(unnamed)} recordings ({unnamed[0]}, ...) is"
            if len(unnamed) == 1:
                which = f"its one recording, {unnamed[0]}, is not"
            name = f"{self._example.replace(' ', '_')}-1.wav"
            raise TangyError(
                plain(
                    f"{shown}: {which} named by what is said in it, as {name} is, and "
                    f"{self._example}/1.wav (none/1.wav: no command)."
                )
            )
        if not found:
            why = f" ({left_out[0][0]} {left_out[0][1]})" if left_out else ""
            raise TangyError(
                plain(f"{shown}: there are no WAV files in it{why}; name each by what is said, ")
                + "as in call_number-1.wav, or put it into a folder of that name."
            )
        return LabelledRecordings(top, tuple(found), tuple(left_out), tuple(unnamed))

    def _of_folder(self, folder: Path, *, below: bool) -> UtteranceLabel | None:
        """Return the label by a folder's name; the top one can only name an intent."""
        words = _words(folder.name)
        return self._intent(words) or (_no_command(words) if below else None)

    def _intent(self, words: Words) -> UtteranceLabel | None:
        for length in range(min(len(words), self._longest), 0, -1):
            label = self._intents.get(words[:length])
            if label is not None:
                if label.behaviour in self._to_people and label.user is None:
                    rest = words[length:]
                    user = self._numbers.get(rest[0]) if rest else None
                    return UtteranceLabel(label.behaviour, user or self._id_in(rest))
                return label
        return None

    def _id_in(self, words: Words) -> str | None:
        """Return the person whose id is among the words."""
        for id, person in self._ids.items():
            places = range(len(words) - len(id) + 1)
            if any(words[place : place + len(id)] == id for place in places):
                return person
        return None


def _words(name: str) -> Words:
    """Split a name into words; the number of a recording becomes TAKE."""
    first, *rest = _TAKE.split(name)
    words = list(words_of(first))
    for part in rest:
        words += (TAKE, *words_of(part))
    return tuple(words)


def _no_command(words: Words) -> UtteranceLabel | None:
    said = [word for word in words if word != TAKE and not word.isdigit()]
    return UtteranceLabel(None) if said and NO_COMMAND.issuperset(said) else None


def _files(top: Path) -> Iterator[tuple[Path, str]]:
    """Yield every file below a folder in order, with the reason if it is skipped."""
    unread: list[tuple[Path, str]] = []

    def cannot(error: OSError) -> None:
        unread.append((Path(error.filename), f"cannot be read ({error.strerror})"))

    for place, folders, names in os.walk(top, onerror=cannot):
        here = Path(place)
        yield from unread
        unread.clear()
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        yield from ((here / n, "is a symbolic link") for n in folders if (here / n).is_symlink())
        for name in sorted(name for name in names if not name.startswith(".")):
            file = here / name
            if file.is_symlink():
                yield file, "is a symbolic link"
            elif file.suffix.casefold() not in SUFFIXES:
                yield file, "is not a WAV file"
            else:
                yield file, ""
    yield from unread

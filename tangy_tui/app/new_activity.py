"""A new activity as its author answers the questions about it, one after another.

Which question comes next depends on the answers alone, so that an author can go back to any of
them: the answers to later questions are kept.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from tangy_profiles.game_rules import COMMAND_WORDS
from tangy_tui.app.authors_words import has_number, is_file, kept, listed_answers, name_of
from tangy_tui.language.answers import yes_or_no

QUIZ, TALK, SONGS, EXERCISES = "quiz", "talk", "songs", "exercises"
MEMORY, GAME, CARDS = "memory", "game", "cards"
KINDS = (QUIZ, TALK, SONGS, EXERCISES, MEMORY, GAME, CARDS)
TITLE, KIND, TEAMS, POINTS, MEDIA = "title", "kind", "teams", "points", "media"
ITEM, TURNS, ROUNDS, WIN_AT = "item", "turns", "rounds", "win-at"
CLAIM, PATTERN, NUMBERS = "claim", "pattern", "numbers"
ASK, RIGHT, WRONG, HINT = "ask", "right", "wrong", "hint"
PICTURE, SOUND = "picture", "sound"
WELCOME, GOODBYE = "welcome", "goodbye"
SENTENCES = (WELCOME, GOODBYE)

ROWS: Mapping[str, tuple[str, ...]] = {
    QUIZ: (ASK, RIGHT, WRONG, HINT),
    TALK: ("text", "more"),
    SONGS: ("song", "line"),
    EXERCISES: ("move", "how", "times"),
    MEMORY: ("pair", "row", "story"),
}
"""What each row of the table holds; a row without its first value ends the table."""

BEFORE: Mapping[str, tuple[str, ...]] = {
    QUIZ: (TEAMS, POINTS, MEDIA),
    TALK: (ITEM, TURNS),
    GAME: (WIN_AT,),
    CARDS: (CLAIM, PATTERN, NUMBERS),
}
DEFAULTS: Mapping[str, str] = {
    KIND: QUIZ, TEAMS: "", POINTS: "y", MEDIA: "n", ITEM: "question", TURNS: "y", WIN_AT: "3",
    NUMBERS: "75", HINT: "", PICTURE: "", SOUND: "",
    "more": "", "times": "five", "story": "",
}  # fmt: skip
"""What counts if the author only presses Enter. The other questions need an answer."""
MOST_ROUNDS: Mapping[str, int] = {QUIZ: 6, SONGS: 4, EXERCISES: 6, MEMORY: 5}
"""Rounds of a game unless the author says otherwise, and kinds that have them."""
RANGES: Mapping[str, tuple[int, int]] = {WIN_AT: (1, 20), NUMBERS: (40, 75)}
YES_OR_NO = (POINTS, MEDIA, TURNS)
CARD_ROWS = ("top", "middle", "bottom")
MOST_WRONG, MOST_TEAMS = 5, 6
LONGEST, LONGEST_TITLE = 200, 60
NOTHING = "-"
"""Typed to leave empty what was answered before."""


class Problem(NamedTuple):
    """Why an answer cannot be taken: a code for its words, and what they name."""

    code: str
    named: tuple[str, ...] = ()


class Examples(NamedTuple):
    """What the activities that come with Tangy offer to the author of another.

    Attributes:
        rows: how many rows the table of each kind has from which an author can begin.
        patterns: what can win a game with cards, with the shapes of each.
        claim: what people call if they have won.
        kinds: the kind of each such activity by its name.
        said: for kinds, the sentences that begin and end a game; `{title}` is its title.
    """

    rows: Mapping[str, int]
    patterns: Mapping[str, tuple[str, ...]]
    claim: str
    kinds: Mapping[str, str]
    said: Mapping[str, tuple[str, str]]


@dataclass
class Draft:
    """The answers so far, by question.

    Attributes:
        folder: where the files will be written.
        examples: what the activities that come with Tangy offer.
        said: the answers; a question of a table's row is named `ask.2`.
        before: answers that the author went back to; they are offered again.
        given: questions that options answered; they are not asked.
        own_rounds: the author chose the rounds of a game; otherwise they follow the table.
        imported: rows that were read from a file, None: the author enters them.
    """

    folder: Path
    examples: Examples
    said: dict[str, str] = field(default_factory=dict)
    before: dict[str, str] = field(default_factory=dict)
    given: set[str] = field(default_factory=set)
    own_rounds: bool = False
    imported: int | None = None

    @property
    def kind(self) -> str:
        """The kind of the activity, one of `KINDS`."""
        return self.said.get(KIND, QUIZ)

    @property
    def name(self) -> str:
        """The file name: the title in lower case, its words joined by dashes."""
        return name_of(self.said.get(TITLE, ""))

    @property
    def fields(self) -> tuple[str, ...]:
        """The columns of a row that the author is asked for."""
        media = (PICTURE, SOUND) if self.yes(MEDIA) and self.kind == QUIZ else ()
        return (*ROWS.get(self.kind, ()), *media)

    def yes(self, key: str) -> bool:
        """Return the answer to a question with yes or no."""
        return self.said.get(key, DEFAULTS[key]) == "y"

    def number(self, key: str) -> int:
        """Return the answer to a question for a number."""
        return int(self.said.get(key) or self.default(key) or 0)

    def questions(self) -> Iterator[str]:
        """Yield all questions in their order, as far as the answers lead."""
        yield TITLE
        yield KIND
        yield from BEFORE.get(self.kind, ())
        if self.fields and self.imported is None:
            number = 1
            while True:
                yield row_key(self.fields[0], number)
                if not self.said.get(row_key(self.fields[0], number)):
                    break
                yield from (row_key(one, number) for one in self.fields[1:])
                number += 1
        if self.kind in MOST_ROUNDS and self.table_size() > 1:
            yield ROUNDS
        if self.kind in self.examples.said:
            yield from SENTENCES

    def open(self) -> str | None:
        """Return the first question without an answer; None: all have one."""
        return next((key for key in self.questions() if key not in self.said), None)

    def rows(self) -> list[dict[str, str]]:
        """Return the rows of the table that the author has entered."""
        found = list[dict[str, str]]()
        while self.fields and self.said.get(row_key(self.fields[0], len(found) + 1)):
            at = len(found) + 1
            found.append({one: self.said.get(row_key(one, at), "") for one in self.fields})
        return found

    def table_size(self) -> int:
        """Return how many rows the table will have, those of a sample too."""
        return self.imported or len(self.rows()) or self.examples.rows.get(self.kind, 1)

    def files(self) -> list[Path]:
        """Return the pictures and sounds of the rows, each once."""
        names = [row.get(one) for row in self.rows() for one in (PICTURE, SOUND)]
        return [self.folder / name for name in dict.fromkeys(names) if name]

    def default(self, key: str) -> str | None:
        """Return what Enter means; None: an answer is needed."""
        if key in self.before and (key != ROUNDS or self.own_rounds):
            return self.before[key]
        if key == ROUNDS:
            return str(self._usual_rounds())
        base, number = split_key(key)
        if number and base == self.fields[0]:
            return ""
        if base in SENTENCES:
            return self._usual_sentence(base, self.said)
        if base == CLAIM:
            return self.examples.claim
        if base == PATTERN:
            return next(iter(self.examples.patterns))
        if base == "row":
            return CARD_ROWS[(number - 1) % len(CARD_ROWS)]
        return DEFAULTS.get(base)

    def _usual_sentence(self, base: str, said: Mapping[str, str]) -> str:
        """Return the welcome or goodbye that fits the kind and title among some answers."""
        usual = self.examples.said.get(said.get(KIND, QUIZ), ("", ""))[SENTENCES.index(base)]
        return usual.format(title=said.get(TITLE, ""))

    def _usual_rounds(self) -> int:
        """Return the rounds of a game, as many for each team if the table has enough."""
        most, teams = min(MOST_ROUNDS[self.kind], self.table_size()), self.teams()
        return most - most % teams if teams and most > teams else most

    def teams(self) -> int:
        """Return how many teams take turns, 0 if people do."""
        return len(listed_answers(self.said.get(TEAMS, ""))) if self.kind == QUIZ else 0

    def answer(self, key: str, text: str) -> Problem | None:
        """Take an answer; return why it cannot be taken."""
        base, number = split_key(key)
        text = kept(text, quotes=bool(number) or base in SENTENCES)
        typed = text
        if text == NOTHING:
            if number > 1 and base == self.fields[0]:
                self._remove_row(number)
                self._fit_rounds()
                return None
            text = (DEFAULTS.get(base) or "") if not number or base != RIGHT else ""
            self.before.pop(key, None)
        elif not text:
            text = self.default(key) or ""
        text = self._meant(base, text)
        if (problem := self._problem(key, text)) is None:
            if key in (TITLE, KIND):
                self._drop_sentences(key, text)
            self.said[key] = text
            self.before.pop(key, None)
            if key == ROUNDS and typed:
                self.own_rounds = text != str(self._usual_rounds())
            self._fit_rounds()
        return problem

    def back(self) -> bool:
        """Go back to the last question that was asked; return whether there was one."""
        asked = [key for key in self.questions() if key in self.said and key not in self.given]
        now = self.open()
        if now is not None:
            order = list(self.questions())
            asked = [key for key in asked if order.index(key) < order.index(now)]
        if asked:
            self.reopen(asked[-1])
        return bool(asked)

    def reopen(self, *keys: str) -> None:
        """Ask questions again, with their answers as what Enter means."""
        for key in keys:
            if key in self.said:
                self.before[key] = self.said.pop(key)

    def _drop_sentences(self, key: str, text: str) -> None:
        """Drop the sentences that only fit the former title and kind, now that this one changes."""
        former = {**self.said, **self.before}
        for one in SENTENCES:
            usual = self._usual_sentence(one, former)
            fits = usual == self._usual_sentence(one, {**former, key: text})
            if not fits and one not in self.given and former.get(one) == usual:
                self.said.pop(one, None)
                self.before.pop(one, None)

    def _fit_rounds(self) -> None:
        """Fit the rounds to the table; ask the author who chose more than it now has."""
        if self.kind not in MOST_ROUNDS:
            return
        if ROUNDS not in self.said or ROUNDS in self.given or self.open() not in (None, *SENTENCES):
            return
        if not self.own_rounds:
            self.said[ROUNDS] = str(self._usual_rounds())
        elif self.number(ROUNDS) > self.table_size():
            del self.said[ROUNDS]
            self.own_rounds = False

    def _remove_row(self, number: int) -> None:
        """Remove a row of the table: those after it move up."""
        for base in self.fields:
            rest = number
            while (after := row_key(base, rest + 1)) in self.said:
                self.said[row_key(base, rest)] = self.said.pop(after)
                rest += 1
            self.before.pop(row_key(base, number), None)
            if rest == number:
                self.said.pop(row_key(base, number), None)
        if row_key(self.fields[0], number) not in self.said:
            self.said[row_key(self.fields[0], number)] = ""

    def _meant(self, base: str, text: str) -> str:
        """Return an answer as it is kept: `1` is the first kind, `yes please` a yes."""
        low = text.lower()
        if base == KIND:
            at = int(low) if low.isdecimal() else 0
            begun = [one for one in KINDS if low and one.startswith(low)]
            if 1 <= at <= len(KINDS) or len(begun) == 1:
                return KINDS[at - 1] if at else begun[0]
            return self.examples.kinds.get(low, low)
        if base in YES_OR_NO:
            said = yes_or_no({"y": "yes", "n": "no"}.get(low, low))
            return {True: "y", False: "n", None: text}[said]
        if base == PATTERN:
            at = int(low) if low.isdecimal() else 0
            patterns = list(self.examples.patterns)
            return patterns[at - 1] if 1 <= at <= len(patterns) else low
        if base == CLAIM:
            return low
        if base == "times":
            return text.removesuffix(" times")
        if base in (PICTURE, SOUND) and Path(text).parent.resolve() == self.folder.resolve():
            return Path(text).name
        if base == ITEM:
            first, _, rest = text.partition(" ")
            return rest if rest and first.lower() in ("a", "an", "the", "one", "some") else text
        return text

    def _problem(self, key: str, text: str) -> Problem | None:
        base, number = split_key(key)
        if KIND in self.said and not self._takes(base):
            return Problem("other kind")
        if not text and self.default(key) is None:
            return Problem("letters" if base == TITLE else "empty")
        longest = LONGEST if number or base in SENTENCES else LONGEST_TITLE
        if len(text) > longest:
            return Problem("long", (str(longest),))
        if base == TITLE:
            if not name_of(text):
                return Problem("letters")
            there = [self.folder / f"{name_of(text)}{end}" for end in (".toml", ".csv")]
            return next((Problem("there", (str(one),)) for one in there if one.exists()), None)
        if base == KIND and text not in KINDS:
            return Problem("kind", KINDS)
        if base in YES_OR_NO and text not in ("y", "n"):
            return Problem("yes")
        if base == PATTERN and text not in self.examples.patterns:
            return Problem("one of", tuple(self.examples.patterns))
        if base == CLAIM and not (text.isascii() and text.isalpha()):
            return Problem("word")
        if base == CLAIM and text in COMMAND_WORDS:
            return Problem("command", (text,))
        if base == TEAMS and text and not 2 <= len(listed_answers(text)) <= MOST_TEAMS:
            return Problem("teams", ("2", str(MOST_TEAMS)))
        if base == WRONG:
            return self._wrong_problem(text, self.said.get(row_key(RIGHT, number), ""))
        if base == "times" and not has_number(text):
            return Problem("times")
        if base in (PICTURE, SOUND) and text and not is_file(self.folder / text):
            return Problem("no file", (text, str(self.folder)))
        low, high = (1, self.table_size()) if base == ROUNDS else RANGES.get(base, (0, 0))
        if high and not (text.isdecimal() and low <= int(text) <= high):
            return Problem("number", (str(low), str(high)))
        if base == NUMBERS and int(text) % 5:
            return Problem("fives")
        return None

    def _takes(self, base: str) -> bool:
        """Return whether the kind has a question, in some row or after some answers."""
        if base == ROUNDS:
            return self.kind in MOST_ROUNDS
        if base in SENTENCES:
            return self.kind in self.examples.said
        of_some = {one for keys in BEFORE.values() for one in keys}
        return base not in of_some or base in BEFORE.get(self.kind, ())

    def _wrong_problem(self, text: str, right: str) -> Problem | None:
        wrong = listed_answers(text)
        if not 1 <= len(wrong) <= MOST_WRONG:
            return Problem("wrong answers", ("1", str(MOST_WRONG)))
        all_of_them = [one.casefold() for one in (right, *wrong)]
        return Problem("same") if len(set(all_of_them)) < len(all_of_them) else None


def row_key(base: str, number: int) -> str:
    """Return the name of a question about a row of the table."""
    return f"{base}.{number}"


def split_key(key: str) -> tuple[str, int]:
    """Return a question's name and the number of its row, 0 if it is about no row."""
    base, _, number = key.partition(".")
    return base, int(number or 0)

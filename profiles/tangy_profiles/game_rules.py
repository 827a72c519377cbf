"""Game rules that staff can choose from, read from TOML: patterns, claims, visits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import ceil

from tangy_profiles.cards import PATTERNS, Deck
from tangy_profiles.errors import ProfileError, TangyError
from tangy_profiles.reading import Table, nearest, plain

LONGEST_PACE, SHORTEST_PACE, USUAL_PACE = 60.0, 5.0, 30.0
PACES = (5.0, 7.0, 10.0, 15.0, 20.0, 25.0, 30.0, 40.0, 50.0, 60.0)
"""The paces, in s between calls, that staff step through."""

COMMAND_WORDS = frozenset({
    "abort", "acknowledge", "add", "all", "answer", "ask", "assist", "autonomy", "back",
    "brake", "call", "can", "card", "cards", "cease", "clear", "cleared", "come", "continue",
    "could", "drive", "emergency", "end", "enough", "exit", "expert", "faster", "faults",
    "freeze", "give", "go", "guest", "halt", "help", "here", "how", "i", "is", "leave",
    "left", "let", "look", "more", "move", "n", "next", "no", "now", "one", "pace",
    "pattern", "patterns", "pause", "people", "phrases", "plan", "play", "please", "quit",
    "reached", "repeat", "resume", "say", "seen", "send", "several", "slower", "step", "stop",
    "take", "tangy", "that", "the", "time", "visit", "visits", "void", "wait", "what", "when",
    "where", "which", "who", "whoa", "whose", "why", "y", "yes", "you",
})  # fmt: skip
"""First words of what staff type in any game, so no word for a claim."""


_DETERMINERS = frozenset({"a", "an", "the", "one", "1", "single"})
_COUNTS = {"2": "two", "3": "three", "4": "four"}


def _bare(name: str) -> str:
    """Return the name of a pattern without a determiner before it, and with its count as a word."""
    first, _, rest = name.partition(" ")
    if rest and first in _DETERMINERS:
        return _bare(rest)
    return f"{_COUNTS.get(first, first)} {rest}".rstrip()


def next_pace(pace: float, by: int) -> float:
    """Return the next shorter (-1) or longer (1) pace in s; the last one stays."""
    if by < 0:
        return max((one for one in PACES if one < pace), default=PACES[0])
    return min((one for one in PACES if one > pace), default=PACES[-1])


@dataclass(frozen=True)
class Pattern:
    """Winning cells: any of the `shapes`, or `together` different ones of them at once."""

    name: str
    label: str
    shapes: tuple[str, ...]
    together: int = 1

    def on(self, deck: Deck) -> Deck:
        """Return a deck whose cards win by this pattern."""
        return replace(deck, patterns=self.shapes, together=self.together)


@dataclass(frozen=True)
class Strength:
    """A limit on the strategies: how strongly people may be spoken to."""

    name: str
    label: str
    strategies: tuple[str, ...]


@dataclass(frozen=True)
class CallsFirst:
    """Reserves time for calls while many people ask.

    After `visits` in a row an overdue call comes first, and further calls until they have had a
    `share` of the time since the last call, but at most `calls`. In a group of up to `small_group`
    people, requests never wait for a call.
    """

    visits: int
    share: float
    calls: int
    small_group: int

    def due(self, people: int, visits: int, seconds: float, pace: float) -> int:
        """Return how many calls come first, given the s since the last one; 0 for none."""
        if people <= self.small_group or visits < self.visits or seconds < pace:
            return 0
        wanted = round(seconds * self.share / (1.0 - self.share) / pace, 6)
        return min(self.calls, max(1, ceil(wanted)))


@dataclass(frozen=True)
class GameRules:
    """Options that an activity offers staff for a game; "" and 0 if it has no such rule.

    `claim` is the word before the number of a card that is claimed to win. `claim_right`,
    `claim_late` (another card was first), `claim_wrong`, `taken_back` and `play_on` are
    announcements; so are `all_called` (no number is left, and each person gets a visit) and
    `nobody_won` (after these visits). A person without a visit for `unvisited` calls waits for one
    from then on like those who ask, if staff want that. See `CallsFirst`. Of more numbers than
    `numbers_aloud`, so many are said, in the words of `more_numbers`.
    """

    patterns: tuple[Pattern, ...] = ()
    claim: str = ""
    claim_right: str = ""
    claim_late: str = ""
    claim_wrong: str = ""
    taken_back: str = ""
    play_on: str = ""
    all_called: str = ""
    nobody_won: str = ""
    unvisited: int = 0
    strengths: tuple[Strength, ...] = ()
    calls_first: CallsFirst | None = None
    numbers_aloud: int = 0
    more_numbers: str = ""

    def said(self, labels: Sequence[str]) -> str:
        """Return numbers as they are said: all of them, or the first few and how many more."""
        most = self.numbers_aloud
        if not most or len(labels) <= most + 1:  # a single one more is said as well
            return ", ".join(labels)
        few = ", ".join(labels[:most])
        return self.more_numbers.format(numbers=few, count=len(labels) - most)

    def pattern(self, name: str) -> Pattern:
        """Return a pattern by its name or label, in any case; "one line" is a line.

        Raises:
            TangyError: there is none; the message suggests the nearest name.
        """
        wanted = " ".join(name.split()).casefold()
        for pattern in self.patterns:
            if _bare(wanted) in (_bare(pattern.name.casefold()), _bare(pattern.label.casefold())):
                return pattern
        known = [pattern.name for pattern in self.patterns]
        raise TangyError(plain(f"There is no pattern {name!r}: {nearest(wanted, known)}"))

    def left_out(self, strength: str) -> tuple[str, ...]:
        """Return the strategies that a strength excludes; none for ""."""
        chosen = next((one for one in self.strengths if one.name == strength), None)
        known = {name for one in self.strengths for name in one.strategies}
        return () if chosen is None else tuple(sorted(known - set(chosen.strategies)))


NO_RULES = GameRules()


@dataclass(frozen=True)
class GamePlan:
    """Staff's plan for a game; the defaults leave the activity's own game unchanged.

    `patterns` are played for one after another; "" as a strength allows all strategies.
    """

    patterns: tuple[str, ...] = ()
    several: bool = False
    """Whether others with the pattern at the same call win as well."""
    visits: bool = False
    """Whether people without a visit for a while count as asking."""
    strength: str = ""
    absent: tuple[str, ...] = ()
    """Participants who have not come yet."""
    pace: float = 0.0
    """Time between calls, in s; 0: unchanged."""
    minutes: int = 0
    """Planned duration of the session; 0: open."""


@dataclass
class Patterns:
    """The patterns of one game: the current one, and the next ones."""

    rules: GameRules
    deck: Deck
    left: list[Pattern] = field(default_factory=list)
    present: Pattern | None = None
    """The current one; None: staff chose none, so it is the activity's own."""
    won: int = 0
    """How many patterns were won before the current one."""

    @classmethod
    def of(cls, rules: GameRules, deck: Deck, names: Sequence[str]) -> Patterns:
        """Return the patterns of a plan; without names the activity's deck is used."""
        chosen = [rules.pattern(name) for name in names]
        return cls(rules, deck, chosen[1:], chosen[0] if chosen else None)

    @property
    def played(self) -> Deck:
        """The deck whose cards win by the current pattern."""
        return self.deck if self.present is None else self.present.on(self.deck)

    @property
    def current(self) -> Pattern | None:
        """The pattern to play for; None if the activity has no name for it."""
        if self.present is not None:
            return self.present
        return next((one for one in self.rules.patterns if one.on(self.deck) == self.deck), None)

    @property
    def label(self) -> str:
        """The label of the pattern to play for; "" if it has none."""
        return "" if (current := self.current) is None else current.label

    @property
    def chosen(self) -> list[Pattern]:
        """The pattern to play for and those that follow, if staff chose any."""
        if self.present is None and not self.left:
            return []
        return [*filter(None, (self.current,)), *self.left]

    def follow_with(self, names: Sequence[str]) -> None:
        """Choose the patterns after the current one."""
        self.left = [self.rules.pattern(name) for name in names]

    def advance(self) -> bool:
        """Go on to the next pattern; return whether there was one."""
        if not self.left:
            return False
        self.present = self.left.pop(0)
        self.won += 1
        return True


def read_game_rules(top: Table, deck: Deck, strategies: Sequence[str]) -> GameRules:
    """Read the game rules of an activity; all are optional.

    Raises:
        ProfileError: the file has a mistake.
    """
    patterns = tuple(_read_pattern(entry, deck) for entry in top.tables("patterns", optional=True))
    strengths = tuple(
        _read_strength(entry, strategies) for entry in top.tables("strengths", optional=True)
    )
    rules = top.table("rules", optional=True)
    found = GameRules(
        patterns=patterns,
        strengths=strengths,
        claim=rules.text("claim", ""),
        claim_right=_said(rules, "claim_right", ("card", "pattern")),
        claim_late=_said(rules, "claim_late", ("card", "pattern")),
        claim_wrong=_said(rules, "claim_wrong", ("card", "pattern")),
        taken_back=_said(rules, "taken_back", ("call",)),
        play_on=_said(rules, "play_on", ("pattern",)),
        all_called=_said(rules, "all_called", ("pattern",)),
        nobody_won=_said(rules, "nobody_won", ("pattern",)),
        unvisited=rules.whole("unvisited", 0, 999, 0),
        calls_first=_read_calls_first(rules) if "calls_first" in rules else None,
        numbers_aloud=rules.whole("numbers_aloud", 0, 99, 0),
        more_numbers=_said(rules, "more_numbers", ("numbers", "count")),
    )
    if found.numbers_aloud and "{numbers}" not in found.more_numbers:
        raise rules.wrong("more_numbers", "must have {numbers} in it.")
    if found.claim.casefold() in COMMAND_WORDS:
        raise rules.wrong("claim", "begins a command of staff; choose another word.")
    rules.close()
    names = [one.name for one in patterns] + [one.name for one in strengths]
    if len(set(names)) < len(names):
        raise top.wrong("patterns", "two patterns or strengths have the same name.")
    return found


def _read_pattern(entry: Table, deck: Deck) -> Pattern:
    name = entry.text("name")
    shapes = entry.words("shapes", PATTERNS)
    together = entry.whole("together", 1, 4, 1)
    pattern = Pattern(name, entry.text("label", name), shapes, together)
    entry.close()
    if not pattern.on(deck).lines:
        raise entry.wrong("shapes", "make no pattern on this card.")
    return pattern


def _read_calls_first(rules: Table) -> CallsFirst:
    entry = rules.table("calls_first")
    found = CallsFirst(
        visits=entry.whole("visits", 1, 99),
        share=entry.number("share", 0.05, 0.95),
        calls=entry.whole("calls", 1, 99),
        small_group=entry.whole("small_group", 0, 99),
    )
    entry.close()
    return found


def _read_strength(entry: Table, strategies: Sequence[str]) -> Strength:
    name = entry.text("name")
    chosen = entry.words("strategies", strategies)
    if not chosen:
        raise entry.wrong("strategies", "must hold at least one strategy.")
    strength = Strength(name, entry.text("label", name), chosen)
    entry.close()
    return strength


def _said(table: Table, key: str, slots: Sequence[str]) -> str:
    """Read an announcement, and check its slots."""
    text = table.text(key, "")
    try:
        text.format(**dict.fromkeys(slots, ""))
    except (KeyError, IndexError, ValueError):
        wanted = " and ".join("{%s}" % slot for slot in slots)  # noqa: UP031 - literal braces
        raise ProfileError(str(table.wrong(key, f"can have {wanted} filled in alone."))) from None
    return text

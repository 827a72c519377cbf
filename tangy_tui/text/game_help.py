"""What staff can type in a game: the commands that help lists, and examples of them."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import NamedTuple

from tangy_profiles.game_rules import GameRules
from tangy_tui.app.claim_grammar import CHECK
from tangy_tui.app.game_commands import (
    AskFor,
    CallAgain,
    ChoosePatterns,
    ClaimCard,
    Drive,
    GameCommand,
    HasCard,
    Joins,
    LetWin,
    PlanTime,
    SetPace,
    TakeBackCall,
    Tell,
    VoidResponse,
)
from tangy_tui.app.offered import Need, needs_of

HELP = "You can type at any time:"
CALLS: frozenset[Need] = frozenset({"calls"})
ANSWER = "B"
"""An answer in examples, if no question is open."""


class Row(NamedTuple):
    """A line of help: words to type, their meaning, and the command that they give, if any."""

    typed: str
    meaning: str
    gives: type[GameCommand] | None = None
    needs: frozenset[Need] = frozenset()

    def suits(self, offers: Collection[Need]) -> bool:
        """Return whether a game offers this."""
        return self.needs | needs_of(self.gives) <= {*offers}


ROWS = (
    Row("stop", "the robot stands at once; so does any sentence that aims at it"),
    Row("pause", "nothing more is done after what is done now"),
    Row("go on", "goes on after a pause or a stop"),
    Row("step", "does one thing, and pauses"),
    Row("take over", "you say what Tangy does next: then type it in words"),
    Row("give back", "Tangy goes on by itself after all"),
    Row("autonomy alone", "Tangy does everything by itself; or: unsure, each (it asks you first)"),
    Row("call again", "says the last number once more", CallAgain),
    Row("take back", "the last number counts as not called", TakeBackCall),
    Row("take back B-5", "counts B-5 as not called", TakeBackCall),
    Row("pace 20", "calls every 20 s; or: faster, slower", SetPace),
    Row(
        "plan 20 minutes",
        "you play for 20 minutes from now; or: 10 more minutes, plan until 15:40",
        PlanTime,
    ),
    Row("how long", "says how long you have played, and when the planned time is over"),
    Row(
        f"{CHECK} 17",
        f"checks card 17 against all calls; {CHECK} 17 NAME says whose it is",
        ClaimCard,
    ),
    Row(
        "NAME has card 17",
        "tells Tangy whose card it is, so that a claim names the person",
        HasCard,
    ),
    Row("people", "says who is here, and in which seat"),
    Row("cards", "says whose card is whose", needs=CALLS),
    Row(
        "play for NAME, NAME",
        "the patterns to play for next, in order; patterns lists them",
        ChoosePatterns,
    ),
    Row(
        "several winners",
        "everybody with the pattern at the same call wins; or: one winner",
        LetWin,
    ),
    Row("visits on", "also visits people who do not ask; or: visits off", LetWin),
    Row("here NAME, left NAME", "somebody has come, or has left"),
    Row(
        "add NAME",
        "a new person joins; on a seat: add NAME on seat 3; only for today: guest NAME",
        Joins,
    ),
    Row("help NAME, ask for NAME", "Tangy helps somebody who cannot ask", AskFor),
    Row(
        "why not NAME",
        "says when a person's turn comes, and why not now; ask in any words",
        needs=frozenset({"turns"}),
    ),
    Row(f"NAME: {ANSWER}", "tells Tangy what a person answers or does", Tell),
    Row(f"answer: {ANSWER}", "the same for the person the game is waiting for", Tell),
    Row("void NAME", "the last response of somebody does not count", VoidResponse),
    Row("drive left 2", "drives by hand for 2 s: forward, back, left, right", Drive),
    Row("where, why", "says what Tangy sees; what it does now, why, and who waits"),
    Row("what, faults", "says what to do about a fault, and all faults of this game"),
    Row("seen, expert, reached, clear", "about a fault that halts Tangy"),
    Row("wait 3", "reads the next line after 3 s (for scripts); or: wait until asked, over"),
    Row("wait until called", "reads the next line after the next number", needs=CALLS),
    Row("end", "ends the game"),
)
"""What help lists, in this order; a game leaves out what it does not offer."""


def help_lines(offers: Collection[Need], claim: str = "", answer: str = "") -> Iterator[str]:
    """Yield what can be typed in a game, with the meanings.

    Args:
        offers: what the game has.
        claim: the activity's word before the number of a card that is claimed to win.
        answer: an answer that can be given now.
    """
    yield HELP
    for row in ROWS:
        if not row.suits(offers):
            continue
        line = f"  {row.typed}: {row.meaning}"
        if row.gives is ClaimCard and claim:
            line = line.replace(f"{CHECK} 17", f"{claim} 17")
        elif row.gives is Tell and answer:
            line = line.replace(f": {ANSWER}:", f": {answer}:")
        yield line


def example_words(rules: GameRules, offers: Collection[Need]) -> str:
    """Give examples of commands, and name the key that explains what Tangy does."""
    patterns = f"play for {rules.patterns[-1].name}" if rules.patterns else ""
    examples: tuple[tuple[str, type[GameCommand] | None], ...] = (
        ("pace 20", SetPace),
        (f"{rules.claim} 17", ClaimCard),
        (patterns, ChoosePatterns),
        ("take back", TakeBackCall),
        ("left Rosa", None),
        ("help Rosa", AskFor),
    )
    shown = [typed for typed, gives in examples if Row(typed, "", gives).suits(offers)]
    asked = " Or ask: why not Rosa." if "turns" in offers else ""
    return (
        f"For example: {', '.join(shown)}. To see what Tangy does and why: type why, or press "
        f"{{why}} without this line.{asked}"
    )

"""The file of a new activity: questions to its author, and the template."""

from __future__ import annotations

from dataclasses import dataclass

ASK_TITLE = "What is the activity called? "
ASK_ITEMS = "What does each round bring: a question, song, story ...? (Enter: nothing new) "
ASK_TURNS = "Do people take turns? (y/n) "
ASK_AGAIN = "Please give it a name with at least one letter. "
ASK_YES_OR_NO = "Please type y or n. "
ASK_WHICH_ITEM = "Please name one such thing, as 'song'. (Enter: nothing new) "


OR = "{} or {}"
"""Joins the options of a question: all but the last one, and the last one."""
HINT = "It is not {}."
"""The hint for a question without one; it names a wrong option."""


ARTICLES = ("a", "an", "the", "one", "some")


@dataclass(frozen=True, slots=True)
class NewActivity:
    """The author's answers: the title, what a round brings, whether people take turns."""

    title: str
    item: str
    turns: bool

    @property
    def name(self) -> str:
        """The file name: the title in lower case, its words joined by dashes."""
        kept = "".join(c if c.isascii() and c.isalnum() else " " for c in self.title.lower())
        return "-".join(kept.split())


def without_article(item: str) -> str:
    """Return a noun without its article: "poem" for "a poem"."""
    first, _, rest = item.partition(" ")
    return rest if rest and first.lower() in ARTICLES else item


def items_table(new: NewActivity) -> str:
    """Return the CSV file of the items, with two sample rows to replace."""
    return f"text,more\nThe first {new.item},Something to add to it\nThe second {new.item},More\n"


def activity_file(new: NewActivity) -> str:
    """Return the activity's file, which can be played as it is and tells what to change."""
    item = bool(new.item)
    whose = 'to = "whose turn"\n' if new.turns else ""
    about = ', about = "whose turn"' if new.turns else ""
    turn = ', "next turn"' if new.turns else ""
    per = 'per = "player", ' if new.turns else ""
    mine = ', "turn is yes"' if new.turns else ""
    told = "{name} answered" if new.turns else "there was an answer"
    seen = 'sees = ["clock", "helped"]'
    silent = "no answer from {name} yet" if new.turns else "no answer yet"
    over = '["items is over"]' if item else '["round >= 3"]'
    count = "" if item else 'round = { kind = "count" }          # the rounds so far\n'
    nxt = '"next item"' if item else '"add round"'
    said = "{text}" if item else "What comes to your mind today?"
    if new.turns:
        said = "{name}: {text}" if item else "{name}, what comes to your mind today?"
    more = "{more}" if item else "Take a moment, and think of something nice."
    table = f'items = {{ file = "{new.name}.csv" }}  # one row a round\n'
    return f"""# {new.title}. Try it with: tangy activity try {new.name}.toml
name = "{new.name}"
title = "{new.title}"
summary = "1 to 12 people, 15 minutes; you need nothing else"  # read where activities are chosen
{table if item else ""}flags = ["opened", "waiting", "helped"]  # each is yes or no: no at first

# The current stage is the first one whose conditions hold. `sees` names the facts that Tangy
# decides by: it learns one answer for each of their values. People read `words`.
stages = [
  {{ name = "start", words = "nobody has been welcomed yet", when = ["opened is no"] }},
  {{ name = "reply", words = "{told}", when = ["waiting is yes", "answer is given"]{about} }},
  {{ name = "wait", words = "{silent}", when = ["waiting is yes"]{about}, {seen} }},
  {{ name = "close", words = "all rounds are over", when = {over} }},
  {{ name = "next", words = "no round is under way" }},
]

# What a good host does, for `tangy activity try` and the scripted teacher. Tangy never learns
# from this: it learns from what you show.
expected = [
  ["start", "open the round"],
  ["reply", "thank people"],
  ["wait", "clock is <20", "give time"],
  ["wait", "helped is no", "help on"],
  ["wait", "thank people"],
  ["close", "close the round"],
  ["next", "begin the next"],
]

[facts]
clock = {{ kind = "timer", bands = [20] }}      # s; below 20, or not
{count}answer = {{ {per}values = ["none", "given"], from = ["staff", "button"] }}

[people]                                      # for simulated games: when, and how probably
answer = {{ while = ["waiting is yes", "answer is none"{mine}], chance = 0.4, given = 1 }}

[behaviours."open the round"]
does = ["set opened yes"]
says = ["Welcome to {new.title}!"]
[behaviours."begin the next"]
{whose}does = [{nxt}, "set waiting yes", "set helped no", "clear answer", "start clock"]
says = ["{said}"]
[behaviours."give time"]
says = ["Take your time.", "No hurry."]
[behaviours."help on"]
{whose}does = ["set helped yes", "start clock"]
says = ["{more}"]
[behaviours."thank people"]
{whose}does = ["set waiting no"{turn}]
says = ["Thank you{", {name}" if new.turns else ""}!"]
[behaviours."close the round"]
does = ["finish"]
says = ["That was {new.title}. Goodbye!"]
"""


def written_lines(toml: str, table: str) -> list[str]:
    """Tell which files were written, and what to do next."""
    also = f" and {table}" if table else ""
    return [
        f"Written: {toml}{also}. Change what you like, then:",
        f"  tangy activity check {toml}",
        f"  tangy activity try {toml}",
        f"  tangy teach --guided --activity {toml}",
    ]

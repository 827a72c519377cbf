"""The file of a new activity in rounds, of which nothing is right or wrong."""

from __future__ import annotations

from dataclasses import dataclass

OR = "{} or {}"
"""Joins the options of a question: all but the last one, and the last one."""
HINT = "It is not {}."
"""The hint for a question without one; it names a wrong option."""


@dataclass(frozen=True, slots=True)
class NewActivity:
    """The author's answers: the names, what a round brings, whether people take turns."""

    name: str
    title: str
    item: str
    turns: bool


COLUMNS = ("text", "more")


def sample_rows(item: str) -> list[tuple[str, str]]:
    """Return two rows of the table to replace."""
    return [(f"The first {item}", "Something to add to it"), (f"The second {item}", "More")]


def activity_file(new: NewActivity) -> str:
    """Return the activity's file, which can be played as it is and tells what to change."""
    whose = 'to = "whose turn"\n' if new.turns else ""
    about = ', about = "whose turn"' if new.turns else ""
    turn = ', "next turn"' if new.turns else ""
    per = 'per = "player", ' if new.turns else ""
    mine = ', "turn is yes"' if new.turns else ""
    told = "{name} answered" if new.turns else "there was an answer"
    seen = 'sees = ["clock", "helped"]'
    silent = "no answer from {name} yet" if new.turns else "no answer yet"
    said = "{name}: {text}" if new.turns else "{text}"
    return f"""# {new.title}. Try it with: tangy activity try {new.name}.toml
name = "{new.name}"
title = "{new.title}"
summary = "1 to 12 people, 15 minutes; you need nothing else"  # read where activities are chosen
items = {{ file = "{new.name}.csv" }}  # one row a round
flags = ["opened", "waiting", "helped"]  # each is yes or no: no at first

# The current stage is the first one whose conditions hold. `sees` names the facts that Tangy
# decides by: it learns one answer for each of their values. People read `words`.
stages = [
  {{ name = "start", words = "nobody has been welcomed yet", when = ["opened is no"] }},
  {{ name = "reply", words = "{told}", when = ["waiting is yes", "answer is given"]{about} }},
  {{ name = "wait", words = "{silent}", when = ["waiting is yes"]{about}, {seen} }},
  {{ name = "close", words = "all rounds are over", when = ["items is over"] }},
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
answer = {{ {per}values = ["none", "given"], from = ["staff", "button"] }}

[people]                                      # for simulated games: when, and how probably
answer = {{ while = ["waiting is yes", "answer is none"{mine}], chance = 0.4, given = 1 }}

[behaviours."open the round"]
does = ["set opened yes"]
says = ["Welcome to {new.title}!"]
[behaviours."begin the next"]
{whose}does = ["next item", "set waiting yes", "set helped no", "clear answer", "start clock"]
says = ["{said}"]
[behaviours."give time"]
says = ["Take your time.", "No hurry."]
[behaviours."help on"]
{whose}does = ["set helped yes", "start clock"]
says = ["{{more}}"]
[behaviours."thank people"]
{whose}does = ["set waiting no"{turn}]
says = ["Thank you{", {name}" if new.turns else ""}!"]
[behaviours."close the round"]
does = ["finish"]
says = ["That was {new.title}. Goodbye!"]
"""

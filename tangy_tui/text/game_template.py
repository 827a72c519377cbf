"""The file of a new game: people take turns, and their moves win points."""

from __future__ import annotations

# Parts that would make lines of the template too long: an inline table cannot be wrapped.
MOVED = '["moving is yes", "move is not none"]'
OPEN = '["moving is yes"]'
WHOSE = 'about = "whose turn"'
WAITS = 'sees = ["clock", "helped"]'
TOLD = '["scores not told yet", "scores told"]'
ABLE = '["moving is yes", "move is none", "turn is yes"]'


def game_file(name: str, title: str, win_at: int) -> str:
    """Return the game's file, which can be played as it is and tells what to change.

    Args:
        name: the name of the file and the activity.
        title: the title of the activity.
        win_at: the points with which a person wins.
    """
    won = f'["any score >= {win_at}"]'
    return f"""# {title}. Try it with: tangy activity try {name}.toml
name = "{name}"
title = "{title}"
summary = "1 to 12 people, 15 minutes; say here what you need"  # read where activities are chosen
flags = ["opened", "moving", "helped", "told"]  # each is yes or no: no at first

# The current stage is the first one whose conditions hold. `sees` names the facts that Tangy
# decides by: it learns one answer for each of their values. People read `words`.
stages = [
  {{ name = "start", words = "nobody has been welcomed yet", when = ["opened is no"] }},
  {{ name = "moved", words = "{{name}} made a move", when = {MOVED}, {WHOSE}, sees = ["move"] }},
  {{ name = "wait", words = "no move of {{name}} yet", when = {OPEN}, {WHOSE}, {WAITS} }},
  {{ name = "won", words = "a person has enough points", when = {won}, sees = ["told"] }},
  {{ name = "next", words = "the next person can begin" }},
]
words = {{ move = ["no move", "it won a point", "it won nothing"], told = {TOLD} }}

# What a good host does, for `tangy activity try` and the scripted teacher. Tangy never learns
# from this: it learns from what you show.
expected = [
  ["start", "open the game"],
  ["moved", "move is hit", "applaud"],
  ["moved", "cheer the person up"],
  ["wait", "clock is <20", "give time"],
  ["wait", "helped is no", "help on"],
  ["wait", "cheer the person up"],
  ["won", "told is no", "tell the scores"],
  ["won", "close the game"],
  ["next", "give the turn"],
]

[facts]
clock = {{ kind = "timer", bands = [20] }}      # s; below 20, or not
score = {{ kind = "count", per = "player" }}
move = {{ per = "player", values = ["none", "hit", "miss"], from = ["staff", "button"] }}

[people]                                      # for simulated games: when, and how probably
move = {{ while = {ABLE}, chance = 0.4, hit = 6, miss = 4 }}

[behaviours."open the game"]
does = ["set opened yes"]
says = ["Welcome to {title}!"]
[behaviours."give the turn"]
to = "whose turn"
does = ["set moving yes", "set helped no", "clear move", "start clock"]
says = ["{{name}}, it is your turn.", "Now {{name}}."]
[behaviours."give time"]
says = ["Take your time.", "No hurry."]
[behaviours."help on"]
to = "whose turn"
does = ["set helped yes", "start clock"]
says = ["{{name}}, just try. It need not be perfect."]
[behaviours."applaud"]
to = "whose turn"
does = ["add score", "set moving no", "next turn"]
says = ["Well done, {{name}}! A point for you."]
posture = "cheer"
[behaviours."cheer the person up"]
to = "whose turn"
does = ["set moving no", "next turn"]
says = ["Next time, {{name}}."]
[behaviours."tell the scores"]
does = ["set told yes"]
says = ["We have a winner. The scores: {{score of each}}."]
[behaviours."close the game"]
does = ["finish"]
says = ["That was {title}. Goodbye!"]
"""

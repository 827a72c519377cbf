"""Questions to the author of a new activity, and the preview of what will be written."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence

from tangy_tui.app import new_activity as new
from tangy_tui.app.authors_words import listed_answers
from tangy_tui.app.new_activity import Draft, Problem, row_key, split_key
from tangy_tui.text.numbers import counted

BEGIN = (
    "Tangy asks a few questions. Enter takes what stands in [ ].",
    "Type back to return to the question before. Nothing is written until you say yes at the end.",
)
ANSWER = "> "
BACK = ("back", "go back")
OR_BACK = "Type back to return to the question before."
AT_THE_FIRST = "This is the first question."
NOTHING_ANSWERED = "The answers ended before the last question: nothing is written."
NOTHING_WRITTEN = "Nothing is written."
WRITE = "Shall Tangy write it? (y: yes · n: no · back · a number: change that answer)"
WRITE_AGAIN = "Please type y, n, back, or one of the numbers above."
ONE_MOMENT = "One moment: Tangy checks the activity, and plays a game of it."
BEGINS = "A game of it goes like this:"
LEFT_OUT = "... ({} left out)"
ENDS_OF_TEMPLATES = ("Welcome to {title}!", "That was {title}. Goodbye!")
"""What the files of talks and games say first and last."""
CHECKED = "Tangy has checked it, and found no mistake."
WITH_MISTAKES = "Tangy cannot play this yet. Change the answer that it is about:"
NOTHING = "nothing"

KIND_WORDS: Mapping[str, str] = {
    new.QUIZ: "questions with right and wrong answers, points if you like, also for teams",
    new.TALK: "questions, poems or stories to talk about: nothing is right or wrong",
    new.SONGS: "everybody sings along",
    new.EXERCISES: "everybody moves along",
    new.MEMORY: "people find two cards that match",
    new.GAME: "people take turns, and a good throw or move wins a point",
    new.CARDS: "numbers are called, and people mark their cards, as in {game}",
}

QUESTIONS: Mapping[str, str] = {
    new.TITLE: "What is the activity called?",
    new.KIND: "Which kind is it? Type its number or its name:",
    new.TEAMS: "Who answers? Enter: each person in turn. Or type the names of teams, with commas:",
    new.POINTS: "Do right answers win points? (y/n)",
    new.MEDIA: "Do questions have a picture or a sound of your own? (y/n)",
    new.ITEM: "What does each round bring: a question, a poem, a story ...?",
    new.TURNS: "Does each round go to one person, in turns? (y/n; n: to the whole group)",
    new.WIN_AT: "How many points does a person need to win?",
    new.CLAIM: "What do people call out when they have won?",
    new.PATTERN: "What wins? Type its number or its name:",
    new.NUMBERS: "What is the highest number, 40 to 75? The fewer, the shorter the game:",
    new.ROUNDS: "How many of them come up in one game?",
    new.WELCOME: "What does Tangy say to welcome people?",
    new.GOODBYE: "What does Tangy say at the very end?",
    new.ASK: "Question {n}, as Tangy should ask it",
    new.RIGHT: "The right answer:",
    new.WRONG: "One to five wrong answers, with commas:",
    new.HINT: "A hint, as Tangy should say it (Enter: Tangy names a wrong answer):",
    new.PICTURE: "Its picture, the name of a file in {folder} (Enter: none):",
    new.SOUND: "Its sound, the name of a file in {folder} (Enter: none):",
    "text": "{item} {n}, as Tangy should say it",
    "more": "What Tangy says if nobody answers (Enter: a few kind words):",
    "song": "Song {n}: its name",
    "line": "Its first line:",
    "move": "Movement {n}, in a few words, such as Roll your shoulders",
    "how": "How it is done, as Tangy should say it:",
    "times": "How many times?",
    "pair": "Pair {n}: what is on both cards, such as roses",
    "row": "In which row does one of them lie? (top, middle or bottom)",
    "story": "What Tangy says when it is found (Enter: a few kind words):",
}
ENDS = " (Enter: no more)"
ENDS_EMPTY = " (Enter: take Tangy's examples, and change them later)"

PROBLEMS: Mapping[str, str] = {
    "letters": "Please give it a name with at least one letter.",
    "empty": "Please type an answer.",
    "long": "Please make it shorter: at most {0} characters.",
    "there": "{0} is there already. Please give the activity another name.",
    "kind": "Please type a number from 1 to {count}, or one of the names.",
    "one of": "Please type a number from 1 to {count}, or one of: {all}.",
    "yes": "Please type y or n.",
    "word": "Please type one word, in plain letters.",
    "command": "Staff type {0} for something else in games. Please choose another word.",
    "teams": "Please type from {0} to {1} names, with commas between them, or only Enter.",
    "wrong answers": "Please type from {0} to {1} wrong answers, with commas between them.",
    "same": "Two of the answers are the same. Please type wrong answers that differ.",
    "no file": "There is no {0} in {1}. Put it there, or press Enter for none.",
    "times": "Please type a number, such as 5 or five.",
    "number": "Please type a number from {0} to {1}.",
    "fives": "Please type a number that 5 divides: 40, 45, 50 ...",
    "no fields": "Please type all parts of it, with ; between them: {all}.",
    "no rows": "This kind has no rows.",
    "other kind": "This is for another kind of activity.",
}
LABELS: Mapping[str, str] = {
    new.TITLE: "name",
    new.KIND: "kind",
    new.TEAMS: "who answers",
    new.POINTS: "points for right answers",
    new.MEDIA: "pictures or sounds",
    new.ITEM: "each round brings",
    new.TURNS: "people take turns",
    new.WIN_AT: "points to win",
    new.CLAIM: "people call",
    new.PATTERN: "what wins",
    new.NUMBERS: "highest number",
    new.ROUNDS: "in one game",
    new.WELCOME: "welcome",
    new.GOODBYE: "at the end",
    new.ASK: "question",
    "song": "song",
    "move": "movement",
    "pair": "pair",
}
PARTS: Mapping[str, str] = {
    new.RIGHT: "right: {}",
    new.WRONG: "wrong: {}",
    new.HINT: "hint: {}",
    new.PICTURE: "picture: {}",
    new.SOUND: "sound: {}",
}
EACH_IN_TURN = "each person in turn"
MORE_ROWS = "one more"
EXAMPLES = "Tangy's examples ({}); change them in the table"
UNEVEN = "      {teams} teams cannot share {rounds} evenly: some get one more. Even: {even}."
FROM_FILE = "   {} from your file"
SUMMARY_OF_TEAMS = "{} teams, 10 minutes; you need nothing else"
COMMENT = "# {title}. Try it with: tangy activity try {name}.toml"
THINK_IT_OVER, TALK_IT_OVER = "Think it over.", "Talk it over."
MORE = "Take a moment, and think of something nice."
STORY = "A fine pair!"
HINT_OF_TWO = "Take your time, and trust your first thought."


def question_lines(draft: Draft, key: str) -> list[str]:
    """Return a question, with its choices, and with what Enter means in brackets."""
    base, number = split_key(key)
    item = draft.said.get(new.ITEM, "").capitalize()
    asked = QUESTIONS[base].format(n=number, folder=folder_words(str(draft.folder)), item=item)
    default = draft.default(key)
    if number and base == draft.fields[0]:
        ends = ENDS if number > 1 else ENDS_EMPTY
        asked += (ends if not default else "") + ":"
    lines = [f"{asked} [{_said(base, default)}]" if default else asked]
    if base == new.KIND:
        game = next(name for name, kind in draft.examples.kinds.items() if kind == new.CARDS)
        told = {kind: KIND_WORDS[kind].format(game=game.capitalize()) for kind in new.KINDS}
        lines += [f"  {n} {kind}: {told[kind]}" for n, kind in enumerate(new.KINDS, 1)]
    if base == new.PATTERN:
        lines += [f"  {n} {one}" for n, one in enumerate(draft.examples.patterns, 1)]
    return lines


def folder_words(folder: str) -> str:
    """Name a folder in a sentence."""
    return "this folder" if folder == "." else folder


def problem_words(problem: Problem) -> str:
    """Tell why an answer cannot be taken, and what to type."""
    named = problem.named
    if problem.code == "no file":
        named = (named[0], folder_words(named[1]))
    return PROBLEMS[problem.code].format(*named, count=len(named), all=", ".join(named))


def draft_lines(draft: Draft) -> list[str]:
    """List the answers with the numbers by which they can be changed."""
    lines = []
    for number, (label, keys) in enumerate(answers(draft), 1):
        lines.append(f"  {number:2}  {label}: {_told(draft, keys)}")
    rounds, teams = draft.number(new.ROUNDS) if draft.kind == new.QUIZ else 0, draft.teams()
    if teams and rounds % teams:
        low = rounds - rounds % teams
        fair = [n for n in (low, low + teams) if 0 < n <= draft.table_size()]
        even = " or ".join(map(str, fair)) or "none"
        asked = counted(rounds, LABELS[new.ASK])
        lines.append(UNEVEN.format(teams=teams, rounds=asked, even=even))
    if draft.imported:
        lines.append(FROM_FILE.format(counted(draft.imported, LABELS[new.ASK])))
    return lines


def answers(draft: Draft) -> list[tuple[str, list[str]]]:
    """Return the answers in their order, a row of the table as one: its words and its questions."""
    found = list[tuple[str, list[str]]]()
    for key in draft.questions():
        base, number = split_key(key)
        noun = draft.said.get(new.ITEM) or LABELS.get(base, "")
        if not number:
            found.append((LABELS[base], [key]))
        elif base == draft.fields[0] and draft.said.get(key):
            found.append((f"{noun} {number}", [row_key(f, number) for f in draft.fields]))
        elif base == draft.fields[0]:
            rows = MORE_ROWS if number > 1 else f"{noun}s"
            found.append((rows, [key]))
    return found


def _told(draft: Draft, keys: Sequence[str]) -> str:
    base, number = split_key(keys[0])
    said = draft.said.get(keys[0], "")
    if number and not said:
        sample = draft.examples.rows.get(draft.kind, 2)
        return EXAMPLES.format(sample) if number == 1 else NOTHING
    if base == new.TEAMS:
        return " · ".join(listed_answers(said)) or EACH_IN_TURN
    if base in new.YES_OR_NO:
        return _said(base, said) or NOTHING
    parts = [(split_key(key)[0], draft.said.get(key, "")) for key in keys]
    return " · ".join(PARTS.get(part, "{}").format(text) for part, text in parts if text)


def _said(base: str, text: str | None) -> str:
    if base in new.YES_OR_NO and text:
        return {"y": "yes", "n": "no"}[text]
    return text or ""


def written_lines(toml: str, table: str, *, cards: bool = False, options: str = "") -> list[str]:
    """Tell which files were written, and what to do next with the options of the call."""
    name = shlex.quote(toml)
    also = f" and {table}" if table else ""
    tried = [] if cards else [f"  tangy activity try {name}"]
    return [
        f"Written: {toml}{also}. Next:",
        *tried,
        f"  tangy teach --guided --activity {name}{options}",
        f"  tangy learn --activity {name}{options}",
        f"  tangy play --activity {name}{options}",
        f"Change what you like in the files, then: tangy activity check {name}",
    ]

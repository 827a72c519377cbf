"""The grammar of typed commands for games, on screens and in the console.

The parsers return `None` for words that are no command. The caller then takes them as an answer
if Tangy asks, or as a behaviour in words for the phrasebook while teaching. Any sentence that
means to stop the robot is a STOP.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection
from contextlib import suppress

from tangy_profiles.activity import Activity
from tangy_profiles.errors import TangyError
from tangy_profiles.game_rules import NO_RULES, GameRules
from tangy_profiles.reading import plain
from tangy_tui.app.game_commands import (
    AUTONOMY,
    DIRECTIONS,
    LONGEST_DRIVE,
    Accept,
    Acknowledge,
    AskFor,
    CallAgain,
    CallExpert,
    ChangePace,
    Clear,
    Drive,
    EndGame,
    GameCommand,
    GiveBack,
    GoOn,
    LetWin,
    OneStep,
    Pause,
    Reached,
    SetAutonomy,
    StopRobot,
    TakeBackCall,
    TakeOver,
    Tell,
    VoidResponse,
)
from tangy_tui.app.plan_grammar import read_planned
from tangy_tui.app.request_grammar import read_request, tells_a_fall, without_courtesy
from tangy_tui.language.steering import steering_of
from tangy_tui.language.stop_sentence import stops
from tangy_tui.learning.verification import Reply

ANSWERS = {"y": True, "yes": True, "n": False, "no": False}
LONGEST_NUMBER = 4  # digits
LEAVING = ("quit", "exit", "leave", "leave the game", "go home")


FIXED: dict[str, GameCommand] = {
    **dict.fromkeys(("pause", "wait a moment"), Pause()),
    **dict.fromkeys(("go on", "continue", "resume", "go"), GoOn()),
    **dict.fromkeys(("step", "one step", "next step"), OneStep()),
    **dict.fromkeys(("take over", "let me say"), TakeOver()),
    **dict.fromkeys(("give back", "go on by yourself"), GiveBack()),
    **dict.fromkeys(("call again", "repeat the number", "say it again"), CallAgain()),
    **dict.fromkeys(("take back", "take the call back", "call back"), TakeBackCall()),
    **dict.fromkeys(("faster", "call faster"), ChangePace(1)),
    **dict.fromkeys(("slower", "call slower"), ChangePace(-1)),
    **dict.fromkeys(("several winners", "more than one winner"), LetWin(several=True)),
    "one winner": LetWin(several=False),
    **dict.fromkeys(("visits on", "visit everybody"), LetWin(visits=True)),
    "visits off": LetWin(visits=False),
    **dict.fromkeys(("seen", "acknowledge", "i have seen it"), Acknowledge()),
    **dict.fromkeys(("expert", "call expert", "call the expert"), CallExpert()),
    **dict.fromkeys(("reached", "i have reached them"), Reached()),
    **dict.fromkeys(("clear", "cleared", "all is well"), Clear()),
    **dict.fromkeys(("all right", "that is all right"), Accept()),
    **dict.fromkeys(("end", *LEAVING), EndGame()),
}
"""Complete commands; help shows the first wording of each."""

_DRIVE = re.compile(r"drive (\w+)(?: (?:for )?(\d{1,3}(?:\.\d{1,2})?)(?: ?s| seconds?)?)?")
_ABOUT = re.compile(r"(ask for|help for|void|void the response of) (.+)", re.I)
_TOLD = re.compile(r"(.{1,60}?)(:| says| answers| answered) (\S.*)", re.I)
_ANSWER = re.compile(r"(?:answer:|the answer is) (\S.*)", re.I)
_POLITE = (
    r"(?:please |can you |could you |will you |would you |why don['\u2019]t you |why not "
    r"|how about you |tangy,? |let tangy |now |you )*"
)
_GO_THERE = re.compile(
    rf"{_POLITE}(?:help(?: out)?|assist|visit|look after|see to|attend to|take care of|check on"
    r"|go(?: over| back| first| now| next)? (?:to|and help|and see|and visit|help|see|visit)"
    r"|(?:drive|come|move)(?: over| back)? to|send (?:tangy|it|the robot|help) to)"
    r" (.+?)(?: and help(?: her| him| them)?)?(?:,? (?:please|now|first|next|quickly|too))*",
    re.I,
)
_NEEDS = re.compile(
    r"(.+?) (?:needs|wants|would like|asks for|is asking for|asked for|has asked for)"
    r"(?: some| a| tangy's| your)? (?:help|visit|hand|assistance|you|tangy|the robot)"
    r"(?:,? (?:please|now|first|next|too))*",
    re.I,
)
"""Ways to ask for help for a person."""
_NO_PERSON = re.compile(
    r"(?:(?:front|home|me|us|him|her|them|it|you|everybody|everyone|all|people|somebody|someone"
    r"|nobody|i|we|user|person|place|table)$|(?:the|a|your|my|this|that|with|at|in|out|to) )"
)
"""What names nobody."""
_END = re.compile(
    rf"{_POLITE}(?:let us |let['\u2019]s |we )?(?:end|finish|leave|close)"
    r"(?: (?:the|this|our) (?:game|quiz|round|session|(?P<title>.+?))| game)"
    r"(?:,? (?:please|now|here|today|for today))*",
)
"""Ways to end the game."""
_WINNERS = re.compile(
    rf"{_POLITE}(?:(?:let|make|have) (?:it |there be )?|(?:we |i )want |with |for )?"
    r"(?:(?P<one>(?:only |just )?(?:one|a single|1)(?: (?:winner|person|of them|player))?"
    r"(?: (?:can |may |should )?wins?)?)"
    r"|(?:several|many|more(?: than one)?|all|two) winners?"
    r"|(?:everybody|everyone|they all|all of them|all|several(?: people)?)(?: who has it)?"
    r" (?:can |may |should )?wins?)"
    r"(?:,? (?:only|please|now|today|this time|again|at once|at the same time|per game))*"
)
"""Ways to say whether several people can win, if they name a win."""
_DIAL = re.compile(r"autonomy (\w+)")


def read_command(
    text: str,
    find_person: Callable[[str], str],
    game: Collection[str] = (),
    rules: GameRules = NO_RULES,
) -> GameCommand | None:
    """Parse words as a command; None if they are none of these.

    Args:
        text: what was typed or heard.
        find_person: returns the id of a person by name or id.
        game: the words of the activity's title.
        rules: the choices that the activity gives staff.

    Raises:
        TangyError: they resemble a command, but a part of it is wrong; one sentence.
    """
    whole = " ".join(text.split()).strip(" .!").casefold()
    if whole in FIXED or (whole := steering_of(text) or whole) in FIXED:
        return FIXED[whole]
    said = without_courtesy(text).strip(" .!")
    words = said.casefold()
    if words == "stop" or stops(text, game) or tells_a_fall(text, find_person):
        return StopRobot()
    if words in FIXED:
        return FIXED[words]
    if (winners := _WINNERS.fullmatch(words)) and re.search(r"\bwin", words):
        return LetWin(several=winners["one"] is None)
    if (planned := read_planned(said, find_person, rules)) is not None:
        return planned
    if dial := _DIAL.fullmatch(words):
        level = next((one for one in AUTONOMY if one == dial[1]), None)
        if level is None:
            raise TangyError(plain(f"There is no autonomy {dial[1]!r}: {', '.join(AUTONOMY)}."))
        return SetAutonomy(level)
    if about := _ABOUT.fullmatch(said):
        person = find_person(about[2])
        voids = about[1].casefold().startswith("void")
        return VoidResponse(person) if voids else AskFor(person)
    if told := _read_told(said, find_person):
        return told
    if drive := _DRIVE.fullmatch(words):
        direction = next((one for one in DIRECTIONS if one == drive[1]), None)
        if direction is None:
            known = ", ".join(DIRECTIONS)
            raise TangyError(plain(f"Tangy cannot drive {drive[1]!r}: {known}."))
        seconds = float(drive[2] or 1)
        if seconds > LONGEST_DRIVE:
            raise TangyError(f"One line drives for {LONGEST_DRIVE:g} s at most.")
        return Drive(direction, seconds)
    return None


def read_help(text: str, find_person: Callable[[str], str]) -> AskFor | None:
    """Parse plain words that ask for help for a person: "help Rosa", "Rosa needs help".

    While Tangy asks what to do next, such words are the answer instead.

    Args:
        text: what was typed.
        find_person: returns the id of a person by name or id.

    Raises:
        TangyError: nobody is called so; one sentence.
    """
    said = " ".join(text.split()).strip(" .!?")
    if (there := _GO_THERE.fullmatch(said)) and not _NO_PERSON.match(there[1].casefold()):
        try:
            return AskFor(find_person(there[1]))
        except TangyError:
            if there[1].count(" ") <= 1:
                raise
    if needs := _NEEDS.fullmatch(said):
        with suppress(TangyError):  # it may be an answer in words
            return AskFor(find_person(needs[1]))
    return None


def read_end(text: str, game: Collection[str] = ()) -> EndGame | None:
    """Parse plain words that end the game: "end the game", "please finish the bingo now".

    While Tangy asks what to do next, such words are the answer instead: it says goodbye.

    Args:
        text: what was typed.
        game: the words of the activity's title.
    """
    ends = _END.fullmatch(" ".join(text.split()).strip(" .!?").casefold())
    named = ends is not None and set((ends["title"] or "").split()) <= set(game)
    return EndGame() if named else None


def read_telling(line: str, find_person: Callable[[str], str]) -> Tell:
    """Parse a report about a person: "NAME: words", or words about the person the game waits for.

    Raises:
        TangyError: nobody has the name before the colon; one sentence.
    """
    said = " ".join(line.split())
    return _read_told(said, find_person) or Tell(None, said)


def _read_told(said: str, find_person: Callable[[str], str]) -> Tell | None:
    """Parse a report about a person; None if the words are not one.

    Raises:
        TangyError: nobody has the name before the colon; one sentence.
    """
    if answer := _ANSWER.fullmatch(said):
        return Tell(None, answer[1])
    if told := _TOLD.fullmatch(said):
        try:
            return Tell(find_person(told[1]), told[3])
        except TangyError:
            if told[2] == ":":
                raise
    return None


def command_reader(
    activity: Activity,
    find_person: Callable[[str], str],
    asks: Callable[[], bool] = lambda: False,
) -> Callable[[str], GameCommand | None]:
    """Return a command parser for games of an activity; see `read_command`.

    Args:
        activity: the activity.
        find_person: returns the id of a person by name or id.
        asks: returns whether staff say what Tangy does next; then "go to Rosa" and "end the game"
            are no commands.
    """
    title = frozenset(activity.title.casefold().split())

    def read(text: str) -> GameCommand | None:
        command = read_command(text, find_person=find_person, game=title, rules=activity.rules)
        if command is not None or asks():
            return command
        request = read_end(text, title) or read_request(text)
        return request or read_help(text, find_person)

    return read


def read_answer(text: str) -> Reply | None:
    """Parse the answer to a verification: yes, no, or the number of an alternative."""
    words = text.strip().casefold()
    if words in ANSWERS:
        return Reply(ANSWERS[words])
    if words.isdecimal() and words.isascii() and len(words) <= LONGEST_NUMBER:
        return Reply(yes=False, alternative=int(words))
    return None

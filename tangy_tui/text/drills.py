"""Words for drills, on the screen and in the console: rounds, corrections, and score sheets."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from datetime import datetime
from types import MappingProxyType
from typing import TYPE_CHECKING, assert_never

from tangy_profiles.health import OK
from tangy_profiles.reading import plain
from tangy_tui.monitoring.drill import ACTIONS, Drill, DrillAsks, DrillOption, Question, StaffDoes
from tangy_tui.monitoring.evidence import STATES
from tangy_tui.text.numbers import counted
from tangy_tui.text.situations import state_words
from tangy_tui.text.times import day_and_time

if TYPE_CHECKING:
    from tangy_profiles.drill_sheet import AnsweredRound, Sheet
    from tangy_tui.monitoring.drill_policy import DrillNote
    from tangy_tui.monitoring.drill_rounds import DrillSimulator, Round

StyledLine = tuple[str, str]
"""A line and its ink (an ink of the screens: text, dim, strong, ...)."""

CLASS_WORDS: Mapping[str, str] = MappingProxyType(
    {
        "expert": "critical, the expert",
        "user": "help at the table",
        "teacher": "say what to do",
        "continue": "Tangy goes on",
        "none": "nothing wrong",
    }
)
"""The classes of faults on the score sheet."""

RELEASE = "The expert was here and says: try it now. Seen: {seen}."
WELCOME = (
    "Each round shows what staff see at one moment of a game. Say what is wrong and what you "
    "would do. None of it is real. Tangy keeps only your score."
)
KEPT = "Your earlier answers are kept as an unfinished drill."
NOTHING_KEPT = "Nothing was kept, because you did not finish the first round."
NOTHING_MOVES = "Nothing is moving: this is a rehearsal without the robot."
HELP = "Type the number or letter of an answer, or quit."

_QUIET = {
    "refused": "People may refuse. Tangy asks again, and after a while leaves it at that.",
    "late": "It was done. Late counts as no for how Tangy asks next time, and is no fault.",
    "asks": "People who ask for help wait their turn; Tangy comes by itself.",
    "reading": "That is how it should be.",
}


def note_words(note: DrillNote) -> str:
    """Tell why a drill does not use the learnt policy, and what it uses instead."""
    return f"{_instead(note)}: for this drill a scripted teacher has shown the game."


def _instead(note: DrillNote) -> str:
    match note:
        case "nothing learnt":
            return "Tangy has learnt nothing yet"
        case "unusable":
            return "What Tangy has learnt cannot be used"
        case "changed":
            return "What Tangy has learnt has changed"
        case "gaps":
            return "What Tangy has learnt has gaps"
        case forgotten:
            assert_never(forgotten)


def action_words(action: StaffDoes) -> str:
    """Name an action of staff."""
    match action:
        case "continue":
            return "Let Tangy go on by itself"
        case "user":
            return "Help it: do what it asks for"
        case "teacher":
            return "Say what Tangy should do"
        case "expert":
            return "Keep people away, call the expert, then clear"
        case forgotten:
            assert_never(forgotten)


def option_words(question: Question, option: DrillOption) -> str:
    """Name an answer to a question."""
    if question.kind == "what":
        return option.name if option.value else "Nothing is wrong"
    if question.kind == "do":
        return _done(option.value)
    return option.value.capitalize()


def asked_words(kind: DrillAsks) -> str:
    """Ask a question of a round."""
    match kind:
        case "what":
            return "What is it?"
        case "do":
            return "What do you do?"
        case "clear":
            return "May Tangy be cleared now?"
        case forgotten:
            assert_never(forgotten)


def round_parts(table: DrillSimulator, shown: Round) -> list[tuple[str, str]]:
    """Describe what staff see in a round: pairs of a label and a sentence."""
    activity, acted = table.activity, shown.acted
    just = "The game has only begun."
    if acted is not None:
        target = f" ({table.name(acted.action.target)})" if acted.action.target else ""
        just = f"{acted.action.behaviour.question}{target}. It said: {acted.speech}"
    where = state_words(activity, shown.state, shown.scene, table.name)
    parts = [
        ("Now", f"{activity.in_words(shown.state.situation)}. {where}"),
        ("Just done", just),
        ("Noticed", f"{shown.noticed}."),
        ("Devices", device_words(shown.devices)),
    ]
    return [(label, plain(text)) for label, text in parts]


def device_words(devices: Sequence[tuple[str, str]]) -> str:
    """Summarise the state of all devices; faulty ones are named."""
    by_state: dict[str, list[str]] = {}
    for label, state in devices:
        by_state.setdefault(state, []).append(label)
    well = by_state.pop(OK, [])
    if not by_state:
        return "None reports an error."
    parts = [
        f"{', '.join(labels)}: {STATES.get(state, state)}"
        if well or len(by_state) > 1
        else f"all {len(labels)}: {STATES.get(state, state)}"
        for state, labels in by_state.items()
    ]
    if well:
        parts.append(f"no error from the other {counted(len(well), 'device')}")
    return "; ".join(parts) + "."


def question_words(question: Question, shown: Round) -> str:
    """Return the question; one about clearing includes the observations at that moment."""
    if question.kind == "clear" and shown.release is not None:
        return f"{RELEASE.format(seen=shown.release.seen)} {asked_words(question.kind)}"
    return asked_words(question.kind)


def told_lines(table: DrillSimulator, shown: Round, answered: AnsweredRound) -> list[StyledLine]:
    """Tell the right answers of a round, the reasons, and the advice."""
    fault = shown.fault
    what = "nothing was wrong" if fault is None else fault.name
    lines = [_verdict(answered.named_right, what, _named(table, answered.named))]
    lines.append(
        _verdict(answered.acted_right, _action(answered.recovery), _action(answered.acted))
    )
    if answered.may_clear is not None:
        yes = "it is mended, so Tangy may be cleared"
        no = "it is still there, so Tangy must not be cleared"
        said = "yes" if answered.cleared else "no"
        lines.append(
            _verdict(answered.cleared_right is True, yes if answered.may_clear else no, said)
        )
    if fault is None:
        lines.append(("text", f"Why: {shown.noticed}. {_QUIET.get(shown.quiet, '')}"))
    else:
        lines.append(("text", f"Why: {fault.why}. {fault.console}"))
        lines.append(("strong", "What should I do?"))
        lines += [("text", f"{number}. {step}") for number, step in enumerate(fault.advice, 1)]
    points = f"{answered.points} of {counted(answered.most, 'point')}, {answered.seconds:.0f} s."
    lines.append(("dim", points))
    return [(ink, plain(text)) for ink, text in lines]


def _verdict(right: bool, was: str, said: str) -> StyledLine:
    if right:
        return "good", f"Right: {was}."
    return "bad", f"Not quite. Right would be: {was}. You said: {said}."


def _named(table: DrillSimulator, code: str) -> str:
    return table.rule_name(code) if code else "nothing is wrong"


def _action(recovery: str) -> str:
    words = _done(recovery)
    return words[0].lower() + words[1:]


def _done(recovery: str) -> str:
    return next(action_words(action) for action in ACTIONS if action == recovery)


def sheet_lines(sheet: Sheet, width: int = 80, before: Sheet | None = None) -> list[StyledLine]:
    """Format a score sheet for a width in characters: table, totals, and what to rehearse again.

    `before` is the person's previous sheet.
    """
    state = "" if sheet.finished else f", left after {len(sheet.answered)} of {sheet.rounds}"
    took = "" if sheet.median is None else f" Median time {sheet.median:.0f} s."
    lines: list[StyledLine] = [
        ("strong", f"{sheet.who}: {sheet.points} of {counted(sheet.most, 'point')}{state}.{took}")
    ]
    if before is not None:
        lines.append(("dim", f"The last time: {before.points} of {counted(before.most, 'point')}."))
    name_width = max(12, min(44, width - 32))
    lines.append(("dim", f" #  {'What it was':{name_width}}  Named  Done  Clear    s"))
    for one in sheet.answered:
        marks = f"{_mark(one.named_right):5}  {_mark(one.acted_right):4}  "
        marks += f"{_mark(one.cleared_right):5}  {one.seconds:3.0f}"
        ink = "text" if one.points == one.most else "warn"
        lines.append((ink, f"{one.number:2}  {_cut(one.name, name_width)}  {marks}"))
    for kind, (points, most) in sheet.by_class.items():
        lines.append(("text", f"{CLASS_WORDS[kind]:>{name_width + 4}}  {points} of {most}"))
    if not sheet.again:
        lines.append(("good", "Nothing to rehearse again: all of it was right."))
        return [(ink, plain(text)) for ink, text in lines]
    lines += [("text", ""), ("strong", "To rehearse again:")]
    for one in sheet.again:
        lines.append(("text", f"{one.name}: {_action(one.recovery)}."))
        lines += [("dim", f"  {number}. {step}") for number, step in enumerate(one.advice, 1)]
    return [(ink, plain(text)) for ink, text in lines]


def _mark(right: bool | None) -> str:
    return "-" if right is None else "yes" if right else "NO"


def _cut(text: str, width: int) -> str:
    return text.ljust(width) if len(text) <= width else f"{text[: width - 1]}…"


def sheets_lines(sheets: Sequence[Sheet], when: Callable[[str], str], who: str = "") -> list[str]:
    """List earlier sheets (of one person), the oldest first; `when` formats a time of the log."""
    if not sheets:
        return ["No drill yet: tangy drill begins one."]
    if who:
        names = sorted({sheet.who for sheet in sheets})
        sheets = [sheet for sheet in sheets if sheet.by(who)]
        if not sheets:
            return [plain(f"No drill of {who} yet; there are sheets of {', '.join(names)}.")]
    wide = max(len("Who"), *(len(sheet.who) for sheet in sheets))
    lines = [f"{'When':16}  {'Who':{wide}}  Rounds   Points  Median s  To rehearse again"]
    for sheet in sheets:
        rounds = f"{len(sheet.answered)} of {sheet.rounds}"
        points = f"{sheet.points} of {sheet.most}"
        took = "-" if sheet.median is None else f"{sheet.median:.0f}"
        again = ", ".join(one.name for one in sheet.again) or "nothing"
        line = (
            f"{when(sheet.at):16}  {sheet.who:{wide}}  {rounds:>8} {points:>8}  {took:>8}  {again}"
        )
        lines.append(plain(line))
    return lines


def left_words(drill: Drill) -> str:
    """Tell which answers of an unfinished drill are stored."""
    return KEPT if drill.sheet.answered else NOTHING_KEPT


GO_ON = ("resume", "go on with it", "your answers so far count")
NEW_DRILL = ("new", "begin a new one", "the other one is kept as an unfinished drill")
NO_INTERRUPTED_DRILL = (
    "No drill was interrupted: there is nothing to go on with. Leave --resume out."
)


def interrupted_words(sheet: Sheet) -> str:
    """Tell that a drill was interrupted, and after which round."""
    when = day_and_time(datetime.fromisoformat(sheet.at))
    return f"A drill was interrupted after {len(sheet.answered)} of {sheet.rounds} rounds ({when})."


def begins_anew(sheet: Sheet) -> str:
    """Tell that a new drill begins, and that the interrupted one is stored unfinished."""
    return f"{interrupted_words(sheet)} It is kept as an unfinished drill, and a new drill begins."


def goes_on(sheet: Sheet) -> str:
    """Tell that an interrupted drill resumes."""
    return f"{interrupted_words(sheet)} It goes on now. `tangy drill --discard` begins a new one."


NO_HURRY = "There is no hurry: you see your time, but it does not count."
SEE_NOW = "What you see"
SAW = "What you saw"
WAS_RIGHT = "What was right"
LEAVE = "Leave the drill?"
LEAVE_DETAIL = "Your answers are kept as an unfinished drill."
SHEET_KEPT = "The sheet is kept."


def so_far_words(sheet: Sheet) -> str:
    """Tell the points of a drill so far."""
    return f"{sheet.points} of {sheet.most} so far."

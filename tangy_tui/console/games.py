"""Games line by line: what happens, and a teacher who answers where Tangy is not sure."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tangy_profiles.beliefs import probability_best
from tangy_profiles.demonstration import Demonstration
from tangy_tui.console.faults import advice_lines, attend, fault_lines
from tangy_tui.interaction.game_events import (
    Acted,
    BeliefUpdated,
    DoneOnce,
    GameBegun,
    GameEnded,
    Taught,
    Unsure,
)
from tangy_tui.learning.explanation import explain, why_words
from tangy_tui.learning.verification import (
    ANSWER_HELP,
    ANSWERS,
    NO_QUESTION,
    NotUnderstood,
    Reply,
    Say,
    Verified,
    answer_help,
)
from tangy_tui.monitoring.fault import Diagnosed, Moved
from tangy_tui.monitoring.scripted_people import answer_by_script, clear_by_script
from tangy_tui.monitoring.supervision import Event, Supervision
from tangy_tui.text.situations import ALL_RIGHT, Name, once_words, state_words, verification_lines

Read = Callable[[], str | None]
"""Returns the next line, or None when there are no more."""
Write = Callable[[str], None]
Demonstrations = Callable[[], Sequence[Demonstration]]

HELP = "Answer with a behaviour in words, or type one of: where, why, help, quit."
WHAT = ("what", "what to do", "what should i do", "what should i do?")
MEANINGS = (
    ("where", "say what Tangy sees"),
    ("why", "say why Tangy asks"),
    ("quit", "give the game up"),
)
STOPPED = "STOP: Tangy stands still until you say what it should do."
ACCEPTING = ("all right", "what happened is all right: expect it from now on")
_TAKEN_BACK = {"undo": "undo", "redo": "redo", "again": "show again"}


def game_lines(event: Event, supervision: Supervision, name: Name, teacher: str = "") -> list[str]:
    """Put one event of a game into lines; `teacher` is who answered, where Tangy had asked."""
    activity = supervision.world.activity
    match event:
        case GameBegun(_, number, _):
            return [f"Game {number} begins."]
        case Acted(number, state, decision, choice, action, _, _, speech):
            target = f" ({name(action.target)})" if action.target else ""
            how = f", {choice.strategy}" if choice else ""
            why = f"as {teacher} said" if teacher else f"{decision.share:.0%} of the votes"
            return [
                f"{number}. {activity.in_words(state.situation)} -> "
                f"{action.behaviour.name}{target}{how}, {why}",
                f"   Tangy says: {speech}",
            ]
        case Diagnosed() | Moved():
            return fault_lines(event)
        case BeliefUpdated(response, belief):
            what = "did not follow, which counts as no"
            if response.followed:
                what = "followed, but late, which counts as no"
            if response.complied:
                what = "complied"
            profile = supervision.persuasion.beliefs[response.person]
            best = max(profile, key=lambda strategy: profile[strategy].mean)
            return [
                f"   {name(response.person)} {what} ({response.strategy} now "
                f"{belief.complied} of {belief.trials}; best so far: {best})."
            ]
        case Unsure(_, _, reason):
            return [f"Tangy asks. {reason} What should it do?"]
        case Taught(teacher, lesson):
            return [
                f"   Tangy has learnt that from {teacher}, as {lesson.policy.name!r}.",
                f"   {lesson.replay.words()}",
            ]
        case DoneOnce(_, instead):
            return [f"   {once_words(instead)}"]
        case GameEnded(_, steps, stopped):
            if stopped is not None:
                return [f"The game stopped after {steps} steps. {stopped}"]
            return [f"The game is over after {steps} steps."]


def belief_lines(supervision: Supervision, name: Name) -> list[str]:
    """Put what is believed of everybody into one line each."""
    lines: list[str] = []
    for person, profile in supervision.persuasion.beliefs.items():
        best = probability_best(profile)
        parts = [
            f"{strategy} {belief.complied}/{belief.trials} (best {best[strategy]:.0%})"
            for strategy, belief in profile.items()
        ]
        lines.append(f"{name(person)}: " + ", ".join(parts))
    return lines


def play_by_lines(
    supervision: Supervision,
    games: int,
    name: Name,
    write: Write,
    read: Read | None = None,
    teacher: str = "",
    demonstrations: Demonstrations | None = None,
    *,
    expert: bool = False,
) -> None:
    """Play games and tell everything that happens.

    Args:
        supervision: what runs the games.
        games: how many games.
        name: returns what a person is called.
        write: writes a line.
        read: the lines of a teacher, who answers where Tangy asks; at their end it gives up.
            Without it a scripted teacher answers.
        teacher: who that is.
        demonstrations: gives all there are, on which the grounds of a question rest.
        expert: scripted staff clear what halts the robot; without them whoever types does, and
            without lines the game ends there.
    """
    for _ in range(games):
        if supervision.halted is not None:
            write(f"No other game is begun: nobody cleared {supervision.halted.name!r}.")
            break
        events = supervision.begin()
        while True:
            answered = next((e.teacher for e in events if isinstance(e, Taught | DoneOnce)), "")
            for event in events:
                for line in game_lines(event, supervision, name, answered):
                    write(line)
            if supervision.over:
                break
            if supervision.halted is not None and expert:
                events = clear_by_script(supervision)
            elif supervision.halted is not None and read is None:
                events = supervision.give_up()
            elif supervision.halted is not None and read is not None:
                events = attend(supervision, write, read, teacher)
            elif supervision.question is not None and read is None:
                events = answer_by_script(supervision)
            elif supervision.question is not None and read is not None:
                events = _ask(supervision, name, write, read, teacher, demonstrations)
            else:
                events = supervision.step()
    for line in belief_lines(supervision, name):
        write(line)


def _ask(
    supervision: Supervision,
    name: Name,
    write: Write,
    read: Read,
    teacher: str,
    demonstrations: Demonstrations | None,
) -> list[Event]:
    """Take a command from a teacher, verified by Y as when teaching; none gives the game up."""
    verifier = supervision.verifier()
    if supervision.acceptable:
        write("If all is well, type: all right. What should I do? Type: what.")
    while (line := read()) is not None:
        text = line.strip()
        lower = text.lower()
        if not text or text.startswith("#"):
            continue
        if lower in ("quit", "exit", "leave"):
            break
        if verifier.stops(text):
            if verifier.question is not None:
                verifier.reply(Reply(yes=False))
            write(STOPPED)
            continue
        if verifier.question is not None:
            if lower in ANSWERS:
                said = verifier.reply(Reply(yes=ANSWERS[lower]))
            elif lower.isdecimal():
                said = verifier.reply(Reply(yes=False, alternative=int(lower)))
            else:
                asks_help = lower in ("help", "?")
                for words in answer_help(verifier.question) if asks_help else [ANSWER_HELP]:
                    write(words)
                continue
        elif lower in ALL_RIGHT and supervision.acceptable:
            return supervision.accept(teacher)
        elif lower in WHAT and (lines := advice_lines(supervision)):
            for words in lines:
                write(words)
            continue
        elif (told := _told(supervision, name, lower, demonstrations)) is not None:
            for words in told:
                write(words)
            continue
        else:
            said = verifier.say(Say(text))
        if isinstance(said, Verified):
            return supervision.answer(said.behaviour, said.target, teacher)
        for words in verification_lines(said):
            write(words)
        if isinstance(said, NotUnderstood):
            write(HELP)
    return supervision.give_up()


def _told(
    supervision: Supervision, name: Name, word: str, demonstrations: Demonstrations | None
) -> list[str] | None:
    """Return what is said to a word that is no behaviour, or None."""
    world = supervision.world
    first = word.split()[0]
    if word in ANSWERS:
        return [NO_QUESTION]
    if word in _TAKEN_BACK or (first == "again" and word.split()[-1].isdecimal()):
        return [f"There is nothing to {_TAKEN_BACK[first]} here: answer, or quit."]
    match word:
        case "help" | "?":
            spoken = [
                f"  {b.question}: say {b.phrases[0]!r}" for b in world.activity.behaviours.values()
            ]
            more = [*MEANINGS, *([ACCEPTING] if supervision.acceptable else [])]
            return [HELP, *spoken, *(f"  {word}: {meaning}" for word, meaning in more)]
        case "where":
            state = world.observe()
            seen = state_words(world.activity, state, world.scene(), name)
            return [f"Now: {world.activity.in_words(state.situation)}. {seen}"]
        case "why":
            return why_lines(supervision, demonstrations)
    return None


def why_lines(supervision: Supervision, demonstrations: Demonstrations | None) -> list[str]:
    """Say on what grounds Tangy asks, or else does what it does now.

    Without the demonstrations it is said at least by which votes.
    """
    question, world = supervision.question, supervision.world
    situation = world.observe().situation if question is None else question.state.situation
    if demonstrations is not None:
        return why_words(world.activity, explain(supervision.policy, demonstrations(), situation))
    decision = supervision.policy.decide(situation) if question is None else question.decision
    votes = ", ".join(f"{behaviour} {share:.0%}" for behaviour, share in decision.votes)
    reason = world.activity.in_words(situation) if question is None else question.reason
    return [reason, f"Votes of the trees: {votes}."]

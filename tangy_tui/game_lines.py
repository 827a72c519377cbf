"""Games line by line: what happens, and a teacher who answers where Tangy is not sure."""

from __future__ import annotations

from collections.abc import Callable

from tangy_profiles.beliefs import probability_best
from tangy_tui.interaction.facilitation import (
    Acted,
    Facilitation,
    GameBegun,
    GameEnded,
    GameEvent,
    Learnt,
    Taught,
    Unsure,
)
from tangy_tui.interaction.scripted_answers import answer_by_script
from tangy_tui.learning.verifying import Reply, Say, Verified
from tangy_tui.wording import Name, verification_lines

Read = Callable[[], str | None]
"""Returns the next line, or None when there are no more."""
Write = Callable[[str], None]


def game_lines(event: GameEvent, facilitation: Facilitation, name: Name) -> list[str]:
    """Put one event of a game into lines."""
    activity = facilitation.world.activity
    match event:
        case GameBegun(_, number, _):
            return [f"Game {number} begins."]
        case Acted(number, state, decision, choice, action, _, _, speech):
            target = f" ({name(action.target)})" if action.target else ""
            how = f", {choice.strategy}" if choice else ""
            return [
                f"{number}. {activity.in_words(state.situation)} -> "
                f"{action.behaviour.name}{target}{how}, {decision.share:.0%} of the votes",
                f"   Tangy says: {speech}",
            ]
        case Learnt(response, belief):
            what = "complied" if response.complied else "followed, but late"
            profile = facilitation.persuasion.beliefs[response.person]
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
        case GameEnded(_, steps, stopped):
            if stopped is not None:
                return [f"The game stopped after {steps} steps. {stopped}"]
            return [f"The game is over after {steps} steps."]


def belief_lines(facilitation: Facilitation, name: Name) -> list[str]:
    """Put what is believed of everybody into one line each."""
    lines: list[str] = []
    for person, profile in facilitation.persuasion.beliefs.items():
        best = probability_best(profile)
        parts = [
            f"{strategy} {belief.complied}/{belief.trials} (best {best[strategy]:.0%})"
            for strategy, belief in profile.items()
        ]
        lines.append(f"{name(person)}: " + ", ".join(parts))
    return lines


def play_by_lines(
    facilitation: Facilitation,
    games: int,
    name: Name,
    write: Write,
    read: Read | None = None,
    teacher: str = "",
) -> None:
    """Play games and tell everything that happens.

    Args:
        read: the lines of a teacher, who answers where Tangy asks; at their end it gives up.
            Without it a scripted teacher answers.
        teacher: who that is.
    """
    for _ in range(games):
        events = facilitation.begin()
        while True:
            for event in events:
                for line in game_lines(event, facilitation, name):
                    write(line)
            if facilitation.over:
                break
            if facilitation.question is not None and read is None:
                events = answer_by_script(facilitation)
            elif facilitation.question is not None and read is not None:
                events = _ask(facilitation, name, write, read, teacher)
            else:
                events = facilitation.step()
    for line in belief_lines(facilitation, name):
        write(line)


def _ask(
    facilitation: Facilitation, name: Name, write: Write, read: Read, teacher: str
) -> list[GameEvent]:
    """Take a command from a teacher, verified by Y as when teaching; none gives the game up."""
    verifier = facilitation.verifier()
    activity = facilitation.world.activity
    while (line := read()) is not None:
        text = line.strip()
        lower = text.lower()
        if not text or text.startswith("#"):
            continue
        if lower in ("quit", "exit", "leave") and verifier.question is None:
            break
        if verifier.question is None:
            if lower in ("help", "?"):
                for behaviour in activity.behaviours.values():
                    write(f"  {behaviour.question}: say {behaviour.phrases[0]!r}")
                write("  quit: give the game up")
                continue
            said = verifier.say(Say(text))
        elif lower in ("y", "n"):
            said = verifier.reply(Reply(yes=lower == "y"))
        elif lower.isdigit():
            said = verifier.reply(Reply(yes=False, alternative=int(lower)))
        else:
            write("Please answer Y to execute it, or N to give a new command.")
            continue
        if isinstance(said, Verified):
            return facilitation.answer(said.behaviour, said.target, teacher)
        for words in verification_lines(said, activity):
            write(words)
    return facilitation.give_up()

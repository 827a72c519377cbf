"""Words for changes in a game other than Tangy's behaviours."""

from __future__ import annotations

from collections.abc import Callable
from typing import assert_never

from tangy_profiles.activity import Activity
from tangy_profiles.game_records import GameChange
from tangy_profiles.planned_game import PlannedGame
from tangy_tui.interaction.game_events import GameChanged
from tangy_tui.text.numbers import counted
from tangy_tui.world import World

Name = Callable[[str], str]


def changed_lines(event: GameChanged, activity: Activity, name: Name) -> list[str]:
    """Tell what changed, and what Tangy says to the group about it."""
    said = [f"   Tangy says: {event.said}"] if event.said else []
    return [changed_words(event, activity, name), *said]


def changed_words(event: GameChanged | GameChange, activity: Activity | None, name: Name) -> str:
    """Describe a change in a sentence, for the game or for the log."""
    person = name(event.person) if event.person else ""
    match event.what:
        case "taken back":
            call = str(event.number) if activity is None else activity.deck.label(event.number)
            return f"{call} is taken back. Tangy calls it again later."
        case "patterns chosen":
            return f"Next: {pattern_words(activity, event.patterns)}."
        case "others first":
            return f"{person} has won. First Tangy goes to the others who may have won as well."
        case "played on":
            return f"{person} has won. The game goes on."
        case "won":
            return f"Tangy goes back to {person}, who has won."
        case "claimed":
            return f"Tangy goes to {person}, whose card wins."
        case "left":
            return f"{person} has left. Tangy no longer goes there."
        case "came":
            return f"{person} is here now."
        case "joined":
            return f"{person} has joined."
        case "visit":
            return f"Tangy has not visited {person} for a while, and goes there in turn."
        case "visit put off":
            return f"Others are asking, so {person}'s visit waits."
        case "visit over":
            return f"{person} has had a visit."
        case "calls first":
            return calls_first_words(event.number)
        case "all called":
            return "All numbers have been called. Tangy goes to each person and looks at the card."
        case "nobody won":
            who = "nobody else has won" if event.number else "nobody has won"
            return f"All numbers have been called, and {who}."
        case "several winners":
            return "Everybody who has the pattern at the same call wins."
        case "one winner":
            return "Only one person wins."
        case "visits on":
            return "Tangy also visits people who do not ask."
        case "visits off":
            return "Tangy visits only people who ask."
        case "pace":
            return "The pace has changed."
        case forgotten:
            assert_never(forgotten)


def calls_first_words(calls: int) -> str:
    """Tell how many calls come before the visits to people who asked, and why."""
    return (
        "Tangy has visited several people, and everybody waits for a number. It first calls "
        f"{counted(calls, 'number')}, then goes to those who ask."
    )


def pattern_words(activity: Activity | None, names: tuple[str, ...]) -> str:
    """Name patterns in order, by their labels."""
    labels = (
        list(names) if activity is None else [activity.rules.pattern(name).label for name in names]
    )
    return ", then ".join(labels) or "nothing more"


def patterns_line(world: World) -> str:
    """Name the pattern to play for, those that follow, and those to choose from."""
    names = ", ".join(pattern.name for pattern in world.activity.rules.patterns)
    if not isinstance(world, PlannedGame) or not names:
        return "There is nothing to choose in this activity."
    played = world.patterns
    now = "" if played.present is None else f"Now: {played.present.label}. "
    then = ", then ".join(pattern.label for pattern in played.left)
    return f"{now}{f'Next: {then}. ' if then else ''}You can choose: {names}."


def cards_line(world: World, name: Name) -> str:
    """Tell whose card is whose, as far as Tangy knows."""
    if not isinstance(world, PlannedGame) or not world.activity.deck.columns:
        return "This activity has no cards."
    known = [f"{name(person)} has card {card}" for person, card in world.known_cards.items()]
    unknown = [name(person) for person in world.people if person not in world.known_cards]
    told = f"{', '.join(known)}." if known else "Tangy does not know whose card is whose."
    if not unknown:
        return told
    others = "Tell Tangy the others" if known else "Tell Tangy"
    return f"{told} {others}, as in: {unknown[0]} has card 17."

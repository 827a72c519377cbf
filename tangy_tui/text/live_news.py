"""A live game in lines: behaviours, owners of cards, and seats."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from tangy_hw.dealt_cards import CardDoubt, CardLearnt
from tangy_profiles.game_records import CallMade
from tangy_tui.app.seats import Seated
from tangy_tui.interaction.game_events import Acted, GameEnded
from tangy_tui.text.calls import logged_words
from tangy_tui.text.games import ended_words, paused_lines

if TYPE_CHECKING:
    from tangy_tui.app.card_news import CardNote
    from tangy_tui.app.live_games import News
    from tangy_tui.monitoring.supervision import Event

Name = Callable[[str], str]

MANY = {2: "two", 3: "three", 4: "four"}


def live_lines(events: Sequence[Event], news: Iterable[News], name: Name) -> list[str]:
    """Describe the events and news of a live game in lines."""
    told = (event_words(event, name) for event in events)
    return [*filter(None, told), *news_lines(news, name)]


def news_lines(news: Iterable[News], name: Name) -> Iterator[str]:
    """Describe news about cards and seats, except what staff reported themselves."""
    for one in news:
        words = seated_words(one, name) if isinstance(one, Seated) else note_words(one, name)
        if words:
            yield words


def event_words(event: Event, name: Name) -> str:
    """Describe an event in one line; "" if it needs none."""
    match event:
        case Acted(number=number, action=action, outcome=outcome, speech=speech):
            whom = "" if action.target is None else f" ({name(action.target)})"
            done = "" if outcome.completed else "  not finished"
            return f"{number:4} {action.behaviour.question}{whom}: {speech}{done}"
        case CallMade(role=role, way=way, stage=stage, said=said):
            return logged_words(role, way, stage, said)
        case GameEnded(pauses=pauses):
            return " ".join([ended_words(event), *paused_lines(*pauses)])
    return ""


def seated_words(seated: Seated, name: Name) -> str:
    """Tell who sits at another person's seat."""
    who = name(seated.person)
    if seated.person == seated.place:
        return f"{who} sits at {who}'s place again."
    return f"{who} sits at {name(seated.place)}'s place: Tangy speaks to {who}."


def note_words(note: CardNote, name: Name) -> str:
    """Describe a note about cards for staff; "" if they know it already."""
    match note.news:
        case CardLearnt():
            return learnt_words(note.news, name)
        case CardDoubt():
            return doubt_words(note.news, name)
    return ""


def learnt_words(learnt: CardLearnt, name: Callable[[str], str]) -> str:
    """Tell staff which owner Tangy assumes for a card."""
    return f"Card {learnt.card} lies in front of {name(learnt.person)}: Tangy takes it for theirs."


def doubt_words(doubt: CardDoubt, name: Callable[[str], str]) -> str:
    """Tell staff why Tangy does not judge a card, and what they can do."""
    whom, count = name(doubt.person), len(doubt.cards)
    many = MANY.get(count, str(count))
    *first, last = map(str, doubt.cards)
    cards = f"{', '.join(first)} and {last}" if first else last
    none = "neither" if count == 2 else "none"
    match doubt.why:
        case "copies":
            return (
                f"There are {many} copies of card {doubt.cards[0]} in front of {whom}. Tangy "
                f"cannot tell which is theirs, and judges {none}: leave one there."
            )
        case "several cards":
            return (
                f"There are {many} cards in front of {whom}: {cards}. Tangy cannot tell which "
                f"is theirs, and judges {none}: leave one there."
            )
        case "another's card":
            return (
                f"The card in front of {whom}, {cards}, is {name(doubt.owner)}'s, as far as Tangy "
                "knows. Tangy does not judge it."
            )
        case "other card":
            return (
                f"The card in front of {whom} is {cards}; theirs is {doubt.own}, as far as Tangy "
                "knows. Tangy does not judge it."
            )

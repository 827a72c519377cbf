"""Words for the search of an activity's games: its findings, and how far it came."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice
from typing import TYPE_CHECKING

from tangy_profiles.declared.vocabulary import ADDRESSED, ASKING, ITEMS, PLACE, TURN
from tangy_tui.text.numbers import counted

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_profiles.declared.activity import DeclaredActivity
    from tangy_profiles.declared.checking import ActivityFlaw, Findings
    from tangy_profiles.declared.search import Cut
    from tangy_profiles.declared.search_way import Event
    from tangy_profiles.declared.state_keys import StateFactor
    from tangy_tui.learning.coverage_proof import CoverageProof

MOST_SHARES = 3
"""How many of the facts that multiply the states most are named."""
MOST_SITUATIONS = 6
"""How many situations without a way to the end are listed."""
POSSIBLE_ALWAYS = "From then on only these are possible:"
EXPECTED_ALWAYS = "From then on 'expected' names only these:"
IN_VAIN = "(Tangy cannot do it here: look at its 'needs' and 'to')"
"""Said of what would end the game."""
BUILT_IN = {
    ITEMS: "the rounds",
    TURN: "the turns",
    ASKING: "the requests for help",
    PLACE: "the robot's place",
    ADDRESSED: "the person spoken to last",
    "last to act": "'last to act'",
    "quietest": "'quietest'",
}
"""Parts of a state besides the facts of the file."""


def finding_words(source: str, found: ActivityFlaw) -> str:
    """Describe a flaw of an activity, in one line that names the place."""
    name = repr(found.name)
    match found.flaw:
        case "stage never reached":
            words = f"stages: no game reaches the stage {name}"
        case "situation never reached":
            words = f"stages: this situation never occurs: {found.name}"
        case "fact never changes":
            words = f"facts.{found.name}: nothing ever sets it"
        case "fact never cleared":
            words = f"facts.{found.name}: once it has changed, no behaviour sets it back"
        case "fact never looked at":
            words = f"facts.{found.name}: no stage, condition or text looks at it"
        case "behaviour never possible":
            words = f"behaviours.{found.name}: it can never be chosen; check 'needs' and 'to'"
        case "text lacks a word":
            words = f"behaviours.{found.name}: {found.text!r} lacks a word when it is said"
        case "repeated in vain":
            words = (
                f"behaviours.{found.name}: it changes nothing here, so Tangy would repeat it until "
                f"people do something: {found.text}; expect something else after a timer"
            )
        case "never ends":
            as_expected = found.dead_end is not None and found.dead_end.as_expected
            games = "a game as in 'expected' never ends" if as_expected else "no game can end"
            words = f"stages: from here {games}: {found.name}"
        case "nothing possible":
            words = (
                f"behaviours: here none of them is possible: {found.name}; check 'needs' and 'to'"
            )
    return f"{source}: {words}."


def dead_end_lines(activity: DeclaredActivity, found: ActivityFlaw) -> Iterator[str]:
    """Tell the shortest way to a dead end, and what can be done there."""
    end = found.dead_end
    if end is None:
        return
    teams = bool(activity.teams)
    games = f"games of {_sizes_words((end.players,), teams=teams)}"
    yield f"The shortest way there, in {games}{' that go as expected' if end.as_expected else ''}:"
    if not end.counterexample.way:
        yield "  It is where each game begins."
    for number, step in enumerate(end.counterexample.way, 1):
        whom = f" ({_player(step.whom)})" if step.whom is not None else ""
        yield f"  {number}. {activity.in_names(step.situation)} -> {step.behaviour}{whom}"
        yield from (f"     then {_event_words(event)}" for event in step.then)
    if found.flaw == "nothing possible":
        return
    yield EXPECTED_ALWAYS if end.as_expected else POSSIBLE_ALWAYS
    for situation, behaviours in islice(end.counterexample.possible.items(), MOST_SITUATIONS):
        named = ", ".join(
            f"{one} {IN_VAIN}" if activity.behaviours[one].ends else one for one in behaviours
        )
        yield f"  {activity.in_names(situation)} -> {named}"
    more = len(end.counterexample.possible) - MOST_SITUATIONS
    if more > 0:
        yield f"  and {counted(more, 'more situation')}"


def _event_words(event: Event) -> str:
    """Tell what happens after a behaviour: time in s, or acts of people."""
    if isinstance(event, float):
        return f"{event:.0f} s pass"
    return "; ".join(
        f"{f'{_player(act.who)}: ' if act.who else ''}{act.fact} is {act.value}" for act in event
    )


def _player(id: str) -> str:
    """Name a player of a search: the people in it have no names, but teams do."""
    return {"one": "player 1", "other": "player 2"}.get(id, id)


def shares_words(shares: Sequence[StateFactor]) -> str:
    """Tell which facts multiply the states most, and how an author can reduce them."""
    named = [
        f"{BUILT_IN.get(one.name, repr(one.name))} ({one.times:.1f} times as many)"
        for one in shares[:MOST_SHARES]
    ]
    return (
        f"What makes the most states: {', '.join(named)}. For fewer, give these facts fewer values"
        " or bands, clear them when they no longer matter, or name them in fewer conditions."
    )


def proof_words(activity: Activity, found: CoverageProof) -> list[str]:
    """Tell for which groups a search of all games has proved full coverage."""
    teams = bool(activity.teams)
    reached = counted(len(found.reached), "situation")
    lines = []
    if found.proved:
        lines.append(f"Tangy searched all games of {_sizes_words(found.proved, teams=teams)}.")
    lines += [
        f"Tangy could not search all games of {_sizes_words((size,), teams=teams)}: "
        f"{_cut_words(one.cut, one.states)}"
        for size, one in found.searches
        if one.cut
    ]
    if not teams:
        lines.append("Larger groups were not searched.")
    if found.open:
        lines.append(f"{reached} came about, and in these Tangy would ask you:")
        lines += [
            f"  {activity.in_words(one)}{': for whom?' if why else ''}"
            for one, why in found.open.items()
        ]
    else:
        lines.append(f"{reached} came about, and each was shown.")
    if found.stuck is not None:
        lines.append(f"From here no game ends: {activity.in_words(found.stuck)}.")
    return lines


def search_lines(found: Findings, *, teams: bool) -> list[str]:
    """Tell how far the games of an activity were searched, and what did not occur by then."""
    tried = [one for one in found.searches if not one.as_expected]
    whole = tuple(one.players for one in tried if not one.cut)
    lines = [f"searched all games of {_sizes_words(whole, teams=teams)}."] if whole else []
    lines += [
        f"not searched to the end: games of {_sizes_words((one.players,), teams=teams)}"
        f"{' that go as expected' if one.as_expected else ''}. "
        f"{_cut_words(one.cut, one.states)}"
        for one in found.searches
        if one.cut
    ]
    shares = next((one.shares for one in found.searches if one.shares), ())
    if shares:
        lines.append(shares_words(shares))
    if found.not_met:
        names = ", ".join(one.name for one in found.not_met)
        lines.append(f"did not come up by then, and may be impossible: {names}.")
    return lines


def _cut_words(cut: Cut, states: int) -> str:
    why = "the time for it was over" if cut == "time" else "there are too many"
    return f"The search stopped after {counted(states, 'state')}, because {why}."


def _sizes_words(sizes: Sequence[int], *, teams: bool) -> str:
    """Format group sizes: "1, 2 and 3 players"."""
    *first, last = map(str, sizes)
    both = f"{', '.join(first)} and {last}" if first else last
    noun = "team" if teams else "player"
    return f"{both} {noun if list(sizes) == [1] else noun + 's'}"

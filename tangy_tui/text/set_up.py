"""Words of the set-up of a live game."""

from __future__ import annotations

from collections.abc import Sequence
from typing import assert_never

from tangy_tui.app.readiness import Check, CheckName
from tangy_tui.app.set_up import Choice, SetUp
from tangy_tui.text.missing_devices import missing_words
from tangy_tui.text.numbers import listed
from tangy_tui.text.register import staff_names
from tangy_tui.text.rooms import room_words

TITLE = "Set up"
PEOPLE, GAME, READY = "Who is here, and where they sit", "The game", "Is everything ready?"
HERE, NOT_HERE = "here", "not here"
SOUND = "Hello. Can everybody hear me?"
CARD_HOW = "Hold a card in front of Tangy, then press Enter."
NO_CARD = "Tangy saw no card. Hold one closer, flat, and in good light."
NO_SOUND = "Tangy could not speak. Check its loudspeaker."
SWITCH_FIRST = "First press Enter on Robot: Tangy is still off."
SEATED = "Tangy is on: people and seats stay. Leave with esc to change them."
PATTERNS_HOW = "Press the numbers of the patterns, in the order you want."
SEATS = "The room"
CHOICES: dict[Choice, str] = {
    "seats": "the seats",
    "patterns": "the patterns to play for",
    "strength": "how strongly Tangy speaks",
}
TEAMS_PLAY = "Teams play this activity: people are not added one by one."
ACTIVITY, ROOM = "Activity", "Room"
ON_DUTY, WHO_IS_ON_DUTY = "On duty", "Who is on duty?"
TYPES_NAME = "(Enter: another name)"
DUTY_DETAIL = "Reports show this name for what staff do."
ADD, ADD_GUEST, RENAME = "Who has come?", "Is {} here for good?", "What is {} called?"
FOR_GOOD, TODAY = "takes part from today on", "is a guest today"
FOR_GOOD_NOTE, TODAY_NOTE = "Tangy remembers the person", "Tangy forgets the person tomorrow"
NAME_DETAIL = "Tangy calls people by this name."
LOOKS = "Tangy looks. One moment ..."
STILL_BUSY = "One moment: Tangy is still busy."
CARRIED = "{}: the arrows go to another seat, space puts down."
CHANGES = "{} and {} change seats? Space: yes, esc: no."
BENCH_CARD = "On the bench nobody holds a card up. Tangy reads cards in the game."
BENCH_FACE = "On the bench nobody comes to Tangy. It sees people in the game."
FACE_HOW = "Stand in front of Tangy, one person at a time."
NO_FACE = "Tangy knows nobody it sees. Stand closer, or press Enter on the name."
WHOSE = "Whose card is {}?"
OTHER_ACTIVITY = "Tangy is on: the activity stays. Leave with esc to change it."
SAID = "Tangy has spoken. Press Enter if you heard it."
STOPPED = "Tangy was stopped. Begin the game when all is well."
SAID_BY_LINES = "Tangy has spoken. Type heard if you heard it, or sound to hear it again."
NO_FACE_BY_LINES = "Tangy knows nobody it sees. Stand closer, and type face again. Or begin."
TRY_LINES = (
    "Try Tangy: card reads a card that you hold up, face looks who is there, sound lets it speak. "
    "Then type begin, or end."
)
UNHEARD = "Sound: nobody has said yet that they heard Tangy."
BEGIN_ANYWAY = "Begin although not everything is ready?"
LEAVE = "Leave without a game?"
LEAVE_DETAIL = "Who is away, the seats and the choices for the game are not kept. New people are."
BEGIN_DETAIL = "Tangy starts moving and speaking."

NAMES: dict[CheckName, str] = {
    "robot": "Robot",
    "battery": "Battery",
    "tablet": "Tablet on its chest",
    "cards": "Cards",
    "faces": "Faces",
    "sound": "Sound",
}


def dropped_words(dropped: Sequence[Choice]) -> str:
    """Tell which choices the new activity does not have; "" if it kept all."""
    if not dropped:
        return ""
    lost = ", ".join(CHOICES[one] for one in dropped)
    return f"Not kept, as this activity has other choices: {lost}."


NOT_READY = "NOT READY"
"""The state of a robot that is on, with a device that is not well."""
BEGIN_HOW = "{begin} begins the game: hold Shift and press b."


def robot_words(check: Check) -> str:
    """Tell the state of the robot for the status line, from its check."""
    return {"off": "OFF", "not ready": NOT_READY}.get(check.state, "OK")


def people_words(setup: SetUp) -> str:
    """Tell how many people are here."""
    return f"{len(setup.seats) - len(setup.away)} of {len(setup.seats)} are here"


def carried_words(setup: SetUp, person: str) -> str:
    """Tell how to carry a person who is picked up, and who changes seats with them."""
    if setup.world is not None:
        return SEATED
    name = setup.workspace.name
    other = setup.changes_with(person)
    return CHANGES.format(name(person), name(other)) if other else CARRIED.format(name(person))


def patterns_words(setup: SetUp) -> str:
    """Name the patterns to play for."""
    rules, deck = setup.workspace.activity.rules, setup.workspace.activity.deck
    if labels := [rules.pattern(name).label for name in setup.patterns]:
        return ", then ".join(labels)
    usual = [one.label for one in rules.patterns if one.on(deck) == deck]
    return f"{usual[0]}, as usual" if usual else "as usual"


def pattern_keys(setup: SetUp) -> str:
    """Name the patterns with their numbers."""
    patterns = setup.workspace.activity.rules.patterns
    return ", ".join(f"{number} {one.name}" for number, one in enumerate(patterns, 1))


def winners_words(setup: SetUp) -> str:
    """Tell how many people can win."""
    return "everybody with the pattern at the same call" if setup.several else "one"


def visits_words(setup: SetUp) -> str:
    """Say whom Tangy visits."""
    return "also people who do not ask" if setup.visits else "only people who ask"


def strength_words(setup: SetUp) -> str:
    """Tell how strongly Tangy may speak to people."""
    strengths = setup.workspace.activity.rules.strengths
    chosen = next((one.label for one in strengths if one.name == setup.strength), "")
    return chosen or "as Tangy has learnt"


def minutes_words(minutes: int) -> str:
    """Tell the planned length of the session, in minutes."""
    return f"{minutes} minutes" if minutes else "as long as you like"


def pace_words(pace: float) -> str:
    """Tell the pace: `pace` is in s from call to call."""
    return f"a call every {pace:g} s"


def check_words(check: Check) -> str:
    """Tell the state of a check, and what to do if it failed."""
    match check.state:
        case "off":
            return "off: Enter switches it on" if check.name == "robot" else "when Tangy is on"
        case "ready":
            return _ready(check)
        case "not checked":
            return _to_try(check.name)
        case "not told":
            return _NOT_TOLD[check.name]
        case "not ready":
            return _to_do(check)
        case forgotten:
            assert_never(forgotten)


_NOT_TOLD: dict[CheckName, str] = {
    "robot": "nothing is known of it",
    "battery": "no device of this robot tells its charge",
    "tablet": "this robot has no tablet",
    "cards": "this robot reads none",
    "faces": "Tangy knows no faces here",
    "sound": "this robot has no loudspeaker",
}


def _to_try(name: CheckName) -> str:
    match name:
        case "cards":
            return "Enter reads one: its owner is here"
        case "faces":
            return "Enter looks who is there"
        case _:
            return "Enter lets Tangy speak"


def not_ready_words(check: Check) -> str:
    """Tell in a sentence which check failed, and what to do."""
    if check.name == "sound":
        return UNHEARD
    return f"{NAMES[check.name]}: {_to_do(check)}."


def summary_words(checks: Sequence[Check]) -> str:
    """Summarise the checks in a line."""
    if all(check.state == "off" for check in checks):
        return "Tangy is off: nothing is checked yet"
    wrong = [NAMES[check.name] for check in checks if check.state == "not ready"]
    untried = [NAMES[check.name] for check in checks if check.state == "not checked"]
    if wrong:
        return f"not ready: {', '.join(wrong)}".lower()
    return f"ready; not tried: {', '.join(untried)}".lower() if untried else "all is ready"


def card_seen_words(card: str, name: str) -> str:
    """Tell whose card was read, and that they are here."""
    return f"Card {card}: {name} is here."


def whose_line(card: str) -> str:
    """Ask at the lines whose card was read."""
    return f"{WHOSE.format(card)} Type: Rosa has card {card}."


def face_seen_words(name: str) -> str:
    """Tell who was recognised, and that they are here."""
    return f"{name} is here."


def _ready(check: Check) -> str:
    match check.name:
        case "robot":
            return "on, and all its devices work"
        case "battery":
            return check.about
        case "tablet":
            return f"connected, {check.about}"
        case "cards":
            return f"card {check.about} was read"
        case "faces":
            return f"{check.about} was seen last"
        case "sound":
            return "heard"
        case forgotten:
            assert_never(forgotten)


def _to_do(check: Check) -> str:
    match check.name:
        case "robot":
            return f"check: {check.about}"
        case "battery":
            return f"{check.about}: charge it first"
        case "tablet":
            return f"open {check.about} on it"
        case "cards":
            return CARD_HOW
        case "faces":
            return FACE_HOW
        case "sound":
            return "did you hear it? Enter: yes"
        case forgotten:
            assert_never(forgotten)


def line_of(check: Check) -> str:
    """Tell the state of a check in line mode, which has no keys."""
    unchecked = check.state == "not checked"
    return "not tried" if unchecked else check_words(check)


def lines_of(setup: SetUp) -> list[str]:
    """Describe the set-up line by line."""
    name = staff_names(setup.workspace.name)
    people = (
        f"  {seat}. {name(person)}: {NOT_HERE if person in setup.away else HERE}"
        for seat, person in enumerate(setup.seats, 1)
    )
    return [
        f"{PEOPLE}: {people_words(setup)}.",
        *people,
        f"{ACTIVITY}: {setup.workspace.activity.title}. "
        f"{ROOM}: {room_words(setup.workspace.room, setup.workspace.chosen_room)}.",
        *_game_lines(setup),
        *missing_words(setup.workspace.robot, setup.workspace.activity),
    ]


def as_before_words(setup: SetUp) -> str:
    """Tell what a game takes from the last one if nobody sets it up."""
    name = staff_names(setup.workspace.name)
    away = [name(person) for person in setup.seats if person in setup.away]
    here = f"Not here: {listed(away)}." if away else "Everybody is here."
    return " ".join(("As you left your last game.", here, *_game_lines(setup)))


def _game_lines(setup: SetUp) -> list[str]:
    """Describe the choices for the game; without patterns there are fewer."""
    pace = f"Pace: {pace_words(setup.pace)}. " if setup.calls else ""
    pace = f"{pace}Time: {minutes_words(setup.minutes)}. {ON_DUTY}: {setup.on_duty}."
    if not setup.workspace.activity.rules.patterns:
        return [pace, f"Tangy's words: {strength_words(setup)}."]
    return [
        f"Played for: {patterns_words(setup)}. Winners: {winners_words(setup)}.",
        pace,
        f"Tangy visits {visits_words(setup)}. Its words: {strength_words(setup)}.",
    ]

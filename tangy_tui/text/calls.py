"""Whom to call about a fault that halts a robot, and the state of such calls."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from tangy_profiles.contacts import EXPERT, STAFF_ROLE, Contact
from tangy_profiles.reading import plain

if TYPE_CHECKING:
    from tangy_profiles.robot import Robot
    from tangy_tui.monitoring.calls import CallState
    from tangy_tui.monitoring.supervision import Supervision

SIMULATED = "The simulated expert has looked at it."
CALLS_NOBODY = "Tangy calls nobody itself."
TEST_CALL = "This is a test of how Tangy calls you. Nothing is wrong."
REHEARSAL = "This is a rehearsal: the robot is simulated. Nothing is wrong."


def nobody_named(role: str) -> str:
    """Tell that a robot's file names nobody for a role, and how to name somebody."""
    return f"nobody is named; add [{role}] to the robot's file, as in tangy.toml."


def whom_to_call(robot: Robot) -> str:
    """Tell whom staff call for what they cannot repair, or that nobody is named."""
    expert = robot.expert
    if expert is None:
        return "No expert is named for this robot: ask your facility who looks after it."
    return plain(f"Call the expert, {_named(expert)}.")


def _named(contact: Contact) -> str:
    return f"{contact.name}: {contact.telephone}" if contact.telephone else contact.name


def calling_words(contact: Contact) -> str:
    """Tell that a contact is being called, and their number in case nobody answers."""
    return plain(f"Tangy calls {_named(contact)} ...")


def call_words(state: CallState) -> str:
    """Tell the state of a call; a contact is reached only when they have answered."""
    contact = state.contact
    then = f"Nobody has answered yet: call {_named(contact)}."
    match state.stage:
        case "tried":
            words = f"Tangy is sending a message to {contact.name}. {then}"
        case "sent":
            words = f"Tangy has sent a message to {contact.name}. {then}"
        case "failed":
            words = f"Tangy cannot reach {contact.name} ({state.said}). {then}"
        case "answered" if state.way:
            words = f"{contact.name} was reached: they answered on the {state.way}."
        case "answered":
            said = f": {state.said.rstrip('.')}" if state.said else ""
            words = f"{contact.name} was reached, and answered{said}."
        case "reached":
            words = f"{contact.name} was reached, by {state.said}."
        case forgotten:
            assert_never(forgotten)
    return plain(words)


def logged_words(role: str, way: str, stage: str, said: str) -> str:
    """Describe the result of a call for the log."""
    if stage == "reached":
        return plain(f"The {role} was reached, by {said}.")
    stages = {
        "tried": "a message is being sent",
        "sent": "a message was sent, and not answered yet",
        "answered": "was reached, and answered",
        "failed": "could not be reached",
    }
    told = f": {said}" if said else ""
    return plain(f"The {role} ({way}): {stages.get(stage, stage)}{told}.")


def expert_words(game: Supervision) -> str:
    """Tell the state of the call to the expert, or whom staff have to call themselves."""
    state = None if game.calls is None else game.calls.state(EXPERT)
    if state is not None:
        return call_words(state)
    if (contact := None if game.calls is None else game.calls.to_call(EXPERT)) is not None:
        return calling_words(contact)
    return f"{whom_to_call(game.robot)} {CALLS_NOBODY}"


def advised_call(game: Supervision) -> str:
    """Tell whom staff call for what they cannot repair, or that this person was reached."""
    state = None if game.calls is None else game.calls.state(EXPERT)
    return call_words(state) if state is not None and state.over else whom_to_call(game.robot)


def staff_words(game: Supervision) -> str:
    """Tell the state of the call to staff, "" if there is none."""
    state = None if game.calls is None else game.calls.state(STAFF_ROLE)
    return "" if state is None else call_words(state)


def expert_line(game: Supervision) -> str:
    """Tell who is called about the fault that halts Tangy, or whom staff should call."""
    from tangy_sim.worlds.faulty_world import FaultyWorld

    return SIMULATED if isinstance(game.world, FaultyWorld) else expert_words(game)


def waits_line(game: Supervision, asked: str) -> str:
    """Tell the state of the calls, then what Tangy waits for."""
    if game.calls is None:
        return asked
    states = (game.calls.state(EXPERT), game.calls.state(STAFF_ROLE))
    return " ".join([*(call_words(state) for state in states if state is not None), asked])


def tried_words(contact: Contact, stage: str, said: str = "") -> str:
    """Describe the result of a test call to a contact."""
    number = contact.telephone or "no telephone number is given"
    match stage:
        case "answered":
            return plain(f"a test message was answered{f': {said}' if said else ''} ({number})")
        case "failed":
            return plain(f"a test message could not be sent: {said} ({number})")
        case "none":
            return plain(f"neither a command nor a url is given, so staff call: {number}")
    return plain(f"a test message was sent, and not answered so far ({number})")

"""Observes a person's response to a request in a live game."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_profiles.behaviour import Action, Behaviour
from tangy_profiles.state import Response

if TYPE_CHECKING:
    from tangy_hw.robot_client.live_world import LiveWorld

LOOK_SECONDS = 0.5  # between two looks at the person
PATIENCES = 2.0  # windows of patience after which the request counts as ignored


def watch_response(world: LiveWorld, action: Action, numbers: tuple[int, ...]) -> Response | None:
    """Observe the response of the person beside the robot; None if it cannot be observed."""
    place, patience = world.tracker.place, world.activity.patience
    person = world.who(place)
    if world.eyes is not None and action.behaviour.corrects:
        told = world.eyes.response(action, place, person)
        world.tracker.seen = world.judged(place, world.eyes.state)
        return told
    with world.commands.waiting_for("response", person, PATIENCES * patience):
        return _watch(world, action, numbers, person)


def _watch(
    world: LiveWorld, action: Action, numbers: tuple[int, ...], person: str
) -> Response | None:
    """Look until a request has been carried out, or counts as ignored."""
    patience = world.activity.patience
    began = before = world.link.time
    while True:
        done = _is_done(world, action.behaviour, numbers)
        now = world.link.time
        seconds = (before + now) / 2 - began  # it was done between the two looks
        if done:
            return Response(person, action.strategy, True, seconds <= patience, seconds)
        if now - began > PATIENCES * patience:
            if action.behaviour.only_talks or world.cards.view is None:
                return None  # a sign that stays up may be forgotten, or mean something else
            return Response(person, action.strategy, False, False, now - began)
        before = now


def _is_done(world: LiveWorld, behaviour: Behaviour, numbers: tuple[int, ...]) -> bool:
    """Look whether a request has been carried out."""
    place = world.tracker.place
    if behaviour.only_talks:
        world.commands.wait(LOOK_SECONDS)
        world.commands.settle()
        return place not in world.requests.signs
    card = world.cards.look(place, world.called, LOOK_SECONDS, person=world.who(place))
    done = world.cards.shows_done(card, behaviour, numbers)
    if done:
        world.cards.looked("card", place, card)
    if place in world.tracker.queue:
        world.tracker.seen = world.state_on(card)
    return done

"""Facilitation: the policy decides, persuasion chooses the words, and every step is logged."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from random import Random

import pytest

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Action
from tangy_profiles.beliefs import Beta
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.game_records import GameEnding
from tangy_profiles.state import Outcome, Situation
from tangy_profiles.store import Store
from tangy_sim.worlds.users import load_users
from tangy_sim.worlds.world import SimulatedWorld
from tangy_tui.interaction import facilitation as room
from tangy_tui.interaction.facilitation import Facilitation
from tangy_tui.interaction.game_events import Acted, BeliefUpdated, GameBegun, GameEnded, GameEvent
from tangy_tui.interaction.persuasion import Persuasion
from tangy_tui.learning.policy import Policy, learn_policy
from tests.interaction.conftest import FEW, acts, play

Cover = Callable[[str, int, int], tuple[Demonstration, ...]]

Make = Callable[..., Facilitation]


def without(policy: Policy, situation: Situation, **change: object) -> Policy:
    """The same policy, except for its decision in one situation."""
    decision = replace(policy.decide(situation), **change)  # type: ignore[arg-type]
    return replace(policy, table={**policy.table, situation: decision})


def test_a_game_is_played_from_the_greeting_to_the_goodbye(facilitate: Make) -> None:
    events = play(facilitate())
    assert isinstance(events[0], GameBegun)
    names = [act.action.behaviour.name for act in acts(events)]
    assert (names[0], names[-2:]) == ("greeting", ["celebrate", "valediction"])
    assert isinstance(events[-1], GameEnded)
    assert (events[-1].steps, events[-1].stopped) == (len(names), None)


def test_every_step_follows_the_policy_for_the_observed_state(
    facilitate: Make, policy: Policy, activity: Activity
) -> None:
    for number, act in enumerate(acts(play(facilitate(2))), 1):
        assert act.number == number
        assert act.decision == policy.decide(act.state.situation)
        assert act.action.behaviour == activity.behaviours[act.decision.behaviour]
        assert act.action.target == (act.state.attended if act.action.behaviour.attends else None)
        assert act.right
        assert act.after.step == act.state.step + 1


def test_a_strategy_is_chosen_only_for_persuading_behaviours(
    facilitate: Make, activity: Activity
) -> None:
    events = play(facilitate(3), 6)
    for act in acts(events):
        behaviour = act.action.behaviour
        assert (act.choice is not None) == behaviour.persuades
        if act.choice is None:
            assert act.action.strategy == activity.plain_strategy
        else:
            assert act.choice.person == act.action.target
            assert act.action.strategy == act.choice.strategy
            assert act.action.speech == behaviour.speech[act.choice.strategy]
    assert len({act.action.strategy for act in acts(events)}) == 4


def test_the_speech_names_the_person_and_the_numbers(facilitate: Make, activity: Activity) -> None:
    for act in acts(play(facilitate(4), 4)):
        assert "{" not in act.speech + act.image
        template = activity.behaviours[act.action.behaviour.name].speech[act.action.strategy]
        if "{name}" in template:
            assert act.action.target is not None
            assert f"User {act.action.target[-1]}" in act.speech
        for number in act.outcome.numbers:
            assert activity.deck.label(number) in act.speech


def test_each_response_updates_the_posterior_of_the_used_strategy(facilitate: Make) -> None:
    facilitation = facilitate(5)
    counted: dict[tuple[str, str], Beta] = {}
    acted: Acted | None = None
    for event in play(facilitation, 8):
        if isinstance(event, Acted):
            acted = event
        if isinstance(event, BeliefUpdated):
            assert acted is not None
            response = event.response
            assert acted.choice is not None
            assert (response.person, response.strategy) == (
                acted.choice.person, acted.choice.strategy,
            )  # fmt: skip
            key = (response.person, response.strategy)
            counted[key] = counted.get(key, Beta()).updated(response.complied)
            assert event.belief == counted[key]
    assert len(counted) > 8
    for (person, strategy), belief in counted.items():
        assert facilitation.persuasion.beliefs[person][strategy] == belief


# ---------------------------------------------------------------------------------- stopping


@pytest.mark.slow
def test_an_undemonstrated_situation_ends_the_game_with_the_reason(
    facilitate: Make, policy: Policy, activity: Activity
) -> None:
    for situation in activity.situations:
        events = play(facilitate(11, without(policy, situation, seen=0)), 8)
        stopped = {e.stopped for e in events if isinstance(e, GameEnded)} - {None}
        assert stopped == {
            "Nobody has shown Tangy what to do here yet: "
            f"{activity.in_words(situation)}. Demonstrate it once."
        }


def test_an_unsure_decision_ends_the_game_with_the_reason(facilitate: Make, policy: Policy) -> None:
    start = Situation("start", "ANR", "occluded")
    ended = play(facilitate(11, without(policy, start, share=0.69)))[-1]
    assert isinstance(ended, GameEnded)
    assert ended.steps == 0
    assert ended.stopped is not None
    assert "not sure" in ended.stopped
    assert "69%" in ended.stopped
    assert acts(play(facilitate(11, without(policy, start, share=0.7))))


def test_a_game_without_progress_is_stopped(
    facilitate: Make, policy: Policy, monkeypatch: pytest.MonkeyPatch, store: Store
) -> None:
    monkeypatch.setattr(room, "MOST_STEPS", 50)
    start = Situation("start", "ANR", "occluded")
    ended = play(facilitate(11, without(policy, start, behaviour="joke")))[-1]
    assert isinstance(ended, GameEnded)
    assert (ended.steps, ended.stopped) == (50, "The game did not end within 50 steps.")
    kept = store.last(GameEnding)
    assert kept is not None
    assert kept.body["stopped"] == ended.stopped


def test_an_unexpected_behaviour_is_not_right(facilitate: Make, policy: Policy) -> None:
    start = Situation("start", "ANR", "occluded")
    facilitation = facilitate(11, without(policy, start, behaviour="joke"))
    facilitation.begin()
    assert not acts(facilitation.step())[0].right


def test_no_steps_follow_the_end_until_the_next_game(facilitate: Make) -> None:
    facilitation = facilitate(12)
    assert facilitation.step() == []
    play(facilitation)
    assert facilitation.step() == []
    begun = facilitation.begin()[0]
    assert isinstance(begun, GameBegun)
    assert (begun.number, facilitation.steps) == (2, 0)


# ------------------------------------------------------------------------------ other settings


@pytest.mark.parametrize("users", range(1, 5))
def test_the_same_seed_plays_the_same_games(users: int, facilitate: Make, store: Store) -> None:
    def told(events: list[GameEvent]) -> list[object]:
        return [e for e in events if isinstance(e, Acted | BeliefUpdated)]

    one = facilitate(13, users=users)
    other = facilitate(13, users=users)
    assert told(play(one, 2)) == told(play(other, 2))


@pytest.mark.slow
def test_a_made_up_activity_is_facilitated(
    lanterns: Activity, cover: Cover, facilitate: Make
) -> None:
    shown = [d for seed in (1, 2) for d in cover("lanterns", seed, 4)]
    learnt = learn_policy(lanterns, shown, settings=FEW)
    events = play(facilitate(14, learnt, lanterns), 10)
    assert all(act.right for act in acts(events))
    endings = [event for event in events if isinstance(event, GameEnded)]
    assert [ending.stopped for ending in endings] == [None] * 10
    assert any(isinstance(event, BeliefUpdated) for event in events)


def test_people_without_mistakes_only_get_a_celebration(
    activity: Activity, policy: Policy, store: Store, ids: tuple[str, ...]
) -> None:
    perfect = replace(load_users(), miss=0, slip=0, ask=0, occluded=0)
    world = SimulatedWorld(activity, ids, seed=1, users=perfect)
    persuasion = Persuasion(ids, tuple(activity.strategies), Random(1))
    events = play(Facilitation(world, policy, persuasion, store, names={}, seed=1), 3)
    assert not any(isinstance(event, BeliefUpdated) for event in events)


def test_a_failed_behaviour_is_no_success(
    facilitate: Make, policy: Policy, monkeypatch: pytest.MonkeyPatch
) -> None:
    execute = SimulatedWorld.execute

    def in_vain(world: SimulatedWorld, action: Action) -> Outcome:
        return execute(world, action)._replace(completed=False)

    monkeypatch.setattr(SimulatedWorld, "execute", in_vain)
    done = acts(play(facilitate(11, policy)))
    assert done
    assert not any(act.right for act in done)

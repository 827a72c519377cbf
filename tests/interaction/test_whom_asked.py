"""If the addressee of a behaviour is unclear, Tangy asks, learns the answer, and continues."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from random import Random

import pytest

from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.store import Store
from tangy_profiles.teaching_records import (
    DemonstrationBegun,
    DemonstrationFinished,
    DemonstrationStep,
)
from tangy_sim.worlds.declared_world import DeclaredWorld
from tangy_tui.interaction.facilitation import Facilitation
from tangy_tui.interaction.game_events import Taught, Unsure
from tangy_tui.interaction.persuasion import Persuasion
from tangy_tui.learning.online_learning import OnlineLearning
from tangy_tui.learning.policy import learn_policy
from tests.support.declared import declared

ACTIVITY = declared("trivia")
PEOPLE = ("user1", "user2", "user3")
REPEAT = "repeat question"


def shown_alone(seed: int) -> Demonstration:
    """Show games with one person, whom every selector names."""
    steps: list[Step] = []
    world = DeclaredWorld(ACTIVITY, PEOPLE[:1], seed=seed)
    for _ in range(40):
        world.begin()
        while not world.over:
            state = world.observe()
            behaviour = ACTIVITY.behaviours[ACTIVITY.expected[state.situation]]
            target = PEOPLE[0] if behaviour.to else None
            world.execute(ACTIVITY.action(behaviour, target, None))
            steps.append(Step(behaviour.name, target, state, world.observe()))
    return Demonstration("alone", "trivia", "test", seed, PEOPLE[:1], tuple(steps), True)


@pytest.mark.slow
def test_disagreeing_selectors_are_asked_about_once(tmp_path: Path) -> None:
    shown = shown_alone(1)
    policy = learn_policy(ACTIVITY, [shown])
    assert policy.whom["repeat", REPEAT] == ("first asking", "whose turn")
    with Store.open(tmp_path, write=True) as store:
        with store.transaction():
            store.append(DemonstrationBegun.from_demonstration(replace(shown, steps=()), kept=0))
            for step in shown.steps:
                shown_step = DemonstrationStep(
                    demonstration=shown.id, step=step, heard="", confidence=1.0
                )
                store.append(shown_step)
            store.append(DemonstrationFinished(demonstration=shown.id))
        game = Facilitation(
            DeclaredWorld(ACTIVITY, PEOPLE, seed=4),
            policy,
            Persuasion(PEOPLE, tuple(ACTIVITY.strategies), Random(1)),
            store,
            names={},
            seed=4,
            answers=OnlineLearning(store, ACTIVITY),
        )
        asked, taught = 0, 0
        for _ in range(10):
            game.begin()
            while not game.over:
                events = game.step()
                question = next((one for one in events if isinstance(one, Unsure)), None)
                if question is None:
                    continue
                asked += 1
                assert question.decision.sure
                asking = dict(question.state.whom)["first asking"]
                done = game.answer(ACTIVITY.behaviours[REPEAT], asking, "ann")
                taught += any(isinstance(one, Taught) for one in done)
        assert (asked, taught) == (1, 1)
        assert game.policy.whom["repeat", REPEAT] == ("first asking",)

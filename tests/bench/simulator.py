"""Steps per second of the simulator with a policy, beside wrapped Gymnasium CartPole.

Run by hand: `python tests/bench/simulator.py` (needs the extra [bench]). Both run in this process,
in turns, so that load on the machine affects both; the ratio of the medians counts. A step of
Tangy: observe the joint state, look up the decision, execute the behaviour. A step of CartPole
is `env.step` of `gymnasium.make("CartPole-v1")` with its default wrappers. The second table
compares a looked-up decision with scikit-learn's `predict_proba` on one row.
"""

from __future__ import annotations

from statistics import median
from time import perf_counter

from tangy_profiles.activity import load_activity
from tangy_profiles.behaviour import Action
from tangy_profiles.demonstration import Demonstration, Step
from tangy_sim.worlds.users import load_users
from tangy_sim.worlds.world import SimulatedWorld
from tangy_tui.learning.policy import Policy, all_situations, encoder, learn_policy

ROUNDS = 9
STEPS = 40_000


def learnt() -> Policy:
    """Learn from three scripted demonstrations."""
    activity = load_activity("bingo")
    shown = []
    for seed in range(3):
        world = SimulatedWorld(
            activity, ("u1", "u2", "u3", "u4"), seed=seed, users=load_users().teaching()
        )
        steps = []
        while not world.over:
            state = world.observe()
            name = activity.expected[state.situation]
            world.execute(activity.action(activity.behaviours[name], state.attended, None))
            steps.append(Step(name, state.attended, state, world.observe()))
        shown.append(
            Demonstration(str(seed), "bingo", "bench", seed, world.people, tuple(steps), True)
        )
    return learn_policy(activity, shown)


def ours(policy: Policy) -> float:
    """Return steps per second of games played one after another."""
    activity = load_activity("bingo")
    people = ("u1", "u2", "u3", "u4")
    world = SimulatedWorld(activity, people, seed=5)
    actions: dict[tuple[str, str | None], Action] = {
        (name, person): activity.action(behaviour, person if behaviour.attends else None, None)
        for name, behaviour in activity.behaviours.items()
        for person in (*people, None)
    }
    begun = perf_counter()
    for _ in range(STEPS):
        state = world.observe()
        decision = policy.decide(state.situation)
        world.execute(actions[decision.behaviour, state.attended])
        if world.over:
            world.begin()
    return STEPS / (perf_counter() - begun)


def cart_pole() -> float:
    """Return steps per second of CartPole with its default wrappers."""
    import gymnasium

    environment = gymnasium.make("CartPole-v1")
    environment.reset(seed=5)
    begun = perf_counter()
    for step in range(STEPS):
        _, _, ended, cut, _ = environment.step(step & 1)
        if ended or cut:
            environment.reset()
    return STEPS / (perf_counter() - begun)


def lookup(policy: Policy) -> tuple[float, float]:
    """Return seconds for one decision: looked up, and computed by the forest."""
    import numpy as np
    from sklearn.ensemble import RandomForestClassifier

    activity = load_activity("bingo")
    situations = list(activity.situations)
    encode = encoder(list(all_situations(activity)))
    rows = np.array([encode(s) for s in all_situations(activity)])
    forest = RandomForestClassifier(n_estimators=100, bootstrap=False, random_state=0)
    forest.fit(rows, [policy.decide(s).behaviour for s in all_situations(activity)])
    begun = perf_counter()
    for _ in range(20_000):
        for situation in situations:
            policy.decide(situation)
    fast = (perf_counter() - begun) / 20_000 / len(situations)
    begun = perf_counter()
    for place in range(100):
        forest.predict_proba(rows[place % len(rows)].reshape(1, -1))
    return fast, (perf_counter() - begun) / 100


def main() -> None:
    """Print both tables."""
    policy = learnt()
    pairs = [(ours(policy), cart_pole()) for _ in range(ROUNDS)]
    mine, theirs = median(p[0] for p in pairs), median(p[1] for p in pairs)
    print(f"steps per second, median of {ROUNDS} turns of {STEPS:,} steps each")
    print(f"  simulator with policy     {mine:12,.0f}")
    print(f"  Gymnasium CartPole        {theirs:12,.0f}")
    print(f"  ratio                     {mine / theirs:12.2f}   (wanted: at least 0.9)")
    fast, slow = lookup(policy)
    print("one decision")
    print(f"  looked up                 {fast * 1e6:12.3f} us")
    print(f"  predict_proba, one row    {slow * 1e6:12.1f} us")
    print(f"  ratio                     {slow / fast:12,.0f}   (wanted: at least 1,000)")


if __name__ == "__main__":
    main()

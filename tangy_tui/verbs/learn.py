"""`tangy learn` and `tangy policy`: make a policy from demonstrations, and show it."""

from __future__ import annotations

from typing import Annotated

import typer

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.verbs.common import (
    ActivityName,
    Data,
    Json,
    Seed,
    open_house,
    print_json,
    say_notices,
)


def learn(
    activity: ActivityName = "bingo",
    forest: Annotated[str, typer.Option(help="exact, or paper for its bagging.")] = "exact",
    name: Annotated[str, typer.Option(help="What to call the policy.")] = "",
    unfinished: Annotated[
        bool, typer.Option("--unfinished", help="Learn from unfinished demonstrations too.")
    ] = False,
    seed: Annotated[int, typer.Option(help="The seed of the forest.")] = 0,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Learn a policy from the demonstrations."""
    from dataclasses import replace

    from tangy_profiles.reading import nearest
    from tangy_tui.documents import policy_document
    from tangy_tui.learning.library import read_demonstrations
    from tangy_tui.learning.policies import keep_policy
    from tangy_tui.learning.policy import FORESTS, learn_policy
    from tangy_tui.wording import counted

    if forest not in FORESTS:
        raise TangyError(f"--forest {plain(forest)}: {nearest(forest, FORESTS)}")
    with open_house(data, activity, 4) as house:
        shown = read_demonstrations(house.store, house.activity.name)
        used = [d for d in shown if d.finished or (unfinished and d.steps)]
        left_out = sum(1 for d in shown if d.steps and d not in used)
        policy = learn_policy(
            house.activity,
            used,
            settings=replace(FORESTS[forest], seed=seed),
            name=plain(name)[:40],
        )
        keep_policy(house.store, policy)
        seen = [s for s in house.activity.situations if policy.decide(s).seen]
        if as_json:
            print_json(
                {
                    **policy_document(house, policy),
                    "steps": sum(len(d.steps) for d in used),
                    "left_out": left_out,
                }
            )
            return
        steps = sum(len(d.steps) for d in used)
        print(
            f"Learnt {policy.name!r} from {counted(len(used), 'demonstration')} ({steps} steps): "
            f"{len(seen)} of {len(house.activity.situations)} situations were shown."
        )
        for situation in house.activity.situations:
            if situation not in seen:
                print(f"  not shown yet: {house.activity.in_words(situation)}")
        if left_out:
            print(
                f"{counted(left_out, 'unfinished demonstration')} left out; "
                "--unfinished learns from them too."
            )


def policy(
    activity: ActivityName = "bingo",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Show what was learnt: every situation, what Tangy does there, and what follows."""
    from tangy_tui.documents import policy_document
    from tangy_tui.learning.library import effects_of
    from tangy_tui.learning.policies import load_policy
    from tangy_tui.ui import reports

    with open_house(data, activity, 4, write=False) as house:
        learnt, notices = load_policy(house.store, house.activity)
        say_notices(notices)
        if as_json:
            print_json(policy_document(house, learnt))
        else:
            effects = effects_of(house.store, house.activity, learnt)
            reports.print_policy(house.activity, learnt, effects)

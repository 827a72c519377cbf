"""The whole story in a minute: a scripted teacher demonstrates, Tangy learns, and plays a game."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from tangy_tui.app.scripted_staff import scripted_controller
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.tally import Tally
from tangy_tui.learning.effects import learn_effects
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policies import keep_policy, unused_name, without_strange_steps
from tangy_tui.learning.policy import Policy, learn_policy
from tangy_tui.learning.scripted_teacher import SCRIPTED, ScriptedTeacher
from tangy_tui.learning.teaching_events import Begun, Executed, Next
from tangy_tui.text import demo
from tangy_tui.text.command_line import TEACH_YOURSELF
from tangy_tui.text.games import belief_lines, game_lines

DEMONSTRATIONS = 3
"""What the paper found to be enough when situations come about by chance."""


def tell(workspace: Workspace, seed: int, write: Callable[[str], None]) -> dict[str, Any]:
    """Tell the story line by line; return what the game added up to."""
    activity = workspace.activity
    write(demo.demonstrates(activity.title, DEMONSTRATIONS))
    teaching = workspace.teaching(SCRIPTED, seed)
    teacher = ScriptedTeacher(teaching)
    events = teaching.begin()
    seen = set()
    for number in range(DEMONSTRATIONS):
        events = [*(teaching.apply(Next()) if number else events), *teacher.demonstrate()]
        for event in events:
            match event:
                case Begun(demonstration):
                    write(f"   Game {demonstration.seed}:")
                case Executed(_, step, _, _, speech, _) if step.state.situation not in seen:
                    seen.add(step.state.situation)
                    write(f"   new: {activity.in_words(step.state.situation)}")
                    done = activity.behaviour_words(step.behaviour)
                    write(f"        teacher: {done}. Tangy: {speech}")
        steps = len(teaching.demonstration.steps)
        write(demo.shown_so_far(steps, len(seen), len(activity.situations)))
    policy = learn(workspace)
    shown = read_library(workspace.store, activity.name).demonstrations
    effects = learn_effects(activity, shown)
    write(demo.LEARNS)
    for situation in activity.situations:
        decision = policy.decide(situation)
        write(
            f"   {activity.in_words(situation)} -> {activity.behaviour_words(decision.behaviour)} "
            f"({decision.share:.0%} of the votes, {decision.seen} times shown)"
        )
    write(demo.effects_known(len(effects.values)))
    write(demo.PLAYS)
    supervision = workspace.supervision(policy, seed)
    tally = Tally()
    control = scripted_controller(supervision)
    events_of_game = control.begin()
    while True:
        tally.add(events_of_game)
        for game_event in events_of_game:
            for line in game_lines(game_event, supervision, workspace.name):
                write(f"   {line}")
        if supervision.over:
            break
        events_of_game = control.next()
    write(demo.BELIEVES)
    for line in belief_lines(supervision, workspace.name):
        write(f"   {line}")
    write(TEACH_YOURSELF)
    return tally.to_json(activity.situations, supervision.persuasion.beliefs)


def learn(workspace: Workspace) -> Policy:
    """Learn from the finished demonstrations, by what teachers said of them; keep the policy."""
    library = read_library(workspace.store, workspace.activity.name)
    used, _ = without_strange_steps(workspace.activity, library.finished)
    policy = learn_policy(workspace.activity, used, resolutions=library.resolutions)
    policy = unused_name(workspace.store, policy)
    keep_policy(workspace.store, policy)
    return policy

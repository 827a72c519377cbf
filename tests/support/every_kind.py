"""A data folder whose log has events of every kind, written by the program itself."""

from __future__ import annotations

from pathlib import Path

from tangy_hw.perception.faces import face_store
from tangy_profiles.drill_sheet import AnsweredRound, Sheet
from tangy_profiles.events import kinds
from tangy_profiles.game_records import (
    AnswerNotClear,
    CallMade,
    DrillAnswered,
    DrillHeld,
    EffectAccepted,
    FaultDiagnosed,
    GameChange,
    GameResumed,
)
from tangy_profiles.game_world import BENCH
from tangy_profiles.people_records import (
    EventsLost,
    MicrophoneChecked,
    MicrophoneForgotten,
    ResponseAwaited,
)
from tangy_profiles.persuading import PersuasionConfig
from tangy_profiles.store import Store
from tangy_profiles.voice import VoicePreference
from tangy_tui.app.register import add_person, archive_person
from tangy_tui.app.scripted_staff import go_on_by_script, scripted_controller
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.feedback import Feedback
from tangy_tui.interaction.game_worlds import GameWorlds
from tangy_tui.learning.conflicts import Conflict, DemonstratedStep
from tangy_tui.learning.editing import Editor
from tangy_tui.learning.own_phrases import OwnPhrases
from tangy_tui.learning.policies import load_policy
from tangy_tui.learning.scripted_teacher import ScriptedTeacher
from tangy_tui.learning.teaching_events import Next, Redo, Undo
from tangy_tui.monitoring.accepted import read_accepted, take_back
from tangy_tui.speech import recordings
from tests.support.append_body import append_body


def write_every_kind(folder: Path) -> None:
    """Add the missing kinds of events to a folder with a learnt policy."""
    workspace = Workspace(folder)
    try:
        with workspace.store.transaction():
            _teach(workspace)
            _edit(workspace)
            _play(workspace)
            _tell_of_people(workspace)
            _rehearse(workspace)
        missing = kinds().keys() - workspace.store.kinds().keys()
        assert not missing, f"write_every_kind writes none of {sorted(missing)}"
        assert workspace.store.check() == []
    finally:
        workspace.close()


def _teach(workspace: Workspace) -> None:
    teaching = workspace.teaching("Ada", 9)
    teaching.begin()
    teacher = ScriptedTeacher(teaching)
    for _ in range(10):  # five behaviours, each with a yes
        teaching.apply(teacher.command())
    teaching.apply(Undo())
    teaching.apply(Undo())
    teaching.apply(Redo())
    list(teacher.demonstrate())
    teaching.apply(Next())

    OwnPhrases(workspace.store, workspace.activity, "Ada").note(
        "let us hear one more", "call number", kept=True
    )


def _edit(workspace: Workspace) -> None:
    editing = Editor(workspace.store, workspace.activity)
    editing.merge("1", "2")
    editing.split("3", 4)
    editing.undo()
    editing.redo()
    editing.delete("4")
    editing.restore("4")
    shown = editing.library.finished[0]
    step = shown.steps[0]
    there = (DemonstratedStep(shown.id, shown.teacher, 1, step),)
    editing.resolve(Conflict(step.state.situation, {step.behaviour: there}), step.behaviour)


def _play(workspace: Workspace) -> None:
    policy, _ = load_policy(workspace.store, workspace.activity)
    for injections in (["voice-dead@3", "base-stuck"], ["never-complies"], ["link-lost@6"]):
        game = workspace.supervision(policy, None, asks=True, injections=injections)
        control = scripted_controller(game)
        control.begin()
        while not game.over:
            go_on_by_script(control, expert=True)
            game.note("stopped", "Ada") if game.steps == 5 else None
    fault = workspace.store.last(FaultDiagnosed)
    step = next(workspace.store.events("demonstration step"))
    assert fault is not None
    about = {"activity": "bingo", "game": fault.body["game"], "by": "Ada"}
    kept = {key: step.body[key] for key in ("behaviour", "target", "state", "after", "completed")}
    append_body(workspace.store, EffectAccepted, {**about, "fault": fault.body["fault"], **kept})
    assert read_accepted(workspace.store, "bingo")
    take_back(workspace.store, "bingo", 1)
    called = {"game": fault.body["game"], "fault": fault.body["fault"], "role": "expert"}
    append_body(workspace.store, CallMade, {**called, "way": "command", "stage": "sent"})
    heard = {"fact": "answer", "said": "B", "certainty": 0.4, "source": "staff"}
    append_body(workspace.store, AnswerNotClear, {"game": fault.body["game"], **heard})
    append_body(workspace.store, GameResumed, {"game": fault.body["game"], "steps": 1, "by": "Ada"})
    changed = {"game": fault.body["game"], "steps": 1, "what": "played on", "person": "user1"}
    append_body(workspace.store, GameChange, changed)
    GameWorlds(workspace.store).set(fault.body["game"], BENCH, "Ada")
    append_body(workspace.store, EffectAccepted, {**about, "fault": fault.body["fault"], **kept})


def _tell_of_people(workspace: Workspace) -> None:
    store, feedback = workspace.store, Feedback(workspace.store)
    archive_person(store, add_person(store))
    rosa = workspace.people[0]
    workspace.rename(rosa, "Rosa")
    rosa = workspace.people[0]
    workspace.pronounce(rosa, "R OW Z AH")
    workspace.prefer_voice(rosa, VoicePreference(110))
    strategy, other, *_ = workspace.activity.strategies
    seq = append_body(store, ResponseAwaited, {"game": None}, person=rosa.id, strategy=strategy)
    feedback.give(rosa.id, strategy, True, of=seq)
    entry = feedback.give(rosa.id, strategy, False)
    feedback.void(rosa.id, entry.seq, "not heard")
    feedback.switch(rosa.id, other, False, workspace.activity.strategies)
    feedback.choose_method(rosa.id, PersuasionConfig("bayes-ucb", "people", 0.98, "day"))
    feedback.undo()
    feedback.choose_method(rosa.id, PersuasionConfig("bayes-ucb"))
    face_store.consent(store, rosa.id, True, "in writing")
    face_store.forget_face(store, rosa.id)
    store.forget(workspace.people[1].id)
    workspace.rename(workspace.people[1], "Bea")
    store.forget(workspace.people[1].id)
    recordings.consent(store, "Ada", True)
    recordings.forget_recordings(store)


def _rehearse(workspace: Workspace) -> None:
    store: Store = workspace.store
    append_body(store, EventsLost, {"first": 1, "last": 1})
    store.accept_losses()
    rounds = (
        AnsweredRound(
            1, "voice-dead", "no voice", "go on", ("a",), "voice-dead", "go on", 3.0, None, None
        ),
        AnsweredRound(2, "", "", "continue", (), "", "continue", 2.0, None, None),
    )
    store.append(DrillAnswered(sheet=Sheet("Ada", "bingo", 1, 2, rounds[:1])))
    store.append(DrillHeld(sheet=Sheet("Ada", "bingo", 1, 2, rounds)))
    settings = {"garbage": 1.0, "shift": 0.0}
    append_body(
        store, MicrophoneChecked, {"source": "arecord", "settings": settings, "figures": {}}
    )
    append_body(store, MicrophoneForgotten, {"source": "arecord"})

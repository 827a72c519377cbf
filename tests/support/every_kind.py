"""A data folder whose log has events of every kind there is, written by the program itself."""

from __future__ import annotations

from pathlib import Path

from tangy_hw.perception.faces import face_store
from tangy_profiles.events import BODIES
from tangy_profiles.persuading import Persuading
from tangy_profiles.store import LOST, Store
from tangy_profiles.voice import VoicePreference
from tangy_tui.app.workspace import House
from tangy_tui.interaction.feedback import AWAITED, Feedback
from tangy_tui.learning.conflicts import Conflict, Shown
from tangy_tui.learning.editing import Editor
from tangy_tui.learning.policies import load_policy
from tangy_tui.learning.scripted_teacher import ScriptedTeacher
from tangy_tui.learning.teaching_events import Next, Redo, Undo
from tangy_tui.monitoring.accepted import read_accepted, take_back
from tangy_tui.monitoring.drill_sheet import DRILL, Answered, Sheet
from tangy_tui.monitoring.fault import ACCEPTED, FAULT
from tangy_tui.monitoring.scripted_people import go_on_by_script
from tangy_tui.speech import calibration, recordings


def write_every_kind(folder: Path) -> None:
    """Add to a folder in which something was learnt what is missing of every kind."""
    house = House(folder)
    try:
        with house.store.transaction():
            _teach(house)
            _edit(house)
            _play(house)
            _tell_of_people(house)
            _rehearse(house)
        missing = BODIES.keys() - house.store.kinds().keys()
        assert not missing, f"write_every_kind writes none of {sorted(missing)}"
        assert house.store.check() == []
    finally:
        house.close()


def _teach(house: House) -> None:
    teaching = house.teaching("Ada", 9)
    teaching.begin()
    teacher = ScriptedTeacher(teaching)
    for _ in range(10):  # five behaviours, each with a yes
        teaching.apply(teacher.command())
    teaching.apply(Undo())
    teaching.apply(Undo())
    teaching.apply(Redo())
    list(teacher.demonstrate())
    teaching.apply(Next())


def _edit(house: House) -> None:
    editing = Editor(house.store, house.activity)
    editing.merge("1", "2")
    editing.split("3", 4)
    editing.undo()
    editing.redo()
    editing.delete("4")
    editing.restore("4")
    shown = editing.library.finished[0]
    step = shown.steps[0]
    there = (Shown(shown.id, shown.teacher, 1, step),)
    editing.resolve(Conflict(step.state.situation, {step.behaviour: there}), step.behaviour)


def _play(house: House) -> None:
    policy, _ = load_policy(house.store, house.activity)
    for injections in (["voice-dead@3", "base-stuck"], ["never-complies"], ["link-lost@6"]):
        game = house.supervision(policy, None, asks=True, injections=injections)
        game.begin()
        while not game.over:
            go_on_by_script(game, expert=True)
            game.note("stopped the robot", "Ada") if game.steps == 5 else None
    fault = house.store.last(FAULT)
    step = next(house.store.events("demonstration step"))
    assert fault is not None
    about = {"activity": "bingo", "game": fault.body["game"], "by": "Ada"}
    kept = {key: step.body[key] for key in ("behaviour", "target", "state", "after", "completed")}
    house.store.append(ACCEPTED, {**about, "fault": fault.body["fault"], **kept})
    assert read_accepted(house.store, "bingo")
    take_back(house.store, "bingo", 1)
    house.store.append(ACCEPTED, {**about, "fault": fault.body["fault"], **kept})


def _tell_of_people(house: House) -> None:
    store, feedback = house.store, Feedback(house.store)
    rosa = house.people[0]
    house.rename(rosa, "Rosa")
    rosa = house.people[0]
    house.pronounce(rosa, "R OW Z AH")
    house.prefer_voice(rosa, VoicePreference(110))
    strategy, other, *_ = house.activity.strategies
    seq = store.append(AWAITED, {"game": None}, person=rosa.id, strategy=strategy)
    feedback.give(rosa.id, strategy, True, of=seq)
    entry = feedback.give(rosa.id, strategy, False)
    feedback.void(rosa.id, entry.seq, "not heard")
    feedback.switch(rosa.id, other, False, house.activity.strategies)
    feedback.choose_method(rosa.id, Persuading("bayes-ucb", "people", 0.98, "day"))
    feedback.undo()
    feedback.choose_method(rosa.id, Persuading("bayes-ucb"))
    face_store.consent(store, rosa.id, True, "in writing")
    face_store.forget_face(store, rosa.id)
    store.forget(house.people[1].id)
    house.rename(house.people[1], "Bea")
    store.forget(house.people[1].id)
    recordings.consent(store, "Ada", True)
    recordings.forget_recordings(store)


def _rehearse(house: House) -> None:
    store: Store = house.store
    store.append(LOST, {"first": 1, "last": 1})
    rounds = (
        Answered(
            1, "voice-dead", "no voice", "go on", ("a",), "voice-dead", "go on", 3.0, None, None
        ),
        Answered(2, "", "", "continue", (), "", "continue", 2.0, None, None),
    )
    store.append(DRILL, Sheet("Ada", "bingo", 1, 2, rounds).to_json())
    settings = {"garbage": 1.0, "shift": 0.0}
    store.append(calibration.CHECKED, {"source": "arecord", "settings": settings, "figures": {}})
    store.append(calibration.FORGOTTEN, {"source": "arecord"})

"""The report of a session from the log alone: games, Table II, people, faults, and open issues."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from datetime import datetime
from typing import Any
from xml.etree import ElementTree

import pytest

from tangy_profiles.errors import TangyError
from tangy_profiles.people_records import ResponseAwaited
from tangy_profiles.store import Store
from tangy_sim.worlds import faulty_world
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.tally import Tally
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.fault import Diagnosed, Moved, read_faults
from tangy_tui.monitoring.fault_table import ROWS, fault_rows
from tangy_tui.monitoring.games import find_game, find_games, read_games
from tangy_tui.monitoring.people_progress import RESULTS
from tangy_tui.monitoring.replay import AnsweredRequest, Done, GameReplay, Noted, read_replays
from tangy_tui.monitoring.session import Session, SessionNote, read_session
from tangy_tui.pages.session import session_page
from tangy_tui.text.endings import BROKEN_OFF, ending_words
from tangy_tui.text.log import MOST_TOLD, replay_lines, session_lines
from tangy_tui.text.results import RESULT_WORDS
from tests.monitoring.conftest import Supervise
from tests.support.append_body import append_body
from tests.support.games import acts, play

FAULTS = ("laser-disconnected@6", "path-blocked", "voice-dead@9", "request-stuck", "no-effect@20")


def told(workspace: Workspace, wanted: str = "all") -> Session:
    games = find_games(read_games(workspace.store), wanted)
    activities = {workspace.activity.name: workspace.activity}
    return read_session(workspace.store, games, activities, workspace.names)


def without(body: Mapping[str, Any], *keys: str) -> dict[str, Any]:
    return {key: value for key, value in body.items() if key not in keys}


def test_a_played_game_is_read_back_from_the_log(
    workspace: Workspace, supervise: Supervise
) -> None:
    game = supervise(*FAULTS)
    events = play(game)
    (replay,) = read_replays(
        workspace.store,
        read_games(workspace.store),
        {workspace.activity.name: workspace.activity},
        workspace.names,
    )
    assert [done.behaviour for done in replay.done] == [
        act.action.behaviour.name for act in acts(events)
    ]
    assert [done.right for done in replay.done] == [act.right for act in acts(events)]
    assert [done.said for done in replay.done if done.said] == [
        act.speech for act, done in zip(acts(events), replay.done, strict=True) if done.said
    ]
    assert replay.timed
    assert [m.seconds for m in replay.moments] == sorted(m.seconds for m in replay.moments)
    faults = [m for m in replay.moments if isinstance(m.what, Diagnosed)]
    assert [m.seconds for m in faults] == [
        pytest.approx(m.what.fault.seconds) for m in faults if isinstance(m.what, Diagnosed)
    ]
    assert len(faults) == len(replay.faults) == len(read_faults(workspace.store))
    assert sum(isinstance(m.what, Moved) for m in replay.moments) == sum(
        len(fault.moves) for fault in replay.faults
    )


def test_the_rows_of_table_two_match_the_played_games(
    workspace: Workspace, supervise: Supervise
) -> None:
    tally = Tally()
    game = supervise("path-blocked")
    for _ in range(2):
        tally.add(play(game))
    session = told(workspace)
    assert list(session.rows) == tally.rows(workspace.activity.situations)
    document = session.to_json()
    assert document["rows"] == tally.to_json(workspace.activity.situations, {})["rows"]
    assert [game["number"] for game in document["games"]] == [1, 2]


def test_the_four_rows_of_faults_are_there_in_the_papers_order(
    workspace: Workspace, supervise: Supervise
) -> None:
    assert [(row["criticality"], row["recovery"]) for row in fault_rows([])] == list(ROWS)
    assert all(row["success"] is None and row["instances"] == 0 for row in fault_rows([]))
    play(supervise(*FAULTS))
    session = told(workspace)
    rows = session.to_json()["faults"]
    assert [(row["criticality"], row["recovery"]) for row in rows] == list(ROWS)
    assert sum(row["instances"] for row in rows) == len(session.faults)
    assert rows[0] == {
        "criticality": "critical", "recovery": "expert", "instances": 1, "success": 1.0,
    }  # fmt: skip


def test_an_open_fault_is_no_success_and_needs_care(
    workspace: Workspace, supervise: Supervise
) -> None:
    play(supervise("base-failed@6", asks=False), expert=False)
    session = told(workspace)
    (row, *_) = fault_rows(session.faults)
    assert (row["instances"], row["success"]) == (1, 0.0)
    (fault,) = session.look_after
    assert session.to_json()["look_after"][0]["advice"] == list(fault.advice)
    assert session.games[0].stopped is not None
    assert fault.console in session_page(session)


def test_a_recovery_succeeds_only_without_a_further_one(
    workspace: Workspace, supervise: Supervise, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(faulty_world, "HELPS", 0.0)
    play(supervise("path-blocked", seed=3))
    (fault,) = told(workspace).faults
    assert (fault.status, fault.ladder) == ("over", ("user", "expert"))
    assert [row["success"] for row in fault_rows([fault]) if row["instances"]] == [0.0]
    nobody = supervise("no-effect@12", asks=False)
    play(nobody)
    (fault,) = [f for f in nobody.faults if f.code == "unexplained"]
    assert (fault.recovery, fault.succeeded) == ("teacher", True)
    (row,) = [row for row in fault_rows([fault]) if row["instances"]]
    assert (row["recovery"], row["success"]) == ("teacher", 0.0), "a teacher was never asked"


def test_only_tolerated_faults_still_need_care(workspace: Workspace, supervise: Supervise) -> None:
    play(supervise("path-blocked", "arm-failed@5"))
    session = told(workspace)
    assert {fault.code: fault.status for fault in session.faults} == {
        "path-blocked": "over", "arm-failed": "borne",
    }  # fmt: skip
    assert [fault.code for fault in session.look_after] == ["arm-failed"]


@pytest.mark.slow
def test_the_report_shows_posteriors_before_and_after_the_session(
    workspace: Workspace, supervise: Supervise
) -> None:
    game = supervise()
    for _ in range(3):
        play(game)
    first, second = told(workspace, "1"), told(workspace, "2")
    for one, two, person in zip(first.people, second.people, workspace.people, strict=True):
        known = workspace.memory().recall(person.id).beliefs
        whole = next(p for p in told(workspace).people if p.id == person.id)
        for strategy in workspace.activity.strategies:
            assert (one.strategies[strategy].before.trials) == 0
            assert one.strategies[strategy].after == two.strategies[strategy].before
            assert whole.strategies[strategy].after == known[strategy]
            assert whole.strategies[strategy].used == known[strategy].trials
    asked = sum(person.interactions for person in told(workspace).people)
    assert asked == sum(workspace.store.responses()[key][0] + workspace.store.responses()[key][1]
                        for key in workspace.store.responses())  # fmt: skip


def test_a_pending_response_is_not_reported_as_a_no(
    workspace: Workspace, supervise: Supervise
) -> None:
    play(supervise())
    (game,) = read_games(workspace.store)
    (end,) = workspace.store.events("game ended")
    append_body(
        workspace.store,
        ResponseAwaited,
        {"game": game.id},
        person=workspace.people[0].id,
        strategy="neutral",
    )
    append_body(workspace.store, "game ended", {**end.body})
    session = told(workspace)
    person = session.people[0]
    assert person.total("awaited") == 1
    assert person.interactions == sum(person.total(what) for what in RESULTS)
    (line,) = [line for line in session_lines(session) if line.startswith(person.name)]
    (neutral,) = [part for part in line.split("; ") if "neutral: " in part]
    assert "answer not known once (" in neutral
    assert f"{person.strategies['neutral'].refused} would rather not" in neutral or not (
        person.strategies["neutral"].refused
    )
    page = session_page(session)
    assert "answer not known once." in page
    root = ElementTree.fromstring(page.partition("\n")[2])  # noqa: S314 - our own page
    rows = [[cell.text for cell in row] for row in root.iter("tr")]
    at = next(row for row in rows if RESULT_WORDS["awaited"] in row).index(RESULT_WORDS["awaited"])
    (row,) = [row for row in rows if row[:2] == [person.name, "neutral"]]
    assert row[at] == "1"
    titles = [circle.find("title") for circle in root.iter("circle")
              if circle.get("class") == "open"]  # fmt: skip
    assert [title.text for title in titles if title is not None] == [RESULT_WORDS["awaited"]]


def test_long_reports_list_only_games_with_faults_or_stops(
    workspace: Workspace, supervise: Supervise
) -> None:
    play(supervise())
    play(supervise("arm-failed@5", seed=2))
    session = told(workspace)
    smooth, bumpy = session.games
    stopped = replace(smooth, id="stopped", number=3, stopped="Somebody said stop.")
    games = [replace(smooth, id=f"game{n}", number=n) for n in range(4, 4 + MOST_TOLD)]
    some = replace(
        session, replays=tuple(GameReplay(game) for game in (smooth, *games[: MOST_TOLD - 1]))
    )
    assert sum(line.startswith("Game ") for line in session_lines(some)) == MOST_TOLD
    all_of_them = tuple(GameReplay(game) for game in (smooth, bumpy, stopped, *games))
    lines = list(session_lines(replace(session, replays=all_of_them)))
    told_of = [line.split(" ")[1] for line in lines if line.startswith("Game ")]
    assert told_of == [str(bumpy.number), "3"]
    assert lines[0].startswith(f"{MOST_TOLD + 3} games, ")
    assert f"{MOST_TOLD + 2} played to the end, 1 stopped before it" in lines[0]
    assert any(f"The other {MOST_TOLD + 1} games " in line and "log list" in line
               for line in lines)  # fmt: skip


def test_a_void_response_is_reported_and_counts_in_no_posterior(
    workspace: Workspace, supervise: Supervise
) -> None:
    play(supervise())
    before = told(workspace)
    person = next(p for p in before.people if p.interactions)
    feedback = workspace.memory().feedback
    entry = next(entry for entry in feedback.history(person.id) if entry.counts)
    feedback.void(person.id, entry.seq, "it was somebody else")
    after = next(p for p in told(workspace).people if p.id == person.id)
    assert after.total("void") == 1
    assert after.interactions == person.interactions
    assert after.strategies[entry.strategy].after.trials == (
        person.strategies[entry.strategy].after.trials - 1
    )
    feedback.give(person.id, entry.strategy, True, of=entry.seq)
    again = next(p for p in told(workspace).people if p.id == person.id)
    assert again.total("void") == 0
    assert again.interactions == person.interactions, "an answer that was mended counts once"


def test_games_of_an_older_version_are_reported(workspace: Workspace, supervise: Supervise) -> None:
    play(supervise())
    with Store.open(workspace.store.folder.parent / "old") as old:
        for event in workspace.store.events():
            body = dict(event.body)
            if event.kind == "game step":
                body = without(body, "seconds", "share", "draws", "teacher", "completed")
                body["state"] = without(body["state"], "closed")
                body["after"] = without(body["after"], "closed")
            append_body(
                old, event.kind, body, person=event.person, strategy=event.strategy,
                complied=event.complied,
            )  # fmt: skip
        games = read_games(old)
        session = read_session(old, games, {workspace.activity.name: workspace.activity}, {})
        assert not session.timed
        assert session.to_json()["seconds"] is None
        assert [(r.behaviour, r.instances) for r in session.rows] == [
            (r.behaviour, r.instances) for r in told(workspace).rows
        ]
        page = session_page(session)
        assert "An older Tangy kept no times" in page
        ElementTree.fromstring(page.partition("\n")[2])  # noqa: S314 - our own page


def test_a_game_of_a_missing_activity_is_reported_with_less_detail(
    workspace: Workspace, supervise: Supervise
) -> None:
    play(supervise())
    session = read_session(workspace.store, read_games(workspace.store), {}, workspace.names)
    assert session.notes[0] == SessionNote("unknown activity", "bingo")
    assert session.games[0].steps == sum(row.instances for row in session.rows)
    assert [p.interactions for p in session.people] == [
        p.interactions for p in told(workspace).people
    ]
    assert session_page(session)


def test_an_interrupted_game_is_marked(workspace: Workspace, supervise: Supervise) -> None:
    game = supervise()
    game.begin()
    for _ in range(5):
        game.step()
    (found,) = read_games(workspace.store)
    assert (found.steps, found.ended, ending_words(found)) == (5, None, BROKEN_OFF)
    assert BROKEN_OFF[1:] in session_page(told(workspace))
    play(supervise(seed=2))
    assert [g.ended is None for g in read_games(workspace.store)] == [True, False]
    assert told(workspace).games[0].steps == 5


def test_a_game_is_found_by_number_id_day_and_last(
    workspace: Workspace, supervise: Supervise
) -> None:
    with pytest.raises(TangyError, match="No game was played yet"):
        find_games(read_games(workspace.store), "last")
    game = supervise()
    for _ in range(3):
        play(game)
    games = read_games(workspace.store)
    day = games[0].at.astimezone().date()
    assert find_game(games, "2") is games[1]
    assert find_game(games, " LAST ") is games[2]
    assert find_game(games, games[1].id) is games[1]
    assert find_games(games, "all") == games
    assert find_games(games, str(day)) == [
        g for g in games if g.at.astimezone().date() == day
    ]  # fmt: skip
    with pytest.raises(TangyError, match="the nearest day with one is"):
        find_games(games, "1999-01-01")
    for wrong in ("0", "4", "", games[0].id[:3] + "?", "99999999999999999999", "2026-13-45"):
        with pytest.raises(TangyError, match="There is no game"):
            find_games(games, wrong)
    with pytest.raises(TangyError, match="means 3 games"):
        find_game(games, "all")


def test_a_page_is_self_contained_and_lists_every_fault(
    workspace: Workspace, supervise: Supervise
) -> None:
    play(supervise(*FAULTS))
    session = told(workspace)
    page = session_page(session)
    root = ElementTree.fromstring(page.partition("\n")[2])  # noqa: S314 - our own page
    assert not [word for word in ("http:", "https:", "src=", "@import", "<link", "<script")
                if word in page]  # fmt: skip
    marks = [g for g in root.iter("g") if g.get("class", "").startswith("fault ")]
    on_drawing = [g for g in marks if g.find("text") is not None]
    assert len(on_drawing) == len(session.faults) >= 4
    items = [li for li in root.iter("li") if li.find("span") is not None]
    assert len(items) == sum(1 + len(fault.moves) for fault in session.faults)
    for drawing in (svg for svg in root.iter("svg") if svg.get("class") == "timeline"):
        width = float(drawing.get("viewBox", "").split()[2])
        for mark in drawing.iter():
            places = [float(mark.get(key, 0)) for key in ("x", "x1", "x2", "cx")]
            assert all(0 <= place <= width for place in places)


def test_markup_in_names_is_escaped_on_a_page(workspace: Workspace, supervise: Supervise) -> None:
    workspace.store.rename(workspace.people[0].id, "<b>&'\"Rosa")
    names = {**workspace.names, workspace.people[0].id: "<b>&'\"Rosa"}
    play(supervise())
    session = read_session(
        workspace.store,
        read_games(workspace.store),
        {workspace.activity.name: workspace.activity},
        names,
    )
    page = session_page(session)
    assert "<b>" not in page
    ElementTree.fromstring(page.partition("\n")[2])  # noqa: S314 - our own page


def test_the_moments_include_every_response(workspace: Workspace, supervise: Supervise) -> None:
    play(supervise())
    (replay,) = told(workspace).replays
    kinds = {type(moment.what) for moment in replay.moments}
    assert {Done, AnsweredRequest} <= kinds
    assert all(datetime.fromisoformat(moment.at).tzinfo for moment in replay.moments)
    assert [moment.to_json()["kind"] for moment in replay.moments].count("step") == len(replay.done)


def test_injected_faults_are_marked(workspace: Workspace, learnt: Policy) -> None:
    game = workspace.supervision(learnt, 3, injections=["voice-dead@2"])
    game.begin()
    game.step()
    game.note("stopped", "Ada")
    game.leave()
    played = read_games(workspace.store)[-1]
    activities = {workspace.activity.name: workspace.activity}
    (replay,) = read_replays(workspace.store, [played], activities, {})
    noted = [m.what for m in replay.moments if isinstance(m.what, Noted)]
    assert [(note.did, note.detail) for note in noted] == [
        ("faults planned", "voice-dead@2"),
        ("stopped", ""),
    ]
    assert "*  Ada stopped the robot." in "\n".join(replay_lines(replay, workspace.activity, str))
    session = read_session(workspace.store, [played], activities, {})
    assert any("voice-dead@2" in note.about for note in session.notes)

"""Reports on activities by facts list the answers and scores of people."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from html import escape
from pathlib import Path
from types import MappingProxyType
from typing import cast
from xml.etree import ElementTree

import pytest

from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_client.declared_live_world import DeclaredLiveWorld
from tangy_hw.robot_client.fact_observation import FactObservation
from tangy_profiles.activity import Activity
from tangy_profiles.declared.acts import raw
from tangy_profiles.declared.typed_observations import TypedObservation
from tangy_profiles.game_records import AnswerNotClear, GameBeginning, GameStep
from tangy_profiles.game_world import LIVE
from tangy_profiles.robot import load_robot
from tangy_profiles.room import load_room
from tangy_profiles.state import FRONT, ActivityState, Situation, UserState
from tangy_profiles.store import Store
from tangy_tui.monitoring.attention import Attention, attention
from tangy_tui.monitoring.games import read_games
from tangy_tui.monitoring.house import by_month, of_world, read_log
from tangy_tui.monitoring.session import Session, read_session
from tangy_tui.pages.session import session_page
from tangy_tui.text.house import MONTH_COLUMNS, NOTHING, month_rows
from tangy_tui.text.log import session_lines
from tangy_tui.text.player_facts import HEADING
from tangy_tui.text.report import call_rows, care_lines, people_table
from tangy_tui.text.times import time_of_day
from tests.hw.links import FakeLink
from tests.support.declared import declared

PEOPLE = ("user1", "user2", "user3")
ALL = tuple(UserState(id, "-", "ANR") for id in PEOPLE)
CALLING = ActivityState(0, Situation("calling", "ANR", "-"), FRONT, None, ALL, None)


class Quiz:
    """A live quiz over a fake link, step by step, in a log."""

    def __init__(self, store: Store) -> None:
        self.store, self.activity = store, declared("trivia")
        self.world = DeclaredLiveWorld(
            self.activity, PEOPLE, cast(RobotLink, FakeLink(PEOPLE)), load_robot(), load_room(),
            seed=4,
        )  # fmt: skip
        self.world.begin()
        store.append(
            GameBeginning(game="g", number=1, activity="trivia", people=PEOPLE, world=LIVE)
        )

    def do(self, name: str, whom: str | None = None, answer: str = "") -> None:
        """Carry out a behaviour; its person then answers."""
        world, state = self.world, self.world.observe()
        world.execute(self.activity.action(self.activity.behaviours[name], whom, None))
        if answer:
            said = raw(world.game, world.game.declaration.facts["answer"], answer)
            world.take(FactObservation(TypedObservation("answer", whom, said), 1.0, "staff"))
        self.store.append(
            GameStep(
                game="g", behaviour=name, target=whom, state=state, after=world.observe(),
                memory=world.memory,
            )
        )  # fmt: skip

    def session(self) -> Session:
        games, names = read_games(self.store), {"user1": "Rosa", "user2": "Fritz"}
        return read_session(self.store, games, {"trivia": self.activity}, names)


@pytest.fixture
def quiz(tmp_path: Path) -> Iterator[Quiz]:
    with Store.open(tmp_path / "data") as store:
        yield Quiz(store)


def played(quiz: Quiz) -> None:
    quiz.do("welcome everyone")
    quiz.do("ask question", "user1", answer="right")
    quiz.do("allow time")
    quiz.do("confirm answer", "user1")
    quiz.do("ask question", "user2", answer="wrong")
    quiz.do("give hint", "user2", answer="wrong")  # wrong again, with another answer
    quiz.do("tell answer", "user2")


def test_each_answer_counts_once_and_belongs_to_its_question(quiz: Quiz) -> None:
    played(quiz)
    (facts,) = quiz.session().player_facts
    assert [(act.person, act.value, act.round) for act in facts.acts] == [
        ("user1", "right", 1), ("user2", "wrong", 2), ("user2", "wrong", 2)
    ]  # fmt: skip
    first, second, _ = facts.acts
    assert first.item and second.item and first.item != second.item
    assert facts.counts == {"score": {"user1": 1, "user2": 0, "user3": 0}}


def test_page_and_lines_list_answers_scores_and_unclear_answers(quiz: Quiz) -> None:
    played(quiz)
    unclear = AnswerNotClear(
        game="g", fact="answer", said="b?", certainty=0.4, source="staff", asked_again=True
    )
    quiz.store.append(unclear, person="user3")
    session = quiz.session()
    page = session_page(session, full=False)
    assert "Answers and scores" in page
    assert "never went" not in page  # Tangy stays at the front in a quiz
    row = page[page.index("Answers and scores") :]
    assert row.index("Rosa") < row.index("it is right (1)") < row.index("it is wrong (2)")
    lines = list(session_lines(session))
    assert "  Rosa: score 1; answer: it is right (1)" in lines
    assert "  user3: score 0; no clear answer: once" in lines
    assert session.to_json()["player_facts"][0]["counts"]["score"]["user1"] == 1


def test_each_game_of_an_evening_is_reported_with_its_own_activity(
    quiz: Quiz, activity: Activity
) -> None:
    bingo = GameBeginning(game="b", number=2, activity="bingo", people=PEOPLE, world=LIVE)
    called = GameStep(
        game="b", behaviour="call number", target=None, state=CALLING, after=CALLING, numbers=(7,),
    )  # fmt: skip
    played(quiz)
    quiz.store.append(bingo)
    quiz.store.append(called)
    for newest_first in (False, True):
        games = sorted(read_games(quiz.store), key=lambda game: game.number, reverse=newest_first)
        known = {"trivia": quiz.activity, "bingo": activity}
        session = read_session(quiz.store, games, known, {})
        (facts,) = session.player_facts
        assert (facts.game, facts.counts["score"]["user1"]) == ("g", 1)
        assert [labels for _, labels in call_rows(session)] == [[("B-7", False)]]
        page = session_page(session, full=False)
        ElementTree.fromstring(page.partition("\n")[2])  # noqa: S314 - our own page
        assert all(one.title in page for one in known.values())
        quizzed = {done.state.stage for r in session.replays for done in r.done} - {"calling"}
        assert all(escape(quiz.activity.stage_words(stage)) in page for stage in quizzed)
        assert "never went" in page and HEADING in page  # in Bingo it could have gone


def test_people_are_missed_only_if_tangy_visits_people(quiz: Quiz, activity: Activity) -> None:
    played(quiz)
    trivia = read_session(quiz.store, read_games(quiz.store), {"trivia": quiz.activity}, {})
    found = attention(trivia.replays).values()
    assert found and not any(one.could_visit or one.never_visited for one in found)
    assert care_lines(found, str) == []
    columns, rows = people_table(trivia)
    assert not {"visits", "time with Tangy", "did as asked", "won"} & {*columns}
    assert len(rows) == len(PEOPLE) and {*map(len, rows)} == {len(columns)}
    assert not any(
        name in line for line in session_lines(trivia) for name in ("Not asked", "asks at most")
    )
    unknown = read_session(quiz.store, read_games(quiz.store), {}, {})
    assert all(one.never_visited for one in attention(unknown.replays).values())
    log = read_log(quiz.store, {}, {"trivia": quiz.activity})
    (month,) = month_rows(by_month(of_world([log], LIVE)))
    assert month[MONTH_COLUMNS.index("never visited")] == NOTHING
    both = Attention("ann", could_visit=False)
    both.add(Attention("ann"))
    assert both.never_visited, "in one of the games Tangy visits people"


def test_a_report_without_player_facts_has_no_section_for_them(quiz: Quiz) -> None:
    session = quiz.session()
    assert session.player_facts == [] and "Answers and scores" not in session_page(session)


def test_what_to_look_after_tells_who_and_when_if_the_file_says_so(quiz: Quiz) -> None:
    declaration = quiz.activity.declaration
    answer = replace(declaration.facts["answer"], attention=("wrong",))
    facts = MappingProxyType({**declaration.facts, "answer": answer})
    quiz.activity = replace(quiz.activity, declaration=replace(declaration, facts=facts))
    played(quiz)
    session = quiz.session()
    (_, first, second) = session.player_facts[0].acts
    times = " and ".join(time_of_day(act.at) for act in (first, second))
    lines = list(session_lines(session))
    assert lines[lines.index("What to look after:") + 1] == f"  Fritz: it is wrong ({times})."
    assert f"Fritz: it is wrong ({times})." in session_page(session, full=False)

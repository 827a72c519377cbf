"""Staff ask in words when Tangy goes to a person, and why: the answer is what the program knows."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import pytest

from tangy_hw.robot_client.help_requests import SignState
from tangy_profiles.activity import known_activities, load_activity
from tangy_profiles.declared.joint_state import joint_state
from tangy_profiles.errors import TangyError
from tangy_profiles.game_records import GameChange
from tangy_profiles.game_rules import GamePlan
from tangy_profiles.health import ERROR, Reading
from tangy_tui.app.game_commands import (
    AskFor,
    ClaimCard,
    EndGame,
    GoesAway,
    GoOn,
    Pause,
    StopRobot,
    TakeOver,
)
from tangy_tui.app.game_moment import (
    GameMoment,
    PersonTurn,
    game_moment,
    turn_of,
    turns_from_now,
)
from tangy_tui.app.inquiry_grammar import AsksAbout, AsksWhoWaits, read_inquiry, read_question
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.staff_view import PersonNow
from tangy_tui.app.teaching_grammar import read_teaching
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.inquiries import Inquiries
from tangy_tui.language.examples import wordings_of
from tangy_tui.learning.policy import Decision
from tangy_tui.text import whose_turn as text
from tangy_tui.text.control import noted_words
from tangy_tui.text.situations import moment_words
from tangy_tui.text.times import local_now
from tests.app.test_interruption import Robot
from tests.app.test_staff_facts import Game
from tests.support.planned_games import Planned

NAMES = {"user1": "Carl", "user2": "Ida", "user3": "Berta", "user4": "Otto"}


@pytest.fixture
def robot(taught: Path) -> Iterator[Robot]:
    workspace = Workspace(taught)
    for person, name in NAMES.items():
        workspace.rename(workspace.find_person(person), name)
    yield Robot(workspace)
    workspace.close()


def ask(robot: Robot, *people: str) -> None:
    """Let people put up their signs, one after the other."""
    robot.link.sign(*(int(one[-1]) for one in people))
    robot.world.observe()


def about(robot: Robot, *people: str) -> list[str]:
    return text.about_lines(robot.control, AsksAbout(people), robot.workspace.name)


def now(robot: Robot) -> list[str]:
    return text.why_now_lines(robot.control, robot.workspace.name)


def test_who_has_not_asked_gets_no_visit(robot: Robot) -> None:
    robot.next(2)
    assert about(robot, "user3") == [
        "Berta has not asked for help.",
        "Tangy has not been with Berta in this game.",
        "If Berta needs help, type: help Berta.",
    ]
    assert now(robot) == ["Tangy calls the next number, because nobody asks for help."]


def test_the_only_one_who_asks_is_next(robot: Robot) -> None:
    robot.next(2)
    ask(robot, "user3")
    robot.control.view()
    robot.link.time += 43.0
    told = about(robot, "user3")
    assert told[:2] == ["Berta asked 40 s ago.", "Berta is next."]
    assert now(robot) == [
        "Tangy goes to Berta next, because Berta asked for help.",
        "Nobody else waits.",
    ]


def test_of_several_who_ask_the_order_is_told(robot: Robot) -> None:
    robot.next(2)
    ask(robot, "user1", "user2", "user3")
    robot.control.view()
    assert about(robot, "user3")[:2] == [
        "Berta has just asked.",
        "Before Berta, Tangy goes to Carl and Ida, in this order.",
    ]
    assert now(robot) == [
        "Tangy goes to Carl next, because Carl has waited longest.",
        "Ida and Berta wait, too, in this order.",
    ]


def test_while_tangy_is_with_somebody_the_next_one_is_told_so(robot: Robot) -> None:
    robot.next(2)
    ask(robot, "user1", "user3")
    robot.next(1)
    assert about(robot, "user3")[1:3] == ["Tangy is with Carl.", "After that, Berta is next."]
    assert about(robot, "user1") == [
        "Tangy is with Carl now, because Carl has waited longest.",
    ]
    first, *others = now(robot)
    assert first.startswith("Tangy is with Carl, because Carl has waited longest. Next: ")
    assert others == ["Berta waits, too."]


def test_staff_who_asked_for_somebody_are_not_told_that_the_person_did(robot: Robot) -> None:
    robot.next(2)
    robot.control.apply(AskFor("user3"))
    robot.control.view()
    assert about(robot, "user3")[0] == "Berta waits for Tangy."
    robot.link.time += 70.0
    assert about(robot, "user3")[0] == "Berta has waited for 1 min."
    robot.world.observe()
    assert now(robot)[0] == "Tangy goes to Berta next, because you asked for Berta."


def test_a_claim_comes_first(robot: Robot) -> None:
    robot.next(2)
    ask(robot, "user3")
    numbers = robot.world.numbers_on(17)
    assert numbers is not None
    robot.world.called.extend(numbers)
    robot.control.apply(ClaimCard(17, "user2"))
    assert about(robot, "user3")[1:3] == [
        "Ida comes first: a claim.",
        "Before Berta, Tangy goes to Ida.",
    ]
    assert now(robot)[0] == "Tangy goes to Ida next, because of the claim."


def test_a_claim_that_waits_for_the_present_step_is_told(robot: Robot) -> None:
    robot.next(2)
    ask(robot, "user3")
    robot.control.plan.say_early(ClaimCard(17, "user2"))
    waits = "Card 17 (Ida) does not win yet. Tangy finishes this, then tells everybody."
    assert about(robot, "user3")[0] == now(robot)[0] == waits
    robot.control.apply(ClaimCard(17, "user2"))
    assert waits not in [*about(robot, "user3"), *now(robot)]


@pytest.mark.parametrize("card", [18, 999])
def test_a_claim_that_comes_while_another_is_announced_keeps_its_own_news(
    robot: Robot, card: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot.next(2)
    numbers = robot.world.numbers_on(17)
    assert numbers is not None
    robot.world.called.extend(numbers)
    plan, later = robot.control.plan, ClaimCard(card, "user3")
    monkeypatch.setattr(robot.world, "announce", lambda words: plan.say_early(later))
    told = robot.control.apply(ClaimCard(17, "user2"))
    assert [getattr(one, "kind", "") for one in told] == ["claim right", ""]
    news = plan.claims[-1]
    if card == 999:  # there is no such card
        assert news == replace(news, card=17, person="user2", kind="claim right", goes=True)
    else:
        assert news == replace(news, card=18, person="user3", told=None, goes=False)


def test_numbers_that_come_first_are_counted(taught: Path) -> None:
    planned = Planned(taught, users=24)
    planned.begin(GamePlan(("full card",), visits=True, pace=5))
    world, name = planned.world, planned.workspace.name
    while world.tracker.calls_first < 2:
        planned.play(calls=len(world.called_now) + 1)
    calls, (first, second) = world.tracker.calls_first, world.tracker.queue[:2]
    told = text.about_lines(planned.control, AsksAbout((first,)), name)
    assert f"Tangy calls {calls} numbers first, because everybody waits for the next one." in told
    assert f"After that, {name(first)} is next." in told
    told = text.about_lines(planned.control, AsksAbout((second,)), name)
    assert f"Before {name(second)}, Tangy goes to {name(first)}." in told
    told = text.why_now_lines(planned.control, name)
    first_calls = f"Tangy calls {calls} numbers before its next visit"
    assert told[0] == f"{first_calls}, because everybody waits for the next one."
    assert told[1].startswith(name(first)) and told[1].endswith(" more wait, in this order.")
    planned.workspace.close()


def test_somebody_who_is_away_gets_no_visit(robot: Robot) -> None:
    robot.next(2)
    robot.control.apply(GoesAway("user3"))
    assert about(robot, "user3")[-1] == "If Berta is back, type: here Berta."
    refused = StaffNote("is away", "user3")
    assert robot.control.apply(AskFor("user3")) == [refused]
    assert noted_words(refused, robot.workspace.name) == (
        "Tangy does not go to Berta, who is not here. If Berta is back, type: here Berta."
    )
    assert "user3" not in robot.world.queue


def test_the_last_visit_is_told_by_the_clock(robot: Robot) -> None:
    robot.next(2)
    ask(robot, "user3")
    robot.next(1)
    robot.control.view()
    ask(robot)
    robot.world.tracker.queue.clear()
    robot.next(1)
    robot.control.view()
    robot.link.time += 3600.0
    turn = turn_of(robot.control, "user3")
    assert turn is not None and turn.person.unvisited is not None
    clock = local_now()
    at = clock - timedelta(seconds=turn.person.unvisited)
    told = text.turn_lines(turn, robot.workspace.name, clock)
    assert f"Tangy was with Berta at {at:%H:%M}." in told
    told = text.turn_lines(turn, robot.workspace.name, None)  # the time is simulated
    assert "Tangy was with Berta 60 min ago." in told


@pytest.mark.parametrize(
    ("does", "told"),
    [
        (Pause(), "The game is paused. Tangy does nothing until you let it go on."),
        (StopRobot(), "Tangy was stopped. It stands still until you let it go on."),
        (StopRobot("Nina"), "Nina stopped Tangy. It stands still until you let it go on."),
        (TakeOver(), "You say what Tangy does next. It waits for that."),
    ],
)
def test_what_holds_the_game_comes_first(robot: Robot, does: Pause, told: str) -> None:
    robot.next(2)
    ask(robot, "user3")
    robot.control.apply(does)
    assert about(robot, "user3")[:2] == [told, "Berta has just asked."]
    assert now(robot)[0] == told
    robot.control.apply(GoOn())


def test_after_the_game_nobody_has_a_turn(robot: Robot) -> None:
    assert about(robot, "user3") == [text.NO_GAME] or robot.control.supervision.games
    robot.next(2)
    robot.control.apply(EndGame())
    assert about(robot, "user3") == now(robot) == ["The game is over."]


def test_a_silent_sensor_and_a_sign_that_does_not_count_are_told(robot: Robot) -> None:
    robot.next(2)
    ask(robot, "user3")
    robot.world.requests.set_aside("user3")
    robot.world.tracker.queue.clear()
    assert about(robot, "user3")[0].startswith("Berta's sign is up, but Tangy was there already.")
    silent = Reading("requests", 9.0, ERROR)
    health = tuple(silent if one.device == "requests" else one for one in robot.link.state.health)
    robot.link.state = replace(robot.link.state, health=health)
    assert about(robot, "user3")[0].startswith("Tangy cannot see now who asks for help")


def test_questions_to_staff_are_told_with_who_waits(robot: Robot) -> None:
    robot.next(2)
    ask(robot, "user3", "user1")
    robot.control.view()
    moment = game_moment(robot.control)
    asks = replace(moment, holder="question", about="Nobody has shown Tangy this.")
    activity, name = robot.workspace.activity, robot.workspace.name
    assert text.now_lines(activity, asks, name) == [
        "Tangy waits for your answer. Nobody has shown Tangy this.",
        "Carl and Berta wait, in this order.",
    ]
    joining = replace(moment, holder="joining", welcomes=("Clara",))
    assert text.held_words(joining) == "Tangy sets itself up for Clara. Then the game goes on."
    drives = replace(moment, welcomes=("Clara",))
    assert text.now_lines(activity, drives, name)[0].startswith("Tangy drives to the front")
    halted = replace(moment, holder="halted", about="Card out of view")
    assert text.held_words(halted) == (
        "A fault halts Tangy (Card out of view). It stands still until all is well again."
    )


def test_who_gets_a_visit_without_asking_is_told_the_rule(taught: Path) -> None:
    planned = Planned(taught)
    planned.begin(GamePlan(("full card",), visits=True))
    planned.play(calls=3)
    name = planned.workspace.name
    resting = next(one.id for one in planned.control.view().people if one.state == "plays")
    told = text.about_lines(planned.control, AsksAbout((resting,)), name)
    rule = "After 15 numbers without a visit, Tangy goes to people as if they had asked."
    assert any(line.startswith(rule) for line in told)
    planned.workspace.close()


@pytest.mark.parametrize(
    ("all_called", "reason"),
    [
        (False, "because Berta has had no visit for 15 numbers."),
        (True, "because all numbers have been called and Tangy looks at each card."),
    ],
)
def test_a_visit_without_a_request_is_told_as_one(
    robot: Robot, all_called: bool, reason: str
) -> None:
    robot.next(2)
    robot.world.all_called = all_called
    robot.world.change(GameChange(game="", steps=2, what="visits on"))
    robot.world.change(GameChange(game="", steps=2, what="visit", person="user3"))
    assert (
        about(robot, "user3")[0]
        == f"Tangy visits Berta{', ' if all_called else ' in turn, '}{reason}"
    )
    assert now(robot)[0] == f"Tangy goes to Berta next, {reason}"


def test_the_plain_sentences_come_before_the_details(robot: Robot) -> None:
    robot.next(2)
    workspace = robot.workspace
    lines = Inquiries(
        robot.control, workspace.name, None, lambda who: workspace.find_person(who).id
    ).lines
    told = lines("why is nothing happening?") or []
    assert told[0] == "Tangy calls the next number, because nobody asks for help."
    assert told[1] == f"{text.IN_DETAIL}:" and all(one.startswith("  ") for one in told[2:])
    assert (lines("Why does nobody go to Berta?") or [])[0] == "Berta has not asked for help."
    assert (lines("why not Xaver") or [""])[0].startswith("There is nobody called 'Xaver'")


@pytest.mark.parametrize(
    "words",
    [
        *("why does nobody go to Berta", "Why not Berta?", "when is it Berta's turn"),
        *("when is Bertas turn", "why Berta", "why doesn't anybody help Berta", "is Berta next?"),
        *("why won't Tangy go to Berta", "when will you visit berta", "how about Berta"),
        *("how long does Berta have to wait", "who is before Berta", "Berta's turn?"),
        *("nobody goes to Berta", "has Berta asked", "what is with Berta", "is Berta away"),
        "when\u2019s it Berta\u2019s turn",
    ],
)
def test_questions_about_a_person_are_understood(robot: Robot, words: str) -> None:
    assert read_question(words, finder(robot)) == AsksAbout(("user3",))


def test_a_question_may_name_several_people_and_names_that_are_words(robot: Robot) -> None:
    robot.workspace.rename(robot.workspace.find_person("user4"), "Will")
    find = finder(robot)
    assert read_question("why Carl and not Berta", find) == AsksAbout(("user1", "user3"))
    assert read_question("when will Tangy go to Ida", find) == AsksAbout(("user2",))
    assert read_question("when is it Will's turn", find) == AsksAbout(("user4",))


@pytest.mark.parametrize(
    "words",
    [
        *("why", "why not", "what now", "Berta", "Berta: B", "why does it wait"),
        *("does Berta's card win", "is it Berta who has bingo", "go to Berta", "help Berta"),
        *("when will you come to us", "call a number", "give Berta a hint"),
    ],
)
def test_other_words_are_no_question_about_a_person(robot: Robot, words: str) -> None:
    assert read_question(words, finder(robot)) is None


@pytest.mark.parametrize(
    "words",
    [
        *("why don't you go to Berta", "why don\u2019t you go to Berta", "why not visit Berta"),
        *("will you go to Berta", "how about you go to Berta", "how about going to Berta"),
        *("nobody asks, so go to Berta", "would you please help Berta"),
    ],
)
def test_what_proposes_something_is_no_question(robot: Robot, words: str) -> None:
    assert read_question(words, finder(robot)) is None
    assert read_inquiry(words) is None


@pytest.mark.parametrize("words", ["why did nobody win", "why does nobody see my card"])
def test_a_question_about_something_else_is_not_answered_so(words: str) -> None:
    assert read_inquiry(words) is None


def test_a_proposal_with_any_or_ever_asks() -> None:
    assert read_inquiry("why don't you do anything?") == "why"
    assert read_inquiry("why don't you say hello first") is None


@pytest.mark.parametrize(
    "words",
    [
        *("how about something to laugh about", "why does Tangy help nobody"),
        *("is the robot going to sleep", "when does it go to front", "why should I go to bed"),
        *("when does Tangy visit each person", "when are you going to start"),
    ],
)
def test_words_that_are_no_names_are_not_refused_as_such(robot: Robot, words: str) -> None:
    assert read_question(words, finder(robot)) is None


@pytest.mark.parametrize(
    "words",
    [
        *("why does Tangy never go to Xaver", "why does nobody help Xaver"),
        *("when will it visit Xaver", "when is it Xaver's turn"),
    ],
)
def test_unknown_names_are_refused(robot: Robot, words: str) -> None:
    with pytest.raises(TangyError, match="There is nobody called 'Xaver'"):
        read_question(words, finder(robot))
    with pytest.raises(TangyError, match="There is nobody called 'strauss'"):
        read_question("when will it visit Strau\u00df", finder(robot))


def test_a_verb_before_its_subject_is_no_name(robot: Robot) -> None:
    robot.workspace.rename(robot.workspace.find_person("user4"), "Will")
    find = finder(robot)
    for words in ("when will you come to us", "when will it come", "how long will the robot wait"):
        assert read_question(words, find) is None
    assert read_question("is Will the next one", find) == AsksAbout(("user4",))
    assert read_question("when will Tangy go to Berta", find) == AsksAbout(("user3",))
    assert read_question("is Berta next, or Will", find) == AsksAbout(("user3",))


@pytest.mark.parametrize(
    "words", ["when is it Mark's turn", "why are you not going to Mark?", "is mark next"]
)
def test_a_name_that_is_also_a_word_of_other_questions_is_a_name(robot: Robot, words: str) -> None:
    assert read_question(words, finder(robot)) is None
    robot.workspace.rename(robot.workspace.find_person("user4"), "Mark")
    assert read_question(words, finder(robot)) == AsksAbout(("user4",))
    assert read_question("when is Mark's card next", finder(robot)) is None


def test_a_verb_that_ends_in_s_is_no_genitive(robot: Robot) -> None:
    robot.workspace.rename(robot.workspace.find_person("user4"), "Ha")
    assert read_question("why has nobody helped", finder(robot)) is None
    assert read_question("does Ha Berta wait", finder(robot)) == AsksAbout(("user4", "user3"))
    assert read_question("when is Ha's turn", finder(robot)) == AsksAbout(("user4",))
    assert read_question("when is berta\u2019s or idas turn", finder(robot)) == AsksAbout(
        ("user3", "user2")
    )


def find_two(wanted: str) -> str:
    if wanted.casefold() not in ("rosa", "otto"):
        raise TangyError(f"There is nobody called {wanted!r}.")
    return wanted.casefold()


ASK_WHO_WAITS = (
    *("who waits", "Who is waiting?", "who has asked for help", "who's asked", "who wants help"),
    *("who needs you", "does anybody need help?", "is anyone waiting", "who has their hand up"),
    *("has anybody asked", "show me the queue", "who else is still waiting for a visit"),
)


@pytest.mark.parametrize("words", ASK_WHO_WAITS)
def test_questions_about_everybody_who_waits_are_understood(words: str) -> None:
    assert read_question(words, find_two) == AsksWhoWaits()


@pytest.mark.parametrize(
    "words", ["who is next", "who is here", "who won", "ask for help", "who called bingo", "wait"]
)
def test_other_words_do_not_ask_who_waits(words: str) -> None:
    assert read_question(words, find_two) != AsksWhoWaits()


@pytest.mark.parametrize("activity", known_activities())
def test_no_words_for_a_step_ask_about_the_game(activity: str) -> None:
    profile = load_activity(activity)
    title = profile.title.casefold().split()
    texts = {t for one in profile.behaviours.values() for t in (*one.phrases, *wordings_of(one))}
    somebody = re.compile(r"\b(?:the )?(?:user|player|person|team)\b")
    said = texts | {somebody.sub(name, text) for text in texts for name in ("Rosa", "Otto")}
    taken = [
        words
        for words in said - {"who is next", "who is winning"}  # staff ask so in each activity
        if read_question(words, find_two) or read_inquiry(words) or read_teaching(words, title)
    ]
    assert len(said) > 20 and taken == []


def finder(robot: Robot) -> Callable[[str], str]:
    return lambda who: robot.workspace.find_person(who).id


def test_who_and_what_comes_before_a_person_is_told_in_order() -> None:
    ann, ben = PersonNow("ann", "comes", 1, 90.0), PersonNow("ben", "asks", 2, 50.0)
    cleo = PersonNow("cleo", "asks", 3, 42.0)
    moment = GameMoment(people=(ann, ben, cleo), with_robot=ann, waiting=(ben, cleo))
    between = replace(moment, calls_between=True)
    lines = text.turn_lines(PersonTurn(cleo, between), str.title, None)
    assert lines == [
        "Cleo asked 40 s ago.",
        "Tangy is on its way to Ann.",
        "Before Cleo, Tangy goes to Ben: Ben has waited longer.",
        "In between it may call some numbers.",
        "Tangy has not been with Cleo in this game.",
    ]
    first = replace(between, calls_first=2)
    told = text.turn_lines(PersonTurn(cleo, first), str.title, None)
    assert told == [*lines[:2], text_of_calls(2), lines[2], lines[4]]
    assert (
        text.turn_lines(PersonTurn(ben, between), str.title, None)[2] == "After that, Ben is next."
    )
    assert text.turn_lines(PersonTurn(ann, moment), str.title, None) == [
        "Tangy is on its way to Ann, because Ann has waited longest."
    ]
    later = replace(moment, people=(replace(ann, waits=30.0), ben, cleo))
    assert text.turn_lines(PersonTurn(later.people[0], later), str.title, None) == [
        "Tangy is on its way to Ann, because Ann comes first."
    ]


def test_everybody_who_waits_is_told_in_the_order_of_the_visits() -> None:
    ann, ben, cleo = (PersonNow(one, "asks", turn=1, waits=40.0) for one in ("ann", "ben", "cleo"))
    comes = replace(ann, state="comes", waits=None)
    moment = GameMoment(people=(comes, ben, cleo), waiting=(ben, cleo), with_robot=comes)
    assert text.waiting_lines(moment, str.title) == [
        "Tangy is on its way to Ann, because Ann comes first.",
        "1. Ben asked 40 s ago.",
        "2. Cleo asked 40 s ago.",
    ]
    assert text.waiting_lines(
        GameMoment(people=(ann,), waiting=(ann,), calls_first=2), str.title
    ) == [
        text_of_calls(2),
        "1. Ann asked 40 s ago.",
    ]
    assert text.waiting_lines(GameMoment(), str.title) == ["Nobody waits for Tangy."]


def text_of_calls(count: int) -> str:
    return f"Tangy calls {count} numbers first, because everybody waits for the next one."


@pytest.mark.parametrize(
    ("can_ask", "sign", "told"), [(True, "", True), (False, "", False), (True, "no sensor", False)]
)
def test_staff_are_told_to_ask_for_somebody_only_if_they_can(
    can_ask: bool, sign: SignState, told: bool
) -> None:
    turn = PersonTurn(PersonNow("ann", "plays"), GameMoment(), sign, can_ask=can_ask)
    lines = text.turn_lines(turn, str.title, None)
    assert ("If Ann needs help, type: help Ann." in lines) is told


def test_in_a_game_with_turns_the_order_of_turns_is_told() -> None:
    game = Game()
    assert turns_from_now(game) == ("ann", "ben")
    ben = PersonNow("ben", "plays", goes_round=False)
    turn = PersonTurn(ben, GameMoment(turns=("ann", "cleo", "ben")))
    assert text.turn_lines(turn, str.title, None) == [
        "It is Ann's turn now. After that Cleo, then Ben."
    ]
    turn = PersonTurn(ben, GameMoment(turns=("ann", "ben")))
    assert text.turn_lines(turn, str.title, None) == ["It is Ann's turn now. Then comes Ben."]
    turn = PersonTurn(ben, GameMoment(turns=("reds", "ben")))
    assert text.turn_lines(turn, str.title, None) == ["It is Reds' turn now. Then comes Ben."]
    waits = PersonTurn(replace(ben, turn=1, waits=42.0), GameMoment(turns=("ann", "ben")))
    assert text.turn_lines(waits, str.title, None)[0] == "Ben asked 40 s ago."
    turn = PersonTurn(ben, GameMoment())
    assert text.turn_lines(turn, str.title, None) == [
        "In this activity Tangy goes to nobody, and nobody has a turn."
    ]


def test_in_a_game_by_facts_the_step_is_told_without_all_facts() -> None:
    game = Game()
    welcome = next(iter(game.activity.behaviours))
    game.game.execute(welcome, None)
    game.game.execute("ask question", "ann")
    state = joint_state(game.game)
    decision = Decision("allow time", 1.0, (("allow time", 1.0),), seen=3)
    moment = GameMoment(turns=("ann", "ben"), state=state, decision=decision)
    (told,) = text.now_lines(game.activity, moment, str.title)
    assert told.startswith("It is Ann's turn. ") and told.endswith(". Next: allow time.")
    assert "\N{MIDDLE DOT}" in moment_words(game.activity, state, str.title)
    assert "\N{MIDDLE DOT}" not in told

"""The facts that staff read about each person in a game declared by facts."""

from __future__ import annotations

from dataclasses import replace

from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.scene import Scene
from tangy_profiles.state import FRONT
from tangy_tui.app.staff_view import PersonNow, StaffWatch
from tangy_tui.text.staff_view import person_words
from tests.support.declared import declared

PEOPLE = ("ann", "ben")


class Game:
    """A world with the part of a game that staff see."""

    def __init__(self) -> None:
        self.activity = declared("trivia")
        self.game = DeclaredGame(self.activity.declaration, PEOPLE)


def lines(world: object) -> list[str]:
    watch = StaffWatch()
    watch.begin(0.0)
    scene = Scene(FRONT, (), dict.fromkeys(PEOPLE, ""), (), None)
    return [person_words(one) for one in watch.look(scene, PEOPLE, 5.0, world).people]


def test_scores_and_the_turn_stand_beside_the_names_where_nobody_is_visited() -> None:
    world = Game()
    assert lines(world) == ["has the turn, score 0", "score 0"]
    world.game.execute("ask question", "ann")
    world.game.execute("confirm answer", "ann")
    assert lines(world) == ["score 1", "has the turn, score 0"]


def test_nobody_has_the_turn_in_a_game_that_is_over() -> None:
    watch = StaffWatch()
    watch.begin(0.0)
    watch.end(4.0)
    scene = Scene(FRONT, (), dict.fromkeys(PEOPLE, ""), (), None)
    people = watch.look(scene, PEOPLE, 5.0, Game()).people
    assert [person_words(one) for one in people] == ["score 0", "score 0"]


def test_a_person_of_a_game_with_visits_has_none_yet() -> None:
    assert lines(object()) == ["no visit yet", "no visit yet"]


def test_a_wait_and_a_visit_of_a_few_seconds_are_told_without_a_number() -> None:
    just = PersonNow("ann", "asks", 1, waits=4.0, unvisited=3.0)
    assert person_words(just) == "asks, just visited"
    assert person_words(replace(just, waits=14.0, unvisited=24.0)) == "asks 10 s, visited 20 s ago"


def test_a_wait_goes_on_in_the_next_game_while_the_person_still_asks() -> None:
    watch = StaffWatch()
    watch.begin(0.0)
    asks = Scene(FRONT, ("ann", "ben"), dict.fromkeys(PEOPLE, ""), (), None)
    watch.look(asks, PEOPLE, 10.0, object())
    watch.end(300.0)
    over = watch.look(replace(asks, requests=()), PEOPLE, 320.0, object())
    assert [one.waits for one in over.people] == [None, None]
    watch.begin(330.0)
    view = watch.look(replace(asks, requests=("ann",)), PEOPLE, 340.0, object())
    assert [one.waits for one in view.people] == [330.0, None]
    later = watch.look(asks, PEOPLE, 350.0, object())
    assert [one.waits for one in later.people] == [340.0, 0.0]

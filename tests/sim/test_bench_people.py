"""The bench's people understand the robot's speech, and play like the simulated people."""

from __future__ import annotations

from collections import Counter
from typing import ClassVar

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tangy_profiles.card_face import numbers_of
from tangy_profiles.fault_file import load_faults
from tangy_profiles.person import Person, load_people
from tangy_profiles.state import FRONT
from tangy_sim.device_simulator.house_rules import tell
from tangy_sim.device_simulator.people import HIDES
from tangy_sim.device_simulator.speech_reception import SpeechReception, speaking_seconds
from tangy_sim.device_simulator.world import BenchWorld
from tests.sim.bench_game import ACTIVITY, ROBOT, Player, bench, drive_to, say

PEOPLE = (*load_people(3), Person("ann", "Ann"), Person("anna", "Anna O'Neil-Smith"))
HEARING = SpeechReception(ACTIVITY, ROBOT, PEOPLE)
WAYS = [
    (behaviour.name, strategy)
    for behaviour in ACTIVITY.behaviours.values()
    for strategy in behaviour.speech
]


def opened(seed: int = 1) -> BenchWorld:
    """Make a world after the greeting of a game."""
    world = bench(seed)
    world.begin()
    say(world, "greeting")
    return world


def asks(world: BenchWorld, person: str = "user2") -> None:
    """Put a person's sign up, and the robot beside them, in sight of the card."""
    world.people.sitters[person].asks_since = world.now
    assert drive_to(world, person)
    world.people.sitters[person].hides = ""


class TestHearing:
    @pytest.mark.parametrize(("behaviour", "strategy"), WAYS)
    @pytest.mark.parametrize("person", PEOPLE, ids=lambda person: person.id)
    def test_people_understand_every_phrase_of_the_robot(
        self, behaviour: str, strategy: str, person: Person
    ) -> None:
        template = ACTIVITY.behaviours[behaviour].speech[strategy]
        numbers = (7,) if "{call}" in template else (71, 5, 33)
        heard = HEARING.hear(ACTIVITY.fill(template, person.name, numbers))
        assert heard is not None and heard.behaviour is not None
        assert (heard.behaviour.name, heard.strategy) == (behaviour, strategy)
        assert heard.person == (person.id if "{name}" in template else "")
        asked = "{call}" in template or "{numbers}" in template
        assert heard.numbers == (numbers if asked else ())

    @pytest.mark.parametrize(("behaviour", "strategy"), WAYS)
    def test_people_answer_to_the_names_of_their_seats(self, behaviour: str, strategy: str) -> None:
        template = ACTIVITY.behaviours[behaviour].speech[strategy]
        numbers = (7,) if "{call}" in template else (71, 5)
        heard = HEARING.hear(ACTIVITY.fill(template, "Seat 2", numbers))
        assert heard is not None
        assert heard.person == (PEOPLE[1].id if "{name}" in template else "")

    def test_people_understand_requests_for_help_and_their_addressee(self) -> None:
        rules = [rule for rule in load_faults(ROBOT).rules if rule.aloud]
        assert rules
        for rule in rules:
            heard = HEARING.hear(rule.fill(rule.aloud, name="Ann", object=ACTIVITY.object))
            assert heard is not None and heard.fault == rule.code
            assert heard.person == ("ann" if "{name}" in rule.aloud else "")

    @given(st.text(max_size=60))
    def test_other_sentences_are_not_understood(self, text: str) -> None:
        assert HEARING.hear(f"{text} perhaps") is None

    def test_a_sentence_takes_its_speaking_time(self) -> None:
        world = bench()
        text = "Hello, everybody. I am Tangy, and today we play Bingo."
        world.say(text)
        world.step(speaking_seconds(text) - 0.1)
        assert not world.said and not world.people.game.opened
        world.step(0.2)
        assert world.said == [text] and world.people.game.opened

    def test_an_interrupted_sentence_is_not_heard(self) -> None:
        world = bench()
        world.say("Hello, everybody. I am Tangy, and today we play Bingo.")
        world.step(1.0)
        world.hush()
        world.step(20.0)
        assert not world.said and not world.people.game.opened


class TestPlaying:
    def test_each_game_deals_different_printed_cards(self) -> None:
        world = bench(5)
        first, second = world.begin(), world.begin()
        assert len(set(first.values())) == 4 and first != second
        for person, card in second.items():
            numbers = world.people.sitters[person].player.numbers
            assert numbers == numbers_of(ACTIVITY.deck, card)

    def test_who_asked_in_vain_still_waits_in_the_next_game(self) -> None:
        world = opened(3)
        helped, left, waits, _ = people = world.people.ids
        for person in people[:3]:
            world.people.ask(person)
        since = world.people.sitters[waits].asks_since
        world.people.meet(helped)
        world.people.away = {left}
        world.step(30.0)
        world.begin()
        assert world.people.asking == (waits,)
        assert world.people.sitters[waits].asks_since == since

    def test_called_numbers_are_marked_after_some_seconds_or_missed(self) -> None:
        world = opened(3)
        for number in ACTIVITY.deck.numbers[:40]:
            say(world, "call number", "", number)
            on_card = [s.player for s in world.people.sitters.values() if number in s.player.cell]
            assert all(p.called >> p.cell[number] & 1 for p in on_card)
        before = [s.player.marked for s in world.people.sitters.values()]
        world.step(6.0)
        after = [s.player.marked for s in world.people.sitters.values()]
        assert before != after  # only now is the last one marked
        players = [s.player for s in world.people.sitters.values()]
        missed = sum((p.called & ~p.marked).bit_count() for p in players)
        assert 0 < missed < 0.3 * sum(p.called.bit_count() for p in players)

    def test_a_person_with_a_full_line_asks(self) -> None:
        world = opened(1)
        sitter = world.people.sitters["user3"]
        line = ACTIVITY.deck.lines[0]
        (last,) = sitter.player.cells(line & -line)
        sitter.player.marked = sitter.player.called = line & (line - 1)
        while sitter.player.marked != sitter.player.called | line:  # some calls are missed
            say(world, "call number", "", last)
            world.step(6.0)
        world.step(3.0)
        assert "user3" in world.asking and world.people.judged("user3") == "bingo"

    def test_nobody_asks_before_the_greeting(self) -> None:
        world = bench(2)
        world.begin()
        for number in ACTIVITY.deck.numbers[:10]:
            say(world, "call number", "", number)
            world.step(5.0)
        for sitter in world.people.sitters.values():
            sitter.player.asks_at = 0.0
        assert not world.asking

    def test_a_person_takes_the_sign_down_after_help(self) -> None:
        world = opened(4)
        asks(world)
        say(world, "encourage", "User 2")
        assert "user2" in world.asking
        world.step(25.0)
        assert "user2" not in world.asking

    def test_a_request_closes_only_after_the_card_is_correct(self) -> None:
        world = opened(4)
        player = world.people.sitters["user2"].player
        player.marked, player.called = 0b0011, 0b0110
        asks(world)
        say(world, "remove markers", "User 2", *player.cells(0b0001))
        world.step(25.0)
        assert player.marked == 0b0010 and "user2" in world.asking
        say(world, "mark numbers", "User 2", *player.cells(0b0100))
        world.step(25.0)
        assert player.marked == 0b0110 and "user2" not in world.asking

    def test_people_comply_by_their_preferences_in_time_or_late(self) -> None:
        world = opened(6)
        asks(world, "user1")
        done = Counter[bool]()
        for _ in range(60):
            world.people.sitters["user1"].hides = "away"
            began = len(world.people.game.responses)
            text = ACTIVITY.fill(
                ACTIVITY.behaviours["move card closer"].speech["neutral"], "User 1", ()
            )
            world.say(text)
            while len(world.people.game.responses) == began:
                world.step(0.1)
            since = world.now
            while world.people.sitters["user1"].hides:
                world.step(0.05)
            took, response = world.now - since, world.people.game.responses[-1]
            assert response.complied == (took <= ACTIVITY.patience - 0.9) and response.followed
            assert 11 - 0.1 <= took <= 19.1 or response.complied
            assert took == pytest.approx(response.seconds, abs=0.2)
            done[response.complied] += 1
        assert done[True] / 60 == pytest.approx(
            world.people.preferences["user1"]["neutral"], abs=0.15
        )

    def test_a_card_is_out_of_view_on_arrival_at_the_given_rate(self) -> None:
        world = bench(7)
        world.begin()
        hidden = Counter[str]()
        for _ in range(300):
            world.people.leave()
            world.people.meet("user1")
            hidden[world.people.sitters["user1"].hides] += 1
        assert 1 - hidden[""] / 300 == pytest.approx(world.people.users.occluded, abs=0.08)
        assert set(hidden) == {"", *HIDES}

    def test_the_robot_is_at_a_place_only_if_it_stands_there(self) -> None:
        world = bench(8)
        world.begin()
        assert world.people.place == FRONT and drive_to(world, "user1")
        assert world.people.place == "user1"
        met: list[str] = []
        meet = world.people.meet

        def noted(person: str) -> None:
            met.append(person)
            meet(person)

        world.people.meet = noted  # type: ignore[method-assign]
        assert drive_to(world, "user4") and met == ["user4"]

    @pytest.mark.slow
    @settings(max_examples=3)
    @given(st.integers(0, 10_000))
    def test_games_are_determined_by_their_seed(self, seed: int) -> None:
        def played(seed: int) -> object:
            one = Player(bench(seed, exact=False))
            one.play(9, most=15)
            return one.rows, one.world.now, one.world.truth()

        assert played(seed) == played(seed)
        assert played(seed) != played(seed + 1)

    @pytest.mark.slow
    def test_the_frequencies_of_situations_match_table_two(self) -> None:
        """The fitted model's figures for twenty games; tests/sim/test_table_two.py has them."""
        games = 6
        one = Player(bench(11))
        for game in range(games):
            one.play(game)
            assert one.world.people.asking  # the winner
        rows = Counter[str]()
        for situation, count in one.rows.items():
            rows[ACTIVITY.expected[situation]] += count
        assert rows["celebrate"] == rows["greeting"] == rows["valediction"] == games
        for behaviour, fitted in (("call number", 714), ("remove markers", 25),
                                  ("mark numbers", 22),
                                  ("encourage", 17), ("move card closer", 22),
                                  ("navigate to user", 69)):  # fmt: skip
            usual = fitted * games / 20
            assert rows[behaviour] == pytest.approx(usual, abs=4 * usual**0.5 + 2), behaviour


def test_people_read_further_numbers_on_the_chest_screen() -> None:
    behaviour = ACTIVITY.behaviours["mark numbers"]
    numbers = tuple(ACTIVITY.deck.numbers[:12])
    for template in behaviour.speech.values():
        few, many = (
            HEARING.hear(ACTIVITY.fill(template, "Ann", said, aloud=True))
            for said in (numbers[:3], numbers)
        )
        assert few is not None and many is not None
        assert (few.numbers, few.more) == (numbers[:3], False)
        assert (many.numbers, many.more) == (numbers[:4], True)


class TestAnInterruptedGame:
    CALLED = (3, 18, 33, 48, 63, 5, 20, 35)
    CARDS: ClassVar = {"user1": 17, "user2": 31, "user3": 99}

    def resumed(self, **also: object) -> BenchWorld:
        """Make a world that was switched on anew in the middle of a game."""
        world = bench(3)
        tell(world.people, {"called": self.CALLED, "cards": self.CARDS, **also})
        return world

    def test_people_go_on_with_their_cards_and_marks(self) -> None:
        world = self.resumed()
        for person, card in self.CARDS.items():
            sitter = world.people.sitters[person]
            assert sitter.card == card and sitter.player.numbers == numbers_of(ACTIVITY.deck, card)
            there = set(sitter.player.numbers) & set(self.CALLED)
            free = world.people.activity.deck.free
            assert set(sitter.player.cells(sitter.player.marked & ~free)) == there
            assert not sitter.player.has_error

    def test_nobody_gets_the_card_of_another_person(self) -> None:
        world = bench(1)
        first = {person: one.card for person, one in world.people.sitters.items()}
        *_, new = first
        cards = dict(zip([*first][:-1], [*first.values()][1:], strict=True))  # has new's card
        for _ in range(2):
            tell(world.people, {"called": self.CALLED, "cards": cards})
        there = [one.card for one in world.people.sitters.values()]
        assert len({*there}) == len(there) and world.people.sitters[new].card != first[new]

    def test_mistakes_and_requests_come_as_in_the_middle_of_a_game(self) -> None:
        people = self.resumed().people
        assert people.game.opened
        assert all(one.player.slips_at > len(self.CALLED) for one in people.sitters.values())

    def test_people_who_asked_still_ask(self) -> None:
        assert self.resumed(asking=["user3"]).people.asking == ("user3",)

    def test_people_ask_for_help_again_as_the_game_goes_on(self) -> None:
        world = self.resumed()
        for number in range(1, 76):
            if number not in self.CALLED:
                say(world, "call number", "", number)
        assert world.people.asking

    def test_a_call_that_was_taken_back_before_does_not_count(self) -> None:
        world = self.resumed()
        tell(world.people, {"taken_back": 18})
        assert 18 not in world.people.game.called
        for sitter in world.people.sitters.values():
            assert 18 not in sitter.player.cells(sitter.player.marked)

"""The phrasebook as data: seats, and laws for every activity and group."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.person import Person, load_people
from tangy_profiles.room import Room, load_room
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.phrase_list import list_phrases
from tangy_tui.language.words import clean, words_of
from tangy_tui.text.phrases import items

BINGO = load_activity("bingo")
ROOM = load_room()
NAMED = replace(ROOM, seat_names=("window", "", "door", ""))

word = st.sampled_from(["swing", "lamp", "fold", "blue", "river", "nod", "seven", "tea"])
phrase = st.lists(word, min_size=1, max_size=4).map(" ".join)


def meaning(book: Phrasebook, text: str) -> tuple[str, str | None] | None:
    command = book.understand(text)
    return (command.behaviour, command.arguments.get("user")) if command else None


def seated(count: int, room: Room = ROOM) -> tuple[Person, ...]:
    return room.placed(load_people(count))


class TestSeats:
    @pytest.mark.parametrize(
        ("text", "user"),
        [
            ("go to seat two", "user2"),
            ("Go to seat 2, please", "user2"),
            ("drive to the window seat", "user1"),
            ("help door seat", "user3"),
            ("drive over to seat number 4", "user4"),
            ("go to seat", None),
            ("go to the seat", None),
            ("go to user 2", "user2"),
        ],
    )
    def test_a_person_is_named_by_seat(self, text: str, user: str | None) -> None:
        book = Phrasebook(BINGO, seated(4, NAMED))
        assert meaning(book, text) == ("navigate to user", user)

    @pytest.mark.parametrize("text", ["go to seat 5", "drive over to seat number nine"])
    def test_an_unknown_seat_names_no_person(self, text: str) -> None:
        book = Phrasebook(BINGO, seated(4))
        assert book.understand(text) is None
        assert book.stranger(text) == f"seat {words_of(text)[-1]}"

    def test_numbers_of_seats_and_people_are_distinguished(self) -> None:
        people = NAMED.placed([Person("user7", "Ada"), Person("user1", "Bob")])
        book = Phrasebook(BINGO, people)
        assert meaning(book, "go to seat 1") == ("navigate to user", "user7")
        assert meaning(book, "go to user 1") == ("navigate to user", "user1")
        assert book.understand("go to seat 7") is None
        assert book.understand("drive over to seat number 7") is None
        assert book.understand("go to user 2") is None
        assert book.stranger("go to seat 7") == "seat 7"

    def test_a_seat_name_exists_only_if_the_seat_is_used(self) -> None:
        assert "go to the window seat" in Phrasebook(BINGO, seated(4, NAMED)).phrases
        assert "go to the window seat" not in Phrasebook(BINGO, seated(3, NAMED)).phrases

    def test_a_room_without_a_word_for_seats_has_names_alone(self) -> None:
        bare = replace(NAMED, seat_word="")
        assert [person.seats for person in bare.placed(load_people(4))] == [
            ("window",), (), ("door",), (),
        ]  # fmt: skip

    def test_another_activity_names_seats_in_its_own_words(self, lanterns: Activity) -> None:
        book = Phrasebook(lanterns, seated(4, NAMED))
        assert meaning(book, "walk to seat three") == ("walk over", "user3")
        assert meaning(book, "walk to the door seat") == ("walk over", "user3")


def meanings(book: Phrasebook) -> dict[tuple[str, ...], tuple[str, str | None]]:
    """Return the meaning of each phrase of a phrasebook."""
    return {phrase.words: (phrase.behaviour, phrase.user) for phrase in book.table.all()}


class TestLaws:
    @given(st.lists(phrase, min_size=len(BINGO.behaviours), max_size=30, unique_by=words_of))
    def test_every_phrase_of_every_phrasebook_means_its_own_behaviour(
        self, phrases: list[str]
    ) -> None:
        count = len(BINGO.behaviours)
        behaviours = {
            name: replace(
                behaviour,
                question=phrases[place],
                phrases=tuple(phrases[place::count]),
                keywords=(),
            )
            for place, (name, behaviour) in enumerate(BINGO.behaviours.items())
        }
        book = Phrasebook(replace(BINGO, behaviours=behaviours), seated(4, NAMED))
        for behaviour in behaviours.values():
            for one in behaviour.phrases:
                assert meaning(book, one) == (behaviour.name, None)

    @given(st.lists(st.text(max_size=20), min_size=1, max_size=7), st.text(max_size=20), st.data())
    def test_a_further_person_changes_no_phrase_for_the_others(
        self, names: list[str], name: str, data: st.DataObject
    ) -> None:
        people = ROOM.placed([Person(f"user{n}", one) for n, one in enumerate(names, 1)])
        more = ROOM.placed([*people, Person(f"user{len(names) + 1}", name)])
        before, after = Phrasebook(BINGO, people), Phrasebook(BINGO, more)
        new, now = words_of(clean(name)), meanings(after)
        for words, meant in meanings(before).items():
            if not (new and words[-len(new) :] == new):  # a name that two people share is ambiguous
                assert now[words] == meant
        text = data.draw(st.sampled_from(sorted(before.phrases)))
        if not (new and words_of(text)[-len(new) :] == new):
            assert meaning(after, text) == meaning(before, text)

    @pytest.mark.parametrize("count", [1, 4, 8])
    def test_completions_and_spoken_phrases_agree(self, lanterns: Activity, count: int) -> None:
        for each in (BINGO, lanterns):
            book = Phrasebook(each, seated(count))
            now = meanings(book)
            typed = {words_of(shown) for shown in book.complete("")}
            for said in book.spoken():
                assert words_of(said) in typed
                assert book.phrases[said] == now[words_of(said)][0]
                assert book.complete(said)[0].startswith(said.partition(" ")[0])

    def test_names_of_people_change_no_meaning_of_a_phrase(self) -> None:
        plain = Phrasebook(BINGO, ())
        named = Phrasebook(BINGO, ROOM.placed([Person("user1", "Mark", "M AA K")]))
        for text in plain.phrases:
            assert meaning(named, text) == meaning(plain, text)


class TestThePage:
    def test_the_list_has_every_phrase_person_and_word(self, activity: Activity) -> None:
        listed = list_phrases(activity, seated(4, NAMED))
        assert [ways.behaviour for ways in listed.behaviours] == list(activity.behaviours)
        for ways in listed.behaviours:
            assert set(activity.behaviours[ways.behaviour].phrases) <= set(ways.phrases)
        assert listed.people[0].ways == ("user 1", "seat 1", "window seat")
        assert {said.word for said in listed.words} >= {"bingo", "window", "two"}
        assert not listed.left_out

    def test_a_search_finds_words_in_any_order(self, activity: Activity) -> None:
        entries = list(items(list_phrases(activity, seated(4))))
        assert [entry.about for entry in entries if entry.has("FUNNY say")] == ["tell a joke"]
        assert [entry.about for entry in entries if entry.has("seat 2")] == ["User 2"]
        assert all(entry.has("") for entry in entries)

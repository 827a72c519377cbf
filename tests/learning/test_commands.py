"""Commands: the phrases for a behaviour, and the handling of any other text."""

from __future__ import annotations

import unicodedata
from dataclasses import replace
from time import process_time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.person import Person, load_people
from tangy_tui.language.commands import KEYWORDS_AT_LEAST, Phrasebook
from tangy_tui.language.words import FILLERS, LONGEST_TEXT

BOOK = Phrasebook(load_activity("bingo"), load_people(4))
NAMED = Phrasebook(
    load_activity("bingo"),
    [
        Person("user1", "Rosa"),
        Person("user2", "José Luis"),
        Person("user3", "李雷"),
        Person("user4", "Anne-Marie"),
    ],
)


def meaning(book: Phrasebook, text: str) -> tuple[str, str | None] | None:
    command = book.understand(text)
    return (command.behaviour, command.arguments.get("user")) if command else None


def bare(text: str) -> list[str]:
    return [word for word in text.split() if word not in FILLERS]


class TestUnderstanding:
    @pytest.mark.parametrize("phrase", BOOK.phrases)
    def test_every_phrase_means_its_behaviour_for_certain(self, phrase: str) -> None:
        command = BOOK.understand(phrase)
        assert command is not None
        assert (command.behaviour, command.confidence) == (BOOK.phrases[phrase], 1.0)
        assert command.behaviour not in command.alternatives

    def test_names_and_questions_of_behaviours_are_phrases(
        self, activity: Activity, lanterns: Activity, people: tuple[Person, ...]
    ) -> None:
        for each in (activity, lanterns):
            book = Phrasebook(each, people)
            for behaviour in each.behaviours.values():
                assert meaning(book, behaviour.name) == (behaviour.name, None)
                assert meaning(book, behaviour.question) == (behaviour.name, None)

    @pytest.mark.parametrize(
        "text",
        [
            "Greet Everyone!",
            "  greet\teveryone ",
            "Tangy, please greet everyone now.",
            "could you greet the everyone",
            "gréet everyone",
            "greet\u202e everyone\u200b",
            "greet everyone\x1b[2J",
        ],
    )
    def test_case_punctuation_fillers_and_controls_do_not_matter(self, text: str) -> None:
        assert meaning(BOOK, text) == ("greeting", None)

    @pytest.mark.parametrize(
        ("text", "user"),
        [
            ("go to user 2", "user2"),
            ("go to user two", "user2"),
            ("Go to the User #2, please", "user2"),
            ("go to user2", "user2"),
            ("drive over to user number two", "user2"),
            ("navigate to user 002", "user2"),
            ("help user 4", "user4"),
            ("go to user", None),
        ],
    )
    def test_a_person_is_named_by_number(self, text: str, user: str | None) -> None:
        assert meaning(BOOK, text) == ("navigate to user", user)

    @pytest.mark.parametrize(
        ("text", "user"),
        [
            ("go to Rosa", "user1"),
            ("go to rsoa", "user1"),
            ("drive over to rosa now", "user1"),
            ("help José Luis", "user2"),
            ("go to jose luis", "user2"),
            ("go to 李雷", "user3"),
            ("go to anne marie", "user4"),
            ("go to user 4", "user4"),
        ],
    )
    def test_a_person_is_named_by_name(self, text: str, user: str) -> None:
        assert meaning(NAMED, text) == ("navigate to user", user)

    @pytest.mark.parametrize("text", ["go to user 9", "go to user 12", "go to user 1 2", "go to 7"])
    def test_an_unknown_number_names_no_person(self, text: str) -> None:
        assert BOOK.understand(text) is None

    @pytest.mark.parametrize(
        ("text", "stranger"),
        [
            ("go to user 7", "user 7"),
            ("go to usr seven", "user 7"),
            ("drive over to user number 9", "user 9"),
            ("go to the player zorro", "player zorro"),
            ("go to zorro", "zorro"),
            ("go to user 2", None),
            ("go to user 1 2", None),
            ("go to front 7", None),
            ("call number 7", None),
            ("don't go to user 7", None),
            ("help the user", None),
            ("qwertz", None),
            ("", None),
        ],
    )
    def test_an_unknown_name_is_distinguished_from_unknown_words(
        self, text: str, stranger: str | None
    ) -> None:
        assert BOOK.stranger(text) == stranger
        if stranger is not None:
            assert BOOK.understand(text) is None

    @pytest.mark.parametrize("text", ["go to seat you", "go to user to", "drive to player to you"])
    def test_a_missing_name_names_no_person(self, text: str) -> None:
        assert BOOK.understand(text) is None
        assert any("go to" in near or "drive to" in near for near in BOOK.suggestions(text))

    def test_unknown_people_are_recognised_in_any_activity(
        self, lanterns: Activity, people: tuple[Person, ...]
    ) -> None:
        book = Phrasebook(lanterns, people)
        for behaviour in lanterns.behaviours.values():
            for phrase in behaviour.phrases:
                goes = behaviour.visits
                noun = phrase.split()[-1]
                assert book.stranger(f"{phrase} 9") == (f"{noun} 9" if goes else None)
        assert Phrasebook(lanterns, ()).stranger("go to user 9") is None

    @pytest.mark.parametrize(
        ("text", "behaviour"),
        [
            ("hello", "greeting"),
            ("would somebody call the next lucky number", "call number"),
            ("let us have a joke", "joke"),
            ("tell him to take those markers off", "remove markers"),
            ("drive all the way back to the front", "navigate to front"),
        ],
    )
    def test_keywords_alone_are_understood(self, text: str, behaviour: str) -> None:
        command = BOOK.understand(text)
        assert command is not None
        assert command.behaviour == behaviour
        assert 0.5 < command.confidence < 1

    def test_keywords_count_less_in_longer_sentences(self) -> None:
        short = BOOK.understand("a good joke")
        long = BOOK.understand("on sunday my uncle heard a joke about seven fishermen and a seal")
        assert short is not None
        assert long is not None
        assert long.confidence < short.confidence

    @pytest.mark.parametrize(
        ("slip", "behaviour"),
        [
            ("greet everyoen", "greeting"),
            ("clal a nubmer", "call number"),
            ("celebarte", "celebrate"),
            ("og to fornt", "navigate to front"),
            ("remvoe markers", "remove markers"),
            ("callnumber", "call number"),
            ("good bye every one", "valediction"),
        ],
    )
    def test_typing_slips_are_understood_with_doubt(self, slip: str, behaviour: str) -> None:
        command = BOOK.understand(slip)
        assert command is not None
        assert command.behaviour == behaviour
        assert 0.3 < command.confidence < 1

    @pytest.mark.parametrize(
        "text", ["hello and goodbye", "after that joke go to the front", "move closer to the front"]
    )
    def test_keywords_of_two_behaviours_decide_nothing(self, text: str) -> None:
        command = BOOK.understand(text)
        assert command is None or command.confidence < KEYWORDS_AT_LEAST

    def test_phrases_that_differ_only_in_fillers_are_uncertain(
        self, activity: Activity, people: tuple[Person, ...]
    ) -> None:
        changed = {
            name: replace(behaviour, phrases=(phrase,), keywords=())
            for (name, behaviour), phrase in zip(
                activity.behaviours.items(), ["do it now", "do it then"], strict=False
            )
        }
        book = Phrasebook(replace(activity, behaviours=changed), people)
        command = book.understand("do it")
        assert command is None or command.confidence < 1

    def test_words_shared_by_two_behaviours_offer_the_other(self) -> None:
        command = BOOK.understand("draw missing number")
        assert command is not None
        assert {command.behaviour, *command.alternatives} >= {"call number", "mark numbers"}
        assert command.confidence < 1

    @pytest.mark.parametrize(
        "text",
        [
            "",
            " \t\n",
            "the",
            "please",
            "yes",
            "n",
            "quit",
            "what is the weather like",
            "thank you very much",
            "don't call a number",
            "do not go to the front",
            "?!...",
            "🙂🙂",
        ],
    )
    def test_text_without_a_command_is_not_understood(self, text: str) -> None:
        assert BOOK.understand(text) is None

    def test_the_heard_text_is_printable(self) -> None:
        command = BOOK.understand("  Call\x07 a \u202eNumber \n please ")
        assert command is not None
        assert command.heard == "Call a Number please"

    @given(st.text())
    def test_any_text_is_understood_or_not_but_never_fails(self, text: str) -> None:
        for book in (BOOK, NAMED):
            command = book.understand(text)
            book.suggestions(text)
            book.complete(text)
            if command is not None:
                assert 0 < command.confidence <= 1
                assert len(command.heard) <= LONGEST_TEXT
                assert not any(unicodedata.category(c).startswith("C") for c in command.heard)
                assert command.behaviour not in command.alternatives
                assert len(set(command.alternatives)) == len(command.alternatives) <= 3

    @given(st.lists(st.sampled_from(sorted({w for p in BOOK.phrases for w in p.split()}))))
    def test_only_phrases_are_certain(self, words: list[str]) -> None:
        command = BOOK.understand(" ".join(words))
        if command is not None and command.confidence == 1:
            meant = [p for p in BOOK.phrases if bare(p) == bare(" ".join(words))]
            assert {BOOK.phrases[phrase] for phrase in meant} == {command.behaviour}

    @given(st.sampled_from(sorted(BOOK.phrases)), st.data())
    def test_a_swapped_letter_never_gives_a_certain_wrong_command(
        self, phrase: str, data: st.DataObject
    ) -> None:
        place = data.draw(st.integers(0, len(phrase) - 2))
        slip = phrase[:place] + phrase[place + 1] + phrase[place] + phrase[place + 2 :]
        command = BOOK.understand(slip)
        if command is not None and command.confidence == 1:
            assert command.behaviour == BOOK.phrases[phrase]

    @pytest.mark.slow
    def test_a_long_text_is_bounded_in_time(self) -> None:
        def seconds(words: int) -> float:
            begun = process_time()
            BOOK.understand("zelebrate " * words)
            BOOK.suggestions("\ufdfa" * words)
            return process_time() - begun

        capped = min(seconds(1_000) for _ in range(3))  # longer than the limit
        assert min(seconds(100_000) for _ in range(3)) < 20 * capped


class TestPeople:
    def test_numbers_of_people_come_from_their_ids(self, activity: Activity) -> None:
        book = Phrasebook(activity, [Person("user7", "Ada"), Person("user3", "Bob")])
        assert meaning(book, "go to user 3") == ("navigate to user", "user3")
        assert meaning(book, "go to user seven") == ("navigate to user", "user7")
        assert book.understand("go to user 1") is None

    def test_people_without_numbered_ids_are_counted(self, activity: Activity) -> None:
        book = Phrasebook(activity, [Person("ada", "Ada"), Person("bob", "Bob")])
        assert meaning(book, "go to user 2") == ("navigate to user", "bob")

    def test_a_shared_name_names_neither_person(self, activity: Activity) -> None:
        book = Phrasebook(activity, [Person("user1", "Rosa"), Person("user2", "ROSA")])
        assert "go to rosa" not in book.phrases
        assert meaning(book, "go to user 2") == ("navigate to user", "user2")

    @pytest.mark.parametrize("name", ["The", "Tangy", "🙂", "...", "front", "2", "a b c d"])
    def test_odd_names_hide_no_phrase(self, activity: Activity, name: str) -> None:
        book = Phrasebook(activity, [Person("user1", name), Person("user2", "Bob")])
        assert meaning(book, "go to the front") == ("navigate to front", None)
        assert meaning(book, "go to user") == ("navigate to user", None)
        assert meaning(book, "go to user 2") == ("navigate to user", "user2")

    @given(st.lists(st.text(max_size=20), min_size=1, max_size=8))
    def test_names_of_people_change_no_phrase_of_the_activity(
        self, activity: Activity, names: list[str]
    ) -> None:
        book = Phrasebook(activity, [Person(f"user{n}", name) for n, name in enumerate(names, 1)])
        for behaviour in activity.behaviours.values():
            for phrase in behaviour.phrases:
                assert meaning(book, phrase) == (behaviour.name, None)
        for number in range(1, len(names) + 1):
            found = meaning(book, f"go to user {number}")
            assert found is not None
            assert found[0] == "navigate to user"

    def test_another_activity_has_its_own_word_for_people(
        self, lanterns: Activity, people: tuple[Person, ...]
    ) -> None:
        book = Phrasebook(lanterns, people)
        assert meaning(book, "walk to guest three") == ("walk over", "user3")
        assert book.understand("call a number") is None

    def test_a_behaviour_without_phrases_is_called_by_its_name(
        self, activity: Activity, people: tuple[Person, ...]
    ) -> None:
        joke = replace(activity.behaviours["joke"], phrases=(), keywords=())
        bare = replace(activity, behaviours={**activity.behaviours, "joke": joke})
        assert meaning(Phrasebook(bare, people), "joke") == ("joke", None)


class TestCompleting:
    def test_the_usual_phrase_of_each_behaviour_comes_first(self, activity: Activity) -> None:
        first = BOOK.complete("")[: len(activity.behaviours)]
        assert BOOK.complete("ca")[0] == "call number"
        assert first[0] == activity.behaviours["greeting"].phrases[0]

    def test_people_are_completed_as_digits(self) -> None:
        assert BOOK.complete("go to user ") == tuple(f"go to user {n}" for n in "1234")
        assert BOOK.complete("Go  to user t") == ("go to user two", "go to user three")

    @given(st.sampled_from(sorted(BOOK.phrases)), st.integers(0, 60))
    def test_completions_begin_with_the_typed_text(self, phrase: str, length: int) -> None:
        found = BOOK.complete(phrase[:length])
        assert found
        assert all(completion.startswith(phrase[:length]) for completion in found)
        assert len(set(found)) == len(found)
        assert set(found) <= set(BOOK.phrases)

    def test_an_unknown_beginning_has_no_completion(self) -> None:
        assert BOOK.complete("xyz") == ()


class TestSuggesting:
    def test_the_nearest_phrases_are_suggested(self) -> None:
        assert BOOK.understand("number") is None
        assert "call number" in BOOK.suggestions("number")
        assert "go to user" in BOOK.suggestions("go")

    @given(st.text(max_size=60))
    def test_suggestions_are_phrases_of_different_behaviours(self, text: str) -> None:
        found = BOOK.suggestions(text)
        assert len({BOOK.phrases[phrase] for phrase in found}) == len(found) <= 3


class TestSpoken:
    def test_phrases_are_words_only(self) -> None:
        for phrase in (*BOOK.spoken(), *NAMED.spoken()):
            assert not any(c.isdigit() for c in phrase)
            assert phrase == " ".join(phrase.split()).casefold()

    def test_spoken_phrases_name_people_by_number_and_name(self) -> None:
        assert "go to user two" in BOOK.spoken()
        assert {"go to rosa", "go to jose luis", "go to user three"} <= set(NAMED.spoken())
        assert not {"go to the rosa", "go to the user two"} & set(NAMED.spoken())

    def test_every_phrase_of_the_activity_is_spoken(self, activity: Activity) -> None:
        listed = {p for b in activity.behaviours.values() for p in b.phrases}
        assert listed <= set(BOOK.spoken()) <= set(BOOK.phrases)

    def test_names_of_behaviours_are_spoken_only_if_they_are_listed(self) -> None:
        assert "valediction" in BOOK.phrases
        assert "valediction" not in BOOK.spoken()

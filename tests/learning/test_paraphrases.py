"""Paraphrases: understood by the learnt intent model, offered, or ignored."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest

from tangy_profiles.activity import Activity, load_activity, shipped_activities
from tangy_profiles.errors import ProfileError
from tangy_profiles.person import Person, load_people
from tangy_profiles.room import load_room
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.examples import SOMEBODY, Example, examples_of
from tangy_tui.language.intent_model import IntentModel, UnreadableModel, read_model
from tangy_tui.language.intents import SHIPPED, Intents, digest_of
from tangy_tui.language.mentions import Mentions
from tangy_tui.language.words import words_of
from tangy_tui.learning.verification import Reply, Say
from tangy_tui.speech.evidence import USUAL, AcousticEvidence
from tangy_tui.speech.understanding import clearly_heard, commanded, understand, wanted
from tests.support.changed import changed_trivia
from tests.support.understood import behaviour_of

BINGO = load_activity("bingo")
PEOPLE = load_room().placed([*load_people(3), Person("user4", "Rosa")])
BOOK = Phrasebook(BINGO, PEOPLE, Intents().model)

REQUESTS = [
    ("encourage them", "encourage"),
    ("ask for the card", "move card closer"),
    ("do you know any jokes", "joke"),
    ("please let us have another joke", "joke"),
    ("would you say hello to all of them", "greeting"),
    ("could you draw another number", "call number"),
    ("tell her to take the wrong markers off", "remove markers"),
    ("please make us laugh", "joke"),
    ("say something kind to him", "encourage"),
    ("she won, clap for the winner", "celebrate"),
    ("help her put her card so that you can see it", "move card closer"),
    ("help Rosa hold her card so that you see it", "move card closer"),
    ("help her put a marker on her card", "mark numbers"),
    ("help her take the marker off her card", "remove markers"),
]
VISITS = [
    ("player one needs a hand", "user1"),
    ("please check on player two", "user2"),
    ("the third player has a question", "user3"),
    ("rosa needs help", "user4"),
    ("see what rosa wants", "user4"),
    ("go over to the person in seat one", "user1"),
]


@pytest.mark.parametrize(("text", "behaviour"), REQUESTS)
def test_paraphrases_are_understood_typed_and_spoken(text: str, behaviour: str) -> None:
    typed = BOOK.understand(text)
    assert typed is not None and typed.behaviour == behaviour
    heard = understand(clearly_heard(text), BOOK, USUAL)
    assert isinstance(heard, Say) and heard.commands
    assert heard.commands[0].behaviour == behaviour  # the question, or the first choice


@pytest.mark.parametrize(("text", "user"), VISITS)
def test_a_paraphrase_names_the_person_to_visit(text: str, user: str) -> None:
    found = BOOK.understand(text)
    assert found is not None
    assert (found.behaviour, dict(found.arguments)) == ("navigate to user", {"user": user})


@pytest.mark.parametrize("name", list(BINGO.behaviours))
def test_names_of_behaviours_are_understood_typed_and_spoken(name: str) -> None:
    typed = BOOK.understand(name)
    assert typed is not None and typed.behaviour == name
    assert behaviour_of(understand(clearly_heard(name), BOOK, USUAL)) == name


@pytest.mark.parametrize(
    "text",
    [
        "they moved the room upstairs",
        "don't call the next number",
        "please do not tell a joke",
        "did she celebrate her birthday",
        "go to user 9",
        "go to user 1 and user 2",
        "the tea is too hot",
        "",
        "\u0000 \u202e",
    ],
)
def test_everyday_talk_is_no_command(text: str) -> None:
    said = understand(clearly_heard(text), BOOK, USUAL)
    assert behaviour_of(said) is None


def test_the_intent_model_changes_no_phrase() -> None:
    plain = Phrasebook(BINGO, PEOPLE)
    for phrase in plain.phrases:
        assert BOOK.understand(phrase) == plain.understand(phrase)


@pytest.mark.parametrize(
    ("activity", "text", "behaviour"),
    [
        ("trivia", "point her the right way", "give hint"),
        ("trivia", "read out the points please", "tell scores"),
        ("trivia", "let them think about it for a while", "allow time"),
        ("exercises", "would you count out loud", "count aloud"),
        ("exercises", "show us the next exercise", "show movement"),
    ],
)
def test_common_requests_are_understood_in_each_activity_that_has_them(
    activity: str, text: str, behaviour: str
) -> None:
    found = Phrasebook(load_activity(activity), PEOPLE, Intents().model).understand(text)
    assert found is not None and found.behaviour == behaviour


def test_an_activity_s_own_wording_is_no_common_request_of_another_behaviour() -> None:
    trivia = load_activity("trivia")
    own = replace(trivia.behaviours["tell scores"], wordings=("drop a hint",))
    changed = replace(trivia, behaviours={**trivia.behaviours, "tell scores": own})
    assert Example(words_of("drop a hint"), "give hint") in examples_of(trivia)
    assert Example(words_of("drop a hint"), "tell scores") in examples_of(changed)


@pytest.mark.slow
def test_the_model_of_a_new_activity_is_learnt_from_its_phrases(
    lanterns: Activity, tmp_path: Path
) -> None:
    intents = Intents(tmp_path)
    book = Phrasebook(lanterns, PEOPLE, intents.model)
    for behaviour in lanterns.behaviours.values():
        if behaviour.only_talks:
            found = book.understand(f"it is time to {behaviour.phrases[0]} I think")
            assert found is not None and found.behaviour == behaviour.name
    assert len(list(tmp_path.glob("*.json"))) == 1


@pytest.mark.slow
def test_a_stored_model_is_used_only_if_it_fits_the_activity(
    lanterns: Activity, tmp_path: Path
) -> None:
    model = Intents(tmp_path).model(lanterns)
    (kept,) = tmp_path.glob("*.json")
    assert Intents(tmp_path).model(lanterns) == model
    kept.write_text('{"behaviours": ["a"], "offsets": [0.0, 1.0], "weights": {}}')
    assert Intents(tmp_path).model(lanterns) == model


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"behaviours":["a"],"offsets":["x"]}', "[[[["])
def test_an_invalid_model_is_refused(text: str) -> None:
    with pytest.raises(UnreadableModel):
        read_model(text)


@pytest.mark.parametrize("name", list(shipped_activities()))
def test_every_shipped_activity_has_a_current_shipped_model(name: str) -> None:
    assert (SHIPPED / f"{digest_of(load_activity(name))}.json").exists(), (
        "run: python -m tangy_tui.language.intent_training"
    )


def test_every_shipped_model_belongs_to_a_shipped_activity() -> None:
    shipped = {digest_of(load_activity(name)) for name in shipped_activities()}
    assert {file.stem for file in SHIPPED.glob("*.json")} - shipped == set(), (
        "run: python -m tangy_tui.language.intent_training"
    )


def test_other_phrases_change_the_digest() -> None:
    greeting = BINGO.behaviours["greeting"]
    other = replace(greeting, phrases=(*greeting.phrases, "hi all"))
    changed = replace(BINGO, behaviours={**BINGO.behaviours, "greeting": other})
    assert digest_of(changed) != digest_of(BINGO)


def test_a_model_is_read_back_unchanged() -> None:
    model = IntentModel(("", "a"), (0.0, 1.5), {"b": (0.25, -1.0)})
    assert read_model(model.to_json()) == model
    assert json.loads(model.to_json())["behaviours"] == ["", "a"]


def test_training_examples_are_unique_and_cover_every_behaviour() -> None:
    examples = examples_of(BINGO)
    assert len({one.words for one in examples}) == len(examples)
    assert {one.behaviour for one in examples} == {"", *BINGO.behaviours}


def test_every_mention_of_a_person_is_one_token() -> None:
    mentions = Mentions(BOOK.table, BOOK.nouns)
    for who in ("user 2", "the second player", "user number two", "user 2's", "user two's"):
        found = mentions.find(words_of(f"look at {who} card"))
        assert found.words == ("look", "at", SOMEBODY, "card")
        assert found.users == {"user2"}
    assert mentions.find(words_of("look at user 9")).strangers
    assert mentions.find(words_of("help the person in")).users == set()


def test_of_several_guesses_the_likeliest_meaning_on_the_weighted_average_counts() -> None:
    guesses = ("the kettle is on the table", "let us have another joke", "let us tell another joke")
    alone = BOOK.paraphrased(guesses[1])
    found = BOOK.paraphrased(*guesses)
    assert found[0].behaviour == alone[0].behaviour == "joke"
    assert found[0].confidence < alone[0].confidence
    assert BOOK.paraphrased(guesses[0], "the weather is nice today", "my back hurts") == ()


def test_the_model_is_looked_up_once_for_all_guesses_and_sentences() -> None:
    asked, activity = [], load_activity("bingo")

    def learnt(one: Activity) -> IntentModel:
        asked.append(one)
        return Intents().model(one)

    book = Phrasebook(activity, load_people(4), learnt)
    assert asked == []  # it may have to be trained first
    for _ in range(2):
        assert book.paraphrased("would you read out another number", "read a number out")
    assert asked == [activity]


@pytest.mark.parametrize(("likely", "sure"), [(0.3, False), (0.7, True)])
def test_a_near_phrase_is_sure_only_if_the_intent_model_supports_it(
    likely: float, sure: bool
) -> None:
    offsets = (math.log(1 - likely), math.log(likely))
    book = Phrasebook(BINGO, PEOPLE, lambda _: IntentModel(("", "joke"), offsets, {}))
    said = understand(clearly_heard("tell another joke about the war"), book, USUAL)
    assert isinstance(said, Say) and said.commands
    assert (said.commands[0].behaviour, said.sure) == ("joke", sure)


def test_nothing_is_offered_if_the_best_guess_forbids_it() -> None:
    others = ("do let us tell another joke", "let us tell another joke", "let's tell another joke")
    assert BOOK.paraphrased(*others)[0].behaviour == "joke"
    assert BOOK.paraphrased("do not let us tell another joke", *others) == ()


@pytest.mark.parametrize(("guesses", "offered"), [
    (("my back hurts", "let us tell another joke"), False),
    (("let us tell another joke", "my back hurts"), True),
])  # fmt: skip
def test_a_free_wording_is_offered_only_if_the_guesses_agree(
    guesses: tuple[str, ...], offered: bool
) -> None:
    assert BOOK.paraphrased(*guesses), "likely enough for words that were typed"
    evidence = AcousticEvidence("the dog is out", "", -0.2, 1.0, 1.0, guesses=guesses)
    said = understand(evidence, BOOK, USUAL)
    assert isinstance(said, Say) and said.commands is not None
    assert [command.behaviour for command in said.commands] == ["joke"] * offered


def test_sound_that_fits_badly_counts_against_words_but_not_against_guesses_that_agree() -> None:
    text = "let us tell another joke"
    alone = AcousticEvidence(text, "", -1.0, 1.0, 1.0)
    without, agreed = (
        understand(one, BOOK, USUAL) for one in (alone, replace(alone, guesses=(text,)))
    )
    assert isinstance(without, Say) and isinstance(agreed, Say)
    assert agreed.commands and agreed.confidence == BOOK.paraphrased(text)[0].confidence
    assert without.confidence < agreed.confidence - 0.05


def test_a_yes_is_heard_whatever_the_guesses_at_a_sentence_are() -> None:
    heard = AcousticEvidence("yes", "", 0.0, 1.0, 1.0, guesses=("guess the", "guess"))
    assert commanded(heard, BOOK, USUAL, live=False) == (Reply(True), None)


def test_the_person_whom_most_guesses_name_is_meant() -> None:
    found = BOOK.paraphrased("please check on rosa", "go and see user one", "see what rosa wants")
    assert found[0].behaviour == "navigate to user"
    assert found[0].arguments == {"user": "user4"}


def test_requests_are_listened_for_with_the_people_who_are_there() -> None:
    sentences = BOOK.table.sentences
    assert "tell a funny story please" in sentences
    assert any("rosa" in sentence.split() for sentence in sentences)
    assert any("user two" in sentence for sentence in sentences)
    assert not [sentence for sentence in sentences if SOMEBODY in sentence]
    assert set(sentences) <= set(wanted(BOOK, USUAL).sentences)


def test_wordings_are_training_data_but_no_phrases() -> None:
    examples = {example.words: example.behaviour for example in examples_of(BINGO)}
    for behaviour in BINGO.behaviours.values():
        for text in behaviour.wordings:
            assert examples[words_of(text)] == behaviour.name
            assert words_of(text) not in {phrase.words for phrase in BOOK.table.all()}


def test_wordings_of_a_declared_activity_are_training_data(tmp_path: Path) -> None:
    phrases = 'phrases = ["give a hint", "help with the question"]\n'
    worded = f'{phrases}wordings = ["make it a little easier"]\n'
    activity = changed_trivia(tmp_path, (phrases, worded))
    examples = {example.words: example.behaviour for example in examples_of(activity)}
    assert examples[words_of("make it a little easier")] == "give hint"


def test_a_wording_must_be_unique_and_in_lower_case(tmp_path: Path) -> None:
    phrases = 'phrases = ["that is right"]\n'
    for wording, problem in (("give a hint", "belongs to"), ("Well Done!", "small letters")):
        with pytest.raises(ProfileError, match=problem):
            changed_trivia(tmp_path, (phrases, f'{phrases}wordings = ["{wording}"]\n'))

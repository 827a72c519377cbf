"""`tangy people pronounce` and `tangy people voice`: pronunciation of names, and voices."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Annotated

import typer

from tangy_profiles.defaults import DEFAULT_ACTIVITY
from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.text.names import conflict_words, if_right, said_words, voice_words
from tangy_tui.verbs.common import REGISTERED, Data, Json, Seed, Users, as_given, print_json
from tangy_tui.verbs.opening import open_workspace
from tangy_tui.verbs.people import Who

if TYPE_CHECKING:
    from tangy_profiles.person import Person
    from tangy_profiles.voice import VoicePreference

Sink = Annotated[str, typer.Option(help="What plays it: auto, the name of a program, or null.")]


def people_pronounce(
    person: Who,
    phones: Annotated[
        str | None,
        typer.Argument(
            metavar='["R OW Z AH"]',
            help="ARPAbet phones, a comma between words; without them: how it is said now.",
        ),
    ] = None,
    hear: Annotated[bool, typer.Option("--hear", help="Say it aloud.")] = False,
    accept: Annotated[bool, typer.Option("--accept", help="Accept what Tangy suggests.")] = False,
    forget: Annotated[bool, typer.Option("--forget", help="Drop the noted pronunciation.")] = False,
    sink: Sink = "auto",
    seed: Seed = None,
    data: Data = None,
    users: Users = REGISTERED,
    as_json: Json = False,
) -> None:
    """Say how a person's name is pronounced.

    Tangy then recognises it when you say it.
    """
    from tangy_tui.language.name_conflicts import find_clash
    from tangy_tui.language.name_pronunciation import accept_suggested, how_said

    changes = phones is not None or accept or forget
    if (phones is not None) + accept + forget > 1:
        raise TangyError("Choose one: phones, --accept or --forget.")
    with open_workspace(data, DEFAULT_ACTIVITY, users, write=changes) as workspace:
        found = workspace.find_person(person)
        if accept:
            phones = accept_suggested(found)
        if changes:
            workspace.pronounce(found, phones)
            found = workspace.find_person(found.id)
        said = how_said(found)
        if as_json:
            print_json({"id": found.id, "name": found.name, **said.to_json()})
        else:
            clash = find_clash(workspace.activity, workspace.people, found)
            print(plain(said_words(said)))
            if clash is not None:
                print(plain(conflict_words(clash)))
            elif said.source == "suggested":
                verb = f"tangy people pronounce {found.id}{as_given(data, users)}"
                print(plain(if_right(verb)))
    if hear:
        _hear(said.phones, found, sink)


def people_voice(
    person: Who,
    rate: Annotated[int | None, typer.Option(help="Words a minute, 80 to 260.")] = None,
    voice: Annotated[
        str | None, typer.Option(help="A voice such as en-us, en-gb or en-us+f3.")
    ] = None,
    usual: Annotated[
        bool, typer.Option("--usual", help="Use the same voice as with everybody else.")
    ] = False,
    seed: Seed = None,
    data: Data = None,
    users: Users = REGISTERED,
    as_json: Json = False,
) -> None:
    """Choose how fast and in which voice Tangy speaks to a person."""
    from tangy_profiles.voice import VoicePreference

    wanted = VoicePreference(rate, voice)
    if usual and (rate, voice) != (None, None):
        raise TangyError("Choose one: --usual, or a --rate and a --voice.")
    changes = usual or (rate, voice) != (None, None)
    with open_workspace(data, DEFAULT_ACTIVITY, users, write=changes) as workspace:
        found = workspace.find_person(person)
        if voice is not None:
            _check_voice(wanted)
        if changes:
            workspace.prefer_voice(found, VoicePreference() if usual else wanted.over(found.voice))
            found = workspace.find_person(found.id)
        if as_json:
            chosen = {"rate": found.voice.rate, "voice": found.voice.voice}
            print_json({"id": found.id, "name": found.name, **chosen})
        else:
            print(plain(voice_sentence(found)))


def voice_sentence(person: Person) -> str:
    """Tell how a person is spoken to."""
    return voice_words(person.name, person.voice.rate, person.voice.voice)


def _check_voice(wanted: VoicePreference) -> None:
    """Refuse a voice that espeak-ng does not have, if it is installed."""
    from tangy_hw.audio.synthesis import Synthesiser

    synthesiser = Synthesiser()
    if not synthesiser.reason:
        synthesiser.check(wanted)


def _hear(phones: str, person: Person, sink: str) -> None:
    from tangy_tui.app.aloud import hear

    if not phones:
        raise TangyError(plain(f"Nobody knows how {person.name} is said: give the phones."))
    asyncio.run(hear(phones, person.voice, sink))

"""The workspace: profiles, the store and a simulated world together, for screens and lines."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from datetime import datetime
from functools import cached_property
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING

from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.defaults import REGISTERED, USUAL_ROBOT
from tangy_profiles.errors import TangyError
from tangy_profiles.game_records import GameBeginning
from tangy_profiles.person import Person, folded, load_people, unaccented
from tangy_profiles.process_log import logging_to
from tangy_profiles.reading import plain
from tangy_profiles.robot import Robot, load_robot
from tangy_profiles.room import room_for
from tangy_profiles.state import FRONT
from tangy_profiles.store import Store
from tangy_tui.app.chosen_activity import choose_activity, chosen_activity
from tangy_tui.app.register import known_people, participants, past_guests

# The engine is imported when it is first asked for: the first screen needs none of it.
from tangy_tui.app.session_door import SessionDoor
from tangy_tui.app.teacher_profile import login_name, read_profile
from tangy_tui.app.user_settings import read_settings

if TYPE_CHECKING:
    from tangy_profiles.demonstration import Demonstration
    from tangy_profiles.game_world import GameWorld
    from tangy_profiles.health import Health
    from tangy_profiles.voice import VoicePreference
    from tangy_tui.interaction.facilitation import Facilitation
    from tangy_tui.interaction.forgetting import Forgotten
    from tangy_tui.interaction.memory import PersonModels
    from tangy_tui.interaction.persuasion import Persuasion
    from tangy_tui.interaction.record import Record
    from tangy_tui.language.commands import Phrasebook
    from tangy_tui.language.intents import Intents
    from tangy_tui.learning.policy import Policy
    from tangy_tui.learning.teaching_events import Again
    from tangy_tui.learning.teaching_session import TeachingSession
    from tangy_tui.monitoring.supervision import Supervision
    from tangy_tui.world import World


def data_folder(chosen: Path | None) -> Path:
    """Return the data folder: the chosen one, or the platform's folder for a person's data."""
    from platformdirs import user_data_path

    return chosen or user_data_path("tangy", appauthor=False)


class Workspace:
    """One activity with its robot, room and people, and the data folder they are kept in."""

    def __init__(
        self,
        folder: Path,
        *,
        activity: str = "",
        users: int = REGISTERED,
        write: bool = True,
        robot: str = USUAL_ROBOT,
        now: Callable[[], datetime] | None = None,
    ) -> None:
        """Read the profiles and open the store, whose clock is `now` (default: the machine's).

        Raises:
            ProfileError: a profile or the settings have a mistake, or there is no such activity.
            StoreError: the data folder cannot be used, or another Tangy writes to it.
        """
        self.settings = read_settings(folder)
        self._users = users
        self.robot: Robot = load_robot(robot)
        self._take_up(activity or chosen_activity(folder))
        load_people(1 if users == REGISTERED else users)  # before a store is opened for them
        self.store = Store.open(folder, write=write, now=now)
        self.door = SessionDoor(folder)
        self._logging = ExitStack()
        if write:
            self._logging.enter_context(logging_to(folder))
        self.people: tuple[Person, ...] = ()
        self.register(users)
        for guest in past_guests(self.store) if write else ():
            self.forget(guest)  # a guest is there for a day

    def _take_up(self, activity: str) -> None:
        loaded: Activity = load_activity(activity)
        self.robot.check(loaded)
        self.activity, self.profile = loaded, activity  # the latter: as it was asked for

    def change_activity(self, activity: str) -> None:
        """Teach and play another activity from now on, or raise TangyError where it cannot be."""
        self._take_up(choose_activity(self.store.folder, activity))
        self.register(self._users)

    @property
    def teacher(self) -> str:
        """Who teaches here, as they said when they began; else the login name."""
        return read_profile(self.store.folder).name or login_name()

    def close(self) -> None:
        """Close the store, the door, and the log of what the program decides."""
        self.door.close()
        self._logging.close()
        self.store.close()

    def read_people(self) -> None:
        """Reload the people: names, pronunciations, voices, seats."""
        self.people = self.room.placed(known_people(self.store, self._sample))

    def register(self, users: int = REGISTERED) -> None:
        """Let the first `count` registered people take part, or all of them."""
        teams = tuple(Person(team, team) for team in self.activity.teams)
        self._sample = teams or participants(self.store, users)
        self.room = room_for(len(self._sample))
        self.read_people()

    def seat(self, order: Sequence[str]) -> None:
        """Let people sit in another order of their ids."""
        self._sample = tuple(sorted(self._sample, key=lambda person: order.index(person.id)))
        self.read_people()

    def name(self, person: str) -> str:
        """Return a person's name."""
        return next((p.name for p in self.people if p.id == person), person)

    def find_person(self, wanted: str) -> Person:
        """Return the person of an id or a name.

        Raises:
            TangyError: nobody, or more than one, is called that.
        """
        by_id = [p for p in self.people if p.id == wanted]
        found = by_id or [p for p in self.people if folded(p.name) == folded(wanted)]
        found = found or [p for p in self.people if unaccented(p.name) == unaccented(wanted)]
        if len(found) == 1:
            return found[0]
        if found:
            raise TangyError(plain(f"More than one person is called {wanted!r}: use the id."))
        there = ", ".join(f"{p.id} is {p.name}" for p in self.people)  # never guess at a person
        raise TangyError(plain(f"There is nobody called {wanted!r}: {there}."))

    def rename(self, person: Person, name: str) -> None:
        """Give a person another name, one that nobody else answers to.

        Lines that were spoken with the old one are forgotten.

        Raises:
            TangyError: the name is somebody else's name or id, or a place, or means something
                else where it is said.
        """
        wanted = folded(name)
        taken = {FRONT: "is a place"}
        for other in self.people:
            if other.id != person.id:
                taken |= dict.fromkeys(
                    (folded(other.id), folded(other.name)), f"is what {other.id} is called"
                )
        if wanted in taken:
            raise TangyError(plain(f"{name!r} {taken[wanted]}: choose another name."))
        from tangy_tui.speech.name_conflicts import check_new_name

        check_new_name(self.activity, self.people, replace(person, name=name.strip()))
        old = self.name(person.id)
        self.store.rename(person.id, name)
        self.read_people()
        if self.name(person.id) != old:
            from tangy_hw.audio.synthesis import clear_cache

            clear_cache()

    def pronounce(self, person: Person, phones: str | None) -> None:
        """Note how a person's name is pronounced (ARPAbet, a comma between words); None: no more.

        Raises:
            TangyError: a phone is none, there are not as many words as in the name, or it sounds
                like somebody else's, or like a phrase.
        """
        self.store.pronounce(person.id, phones and self.check_said(person, phones))
        self.read_people()

    def check_said(self, person: Person, phones: str) -> str:
        """Return the phones of a person's name as they are written down.

        Raises:
            TangyError: as for `pronounce`.
        """
        from tangy_tui.language.pronunciation import check_name
        from tangy_tui.speech.name_conflicts import check_said

        checked = check_name(phones, person.name)
        check_said(self.activity, self.people, person, checked)
        return checked

    def prefer_voice(self, person: Person, preference: VoicePreference) -> None:
        """Note how a person likes to be spoken to."""
        self.store.prefer_voice(person.id, preference)
        self.read_people()

    def forget(self, person: Person, also: Sequence[str] = ()) -> Forgotten:
        """Forget a person: name, pronunciation, voice, face, and consent.

        The name goes from words that were typed or said as well, in the log and in the files of
        the data folder. What they did stays in the log, under an id that says nobody's name.

        Args:
            person: who.
            also: other names that they were called by, which are to go, too.

        Raises:
            TangyError: some of it cannot be deleted.
        """
        from tangy_tui.interaction.forgetting import forget_person

        forgotten = forget_person(self.store, self.activity, self.people, person, also)
        self.read_people()
        from tangy_hw.audio.synthesis import clear_cache

        clear_cache()
        return forgotten

    @property
    def names(self) -> dict[str, str]:
        """The participants' names, by id."""
        return {person.id: person.name for person in self.people}

    @cached_property
    def intents(self) -> Intents:
        """The learnt intent classifier of the activity's behaviours."""
        from tangy_tui.language.intents import Intents

        return Intents()

    def phrasebook(self) -> Phrasebook:
        """Make the phrasebook of said and typed commands, with the teacher's own phrases."""
        from tangy_tui.learning.own_phrases import OwnPhrases

        own = OwnPhrases(self.store, self.activity, self.teacher)
        return own.phrasebook(self.people, self.intents.model)

    def teaching(
        self,
        teacher: str,
        seed: int | None,
        *,
        guided: bool = False,
        again: Again | None = None,
    ) -> TeachingSession:
        """Make a teaching session; `begin` resumes an unfinished demonstration.

        Without a seed the games count on from the demonstrations there are, so that no two are
        alike and each can be had again. A guided game brings about every situation. `again`
        names a demonstration that is to be shown again from some step on.
        """
        from tangy_tui.learning import library
        from tangy_tui.learning.teaching_session import TeachingSession

        if seed is None:
            entries = library.read_library(self.store, self.activity.name).entries.values()
            seed = 1 + max((entry.demonstration.seed for entry in entries), default=0)
        return TeachingSession(
            self.activity,
            self.people,
            self.store,
            self.teaching_world,
            teacher=teacher,
            seed=seed,
            guided=guided,
            again=again,
            learnt=self.intents.model,
        )

    def teaching_world(self, shown: Demonstration) -> World:
        """Make the simulated world of a demonstration, in which people ask more often."""
        from tangy_tui.app.simulated_worlds import teaching_world

        return teaching_world(self.activity, shown, self.store)

    def supervision(
        self,
        policy: Policy,
        seed: int | None,
        *,
        asks: bool = False,
        injections: Sequence[str] = (),
        live: Callable[[], Health] | None = None,
        world: World | None = None,
    ) -> Supervision:
        """Make a run of games under execution monitoring; they are simulated ones.

        Args:
            policy: by which is played.
            seed: of the random generators.
            asks: somebody is there to say what to do where Tangy is not sure.
            injections: faults that are to come, as in `--inject`.
            live: what real devices report, in place of the simulated ones.
            world: where they are played instead, and where `injections` are its own business.

        Raises:
            TangyError: one of the injections is none, or the fault rules have a mistake.
        """
        from tangy_profiles.fault_file import load_faults
        from tangy_profiles.game_world import LIVE
        from tangy_sim.worlds.injection import read_injection
        from tangy_tui.app.simulated_worlds import game_world
        from tangy_tui.monitoring.accepted import expected_effects
        from tangy_tui.monitoring.calls import Calls
        from tangy_tui.monitoring.supervision import Supervision

        to_come = [read_injection(text) for text in injections]
        seed = self.game_seed(seed)
        if world is None:
            world = game_world(self.activity, list(self.names), seed, to_come, live)
        supervision = Supervision(
            self._facilitation(world, policy, seed, asks),
            load_faults(self.robot),
            self.robot,
            self.store,
            lambda learnt: expected_effects(self.store, self.activity, learnt),
            self.name,
            [str(one) for one in to_come],
        )
        if world.played_in == LIVE:
            supervision.call_by(Calls(self.robot, self.store.append))
        return supervision

    def facilitation(self, policy: Policy, seed: int | None, *, asks: bool = False) -> Facilitation:
        """Make a run of simulated games with a policy and the stored posteriors.

        Args:
            policy: by which is played.
            seed: of the random generators.
            asks: somebody is there to say what to do where Tangy is not sure.
        """
        from tangy_tui.app.simulated_worlds import game_world

        seed = self.game_seed(seed)
        world = game_world(self.activity, list(self.names), seed, None)
        return self._facilitation(world, policy, seed, asks)

    def game_seed(self, seed: int | None) -> int:
        """Return a seed: the given one, or one that no game has had."""
        if seed is not None:
            return seed
        games = self.store.events(GameBeginning)
        return 1 + max((game.record.seed for game in games), default=0)

    def _facilitation(self, world: World, policy: Policy, seed: int, asks: bool) -> Facilitation:
        from tangy_tui.interaction.facilitation import Facilitation
        from tangy_tui.learning.online_learning import OnlineLearning

        return Facilitation(
            world,
            policy,
            self.persuasion(Random(f"{seed}/persuasion"), world.played_in),
            self.store,
            names=self.names,
            people=self.people,
            seed=seed,
            answers=OnlineLearning(self.store, self.activity) if asks else None,
            learnt=self.intents.model,
        )

    def persuasion(self, rng: Random, world: GameWorld | None = None) -> Persuasion:
        """Make the persuasion of everybody present from the responses in a world's games."""
        from tangy_tui.interaction.persuasion import Persuasion

        memory = self.memory(world)
        return Persuasion(
            [person.id for person in self.people],
            tuple(self.activity.strategies),
            rng,
            counts=memory.responses(),
            memory=memory,
        )

    def memory(self, world: GameWorld | None = None) -> PersonModels:
        """Make the memory of people's responses, with the activity's method of choice.

        Args:
            world: whose games count (default: the world of the last game).
        """
        from tangy_tui.interaction.memory import PersonModels

        strategies = tuple(self.activity.strategies)
        return PersonModels(self.store, strategies, self.activity.persuasion, world=world)

    def records(self, *people: Person, world: GameWorld | None = None) -> list[Record]:
        """Read the report data of people (of everybody, if none is named)."""
        from tangy_tui.interaction.record import read_records

        return read_records(self.store, self.memory(world), people or self.people)

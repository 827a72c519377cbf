"""The workspace: profiles, the store and a simulated world, for screens and the console."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from datetime import datetime
from functools import cached_property
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, TypedDict

from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.defaults import REGISTERED, USUAL_ROBOT
from tangy_profiles.errors import ProfileError, TangyError
from tangy_profiles.person import Person, load_people
from tangy_profiles.process_log import logging_to
from tangy_profiles.robot import Robot, load_robot
from tangy_profiles.store import Store
from tangy_tui.app.chosen_activity import choose_activity, chosen_activity
from tangy_tui.app.participants import Participants
from tangy_tui.app.register import past_guests
from tangy_tui.app.rooms import check_places, chosen_room, find_room

# The engine is imported on first use: the first screen does not need it.
from tangy_tui.app.session_door import SessionDoor
from tangy_tui.app.teacher_profile import login_name, read_profile
from tangy_tui.app.user_settings import read_settings

if TYPE_CHECKING:
    from tangy_profiles.demonstration import Demonstration
    from tangy_profiles.game_world import GameWorld
    from tangy_profiles.health import Health
    from tangy_profiles.room import Room
    from tangy_tui.interaction.facilitation import Facilitation
    from tangy_tui.interaction.memory import PersonModels
    from tangy_tui.interaction.persuasion import Persuasion
    from tangy_tui.interaction.record import PersonSummary
    from tangy_tui.language.commands import Phrasebook
    from tangy_tui.language.intents import Intents
    from tangy_tui.learning.policy import Policy
    from tangy_tui.learning.teaching_events import Again
    from tangy_tui.learning.teaching_session import TeachingSession
    from tangy_tui.monitoring.supervision import Supervision
    from tangy_tui.world import World


def data_folder(chosen: Path | None) -> Path:
    """Return the data folder: the chosen one, or the platform's folder for user data."""
    from platformdirs import user_data_path

    return chosen or user_data_path("tangy", appauthor=False)


class CallOptions(TypedDict):
    """Options of a command line that opens an activity and a data folder; "" if it needs none."""

    activity: str
    data: str


class Workspace(Participants):
    """One activity with its robot, room and people, and their data folder."""

    def __init__(
        self,
        folder: Path,
        *,
        activity: str = "",
        users: int = REGISTERED,
        write: bool = True,
        robot: str = USUAL_ROBOT,
        room: str = "",
        now: Callable[[], datetime] | None = None,
    ) -> None:
        """Read the profiles and open the store.

        Args:
            folder: the data folder.
            activity: its name or file; "" for the chosen one.
            users: the number of participants.
            write: open the store for writing.
            robot: the name or file of its profile.
            room: its name or file; "" for the chosen one.
            now: the clock of the store; None for the machine's.

        Raises:
            ProfileError: a profile or the settings have a mistake, or the activity does not exist.
            StoreError: the data folder cannot be used, or another Tangy writes to it.
            TangyError: not everybody fits into the room.
        """
        self.settings = read_settings(folder)
        self._users = users
        self.robot: Robot = load_robot(robot)
        self._take_up(activity or chosen_activity(folder))
        load_people(1 if users == REGISTERED else users)  # before a store is opened for them
        self.room_problem = ""
        """Why the room that staff chose cannot be used (its file is gone, or has a mistake)."""
        try:
            self.chosen_room = find_room(folder, room) if room else chosen_room(folder)
        except ProfileError as error:
            if room:
                raise
            self.chosen_room, self.room_problem = None, str(error)
        self.room_is_given = bool(room)
        """Whether the room was named for this run; if not, a resumed game keeps its own room."""
        self.store = Store.open(folder, write=write, now=now)
        self.door = SessionDoor(folder)
        self._logging = ExitStack()
        if write:
            self._logging.enter_context(logging_to(folder))
        self.people = ()
        self.register(users)
        if room and self.chosen_room is not None:
            try:
                check_places(self.chosen_room, len(self.people))
            except TangyError:
                self.close()
                raise
        for guest in past_guests(self.store) if write else ():
            self.forget(guest)  # guests stay for one day

    def _take_up(self, activity: str) -> None:
        loaded: Activity = load_activity(activity)
        self.robot.check(loaded)
        self.activity, self.profile = loaded, activity  # `profile` as it was requested

    def change_activity(self, activity: str) -> None:
        """Change to another activity; raises TangyError if that is not possible."""
        self._take_up(choose_activity(self.store.folder, activity))
        self.register(self._users)

    def leave_resumed_game(self, room: Room | None) -> None:
        """Go back to the people who take part now, and to the room chosen before the game."""
        self.chosen_room = room
        self.register(self._users)

    @property
    def call_options(self) -> CallOptions:
        """The options of a command that opens this activity and folder: those it cannot omit."""
        folder = self.store.folder
        try:
            chosen = chosen_activity(folder)
        except ProfileError:  # a mistake in the file of the choice is no matter of this call
            chosen = ""
        return {
            "activity": "" if self.profile == chosen else self.profile,
            "data": "" if folder == data_folder(None).absolute() else str(folder),
        }

    @property
    def teacher(self) -> str:
        """The teacher's stored name, or else the login name."""
        return read_profile(self.store.folder).name or login_name()

    def close(self) -> None:
        """Close the store, the socket, and the decision log."""
        self.door.close()
        self._logging.close()
        self.store.close()

    @cached_property
    def intents(self) -> Intents:
        """The learnt intent classifier of the activity's behaviours."""
        from tangy_tui.language.intents import Intents

        return Intents()

    def phrasebook(self) -> Phrasebook:
        """Create the phrasebook of spoken and typed commands, with the teacher's own phrases."""
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
        """Create a teaching session; `begin` resumes an unfinished demonstration.

        Without a seed, the session takes one that no demonstration has used yet. A guided game
        brings about every situation. `again` names a demonstration to show again from some step.
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
        """Create the simulated world of a demonstration, in which people ask more often."""
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
        rehearsal: str = "",
    ) -> Supervision:
        """Create a run of games under execution monitoring, simulated by default.

        Args:
            policy: the policy to play by.
            seed: seeds the random generators.
            asks: staff are there to answer if Tangy is unsure.
            injections: faults to inject, as in `--inject`.
            live: returns the readings of real devices, which replace simulated ones.
            world: another world for the games, which handles `injections` itself.
            rehearsal: begins the message to people who are called on the bench; "": call nobody.

        Raises:
            TangyError: an injection is not valid, or the fault rules have a mistake.
        """
        from tangy_hw.robot_client.live_world import LiveWorld
        from tangy_profiles.fault_file import load_faults
        from tangy_profiles.game_world import BENCH, LIVE
        from tangy_sim.worlds.injection import read_injection
        from tangy_tui.app.simulated_worlds import game_world
        from tangy_tui.monitoring.accepted import expected_effects
        from tangy_tui.monitoring.calls import Calls
        from tangy_tui.monitoring.supervision import Supervision

        to_come = [read_injection(text) for text in injections]
        seed = self.game_seed(seed)
        if world is None:
            world = game_world(self.activity, list(self.names), seed, to_come, live, self.robot)
        supervision = Supervision(
            self._facilitation(world, policy, seed, asks),
            load_faults(self.robot),
            self.robot,
            self.store,
            lambda learnt: expected_effects(self.store, self.activity, learnt),
            self.name,
            [str(one) for one in to_come],
        )
        if world.played_in == LIVE or (rehearsal and world.played_in == BENCH):
            buttons = world.link if isinstance(world, LiveWorld) else None
            notice = "" if world.played_in == LIVE else rehearsal
            calls = Calls(self.robot, self.store.append, buttons=buttons, notice=notice)
            supervision.call_by(calls)
        return supervision

    def game_seed(self, seed: int | None) -> int:
        """Return a seed: the given one, or one that no game has used."""
        if seed is not None:
            return seed
        from tangy_profiles.game_records import GameBeginning

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
            room=self.room_source,
            answers=OnlineLearning(self.store, self.activity) if asks else None,
            learnt=self.intents.model,
        )

    def persuasion(self, rng: Random, world: GameWorld | None = None) -> Persuasion:
        """Create the persuasion of everybody present, from their responses in a world's games."""
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
        """Create the memory of people's responses, with the activity's method of choice.

        Args:
            world: the world whose games count (default: the world of the last game).
        """
        from tangy_tui.interaction.memory import PersonModels

        strategies = tuple(self.activity.strategies)
        return PersonModels(self.store, strategies, self.activity.persuasion, world=world)

    def records(self, *people: Person, world: GameWorld | None = None) -> list[PersonSummary]:
        """Read the report data of some people (default: everybody)."""
        from tangy_tui.interaction.record import read_records

        return read_records(self.store, self.memory(world), people or self.people)

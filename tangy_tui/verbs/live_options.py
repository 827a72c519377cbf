"""The options of `tangy live`, and what they exclude."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tangy_profiles.defaults import REGISTERED, USUAL_ROBOT
from tangy_profiles.errors import TangyError
from tangy_profiles.game_world import BENCH, LIVE
from tangy_profiles.given_file import read_given_text
from tangy_profiles.reading import plain
from tangy_tui.verbs import common
from tangy_tui.verbs.bench_options import LinkDelay, LinkLoss, Load, check_load, link_of
from tangy_tui.verbs.hearing import HandsFree, Mic, Mode, SpokenAnswers
from tangy_tui.verbs.playing import Expert, GameOptions, Plain, PolicyName, Teacher
from tangy_tui.verbs.resuming import Discard, Resume
from tangy_tui.verbs.sensors import Cameras, RobotName

if TYPE_CHECKING:
    from tangy_profiles.game_world import GameWorld
    from tangy_sim.servers.link_relay import LinkQuality
    from tangy_sim.worlds.injection import Injection

LARGEST_LIST = 100_000  # bytes of a list of faults

Bench = Annotated[
    bool, typer.Option("--bench", help="Simulate the robot's devices and the people.")
]
Headless = Annotated[
    bool,
    typer.Option("--headless", help="Run without a screen; on the bench as fast as possible."),
]
Injections = Annotated[
    list[str] | None,
    typer.Option(
        "--inject",
        metavar="KIND[@STEP|~P]|FILE",
        help="Bring about a fault on the bench, as with `tangy play --inject`, or the faults "
        "in a file, one on each line. Repeatable.",
    ),
]
OnDuty = Annotated[
    str, typer.Option("--by", help="Who is on duty; reports show it with what staff do.")
]
Pace = Annotated[
    float | None,
    typer.Option(
        min=1,
        max=300,
        show_default=False,
        help="Seconds from one call to the next. Default: as in your last game, or 30.",
    ),
]
Map = Annotated[
    str,
    typer.Option(
        "--map", metavar="FILE.yaml", help="The map of the room, as `tangy map` draws it."
    ),
]
Lost = Annotated[
    bool,
    typer.Option(
        "--lost", help="Tangy does not stand at the front, so it turns to find its place."
    ),
]
Requests = Annotated[str, typer.Option(help="Where requests come from, as for `tangy requests`.")]
Table = Annotated[
    str, typer.Option(help="The table's corners in the pictures, as for `tangy requests`.")
]
Cards = Annotated[
    list[str] | None,
    typer.Option(
        "--card",
        metavar="PERSON=NUMBER",
        help="A person's card, as in Rosa=17: Tangy judges no other card in front of them. "
        "Otherwise it learns the card when it first sees one there. Repeatable.",
    ),
]
Begin = Annotated[bool, typer.Option("--begin", help="Begin at once, without the set-up page.")]


@dataclass(frozen=True)
class LiveOptions(GameOptions):
    """The options of `tangy live`, in the order of its help."""

    robot: RobotName = USUAL_ROBOT
    bench: Bench = False
    games: common.Games = 1
    users: common.Users = REGISTERED
    headless: Headless = False
    plain_lines: Plain = False
    activity: common.ActivityName = ""
    room: common.RoomName = ""
    policy: PolicyName = ""
    inject: Injections = None
    teacher: Teacher = None
    by: OnDuty = ""
    expert: Expert = ""
    pace: Pace = None
    map_: Map = ""
    lost: Lost = False
    camera: Cameras = None
    requests: Requests = ""
    table: Table = ""
    card: Cards = None
    load: Load = 0
    link_delay: LinkDelay = 0.0
    link_loss: LinkLoss = 0.0
    mic: Mic = None
    hands_free: HandsFree = False
    spoken_answers: SpokenAnswers = False
    mode: Mode = None
    begin: Begin = False
    resume: Resume = False
    discard: Discard = False
    seed: common.Seed = None
    data: common.Data = None
    as_json: common.Json = False
    ascii_only: common.Ascii = False

    @property
    def world(self) -> GameWorld:
        """The world of the games."""
        return BENCH if self.bench else LIVE

    @property
    def link(self) -> LinkQuality | None:
        """The quality of the bench's link; None: it is perfect.

        Raises:
            TangyError: it is not on the bench.
        """
        return link_of(self.link_delay, self.link_loss, bench=self.bench)

    def check(self) -> None:
        """Refuse options that exclude each other.

        Raises:
            TangyError: names them.
        """
        self.listening.check()
        if self.inject and not self.bench:
            raise TangyError("--inject: faults are brought about on the bench alone: add --bench.")
        if self.bench and (self.camera or self.requests or self.table or self.card):
            options = "--camera, --requests, --table, --card"
            raise TangyError(f"{options}: the bench brings its own; leave them out.")
        check_load(self.load, bench=self.bench)
        link_of(self.link_delay, self.link_loss, bench=self.bench)

    def injections(self) -> tuple[Injection, ...]:
        """Parse the faults to inject, those in files line by line.

        Raises:
            TangyError: a file cannot be read, or a fault does not exist.
        """
        from tangy_sim.worlds.injection import read_injection

        found: list[Injection] = []
        for text in self.inject or ():
            if os.path.exists(text) and not os.path.isdir(text):  # noqa: PTH110, PTH112 - long names
                found += _listed(text)
            else:
                found.append(read_injection(text))
        return tuple(found)


def _listed(file: str) -> list[Injection]:
    """Parse a file with a fault on each line."""
    from tangy_sim.worlds.injection import read_injection

    found: list[Injection] = []
    lines = read_given_text(Path(file), LARGEST_LIST).split("\n")
    for number, line in enumerate(lines, start=1):
        if line.strip() and not line.startswith("#"):
            try:
                found.append(read_injection(line.strip()))
            except TangyError as error:
                raise TangyError(plain(f"{file}, line {number}: {error}")) from None
    return found

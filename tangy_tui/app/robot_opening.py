"""Opens a real robot or the bench for games, and creates its world."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from tangy_hw.cancellation import Cancellation
from tangy_hw.device_protocols import DeviceError
from tangy_hw.drivers.chest_pairing import keep_pairing
from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_client.declared_live_world import DeclaredLiveWorld
from tangy_hw.robot_client.live_world import FACING, PACE_SECONDS, LiveWorld
from tangy_hw.robot_setup import RobotSetup
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.health import Health
from tangy_profiles.known_devices import driven, reads_cards
from tangy_profiles.reading import plain
from tangy_profiles.room import Room
from tangy_profiles.state import FRONT
from tangy_sim.servers.link_relay import LinkQuality
from tangy_sim.worlds.injection import Injection
from tangy_tui.app.bench_page import BenchPage
from tangy_tui.app.declared_bench_world import BenchedDeclaredWorld
from tangy_tui.app.device_simulator import DeviceSimulator
from tangy_tui.app.simulated_devices_world import BenchedWorld

if TYPE_CHECKING:
    from tangy_profiles.faults import FaultBook
    from tangy_profiles.robot import Robot
    from tangy_tui.app.workspace import Workspace

W = TypeVar("W", bound=LiveWorld)
B = TypeVar("B", bound=BenchedWorld)

LOG, BENCH_LOG = "robot.log", "bench.log"  # in the data folder: errors of the processes
PICTURES = 10  # of each drawn face, to recognise the simulated people
CAMERA = "camera"

Opened = TypeVar("Opened")
Opening = Callable[[bool, Cancellation], AbstractContextManager[Opened]]
"""Opens a robot or its bench (stepped, if wanted), unless it is cancelled."""
WorldOpening = Opening[LiveWorld]
"""Opens one of them for games."""


@dataclass(frozen=True)
class RobotOpening:
    """Opens a robot or its bench for games, as often as wanted; a `WorldOpening`."""

    workspace: Workspace
    bench: bool
    """Whether the robot's devices are simulated."""
    lost: bool
    """Whether the robot is not told its initial pose."""
    options: Mapping[str, Any]
    """Named arguments of `open_bench` or `open_robot`."""

    def __call__(
        self, stepped: bool, cancellation: Cancellation, /
    ) -> AbstractContextManager[LiveWorld]:
        """Open it."""
        from tangy_profiles.fault_file import load_faults

        told: dict[str, Any] = {"book": load_faults(self.workspace.robot), "lost": self.lost}
        told |= {"cancellation": cancellation, **self.options}
        if not self.bench:
            return open_robot(self.workspace, **told)
        told["kind"] = BenchedDeclaredWorld if _is_declared(self.workspace) else BenchedWorld
        return open_bench(self.workspace, stepped=stepped, **told)


def at_front(opening: WorldOpening) -> WorldOpening:
    """Return the opening of a robot that was driven to the front, and so is not lost."""
    return replace(opening, lost=False) if isinstance(opening, RobotOpening) else opening


def opening_of(
    workspace: Workspace,
    *,
    bench: bool,
    lost: bool = False,
    injections: Sequence[Injection] = (),
    link: LinkQuality | None = None,
    own: Mapping[str, Any] | None = None,
    **both: Any,
) -> RobotOpening:
    """Return a callable that opens the robot or its bench.

    Args:
        workspace: the workspace with the robot.
        bench: simulate its devices.
        lost: do not tell the robot its initial pose.
        injections: the faults to inject on the bench.
        link: the quality of the robot's link to its devices on the bench.
        own: options for a real robot only: its cameras, request sensor, and cards.
        both: options for both; see `open_bench` and `open_robot`.
    """
    if bench:
        benched = {"injections": injections, "link": link, "page": BenchPage()}
        return RobotOpening(workspace, bench, lost, {**benched, **both})
    workspace.robot = driven(workspace.robot, _named(own or {}))
    return RobotOpening(workspace, bench, lost, {**(own or {}), **both})


def _named(own: Mapping[str, Any]) -> list[str]:
    """Return the devices whose driver the command line names, rather than the robot's file."""
    cameras = [str(given).partition("=")[0] for given in own.get("cameras", ())]
    return [*cameras, *(["requests"] if own.get("requests") else [])]


@contextmanager
def open_bench(
    workspace: Workspace,
    *,
    seed: int,
    stepped: bool,
    pace: float = PACE_SECONDS,
    book: FaultBook | None = None,
    injections: Sequence[Injection] = (),
    kind: type[B] = BenchedWorld,  # type: ignore[assignment]
    map_: str = "",
    lost: bool = False,
    link: LinkQuality | None = None,
    page: BenchPage | None = None,
    cancellation: Cancellation | None = None,
) -> Iterator[B]:
    """Open a bench that simulates the robot's devices.

    Args:
        workspace: the workspace with the robot.
        seed: determines the people, their cards, and all random events.
        stepped: simulated time runs as fast as it can be computed.
        pace: s between calls.
        book: the fault rules that abort a behaviour.
        injections: the faults to inject in each game.
        kind: the kind of world.
        map_: localise by this map file, not by the geometry of the room.
        lost: do not tell the robot its initial pose.
        link: the quality of the robot's link to its devices, unless it is stepped.
        page: the address of its chest screen; None: any.
        cancellation: cancels the opening.

    Raises:
        Cancelled: it was cancelled.
        TangyError: the bench or the robot process does not start.
    """
    folder, has = workspace.store.folder, workspace.robot.devices
    cancellation, page = cancellation or Cancellation(), page or BenchPage()
    bench = DeviceSimulator(
        seed=seed,
        people=workspace.names,
        stepped=stepped,
        activity=workspace.profile,
        robot=str(workspace.robot.file),
        room=str(workspace.room.file),
        link=link,
        log=folder / BENCH_LOG,
        cancellation=cancellation,
    )
    try:
        at = bench.wires.rosbridge
        screen: dict[str, str | float | bool] = {"kind": "page", "port": page.free_port()}
        setup = RobotSetup(
            robot=str(workspace.robot.file),
            activity=workspace.profile,
            people=tuple(workspace.names),
            room=str(workspace.room.file),
            drivers={
                **{name: {"kind": "rosbridge", "at": at} for name in ROSBRIDGE if name in has},
                **({"voice": _BENCH_VOICE | {"at": at}} if "voice" in has else {}),
                "laser": {"kind": "scip", "at": bench.wires.scip},
                **({"screen": screen} if "screen" in has else {}),
            },
            cameras={CAMERA: bench.wires.head} if CAMERA in has else {},
            requests=f"signs:{bench.wires.infrared}" if "requests" in has else "",
            corners=bench.wires.corners,
            start=None if lost else start_of(workspace.room, tuple(workspace.names)),
            map=map_,
            stepped=stepped,
            seed=seed,
            faces=_drawn_people(bench.wires.faces, cancellation) if CAMERA in has else {},
            log=str(folder / LOG),
            pairing=page.pairing.to_json(),
        )
        linked = _linked(
            kind, setup, workspace, seed=seed, pace=pace, book=book, cancellation=cancellation
        )
        with linked as world:
            page.keep(world.link.screen)
            try:
                world.on(bench, injections, seed)
                yield world
            finally:
                world.leave()
    finally:
        bench.close()


ROSBRIDGE = ("base", "stop_button", "arms")
"""The devices of the bench that use rosbridge, besides its voice."""
_BENCH_VOICE = {"kind": "rosbridge", "play": "/voice/play"}


@contextmanager
def open_robot(
    workspace: Workspace,
    *,
    seed: int,
    pace: float = PACE_SECONDS,
    book: FaultBook | None = None,
    cameras: Sequence[str] = (),
    requests: str = "",
    corners: tuple[tuple[float, float], ...] = (),
    map_: str = "",
    lost: bool = False,
    cards: Mapping[str, int] | None = None,
    courtesies: Mapping[str, str] | None = None,
    cancellation: Cancellation | None = None,
) -> Iterator[LiveWorld]:
    """Open a real robot with the drivers of its profile; `pace` is in s.

    `requests` names the sensor of requests, with the `corners` of the table in its pictures; by
    default the robot's file names it. The robot starts at the front, unless it is `lost`: then it
    localises itself. `cards` maps people to the numbers of their cards, `courtesies` are the
    robot's words to people for whom it waits. `cancellation` cancels the opening.

    Raises:
        Cancelled: it was cancelled.
        TangyError: the profile names no drivers, or the robot process does not start.
    """
    check_drivers(workspace.robot)
    from tangy_hw.perception.faces.face_store import read_faces
    from tangy_hw.perception.faces.reader import open_reader
    from tangy_hw.perception.requests.source_names import requests_named

    cancellation = cancellation or Cancellation()
    name, named = requests_named(workspace.robot)
    requests, corners = requests or name, corners or named
    known = read_faces(workspace.store, open_reader(workspace.robot.faces).kind)
    setup = RobotSetup(
        robot=str(workspace.robot.file),
        activity=workspace.profile,
        people=tuple(workspace.names),
        room=str(workspace.room.file),
        courtesies=courtesies or {},
        cameras=dict(named.split("=", 1) for named in cameras),
        requests=requests,
        corners=corners,
        start=None if lost else start_of(workspace.room, tuple(workspace.names)),
        seed=seed,
        faces={p: rows.tolist() for p, rows in known.items() if p in workspace.names},
        map=map_,
        log=str(workspace.store.folder / LOG),
        pairing=keep_pairing(workspace.store.folder).to_json(),
    )
    kind = DeclaredLiveWorld if _is_declared(workspace) else LiveWorld
    linked = _linked(
        kind, setup, workspace, seed=seed, pace=pace, book=book, cancellation=cancellation
    )
    with linked as world:
        world.cards.dealt.deal(cards or {})
        yield world


def check_drivers(robot: Robot) -> None:
    """Check that a robot's file names drivers.

    Raises:
        DeviceError: it names none.
    """
    if not robot.drivers:
        raise DeviceError(
            f"{robot.file.name} names no drivers, so there is no robot to be reached: "
            "try --bench, or name them as docs/robots.md tells."
        )


def _is_declared(workspace: Workspace) -> bool:
    """Return whether the activity is declared by facts, and so has no cards."""
    return isinstance(workspace.activity, DeclaredActivity)


@contextmanager
def _linked(
    kind: type[W],
    setup: RobotSetup,
    workspace: Workspace,
    *,
    seed: int,
    pace: float,
    book: FaultBook | None,
    cancellation: Cancellation,
) -> Iterator[W]:
    without = tuple(device.name for device in workspace.robot.undriven)
    link = RobotLink(
        replace(setup, without=without),
        log=workspace.store.folder / LOG,
        cancellation=cancellation,
        patience=workspace.robot.liveness.fault_after,
    )
    try:
        link.start()
        link.beat()  # a game starts from the robot's state
        world = kind(
            workspace.activity,
            list(workspace.names),
            link,
            workspace.robot,
            workspace.room,
            seed=seed,
            names=workspace.names,
            pace=pace,
            knows_faces=bool(setup.faces) and reads_cards(workspace.robot),
        )
        if book is not None:
            world.commands.diagnosed = _Diagnosis(book, workspace.robot)
        yield world
    finally:
        link.close()


class _Diagnosis:
    """Diagnoses faults from the readings of the devices alone."""

    def __init__(self, book: FaultBook, robot: Robot) -> None:
        self._book = book
        self._robot = robot

    def __call__(self, health: Health) -> Mapping[str, bool]:
        """Return the codes of the faults, and whether each is critical."""
        from tangy_tui.monitoring.detection import device_evidence
        from tangy_tui.monitoring.diagnosis import diagnose

        evidence = device_evidence(self._robot, health)
        return {one.rule.code: one.rule.critical for one in diagnose(self._book, evidence)}


def check_map(workspace: Workspace, map_: str) -> None:
    """Check that a robot can play by a map, before it is switched on.

    Raises:
        TangyError: it is no map, or the robot cannot reach its places on it.
    """
    from tangy_hw.navigation.map_files import MapFileError, read_map
    from tangy_hw.navigation.planning import PlanError, check_goal

    known = read_map(Path(map_))
    people = tuple(workspace.names)
    for place in (FRONT, *people):
        at = workspace.room.stand(place, people)
        try:
            check_goal(known, (at.x, at.y))
        except PlanError as error:
            where = "the front" if place == FRONT else f"{workspace.name(place)}'s place"
            told = f"{map_}: {where} ({at.x:g}, {at.y:g}) cannot be driven to on it. {error}"
            raise MapFileError(plain(told)) from None


def start_of(room: Room, people: tuple[str, ...]) -> tuple[float, float, float]:
    """Return the pose at the front of a room: x, y in m, and the heading in rad."""
    front = room.stand(FRONT, people)
    return front.x, front.y, FACING


def _drawn_people(
    faces: Mapping[str, int], cancellation: Cancellation
) -> dict[str, list[list[float]]]:
    """Compute the face vectors of the bench's people, as enrolment would.

    Raises:
        Cancelled: it was cancelled.
    """
    from tangy_hw.perception.faces.reader import HaarReader
    from tangy_sim.rendering.faces import drawn_face

    reader = HaarReader()
    known: dict[str, list[list[float]]] = {}
    for place, (person, number) in enumerate(faces.items()):
        cancellation.starts("faces", place, len(faces))
        vectors = []
        for one in range(PICTURES):
            cancellation.check()
            found = reader.read(drawn_face(number, 100 + one))
            if found and found[0].vector is not None:
                vectors.append(found[0].vector)
        known[person] = [[round(float(v), 5) for v in vector] for vector in vectors]
    return known

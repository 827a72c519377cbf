"""Streams of the bench's two cameras; a thread draws their frames.

They run in real time even on a stepped bench: a robot that looks closely takes pictures while no
bench time passes. After a change of the scene, no frame from before is sent.
"""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor

from tangy_sim.device_simulator.camera_views import HeadCamera
from tangy_sim.device_simulator.signs import InfraredCamera, corners_in
from tangy_sim.device_simulator.world import BenchWorld, HeadScene
from tangy_sim.servers.mjpeg_server import MjpegServer

HEAD, INFRARED = "/head", "/infrared"
PAUSE = 0.08  # s of real time between two frames of the head camera
SIGNS_PAUSE = 0.05  # s, for the infrared camera
CLOSE_UP = ("card", "face")


class CameraStreams:
    """Streams the cameras of a world."""

    def __init__(self, world: BenchWorld, faces: Mapping[str, int], *, seed: int) -> None:
        people = world.people.ids
        self._world = world
        self._head = HeadCamera(world.activity, people, faces, seed=seed)
        self.corners = corners_in(world.room)
        self._signs = InfraredCamera(world.room, people, seed=seed)
        self._server = MjpegServer((HEAD, INFRARED))
        self._thread = ThreadPoolExecutor(1, "film")
        self._ahead = ThreadPoolExecutor(1, "cards")
        self._tasks: list[asyncio.Task[None]] = []

    @property
    def sent(self) -> dict[str, int]:
        """Number of frames that each camera has sent."""
        return {path.strip("/"): self._server.camera[path].pushed for path in (HEAD, INFRARED)}

    def url(self, path: str) -> str:
        """Return the address of a stream, "/head" or "/infrared"."""
        return self._server.url(path)

    async def start(self) -> None:
        """Start streaming."""
        await self._server.start()
        self._tasks = [asyncio.create_task(self._film_head()), asyncio.create_task(self._watch())]

    async def close(self) -> None:
        """Stop streaming."""
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        for thread in (self._thread, self._ahead):
            thread.shutdown(wait=False, cancel_futures=True)
        await self._server.close()

    def silence(self, *, head_pulled: bool, head: bool, infrared: bool) -> None:
        """Freeze or resume streams; a camera with an unplugged cable disconnects its viewers."""
        self._server.camera[HEAD].closed = head_pulled
        self._server.camera[HEAD].hangs = head
        self._server.camera[INFRARED].hangs = infrared

    def show_signs(self) -> None:
        """Send a frame of the signs now."""
        camera = self._server.camera[INFRARED]
        if camera.viewers and not camera.hangs:
            camera.push(self._signs.frame(self._world.asking, self._world.people.shown))

    async def _watch(self) -> None:
        while True:
            self.show_signs()
            await asyncio.sleep(SIGNS_PAUSE)

    async def _film_head(self) -> None:
        loop, camera = asyncio.get_running_loop(), self._server.camera[HEAD]
        game, ahead = 0, list[tuple[int, int]]()
        drawing: asyncio.Future[None] | None = None
        while True:
            due = loop.time() + PAUSE
            if camera.viewers and not camera.hangs:
                if game != self._world.games:
                    game = self._world.games
                    people = self._world.people.sitters.values()
                    ahead = [(n, one.card) for n, one in enumerate(people) if one.card]
                elif ahead and (drawing is None or drawing.done()):
                    who, card = ahead.pop(0)  # beside the frames, so that the stream goes on
                    prepare = self._head.prepare
                    drawing = loop.run_in_executor(self._ahead, prepare, game, who, card)
                scene = self._world.head_scene()
                jpeg = await loop.run_in_executor(self._thread, self._head.frame, scene)
                if not _outdated(scene, self._world.head_scene()):
                    camera.push(jpeg)
                else:
                    due = loop.time()
            await asyncio.sleep(max(0.0, due - loop.time()))


def _outdated(scene: HeadScene, now: HeadScene) -> bool:
    """Return whether a frame would show an outdated card or face, or hide a current one."""
    return scene != now and (scene.kind in CLOSE_UP or now.kind in CLOSE_UP)

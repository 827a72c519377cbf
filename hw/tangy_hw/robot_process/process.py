"""The robot process, controlled by JSON lines on its pipes.

The first line is a `RobotSetup`. Then each line is a request: {"id": 7, "do": "go", ...} is
answered by {"id": 7, "done": {...}} or {"id": 7, "failed": "a sentence", "broken": true if it was
aborted}; several may be in progress. {"beat": n} is a heartbeat of the program, without an answer.
An invalid line is answered with its error, and ends nothing. During start-up it sends {"starts":
"laser"} and so on, and {"calls": "laser"} before a driver is opened or first read; then {"beat":
{...}} ten times a second: health, pose, requests, and why it stands.

Whatever happens to the program, the robot stops: when its pipe closes, the process stops the robot
and exits; after a while without messages, it stops the robot and aborts its tasks.
"""

from __future__ import annotations

import asyncio
import gc
import logging
import os
import signal
import sys
import time
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any, assert_never

from tangy_hw.device_protocols import STARTED, DeviceFailed, Twist
from tangy_hw.robot_process.assembly import RobotRuntime, assemble
from tangy_hw.robot_process.controller import LiveRobot
from tangy_hw.robot_process.heartbeat import beat_of
from tangy_hw.robot_process.looks import CameraRequests
from tangy_hw.robot_process.program_pipe import AnswerPipe, end_with
from tangy_hw.robot_process.protocol import (
    calls_of,
    id_of,
    level_of,
    number_of,
    picture_of,
    pose_of,
    text_of,
)
from tangy_hw.robot_process.requests import LastingRequest, immediate_request, lasting_request
from tangy_hw.robot_process.startup import switched_on
from tangy_hw.robot_process.stop_latch import ALONE, STAFF, Preempted
from tangy_hw.robot_setup import RobotSetup
from tangy_profiles.errors import TangyError
from tangy_profiles.health import device_state
from tangy_profiles.process_log import NO_COMMAND, log_to_stderr, serving
from tangy_profiles.worker_lines import Asked, LineError, next_line, open_lines, read_line

_LOG = logging.getLogger(__name__)

BEAT_SECONDS = 0.1
SILENT_SECONDS = 0.15
"""Silence of the program, three of its heartbeats, after which a driving robot stops, and aborts
its tasks if the silence lasts."""
SILENT_STEPPED = 20.0
"""On a stepped bench nothing moves by itself, and the program may be busy."""

Answer = dict[str, Any]


class RobotProcess:
    """Executes requests, and sends heartbeats."""

    def __init__(
        self, wired: RobotRuntime, say: Callable[[Answer], None], *, stepped: bool
    ) -> None:
        """Set the assembled robot; `say` writes a line."""
        self.robot: LiveRobot = wired.robot
        self._wired = wired
        self._say = say
        self._patience = SILENT_STEPPED if stepped else SILENT_SECONDS
        self._stepped = stepped
        self._heard = time.monotonic()
        self._doing: dict[int | str, asyncio.Task[None]] = {}
        self._broken = ""  # reason for the last abort
        self._looks = CameraRequests(self.robot)
        self.robot.alone = self._why_alone
        self.robot.left = self._break_off

    # ---------------------------------------------------------------------- the lines

    async def live(self, said: list[bytes], lines: asyncio.StreamReader) -> None:
        """Execute requests until the program ends, and stop the robot then."""
        self._say({"ready": True, "done": self.robot.body.at_hand})
        beating = asyncio.create_task(self.beat())
        try:
            for line in said:
                await self.take(line)
            while await self._take_next(lines):
                pass
        finally:
            beating.cancel()
            await self.robot.stop("the program has ended")

    async def _take_next(self, lines: asyncio.StreamReader) -> bool:
        """Process the next line; return whether there was one."""
        try:
            line = await next_line(lines)
        except LineError as error:
            self.refuse(str(error))
            return True
        if line:
            await self.take(line)
        return bool(line)

    async def take(self, line: bytes) -> None:
        """Process a line of the program; answer an invalid one with an error."""
        self._heard = time.monotonic()
        try:
            asked = read_line(line)
        except LineError as error:
            self.refuse(str(error))
            return
        if "beat" in asked:
            return
        with serving(asked.get("command", NO_COMMAND)):
            await self._take(asked)

    async def _take(self, asked: Asked) -> None:
        try:
            if asked.get("do") == "stop":  # it precedes everything, even its own errors
                await self._stop(asked)
            if id_of(asked) is None and "id" in asked:
                raise LineError("An id must be a whole number or a text.")
            self._heed(asked)
        except LineError as error:
            self.refuse(str(error), asked)
        except Exception as error:  # the caller must not wait forever
            self.refuse(f"It went wrong ({error!r}).", asked)

    async def _stop(self, asked: Asked) -> None:
        why, by = asked.get("why"), asked.get("by")
        why = why if isinstance(why, str) else "stopped"
        _LOG.warning("stops: %s", why)
        await self.robot.stop(why, by if isinstance(by, str) else STAFF)
        self._break_off(why)

    def refuse(self, why: str, asked: Asked | None = None) -> None:
        """Answer an invalid line, or report it if it has no id."""
        if asked is not None and id_of(asked) is not None:
            self._answer(asked, failed=why)
        else:
            self._say({"failed": why})

    def _heed(self, asked: Asked) -> None:
        """Execute an immediate request, or begin a lasting one.

        Raises:
            LineError: the request is invalid.
        """
        immediate = immediate_request(asked.get("do"))
        match immediate:
            case None:
                self._begin(asked)
                return
            case "stop":
                pass
            case "release":
                self.robot.release(text_of(asked, "by", ""))
            case "seen to":
                self.robot.seen_to()
            case "cancel":
                self.robot.navigator.cancel()
                self._break_off(text_of(asked, "why", "called off"))
            case "drive":
                twist = Twist(number_of(asked, "forward"), number_of(asked, "turn"))
                self.robot.drive_by_hand(twist, overrides=asked.get("overrides") is True)
            case "show calls":
                self.robot.body.offer_calls(calls_of(asked))
            case forgotten:
                assert_never(forgotten)
        self._answer(asked, done={})

    def _begin(self, asked: Asked) -> None:
        lasting, number = lasting_request(asked.get("do")), id_of(asked)
        if lasting is None:
            raise LineError(f"It cannot do {asked.get('do')!r:.100}.")
        _LOG.log(level_of(lasting), "begins %s", lasting)
        if number is None or number in self._doing:
            raise LineError(f"{lasting} needs an id of its own, to be answered by.")
        task = asyncio.create_task(self._do(lasting, asked))
        self._doing[number] = task
        task.add_done_callback(lambda task: self._over(task, asked))

    def _answer(self, asked: Asked, **what: Any) -> None:
        if "failed" in what:
            _LOG.warning("has not done %s: %s", asked.get("do"), what["failed"])
        else:
            _LOG.log(level_of(asked.get("do")), "has done %s", asked.get("do"))
        if id_of(asked) is not None:
            self._say({"id": asked["id"], "at": self.robot.passing.clock.now(), **what})

    def _handler(self, lasting: LastingRequest) -> Callable[[Asked], Awaitable[Answer | None]]:
        match lasting:
            case "perform":
                return self._perform
            case "go":
                return self._go
            case "spin":
                return self._spin
            case "card":
                return self._looks.card
            case "face":
                return self._looks.face
            case "picture":
                return self._looks.picture
            case "sights":
                return self._looks.sights
            case "wait":
                return self._wait
            case "settle":
                return self._settle
            case "replan":
                return self._replan
            case "answered":
                return self._answered
            case "restart":
                return self._restart
            case "relax":
                return self._relax
            case "place":
                return self._place
            case "fail":
                return self._fail
            case forgotten:
                assert_never(forgotten)

    async def _do(self, lasting: LastingRequest, asked: Asked) -> None:
        try:
            done = await self._handler(lasting)(asked)
        except Preempted as error:
            self._answer(asked, failed=str(error), broken=True)
        except asyncio.CancelledError:
            self._answer(asked, failed=self._broken or "called off", broken=True)
        except TangyError as error:
            self._answer(asked, failed=str(error))
        except (KeyError, TypeError, ValueError) as error:
            self._answer(asked, failed=f"It was not asked rightly ({error!r}).")
        except Exception as error:  # the caller must not wait forever
            self._answer(asked, failed=f"It went wrong ({error!r}).")
        else:
            self._answer(asked, done=done or {})

    def _over(self, task: asyncio.Task[None], asked: Asked) -> None:
        self._doing.pop(asked["id"], None)
        if task.cancelled():  # cancelled before it started, so it has not answered
            self._answer(asked, failed=self._broken or "called off", broken=True)

    def _break_off(self, why: str) -> None:
        self._broken = why
        for task in self._doing.values():
            task.cancel()

    # ---------------------------------------------------------------------- tasks

    async def _perform(self, asked: Asked) -> Answer:
        picture, sound = asked.get("picture"), text_of(asked, "sound", "")
        return dict(
            await self.robot.perform(
                text=text_of(asked, "text", ""),
                picture=None if picture is None else picture_of(picture),
                posture=asked.get("posture"),
                sound=Path(sound) if sound else None,
            )
        )

    async def _go(self, asked: Asked) -> Answer:
        arrived = await self.robot.go(pose_of(asked, "to"), text_of(asked, "name", ""))
        return {"arrived": arrived, "pose": list(self.robot.pose)}

    async def _spin(self, _: Asked) -> Answer:
        return {"found": await self.robot.spin()}

    async def _wait(self, asked: Asked) -> None:
        """Let time pass; with "asks" only until there is a new request."""
        there = {ask.seat for ask in self.robot.asking}
        heed = bool(asked.get("asks"))
        await self.robot.passing.until(
            lambda: heed and {ask.seat for ask in self.robot.asking} - there != set(),
            number_of(asked, "seconds"),
        )

    async def _settle(self, _: Asked) -> None:
        """Wait until a stepped bench has delivered fresh observations."""
        if self._stepped:
            await self._wired.settle()

    async def _replan(self, _: Asked) -> None:
        self.robot.replan()

    async def _answered(self, asked: Asked) -> None:
        if self.robot.requests is not None:
            self.robot.requests.answered(int(asked["seat"]))

    async def _restart(self, asked: Asked) -> None:
        await self.robot.restart(str(asked["device"]))

    async def _relax(self, _: Asked) -> None:
        await self.robot.relax()

    async def _place(self, asked: Asked) -> None:
        self.robot.navigator.place(pose_of(asked, "at"))

    async def _fail(self, asked: Asked) -> None:
        state = device_state(asked["state"])
        if state is None:
            raise LineError(f"There is no state {asked['state']!r:.100} of a device.")
        self.robot.fail(str(asked["device"]), state)

    # ---------------------------------------------------------------------- heartbeats

    def _why_alone(self) -> str:
        """Return why the program counts as absent, "" if it does not."""
        silent = time.monotonic() - self._heard > self._patience
        return ALONE if silent else ""

    async def beat(self) -> None:
        """Send heartbeats."""
        number = 0
        while True:
            if not self.robot.watch.overdue:  # after a freeze, handle that first
                number += 1
                async with self.robot.passing.still:
                    self._say({"beat": beat_of(self.robot, number)})
            await asyncio.sleep(BEAT_SECONDS)


async def run() -> int:
    """Run the robot process until the program ends."""
    lines, pipe = await open_lines()
    program = int(sys.argv[1]) if sys.argv[1:] else os.getppid()
    ending = asyncio.create_task(end_with(program, lines))
    try:
        return await _serve(lines, pipe)
    finally:
        ending.cancel()


async def _serve(lines: asyncio.StreamReader, pipe: asyncio.ReadTransport) -> int:
    _, out = await asyncio.get_running_loop().connect_write_pipe(AnswerPipe, sys.stdout)
    try:
        setup = RobotSetup.from_json(await lines.readline())

        def calls(device: str, did: str = STARTED) -> None:
            out.write({"calls": device, "did": did})

        wired = assemble(setup, calls)
        wired.starts, wired.calls = lambda part: out.write({"starts": part}), calls
        # SIGTERM has the effect of a closed pipe; before this, nothing is open.
        asyncio.get_running_loop().add_signal_handler(signal.SIGTERM, pipe.close)
        async with switched_on(wired, lines) as said:
            if said is None:
                return 1
            await RobotProcess(wired, out.write, stepped=setup.stepped).live(said, lines)
    except TangyError as error:
        device = {"device": error.device} if isinstance(error, DeviceFailed) else {}
        out.write({"failed": str(error), **device})
        await asyncio.sleep(0.1)  # until it is written
        return 2
    return 0


def main() -> None:
    """Run the process."""
    log_to_stderr()
    status = asyncio.run(run())
    gc.freeze()  # avoids a last garbage collection over all loaded modules
    sys.exit(status)

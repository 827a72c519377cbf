"""Speech, screen and gestures at the same time; holding still and silence."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Coroutine, Mapping, Sequence
from math import hypot
from pathlib import Path
from typing import Any

from tangy_hw.device_protocols import Arms, Picture, Voice
from tangy_hw.navigation.navigator_protocol import NavigatorProtocol
from tangy_hw.robot_process.body import Body
from tangy_hw.robot_process.control_loop import ControlLoop
from tangy_hw.robot_process.stop_latch import Preempted
from tangy_profiles.health import ERROR
from tangy_profiles.robot import Robot
from tangy_profiles.wav_length import wav_seconds

SPEECH_SECONDS = 60.0  # for one text
POSE_SECONDS = 1.5  # duration of a movement to a pose
STOP_SECONDS = 1.0  # timeout for arms and voice to stop

STOWED = "drive"
"""Pose with the arms close to the body, which is safe with people near."""

_LOG = logging.getLogger(__name__)

Angles = Mapping[str, Sequence[float]]


class Performer:
    """Voice, screen and limbs of a robot; `halted` returns why they must be still."""

    def __init__(
        self,
        body: Body,
        passing: ControlLoop,
        robot: Robot,
        navigator: NavigatorProtocol,
        halted: Callable[[], str],
    ) -> None:
        """Set the devices.

        Args:
            body: the devices.
            passing: the control loop.
            robot: the robot's profile, with gazes and the stowed pose.
            navigator: tracks people around.
            halted: returns why nothing may move, "" if it may.
        """
        self._body, self._passing = body, passing
        self._gazes, self._stowed = robot.gaze, _listed(robot.postures.get(STOWED, {}))
        self._reach = robot.body.arms
        self._halted, self._navigator = halted, navigator
        self._gaze = ""

    async def perform(
        self,
        *,
        text: str = "",
        picture: Picture | None = None,
        posture: Angles | None = None,
        gazes: bool = False,
        sound: Path | None = None,
    ) -> dict[str, bool]:
        """Speak, show and gesture at once, then play a sound; return the parts done.

        Joints are in degrees. Failed parts are skipped: their devices report this. An arm with an
        error prevents gestures, but not turning the head (`gazes`).

        Raises:
            Preempted: it was stopped meanwhile.
        """
        doing: dict[str, Coroutine[Any, Any, None]] = {}
        if self._body.voice is not None and text:
            doing["said"] = self._body.voice.say(text)
        if self._body.screen is not None and picture is not None:
            doing["shown"] = self._body.screen.show(picture)
        arms = self._body.arms
        if arms is not None and posture and (gazes or self._may_gesture(arms, posture)):
            doing["posed"], self._gaze = self._pose(arms, posture), ""
        tasks = {what: asyncio.create_task(work) for what, work in doing.items()}
        seconds = SPEECH_SECONDS
        if self._body.voice is not None and sound is not None:
            playing = _play_after(tasks.get("said"), self._body.voice, sound)
            tasks["played"] = asyncio.create_task(playing)
            seconds += wav_seconds(sound)
        try:
            await self._passing.until(
                lambda: bool(self._halted()) or all(task.done() for task in tasks.values()),
                seconds,
            )
        finally:
            for task in tasks.values():
                task.cancel()
            await asyncio.gather(*tasks.values(), return_exceptions=True)
        if why := self._halted():
            raise Preempted(why)
        return {
            what: not task.cancelled() and task.exception() is None for what, task in tasks.items()
        }

    def _may_gesture(self, arms: Arms, posture: Angles) -> bool:
        """Return whether the arms may move: not with an error, and not out towards a person."""
        if arms.reading().state == ERROR:
            return False
        if _listed(posture) != self._stowed and self._somebody_in_reach:
            _LOG.info("leaves a gesture out: somebody is within reach of the arms")
            return False
        return True

    @property
    def _somebody_in_reach(self) -> bool:
        """Whether the arms could hit a person if they moved out."""
        return any(hypot(one.x, one.y) - one.half < self._reach for one in self._navigator.tracks)

    async def _pose(self, arms: Arms, posture: Angles) -> None:
        """Move the arms, unless the robot was stopped before."""
        if why := self._halted():
            raise Preempted(why)
        await arms.pose(posture, POSE_SECONDS)

    async def look_at(self, what: str) -> None:
        """Turn the head to a card or a face."""
        angles = self._gazes.get(what)
        if angles and self._body.arms is not None and self._gaze != what:
            done = await self.perform(posture=angles, gazes=True)
            if not done.get("posed"):  # the head turns even if an arm is broken
                await self._passing.sleep(POSE_SECONDS)
            self._gaze = what

    async def be_still(self) -> None:
        """Hold the arms at their position, and be quiet; failures change nothing."""
        self._gaze = ""
        works: list[Coroutine[Any, Any, None]] = []
        if self._body.arms is not None:
            works.append(self._body.arms.hold())
        if self._body.voice is not None:
            works.append(self._body.voice.hush())
        tasks = [asyncio.create_task(work) for work in works]
        if tasks:
            await asyncio.wait(tasks, timeout=STOP_SECONDS)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


def _listed(angles: Angles) -> dict[str, list[float]]:
    """Return angles in the form in which they come over a pipe."""
    return {limb: [float(joint) for joint in joints] for limb, joints in angles.items()}


async def _play_after(saying: asyncio.Task[None] | None, voice: Voice, sound: Path) -> None:
    """Play a sound after the current speech, even if that fails."""
    if saying is not None:
        await asyncio.wait({saying})
    await voice.play(sound)

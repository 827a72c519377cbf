"""Checks which parts of this machine work, and how to repair the others: a sentence for each."""

from __future__ import annotations

import locale
import os
import shutil
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from tangy_hw.audio.arecord import list_microphones
from tangy_hw.audio.player import examine_output
from tangy_hw.audio.synthesis import examine_voice
from tangy_hw.audio.wav import SoundError
from tangy_hw.drivers.camera_devices import list_cameras
from tangy_profiles.contacts import EXPERT
from tangy_profiles.errors import TangyError
from tangy_profiles.process_log import LEVEL
from tangy_profiles.reading import plain
from tangy_profiles.store import Store
from tangy_tui.monitoring.log_check import log_problems
from tangy_tui.text import machine
from tangy_tui.text.store import problem_words

if TYPE_CHECKING:
    from tangy_hw.perception.camera_hub import Sources
    from tangy_profiles.activity import Activity
    from tangy_profiles.extensions import Group
    from tangy_profiles.robot import Robot


TEST_SECONDS = 10.0  # for the answer to a test message

NOUNS: Mapping[Group, str] = {
    "drivers": "driver",
    "activities": "activity",
    "methods": "method of persuasion",
}


@dataclass(frozen=True, slots=True)
class Finding:
    """One part of the machine, whether it works, and a sentence about it.

    `broken`: it is there or required, but unusable; a part that is neither ok nor broken is
    missing, and Tangy works without it.
    """

    part: str
    ok: bool
    text: str
    broken: bool = False

    @property
    def state(self) -> str:
        """Return its state in one word: ok, missing or broken."""
        return "ok" if self.ok else "broken" if self.broken else "missing"


def examine(folder: Path, which: Callable[[str], str | None] = shutil.which) -> list[Finding]:
    """Examine everything that Tangy may use.

    Args:
        folder: the data folder.
        which: finds a program on the path.
    """
    return [
        _terminal(),
        _store(folder),
        _speech(),
        _voice(which),
        _sound_output(which),
        _microphone(which("arecord")),
        _camera(),
        *_extensions(),
    ]


def _extensions() -> Iterator[Finding]:
    """Report for every extension by other packages whether it is usable."""
    from tangy_hw.drivers.registry import DRIVERS, driver_kind
    from tangy_profiles.activity import read_activity, shipped_activities
    from tangy_profiles.extensions import (
        GROUPS,
        Extension,
        activity_files,
        extensions,
        problems,
    )
    from tangy_profiles.persuading import PERSUASION_METHODS
    from tangy_tui.interaction.methods import added_method

    if not any(extensions(group) for group in GROUPS):
        return

    def driver(one: Extension) -> str:
        driver_kind(one)
        return ""

    def activity(one: Extension) -> str:
        path = activity_files().get(one.name)
        if path is None:
            return machine.no_activity(one.value, one.name)
        named = read_activity(path).name
        return "" if named == one.name else machine.other_name(path.name, named)

    def method(one: Extension) -> str:
        added_method(one)
        return ""

    own: dict[Group, Iterable[str]] = {
        "drivers": DRIVERS,
        "activities": shipped_activities(),
        "methods": PERSUASION_METHODS,
    }
    checks: dict[Group, Callable[[Extension], str]] = {
        "drivers": driver,
        "activities": activity,
        "methods": method,
    }
    for one, problem in problems(own, checks):
        part = f"{NOUNS[one.group]} {one.name}"
        text = problem or machine.usable(one.package)
        yield Finding(plain(part), not problem, plain(text), broken=bool(problem))


def examine_robot(
    robot: Robot,
    activity: Activity,
    cameras: Sources,
    seconds: float = 5.0,
    *,
    folder: Path | None = None,
) -> list[Finding]:
    """Try every device with an address in a robot's profile; nothing is moved.

    Args:
        robot: the robot with the devices.
        activity: the activity that the robot is to run.
        cameras: the sources of its cameras' pictures, by device.
        seconds: the longest wait for a device.
        folder: the data folder, which knows the paired tablets.
    """
    from tangy_hw.drivers.chest_pairing import keep_pairing
    from tangy_hw.robot_process.isolated_test import try_robot_apart

    # Children of the drivers write their log to this terminal, among the findings.
    os.environ.setdefault(LEVEL, "WARNING")
    pairing = {}
    if folder is not None and any(driver.kind == "page" for driver in robot.drivers.values()):
        with suppress(OSError):  # the chest screen's code must be stored before it is printed
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        pairing = keep_pairing(folder).to_json()

    def label(device: str) -> str:
        known = robot.devices.get(device)
        return f"{robot.title}'s {known.label if known is not None else device}"

    tried = try_robot_apart(robot, activity, cameras, seconds, pairing=pairing)
    return [
        Finding(label(one.device), one.ok, one.text, broken=not one.ok and not one.absent)
        for one in tried
    ]


def examine_contacts(robot: Robot) -> list[Finding]:
    """Call every contact in a robot's file, with a message that says that it is a test."""
    from tangy_hw.calling import CallNews, call
    from tangy_profiles.contacts import ROLES
    from tangy_tui.text.calls import TEST_CALL, nobody_named, tried_words

    findings = []
    for role in ROLES:
        contact = robot.expert if role == EXPERT else robot.staff
        part = f"{robot.title}'s {role}"
        if contact is None:
            findings.append(Finding(part, False, nobody_named(role)))
            continue
        if not contact.reachable:
            findings.append(Finding(f"{part} {contact.name}", False, tried_words(contact, "none")))
            continue
        news: list[CallNews] = []
        test = {"for": role, "robot": robot.title, "text": TEST_CALL}
        call(contact, test, TEST_SECONDS, news.append)
        stage = news[-1].stage
        text = tried_words(contact, stage, news[-1].said)
        failed = stage == "failed"
        findings.append(Finding(f"{part} {contact.name}", not failed, text, broken=failed))
    return findings


def _camera() -> Finding:
    found = list_cameras()
    if not found:
        return Finding("camera", False, machine.NO_CAMERA)
    usable = [f"{device} ({title})" for device, title, may in found if may]
    if not usable:
        what = machine.camera_forbidden(found[0][0], found[0][1])
        return Finding("camera", False, what, broken=True)
    return Finding(
        "camera", True, f"{', '.join(usable)} can be used (try: tangy camera {found[0][0]})."
    )


def _voice(which: Callable[[str], str | None]) -> Finding:
    version, problem = examine_voice(which)
    if problem:
        return Finding("voice", False, problem, broken=bool(version))
    return Finding("voice", True, machine.speaks_with(version))


def _sound_output(which: Callable[[str], str | None]) -> Finding:
    player, problem = examine_output(which)
    if player:
        return Finding("sound output", True, machine.plays_with(player))
    return Finding("sound output", False, machine.shown_as_text(problem))


def _microphone(arecord: str | None) -> Finding:
    instead = "or speak into a laptop's microphone (tangy mic --help)."
    if arecord is None:
        what = "arecord is not installed; install alsa-utils,"
        return Finding("microphone", False, f"{what} {instead}")
    try:
        found = list_microphones(arecord)
    except SoundError as error:
        return Finding("microphone", False, str(error), broken=True)
    if not found:
        return Finding("microphone", False, f"none is found; plug one in, {instead}")
    return Finding("microphone", True, f"{', '.join(found)} can be used (--mic arecord).")


def _terminal() -> Finding:
    term = os.environ.get("TERM", "")
    if not sys.stdout.isatty():
        return Finding("terminal", True, machine.PIPED)
    if term in ("", "dumb"):
        return Finding("terminal", True, machine.dumb_terminal(term))
    size = shutil.get_terminal_size()
    encoding = locale.getpreferredencoding(False)
    return Finding("terminal", True, f"{term}, {size.columns} x {size.lines}, {encoding}.")


def _store(folder: Path) -> Finding:
    problem = _no_place(folder)
    if not problem:
        try:
            with Store.open(folder, write=False) as store:
                problems = problem_words(log_problems(store))
        except TangyError as error:
            problem = str(error)
        else:
            problem = plain(f"{folder}: {problems[0]}") if problems else ""
            if len(problems) > 1:
                problem += machine.more_problems(len(problems) - 1)
    if problem:
        return Finding("data folder", False, problem, broken=True)
    is_so = "is sound" if folder.exists() else "is made as soon as there is something to keep"
    return Finding("data folder", True, plain(f"{folder} {is_so}."))


def _no_place(folder: Path) -> str:
    """Return why a folder, which may not exist yet, cannot store data (empty: it can)."""
    folder = folder.absolute()
    above = next(path for path in (folder, *folder.parents) if _exists(path))
    if above.is_dir() and os.access(above, os.W_OK | os.X_OK):
        return ""
    why = "is no folder" if not above.is_dir() else "cannot be written to"
    if above != folder:
        why = f"cannot be made, for {above} {why}"
    return plain(machine.no_place(folder, why))


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except OSError:  # even the test is forbidden, so examine its parent
        return False


def _speech() -> Finding:
    if find_spec("pocketsphinx") is None:
        return Finding("speech", False, machine.NO_SPEECH)
    return Finding("speech", True, machine.DECODES_SPEECH)

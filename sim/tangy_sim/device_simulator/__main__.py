"""The bench process: commands as JSON lines on stdin, answers on stdout, devices on their wires.

It says {"ready": {...}} first, then answers each {"do": ...} (with its "id", if it has one); see
`DeviceServers.do`. What cannot be done is answered by {"failed": "a sentence"}. It ends with its
stdin.
"""

from __future__ import annotations

import argparse
import asyncio
import logging
import signal
import sys
from collections.abc import Sequence
from contextlib import suppress
from typing import Any

from tangy_profiles.activity import load_activity
from tangy_profiles.errors import TangyError
from tangy_profiles.person import MOST_PEOPLE, Person, load_people
from tangy_profiles.process_log import log_to_stderr
from tangy_profiles.robot import load_robot
from tangy_profiles.room import load_room
from tangy_profiles.worker_lines import AnswerWriter, Asked, coming, open_lines
from tangy_sim.device_simulator.device_servers import DeviceServers
from tangy_sim.device_simulator.world import BenchWorld
from tangy_sim.servers.link_relay import LinkQuality

_LOG = logging.getLogger("tangy_sim.device_simulator")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the bench until its stdin closes, or a command stops it."""
    told = _parser().parse_args(arguments)
    log_to_stderr()
    try:
        people = _people(told.users, told.person)
        world = BenchWorld(
            load_room(told.room),
            load_robot(told.robot),
            load_activity(told.activity),
            people,
            seed=told.seed,
        )
    except TangyError as error:
        print(error, file=sys.stderr)
        return 2
    faces = {person.id: number for number, person in enumerate(people, 1)}
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # its parent closes its stdin
    link = LinkQuality(told.link_delay, told.link_loss)
    servers = DeviceServers(world, stepped=told.stepped, faces=faces, seed=told.seed, link=link)
    asyncio.run(_serve(servers))
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="tangy_sim.device_simulator", description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--users", type=int, default=4, help="how many people play")
    person = parser.add_argument("--person", action="append", default=[], metavar="ID=NAME")
    person.help = "one of the people, in the order of their seats, in place of --users"
    parser.add_argument("--stepped", action="store_true", help="time passes by /bench/advance")
    parser.add_argument("--room", default="common-room")
    parser.add_argument("--robot", default="tangy")
    parser.add_argument("--activity", required=True)
    parser.add_argument("--link-delay", type=float, default=0.0, help="s in each direction")
    parser.add_argument("--link-loss", type=float, default=0.0, help="the share of packets lost")
    return parser


def _people(count: int, named: Sequence[str]) -> tuple[Person, ...]:
    if not named:
        return load_people(count)
    pairs = [one.partition("=")[::2] for one in named]
    people = [Person(id.strip(), name.strip() or id.strip()) for id, name in pairs]
    if len(people) > MOST_PEOPLE or len({person.id for person in people}) < len(people):
        raise TangyError(f"Name up to {MOST_PEOPLE} people, each with an id of their own.")
    return tuple(people)


async def _serve(bench: DeviceServers) -> None:
    answers = AnswerWriter()
    lines, _ = await open_lines()
    answers.write({"ready": await bench.start()})
    passing = None if bench.stepped else asyncio.create_task(bench.run())
    try:
        async for told in coming(answers.refuse, lines):
            answer = _answer(bench, told)
            answers.write(answer)
            if answer.get("done") == "stop":
                break
    finally:
        if passing is not None:
            passing.cancel()
            with suppress(asyncio.CancelledError):
                await passing
        await bench.close()


def _answer(bench: DeviceServers, told: Asked) -> dict[str, Any]:
    try:
        answer = {"done": "stop"} if told["do"] == "stop" else bench.do(told)
    except Exception as error:  # the parent must not wait forever
        answer = {"failed": f"The bench does not understand {told!r:.200} ({error!r:.200})."}
    _LOG.info("asked for %s: %s", told.get("do"), ", ".join(answer))
    return {**answer, "id": told["id"]} if "id" in told else answer


if __name__ == "__main__":
    sys.exit(main())

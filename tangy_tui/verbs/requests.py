"""`tangy requests`: check a source of requests for help: a button box, a broker or signs."""

from __future__ import annotations

import asyncio
import sys
import time
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tangy_profiles.defaults import TO_BEGIN_WITH
from tangy_profiles.errors import TangyError
from tangy_tui.verbs.common import Data, Json, Seed, Users, print_json

if TYPE_CHECKING:
    from tangy_hw.perception.requests.help_request_source import HelpRequest, RequestSource

SOURCES = "buttons, buttons:/dev/input/event5, mqtt://HOST/TOPIC or signs:CAMERA"


def requests(
    source: Annotated[str, typer.Argument(help=f"{SOURCES}.")],
    seconds: Annotated[float, typer.Option(min=0.1, help="How long to listen.")] = 30.0,
    table: Annotated[
        str,
        typer.Option(
            metavar="X,Y,...",
            help="Eight pixels for signs: the table's corners left near, right near, right far, "
            "left far.",
        ),
    ] = "",
    room: Annotated[str, typer.Option(help="A shipped room, or its TOML, for signs.")] = (
        "common-room"
    ),
    users: Users = TO_BEGIN_WITH,
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Show who asks for help, each time that this changes.

    The status is 0 if the source was there in the end, and 1 if it was not.
    """
    from tangy_hw.perception.requests.source_names import read_corners
    from tangy_hw.perception.requests.sources import open_requests
    from tangy_profiles.health import OK
    from tangy_profiles.person import load_people
    from tangy_profiles.room import load_room

    if source == "keyboard":
        raise TangyError(
            "keyboard: the program itself takes the number keys; nothing to listen to."
        )
    people = load_people(users)
    names = {person.id: person.name for person in people}

    async def run() -> dict[str, Any]:
        opened = open_requests(
            source, load_room(room), [person.id for person in people], corners=read_corners(table)
        )
        rows: list[dict[str, Any]] = []
        opened.tell = lambda sentence: print(f"tangy: {sentence}", file=sys.stderr, flush=True)
        async with opened:
            began = time.monotonic()
            try:
                async with asyncio.timeout(seconds):
                    await _listen(opened, rows, began, names, tell=not as_json)
                    ended = True
            except TimeoutError:
                ended = False
            works = ended or opened.reading().state == OK
        return {"source": opened.name, "works": works, "changes": rows}

    found = asyncio.run(run())
    if as_json:
        print_json(found)
    elif not found["changes"]:
        print("Nobody asked.")
    if not found["works"]:
        raise typer.Exit(1)


async def _listen(
    source: RequestSource,
    rows: list[dict[str, Any]],
    began: float,
    names: dict[str, str],
    *,
    tell: bool,
) -> None:
    async for asks in source:
        at = time.monotonic() - began
        rows.append({"at": round(at, 2), "asking": [_row(ask, began) for ask in asks]})
        if tell:
            asking = ", ".join(f"{names[ask.person]} (seat {ask.seat})" for ask in asks)
            print(f"{at:5.1f} s  {asking or 'nobody asks any more'}", flush=True)


def _row(ask: HelpRequest, began: float) -> dict[str, Any]:
    since = round(ask.since - began, 2)
    return {"seat": ask.seat, "person": ask.person, "since": since, "sure": round(ask.sure, 2)}

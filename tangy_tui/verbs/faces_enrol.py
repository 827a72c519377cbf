"""`tangy faces enrol`: learn a person's face, with their consent."""

from __future__ import annotations

import asyncio
import re
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tangy_profiles.defaults import USUAL_ROBOT
from tangy_profiles.errors import TangyError
from tangy_profiles.person import Person, folded
from tangy_profiles.reading import plain
from tangy_profiles.state import FRONT
from tangy_tui.text.faces import consent_question, enrolled_lines
from tangy_tui.verbs.common import Data, Json, Seed, print_json
from tangy_tui.verbs.faces import GUEST, SOURCES, Robot, find_anybody, knowing

if TYPE_CHECKING:
    from tangy_hw.drivers.camera_source import CameraSource
    from tangy_hw.perception.faces.enrolment import Enrolment
    from tangy_hw.perception.faces.gallery import Gallery
    from tangy_profiles.store import Store
    from tangy_tui.app.workspace import Workspace

EVERY = 0.4  # seconds between two pictures of a camera, for other poses of the head
Tell = Callable[[str], None]


def faces_enrol(
    name: Annotated[str, typer.Argument(help="Who it is: an id, a name, or a new name.")],
    source: Annotated[
        str,
        typer.Option(
            "--from", metavar="CAMERA|DIR", help=f"{SOURCES}, or a folder of pictures of them."
        ),
    ],
    count: Annotated[
        int, typer.Option(min=3, max=40, help="How many pictures to take from a camera or video.")
    ] = 15,
    seconds: Annotated[float, typer.Option(min=1, help="Look for at most this long.")] = 60.0,
    consent: Annotated[
        str | None,
        typer.Option(
            metavar="HOW",
            help="How they agreed, and to whom. The log keeps this, so write no names.",
        ),
    ] = None,
    add: Annotated[
        bool, typer.Option("--add", help="Add to the pictures enrolled before.")
    ] = False,
    robot: Robot = USUAL_ROBOT,
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Learn a person's face from a camera or pictures.

    They are asked first, here on the terminal; or --consent says how they agreed, which goes into
    the log. Only features are kept, no pictures; `tangy faces forget` deletes them.
    """
    from tangy_hw.drivers.camera_source import find_camera
    from tangy_hw.perception.faces.enrolment import ADVISED, Enrolment
    from tangy_hw.perception.faces.face_store import keep_face, read_face
    from tangy_hw.perception.faces.gallery import LEAST

    found = find_camera(source)
    if not found.live:
        found = find_camera(source, each=True)
    tell: Tell = (lambda _: None) if as_json else (lambda line: print(plain(line), flush=True))
    with knowing(data, robot, write=True) as (workspace, reader, gallery):
        person, new = _find(workspace, name)
        agreed = _agreed(workspace, person, consent)
        if agreed is None:
            raise TangyError(plain(f"{person.name} has not agreed: nothing is kept."))
        enrolment = Enrolment(reader)
        if add:
            enrolment.take(read_face(workspace.store, person.id, reader.kind))
        if found.kind == "folder":
            rows = _from_pictures(Path(source), enrolment, tell)
        else:
            rows = asyncio.run(_from_camera(found, enrolment, count, seconds, tell))
        for row in enrolment.drop_odd():
            rows[row]["problem"] = "it does not look like the person in the others"
            tell(f"{rows[row]['file']}: {rows[row]['problem']}")
        taken = len(enrolment)
        if taken < LEAST:
            raise TangyError(
                plain(
                    f"{source}: only {taken} of {len(rows)} pictures show a face well enough; "
                    f"{LEAST} are needed, and {ADVISED} are better{_chief_reason(rows)}."
                )
            )
        _check_same(enrolment, gallery, person)
        if agreed:
            _note(workspace.store, person, new, agreed)
        keep_face(workspace.store, person.id, reader.kind, enrolment.vectors())
        several = enrolment.several()
        like = _like_another(enrolment, gallery, person)
        if as_json:
            told = {"id": person.id, "name": person.name, "pictures": taken, "kind": reader.kind}
            print_json({**told, "looks_like": like, "several": several, "from": rows})
            return
        known = "" if like is None else f"{workspace.store.names().get(like, like)} ({like})"
        for line in enrolled_lines(
            person,
            new=new,
            taken=taken,
            advised=ADVISED,
            several=bool(several),
            like=known,
        ):
            tell(line)


def _find(workspace: Workspace, wanted: str) -> tuple[Person, bool]:
    """Find the person, or create a guest for a new name; return also whether they are new."""
    from tangy_profiles.people_records import FaceConsent

    called = wanted.strip()
    if folded(called) == FRONT:
        raise TangyError(plain(f"{called!r} is a place: choose another name."))
    players = [p for p in workspace.people if folded(called) in (p.id, folded(p.name))]
    names = workspace.store.names()
    guests = [i for i in names if i.startswith(GUEST)]
    if players or called in guests or folded(called) in {folded(names[i]) for i in guests}:
        return find_anybody(workspace, called), False
    ids = {*names, *(event.person or "" for event in workspace.store.events(FaceConsent))}
    numbers = [int(i.removeprefix(GUEST)) for i in ids if re.fullmatch(rf"{GUEST}\d{{1,9}}", i)]
    return Person(f"{GUEST}{max(numbers, default=0) + 1}", called), True


def _agreed(workspace: Workspace, person: Person, how: str | None) -> str | None:
    """Ask the person for consent, unless they gave it before or `how` tells how they did.

    Returns:
        How they consented, "" if they had before; None if they do not.
    """
    from tangy_hw.perception.faces.face_store import consent, consented

    store = workspace.store
    if how is not None:
        if not how.strip():
            raise TangyError('--consent: say how they agreed, as in "in writing, asked by staff".')
        name = re.escape(person.name)  # names stay out of the log, which keeps everything
        return re.sub(rf"\b{name}\b", person.id, how, flags=re.I)[:200]
    if person.id in consented(store):
        return ""
    if not sys.stdin.isatty():
        raise TangyError(
            plain(
                f"{person.name} has not agreed yet: ask on a terminal, or say how they agreed "
                f"with --consent; nothing is kept before."
            )
        )
    question = consent_question(person.name, store.folder)
    if typer.confirm(plain(question), default=False, err=True):
        return "asked on the terminal"
    consent(store, person.id, False, "asked on the terminal")
    return None


def _check_same(enrolment: Enrolment, gallery: Gallery, person: Person) -> None:
    """Refuse pictures of a known person that show another person.

    Raises:
        TangyError: most of them do not resemble the known face.
    """
    if person.id not in gallery.people:
        return
    vectors = enrolment.added()
    alike = sum(gallery.compare(vector).person == person.id for vector in vectors)
    if 2 * alike < len(vectors):
        raise TangyError(
            plain(
                f"{len(vectors) - alike} of {len(vectors)} pictures do not look like "
                f"{person.name} as known: nothing was changed. If it is {person.name}, "
                f"`tangy faces forget {person.id}` first."
            )
        )


def _note(store: Store, person: Person, new: bool, how: str) -> None:
    """Store the consent together with the name of a new guest, in one transaction."""
    from tangy_hw.perception.faces.face_store import consent

    with store.transaction():
        if new:
            store.rename(person.id, person.name)
        consent(store, person.id, True, how)


def _from_pictures(folder: Path, enrolment: Enrolment, tell: Tell) -> list[dict[str, Any]]:
    from tangy_hw.drivers.camera_source import pictures_in
    from tangy_hw.perception.pictures import PictureError, read_picture

    rows = []
    for path in pictures_in(folder):
        try:
            problem = enrolment.offer(read_picture(path))
        except PictureError as error:
            problem = str(error).removeprefix(f"{plain(str(path))}: ").removesuffix(".")
        if problem:
            tell(f"{path.name}: {problem}")
        rows.append({"file": path.name, "problem": problem})
    return rows


async def _from_camera(
    source: CameraSource, enrolment: Enrolment, count: int, seconds: float, tell: Tell
) -> list[dict[str, Any]]:
    from tangy_hw.drivers.camera import Camera

    rows: list[dict[str, Any]] = []
    before = len(enrolment)
    said = ""
    ends = time.monotonic() + seconds
    last = -EVERY
    async with Camera(source) as camera:
        while len(enrolment) - before < count and (left := ends - time.monotonic()) > 0:
            frame = await camera.frame(wait=left)
            if frame is None:
                break
            if source.live and frame.stamp - last < EVERY:
                continue
            last = frame.stamp
            problem = await asyncio.to_thread(enrolment.offer, frame.image())
            rows.append({"file": f"frame {frame.seq}", "problem": problem})
            told = problem or f"{len(enrolment) - before} of {count}"
            if told != said:
                said = told
                tell(told)
        why = camera.sight.why
    if not rows:
        raise TangyError(plain(f"{source.name}: no picture came{f' ({why})' if why else ''}."))
    return rows


def _chief_reason(rows: list[dict[str, Any]]) -> str:
    """Return the most frequent problem of the pictures."""
    reasons = [re.sub(r"\(.*?\) ?", "", row["problem"]) for row in rows if row["problem"]]
    if not reasons:
        return ""
    return f" (mostly: {max(set(reasons), key=reasons.count)})"


def _like_another(enrolment: Enrolment, gallery: Gallery, person: Person) -> str | None:
    """Return the other known person whom the pictures resemble, if any."""
    seen = [gallery.compare(vector).person for vector in enrolment.vectors()]
    others = [one for one in seen if one is not None and one != person.id]
    if 2 * len(others) <= len(seen):
        return None
    return max(set(others), key=others.count)

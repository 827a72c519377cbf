"""`tangy faces`: recognise the faces of people who consented."""

from __future__ import annotations

import asyncio
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tangy_profiles.defaults import DEFAULT_ACTIVITY, USUAL_ROBOT
from tangy_profiles.errors import TangyError
from tangy_profiles.person import MOST_PEOPLE, Person, folded
from tangy_profiles.reading import plain
from tangy_tui.text.faces import NO_FACES, face_forgotten
from tangy_tui.verbs.common import Data, Json, Seed, print_json
from tangy_tui.verbs.opening import open_workspace

if TYPE_CHECKING:
    from tangy_hw.drivers.camera_source import CameraSource
    from tangy_hw.perception.faces.gallery import FaceMatch, Gallery
    from tangy_hw.perception.faces.reader import FaceReader, FaceReading
    from tangy_hw.perception.pictures import Picture
    from tangy_tui.app.workspace import Workspace

app = typer.Typer(
    rich_markup_mode=None,
    no_args_is_help=True,
    help="Know people by their faces, with their consent.",
)

SOURCES = "0 or /dev/video0, http://... or rtsp://..., a video"
Robot = Annotated[
    str, typer.Option("--robot", help="A robot, or its TOML, which may name files for faces.")
]
GUEST = "guest"
"""People who are known by face but do not play are guest1, guest2 and so on."""


@app.command("who")
def faces_who(
    files: Annotated[list[Path] | None, typer.Argument(help="Pictures with faces.")] = None,
    source: Annotated[
        str | None, typer.Option("--from", metavar="CAMERA", help=f"Look here instead: {SOURCES}.")
    ] = None,
    together: Annotated[
        bool, typer.Option("--together", help="All pictures show one person: combine them.")
    ] = False,
    seconds: Annotated[float, typer.Option(min=0.5, help="Look for at most this long.")] = 10.0,
    robot: Robot = USUAL_ROBOT,
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Say whose faces pictures or a camera show.

    `likeness` runs from 0 (as like as a stranger) to 1 (as like as the person's own pictures).
    From 0.4 on Tangy recognises the person, unless somebody else is nearly as like. It keeps
    nothing.
    """
    from tangy_hw.drivers.camera_source import find_camera
    from tangy_hw.perception.pictures import read_picture

    if bool(files) == (source is not None):
        raise TangyError("Give pictures with faces, or a camera with --from.")
    found = None if source is None else find_camera(source)
    if source is not None and found is not None and not found.live:
        found = find_camera(source, each=True)
    with knowing(data, robot) as (workspace, reader, gallery):
        names = names_of(workspace)
        if not gallery.people:
            print("tangy: Nobody's face is known yet: tangy faces enrol NAME.", file=sys.stderr)
        if found is not None:
            answer = asyncio.run(_watch(found, reader, gallery, seconds))
            rows = [{"file": found.name, **answer}]
        else:
            seen = [(path, reader.read(read_picture(path))) for path in files or []]
            if together:
                rows = [_voted([faces for _, faces in seen], gallery)]
                rows[0] = {"file": str(seen[0][0]), "files": [str(p) for p, _ in seen], **rows[0]}
            else:
                rows = [{"file": str(path), **_row(faces, gallery)} for path, faces in seen]
        for row in rows:
            for told in (row, *row.get("faces", ())):
                told["name"] = names.get(told["person"] or "")
        if as_json:
            print_json(rows)
            return
        for row in rows:
            print(plain(f"{row['file']}: {_told(row)}"))


@app.command("list")
def faces_list(seed: Seed = None, data: Data = None, as_json: Json = False) -> None:
    """List whose faces Tangy knows, and how each person agreed."""
    from tangy_hw.perception.faces.face_store import consented, kept_faces, read_face
    from tangy_profiles.people_records import FaceConsent

    with open_workspace(data, DEFAULT_ACTIVITY, MOST_PEOPLE, write=False) as workspace:
        names, agreed = names_of(workspace), consented(workspace.store)
        how = {
            event.person: event for event in workspace.store.events(FaceConsent) if event.record.yes
        }
        rows: list[dict[str, Any]] = []
        for person, kind in kept_faces(workspace.store):
            if person in agreed:
                pictures = read_face(workspace.store, person, kind)
                rows.append(
                    {
                        "id": person,
                        "name": names.get(person, person),
                        "pictures": 0 if pictures is None else len(pictures),
                        "kind": kind,
                        "agreed": how[person].at,
                        "how": how[person].record.how,
                    }
                )
        if as_json:
            print_json(rows)
            return
        if not rows:
            print(NO_FACES)
        for row in rows:
            day = row["agreed"][:10]
            print(
                plain(
                    f"{row['id']}  {row['name']}: {row['pictures']} pictures; "
                    f"agreed on {day} ({row['how']})."
                )
            )


@app.command("forget")
def faces_forget(
    person: Annotated[str, typer.Argument(metavar="PERSON", help="An id or a name.")],
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Forget a person's face and consent only."""
    from tangy_hw.perception.faces.face_store import forget_face

    with open_workspace(data, DEFAULT_ACTIVITY, MOST_PEOPLE) as workspace:
        known = find_anybody(workspace, person)
        forgotten = forget_face(workspace.store, known.id)
        if as_json:
            print_json({"id": known.id, "name": known.name, "forgotten": forgotten})
        else:
            print(plain(face_forgotten(known.name, forgotten)))


@contextmanager
def knowing(
    data: Path | None, robot: str, *, write: bool = False
) -> Iterator[tuple[Workspace, FaceReader, Gallery]]:
    """Open the workspace, the robot's face reader, and the known faces."""
    from tangy_hw.perception.faces.face_store import read_faces
    from tangy_hw.perception.faces.gallery import Gallery
    from tangy_hw.perception.faces.reader import open_reader
    from tangy_profiles.robot import load_robot

    reader = open_reader(load_robot(robot).faces)
    with open_workspace(data, DEFAULT_ACTIVITY, MOST_PEOPLE, write=write) as workspace:
        yield workspace, reader, Gallery(read_faces(workspace.store, reader.kind))


def names_of(workspace: Workspace) -> dict[str, str]:
    """Return the names of all who may be known by face, by id."""
    return workspace.store.names() | workspace.names


def find_anybody(workspace: Workspace, wanted: str) -> Person:
    """Return a player, or a guest whose face is known, by id or name.

    Raises:
        TangyError: nobody, or more than one, is called that.
    """
    guests = [
        Person(id, name) for id, name in workspace.store.names().items() if id.startswith(GUEST)
    ]
    found = [guest for guest in guests if guest.id == wanted] or [
        guest for guest in guests if folded(guest.name) == folded(wanted)
    ]
    if len(found) == 1 and not any(folded(p.name) == folded(wanted) for p in workspace.people):
        return found[0]
    return workspace.find_person(wanted)


def _row(faces: list[FaceReading], gallery: Gallery) -> dict[str, Any]:
    """Describe the faces in a picture; the first one without a problem represents it."""
    matches = [None if face.vector is None else gallery.compare(face.vector) for face in faces]
    told = [_face_row(face, match) for face, match in zip(faces, matches, strict=True)]
    chief = next((row for row in told if not row["problem"]), told[0] if told else None)
    if chief is None:
        from tangy_hw.perception.faces.reader import NO_FACE

        chief = _face_row(None, None) | {"problem": NO_FACE}
    return {**chief, "threshold": _enough(), "faces": told}


def _face_row(face: FaceReading | None, match: FaceMatch | None) -> dict[str, Any]:
    return {
        "person": match.person if match else None,
        "likeness": round(match.likeness, 4) if match else None,
        "nearest": match.nearest if match else None,
        "likenesses": {p: round(v, 4) for p, v in match.likenesses.items()} if match else {},
        "problem": face.problem if face else "",
        "box": [round(value) for value in face.box] if face else None,
        "quality": face.quality.document() if face and face.quality else None,
    }


def _enough() -> float:
    from tangy_hw.perception.faces.gallery import ENOUGH

    return ENOUGH


def _voted(pictures: list[list[FaceReading]], gallery: Gallery) -> dict[str, Any]:
    """Let the frames that show one face well vote."""
    from tangy_hw.perception.faces.enrolment import one_face
    from tangy_hw.perception.faces.face_votes import vote

    matches = []
    problem = ""
    for faces in pictures:
        why, vector = one_face(faces)
        if vector is None:
            problem = why
        else:
            matches.append(gallery.compare(vector))
    counted = vote(matches)
    return {
        "person": counted.person,
        "likeness": round(counted.likeness, 4) if matches else None,
        "votes": counted.votes,
        "frames": counted.frames,
        "of": len(pictures),
        "threshold": _enough(),
        "problem": "" if matches else problem,
    }


async def _watch(
    source: CameraSource, reader: FaceReader, gallery: Gallery, seconds: float
) -> dict[str, Any]:
    """Watch a camera until enough frames have a face, or time is up."""
    from tangy_hw.drivers.camera import Camera
    from tangy_hw.perception.faces.enrolment import one_face
    from tangy_hw.perception.faces.face_votes import FRAMES

    pictures: list[list[FaceReading]] = []
    well = 0
    ends = time.monotonic() + seconds
    async with Camera(source) as camera:
        while well < FRAMES and (left := ends - time.monotonic()) > 0:
            frame = await camera.frame(wait=left)
            if frame is None:
                break
            image: Picture = frame.image()
            faces = await asyncio.to_thread(reader.read, image)
            pictures.append(faces)
            well += one_face(faces)[1] is not None
        why = camera.sight.why
    if not pictures:
        raise TangyError(plain(f"{source.name}: no picture came{f' ({why})' if why else ''}."))
    return _voted(pictures, gallery)


def _told(row: dict[str, Any]) -> str:
    """Name the recognised person in words."""
    if row["problem"]:
        return f"cannot tell: {row['problem']}"
    likeness = "" if row["likeness"] is None else f", likeness {row['likeness']:.2f}"
    if row.get("frames") is not None:
        likeness += f", {row['votes']} of {row['frames']} frames"
    told = "unknown" if row["person"] is None else f"{row['name']} ({row['person']})"
    others = [f for f in row.get("faces", ()) if f["person"] and f["box"] != row["box"]]
    more = "".join(f"; also {face['name']} ({face['person']})" for face in others)
    return f"{told}{likeness}{more}"

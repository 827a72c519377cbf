"""A face before a live camera: enrolled, and recognised by a vote."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

from tangy_sim.rendering.faces import drawn_face
from tests.hw.pictures import encoded
from tests.real.camera_server import CameraServer


def looking_at(camera: CameraServer, person: int) -> None:
    """Put a person before the camera who moves the head all the time."""
    camera.kinds["live"] = [
        encoded(drawn_face(person, picture, size=240)).tobytes() for picture in range(60, 75)
    ]


@pytest.mark.slow
def test_a_person_before_a_camera_is_enrolled_and_recognised(tangy: str, tmp_path: Path) -> None:
    def faces(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [tangy, "faces", *arguments, "--json", "--data", str(tmp_path / "d")]
        return subprocess.run(command, capture_output=True, text=True, timeout=60)  # noqa: S603

    with CameraServer() as camera:
        looking_at(camera, 4)
        found = ("--from", camera.url)
        done = faces("enrol", "Zoe", *found, "--count", "4", "--consent", "asked")
        assert done.returncode == 0, done.stderr
        assert json.loads(done.stdout)["pictures"] == 4 and done.stderr == ""
        (row,) = json.loads(faces("who", *found).stdout)
        assert (row["name"], row["frames"]) == ("Zoe", 5)
        looking_at(camera, 6)
        (row,) = json.loads(faces("who", *found).stdout)
        assert (row["person"], row["frames"]) == (None, 5)

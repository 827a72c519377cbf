"""Real cameras: video files written by OpenCV, a folder, and a faulty stream."""

from __future__ import annotations

import asyncio
import os
import signal
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
import pytest

from tangy_hw.drivers.camera import Camera
from tangy_hw.drivers.camera_source import CameraError, CameraSource, find_camera
from tangy_hw.drivers.camera_state import State
from tests.hw.pictures import room, seen
from tests.real.camera_server import CameraServer
from tests.support.terminal import PATIENCE, TANGY

PICTURES = [seen(room(60 + number, 160, 120), np.random.default_rng(number)) for number in range(6)]


async def until(camera: Camera, state: State) -> None:
    """Wait until a camera is in a state."""
    reached = asyncio.Event()
    camera.changed = lambda sight: reached.set() if sight.state == state else None
    if camera.sight.state != state:
        async with asyncio.timeout(PATIENCE):
            await reached.wait()


def film(path: Path, code: str, rate: float = 10.0) -> Path:
    """Write the pictures as a video."""
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*code), rate, (160, 120))
    assert writer.isOpened()
    for picture in PICTURES:
        writer.write(picture)
    writer.release()
    return path


def differs(image: np.ndarray[tuple[int, ...], np.dtype[np.uint8]], number: int) -> float:
    """Return how much a picture differs from the expected one, of 255."""
    return float(np.mean(cv2.absdiff(image, PICTURES[number])))


class TestFiles:
    @pytest.mark.slow
    @pytest.mark.parametrize(
        ("name", "code"), [("a.avi", "MJPG"), ("a.mkv", "FFV1"), ("a.mp4", "mp4v")]
    )
    async def test_every_picture_of_a_video_is_read_once_and_in_order(
        self, name: str, code: str, tmp_path: Path
    ) -> None:
        source = find_camera(str(film(tmp_path / name, code)), each=True)
        async with Camera(source) as camera:
            frames = [frame async for frame in camera]
        assert [frame.seq for frame in frames] == [0, 1, 2, 3, 4, 5]
        stamps = [frame.stamp for frame in frames]
        assert stamps == sorted(stamps)
        for number, frame in enumerate(frames):
            assert differs(frame.image(), number) < 12
        assert camera.sight.state == "ENDED"

    @pytest.mark.slow
    async def test_a_folder_skips_files_that_are_no_pictures(self, tmp_path: Path) -> None:
        for number, picture in enumerate(PICTURES):
            cv2.imwrite(str(tmp_path / f"{number + 8}.png"), picture)
        (tmp_path / "8b.png").write_bytes(b"this is no picture")
        (tmp_path / "8c.jpg").write_bytes((tmp_path / "8.png").read_bytes()[:900])
        cv2.imwrite(str(tmp_path / "9z.png"), np.zeros((1, 1), np.uint8))
        async with Camera(find_camera(str(tmp_path), each=True)) as camera:
            frames = [frame async for frame in camera]
        assert [(frame.width, frame.height) for frame in frames].count((1, 1)) == 1
        whole = [frame for frame in frames if frame.width == 160]
        assert [differs(frame.image(), n) for n, frame in enumerate(whole[-6:])] == [0] * 6

    async def test_a_file_can_be_looped(self, tmp_path: Path) -> None:
        path = film(tmp_path / "a.avi", "MJPG")
        async with Camera(find_camera(str(path), each=True, loop=True)) as camera:
            frames = [await camera.frame() for _ in range(15)]
        assert [frame and frame.seq for frame in frames] == list(range(15))

    @pytest.mark.slow
    async def test_a_video_plays_in_real_time_and_the_newest_picture_counts(
        self, tmp_path: Path
    ) -> None:
        path = film(tmp_path / "a.avi", "MJPG", rate=20)
        async with Camera(find_camera(str(path))) as camera:
            await until(camera, "ENDED")
            assert await camera.frame() is None

    @pytest.mark.slow
    @pytest.mark.parametrize(
        ("name", "content", "word"),
        [
            ("a.avi", b"hello, I am no video " * 50, "no video that can be read"),
            ("a.avi", b"", "no video that can be read"),
            ("a.png", b"nor I a picture", "no pictures that can be read"),
        ],
    )
    async def test_an_unreadable_file_is_an_error_in_one_sentence(
        self, name: str, content: bytes, word: str, tmp_path: Path
    ) -> None:
        (tmp_path / name).write_bytes(content)
        async with Camera(find_camera(str(tmp_path / name))) as camera:
            with pytest.raises(CameraError, match=word):
                await camera.frame(wait=PATIENCE)

    async def test_a_picture_can_be_requested_in_a_size(self, tmp_path: Path) -> None:
        path = film(tmp_path / "a.avi", "MJPG")
        async with Camera(find_camera(str(path), each=True)) as camera:
            small = await camera.frame(fit=(40, 90))
            whole = await camera.frame()
        assert small is not None and whole is not None
        assert (small.width, small.height, len(small.pixels)) == (40, 30, 40 * 30 * 3)
        like = cv2.resize(PICTURES[0], (40, 30), interpolation=cv2.INTER_AREA)
        assert float(np.mean(cv2.absdiff(small.image(), like))) < 12
        assert (whole.width, whole.height, whole.seq) == (160, 120, small.seq + 1)

    @pytest.mark.slow
    async def test_a_playlist_opens_no_other_file(self, tmp_path: Path) -> None:
        path = tmp_path / "list.m3u8"
        path.write_text("#EXTM3U\n#EXTINF:10,\nhttp://127.0.0.1:9/x.ts\n#EXT-X-ENDLIST\n")
        async with Camera(find_camera(str(path))) as camera:
            with pytest.raises(CameraError, match="can be read"):
                await camera.frame(wait=PATIENCE)


@pytest.fixture(scope="module")
def server() -> Iterator[CameraServer]:
    with CameraServer() as one:
        yield one


class TestStream:
    """One camera through all its faults; the beginning and the end of each are reported."""

    @pytest.mark.slow
    @pytest.mark.parametrize(
        ("mode", "state"),
        [
            ("frozen", "FROZEN"),
            ("covered", "COVERED"),
            ("dark", "DARK"),
            ("blurred", "BLURRED"),
            ("half", "DISCONNECTED"),
            ("rubbish", "DISCONNECTED"),
            ("hang", "DISCONNECTED"),
        ],
    )
    async def test_the_beginning_and_the_end_of_each_fault_are_reported(
        self, mode: str, state: State, server: CameraServer
    ) -> None:
        server.mode = "live"
        async with Camera(find_camera(server.url)) as camera:
            await until(camera, "OK")
            before = await camera.frame(wait=PATIENCE)
            server.mode = mode
            await until(camera, state)
            server.mode = "live"
            await until(camera, "OK")
            after = await camera.frame(wait=PATIENCE)
        assert before is not None and after is not None
        assert after.seq > before.seq and after.stamp > before.stamp

    @pytest.mark.slow
    async def test_an_unplugged_camera_is_opened_again(self) -> None:
        with CameraServer() as server:
            async with Camera(find_camera(server.url)) as camera:
                await until(camera, "OK")
                server.unplug()
                await until(camera, "DISCONNECTED")
                server.mode = "live"
                server.listen()
                await until(camera, "OK")

    @pytest.mark.slow
    async def test_only_complete_pictures_are_returned(self) -> None:
        with CameraServer() as server:
            async with Camera(find_camera(server.url)) as camera:
                given = [await camera.frame(wait=PATIENCE)]
                server.mode = "half"
                await until(camera, "DISCONNECTED")
                given.append(await camera.frame(after=-1, wait=PATIENCE))
                server.mode = "live"
                given += [await camera.frame(wait=PATIENCE) for _ in range(4)]
        like = server.still
        assert all(one and np.mean(cv2.absdiff(one.image(), like)) < 5 for one in given)


class TestProcess:
    @pytest.mark.slow
    async def test_ctrl_c_ends_a_recording_with_a_summary(
        self, server: CameraServer, tmp_path: Path
    ) -> None:
        server.mode = "live"
        process = await asyncio.create_subprocess_exec(
            TANGY, "capture", str(tmp_path / "set"), "--from", server.url, "--every", "0.05",
            stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE, start_new_session=True,
        )  # fmt: skip
        assert process.stdout is not None
        first = await asyncio.wait_for(process.stdout.readline(), PATIENCE)
        process.send_signal(signal.SIGINT)
        rest, said = await asyncio.wait_for(process.communicate(), PATIENCE)
        assert (process.returncode, said) == (0, b"")
        assert first == b"000001.png  working\n"
        assert rest.decode().splitlines()[-1].startswith("The pictures are in ")
        names = [path.name for path in sorted((tmp_path / "set").iterdir())]
        assert names[:2] == ["000001.json", "000001.png"]
        assert len(names) % 2 == 0  # every picture has its metadata

    @pytest.mark.slow
    async def test_a_killed_camera_process_is_restarted(self, server: CameraServer) -> None:
        server.mode = "live"
        async with Camera(find_camera(server.url)) as camera:
            first = await camera.frame(wait=PATIENCE)
            assert first is not None and camera.pid is not None
            asked = asyncio.create_task(camera.frame(after=first.seq + 20))
            os.kill(camera.pid, signal.SIGKILL)
            later = await asyncio.wait_for(asked, PATIENCE)
        assert later is not None and later.seq > first.seq + 20

    @pytest.mark.slow
    async def test_a_frozen_camera_process_is_killed_and_restarted(
        self, server: CameraServer
    ) -> None:
        server.mode = "live"
        async with Camera(find_camera(server.url)) as camera:
            await until(camera, "OK")
            hung = camera.pid
            assert hung is not None
            os.kill(hung, signal.SIGSTOP)
            await until(camera, "DISCONNECTED")
            await until(camera, "OK")
            assert camera.pid != hung
        with pytest.raises(ProcessLookupError):
            os.kill(hung, 0)

    @pytest.mark.slow
    async def test_a_camera_process_that_hangs_in_a_read_is_restarted(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr("tangy_hw.drivers.camera.OPEN_SECONDS", 0.5)
        path = tmp_path / "pipe.avi"
        os.mkfifo(path)  # opening it blocks for ever
        source = CameraSource("pipe", "file", str(path), each=True)
        async with Camera(source) as camera:
            asked = asyncio.create_task(camera.frame())
            await another(camera, await another(camera, None))
            film(tmp_path / "a.avi", "MJPG")
            path.unlink()
            (tmp_path / "a.avi").rename(path)
            frame = await asyncio.wait_for(asked, PATIENCE)
        assert frame is not None and differs(frame.image(), 0) < 12

    async def test_closing_ends_the_process_and_pending_requests(
        self, server: CameraServer
    ) -> None:
        server.mode = "hang"
        camera = Camera(find_camera(server.url))
        await camera.start()
        asked = asyncio.create_task(camera.frame())
        process = await another(camera, None)
        await camera.close()
        assert await asked is None
        assert await camera.frame() is None
        with pytest.raises(ProcessLookupError):
            os.kill(process, 0)

    @pytest.mark.slow
    async def test_the_output_of_libraries_goes_to_the_log(
        self, tmp_path: Path, capfd: pytest.CaptureFixture[str]
    ) -> None:
        (tmp_path / "a.avi").write_bytes(b"nothing")
        source = find_camera(str(tmp_path / "a.avi"))
        async with Camera(source, log=tmp_path / "camera.log") as camera:
            with pytest.raises(CameraError):
                await camera.frame(wait=PATIENCE)
        assert (tmp_path / "camera.log").stat().st_size > 0
        assert capfd.readouterr() == ("", "")

    @pytest.mark.slow
    async def test_a_timed_out_wait_returns_nothing(self) -> None:
        async with Camera(find_camera("/dev/video93")) as camera:
            assert await camera.frame(wait=0.05) is None
            await until(camera, "DISCONNECTED")
            assert "no such camera" in camera.sight.why


async def another(camera: Camera, pid: int | None) -> int:
    """Wait until another process reads a camera, and return it."""
    async with asyncio.timeout(PATIENCE):
        while camera.pid in (pid, None):  # noqa: ASYNC110 - nobody tells
            await asyncio.sleep(0.01)
    assert camera.pid is not None
    return camera.pid

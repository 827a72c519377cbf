"""A laptop's microphone through a socket: private, one stream at a time, found again when lost."""

from __future__ import annotations

import asyncio
import os
import shutil
import socket
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from tangy_hw.audio import socket_place
from tangy_hw.audio.socket_place import connect
from tangy_hw.audio.socket_source import LISTENING, QUIET, TAKEN, LaptopMicrophone
from tangy_hw.audio.sources import open_source
from tangy_hw.audio.wav import RATE, SoundError

PATIENCE = 20.0


class Listening:
    """An open source, its reports, and connections to it."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.source = LaptopMicrophone("socket", path)
        self.told = asyncio.Queue[str]()
        self.source.tell = self.told.put_nowait

    async def next(self) -> bytes:
        """The next chunk that is not the quiet after a stream."""
        while not (chunk := await self.piece()).strip(b"\0"):
            pass
        return chunk

    async def piece(self) -> bytes:
        return await asyncio.wait_for(anext(self.source), PATIENCE)

    async def said(self) -> str:
        return await asyncio.wait_for(self.told.get(), PATIENCE)

    def connect(self) -> socket.socket:
        connection = connect(self.path)
        assert connection is not None
        return connection

    async def reads(self, connection: socket.socket, text: bytes) -> bool:
        """Read the reply to a connection."""
        got = b""
        while len(got) < len(text):
            loop = asyncio.get_running_loop()
            read = await asyncio.wait_for(loop.sock_recv(connection, 100), PATIENCE)
            if not read:
                break
            got += read
        return got == text


def _connected_as_nobody(path: Path) -> str:
    """Connect as another user, in another process; return the error's name, if any."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.setuid(65_534)
            socket.socket(socket.AF_UNIX).connect(str(path))
        except OSError as error:
            os.write(writing, type(error).__name__.encode())
        finally:
            os._exit(0)
    os.close(writing)
    with os.fdopen(reading) as answer:
        os.waitpid(child, 0)
        return answer.read()


@pytest.fixture
async def on(tmp_path: Path) -> Listening:
    return Listening(tmp_path / "mic.sock")


class TestPlace:
    async def test_the_socket_is_accessible_only_to_its_user(self, tmp_path: Path) -> None:
        folder = tmp_path / "new" / "data"
        source = open_source("socket", folder=folder)
        made = (folder / "mic.sock").lstat()
        assert stat.S_ISSOCK(made.st_mode)
        assert stat.S_IMODE(made.st_mode) == 0o600
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700
        assert sorted(os.listdir(folder)) == ["mic.sock", "mic.sock.lock"]  # noqa: PTH208
        await source.close()
        assert os.listdir(folder) == []  # noqa: PTH208

    def test_the_socket_never_exists_with_wider_permissions(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        moved: list[tuple[int, int]] = []
        rename = Path.rename

        def watched(made: Path, place: Path) -> Path:
            moved.append((made.lstat().st_mode & 0o777, made.parent.stat().st_mode & 0o777))
            assert not place.exists()
            return rename(made, place)

        monkeypatch.setattr(Path, "rename", watched)
        mask = os.umask(0)
        try:
            place = socket_place.ListeningSocket(tmp_path / "s")
        finally:
            os.umask(mask)
        place.close()
        assert moved == [(0o600, 0o700)]

    @pytest.fixture
    def open_folder(self) -> Iterator[Path]:
        """Make a folder that every user may enter."""
        folder = Path(tempfile.mkdtemp(dir="/tmp"))
        folder.chmod(0o755)
        yield folder
        shutil.rmtree(folder)

    async def test_another_user_is_refused(
        self, open_folder: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        on = Listening(open_folder / "mic.sock")
        waiting = asyncio.ensure_future(on.next())
        assert "Waiting" in await on.said()
        if os.geteuid() == 0:
            assert _connected_as_nobody(on.path) == "PermissionError"
            on.path.chmod(0o666)  # too open, by an oversight
            assert _connected_as_nobody(on.path) == ""
        else:
            own = os.geteuid()
            connection = on.connect()
            monkeypatch.setattr(os, "geteuid", lambda: own + 1)
        assert "Another user" in await on.said()
        monkeypatch.undo()
        connection = on.connect()
        connection.send(b"mine")
        assert await waiting == b"mine"
        connection.close()
        await on.source.close()

    def test_sound_is_not_sent_to_another_user(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        place = socket_place.ListeningSocket(tmp_path / "s")
        monkeypatch.setattr(socket_place, "same_user", lambda connection: False)
        with pytest.raises(SoundError, match="another user listens there"):
            connect(place.path)
        place.close()

    async def test_a_second_listener_is_refused_and_does_not_disturb_the_first(
        self, on: Listening
    ) -> None:
        waiting = asyncio.ensure_future(on.next())
        connection = on.connect()
        assert await on.reads(connection, LISTENING)
        with pytest.raises(SoundError, match="another Tangy listens here"):
            LaptopMicrophone("socket", on.path)
        connection.send(b"still here")
        assert await waiting == b"still here"
        connection.close()
        await on.source.close()

    async def test_a_stale_socket_is_replaced(self, tmp_path: Path) -> None:
        path = tmp_path / "mic.sock"
        left = socket.socket(socket.AF_UNIX)
        left.bind(str(path))
        left.listen()
        left.close()
        (tmp_path / "mic.sock.lock").touch()
        assert connect(path) is None
        await open_source(f"socket:{path}").close()
        assert not path.exists()

    def test_files_and_sockets_of_other_programs_are_left_alone(self, tmp_path: Path) -> None:
        file, foreign = tmp_path / "file", tmp_path / "foreign"
        file.write_text("kept")
        with socket.socket(socket.AF_UNIX) as other:
            other.bind(str(foreign))
            other.listen()
            for path, word in ((file, "no socket"), (foreign, "another program listens")):
                with pytest.raises(SoundError, match=word):
                    open_source(f"socket:{path}")
                assert path.exists()
        assert file.read_text() == "kept"
        assert not list(tmp_path.glob("*.lock"))
        with pytest.raises(SoundError, match="no socket"):
            connect(file)

    async def test_closing_does_not_remove_a_replaced_file(self, tmp_path: Path) -> None:
        path = tmp_path / "mic.sock"
        source = open_source(f"socket:{path}")
        path.unlink()
        path.write_text("somebody else's")
        await source.close()
        assert path.exists()

    async def test_a_socket_works_in_a_deep_folder(self, tmp_path: Path) -> None:
        on = Listening(tmp_path / ("a" * 100) / ("b" * 100) / "mic.sock")
        waiting = asyncio.ensure_future(on.next())
        with on.connect() as connection:
            connection.send(b"deep")
            assert await waiting == b"deep"
        await on.source.close()

    def test_a_long_name_and_an_impossible_folder_are_refused(self, tmp_path: Path) -> None:
        (tmp_path / "file").touch()
        for path, word in (
            (tmp_path / ("n" * 120), "name is too long"),
            (tmp_path / "file" / "in" / "it", "cannot be made"),
        ):
            with pytest.raises(SoundError, match=word):
                open_source(f"socket:{path}")


class TestStreams:
    async def test_consecutive_streams_are_heard_and_reported(self, on: Listening) -> None:
        for word in (b"one!", b"two!"):
            waiting = asyncio.ensure_future(on.next())
            with on.connect() as connection:
                assert await on.reads(connection, LISTENING)
                connection.send(word)
                assert await waiting == word
        gone = asyncio.ensure_future(on.next())
        said = [await on.said() for _ in range(5)]
        assert said == [
            "Waiting for the laptop's microphone.",
            "The laptop's microphone is connected.",
            "The laptop's microphone has gone; waiting for it to come back.",
            "The laptop's microphone is connected.",
            "The laptop's microphone has gone; waiting for it to come back.",
        ]
        await on.source.close()
        with pytest.raises(StopAsyncIteration):
            await gone

    async def test_a_stream_is_followed_by_a_second_of_silence(self, on: Listening) -> None:
        waiting = asyncio.ensure_future(on.piece())
        with on.connect() as connection:
            connection.send(b"stop")
            assert await waiting == b"stop"
        quiet = b"".join([await on.piece() for _ in range(QUIET)])
        assert quiet == bytes(2 * RATE)
        await on.source.close()

    async def test_half_a_sample_at_the_end_of_a_stream_does_not_shift_the_next(
        self, on: Listening
    ) -> None:
        waiting = asyncio.ensure_future(on.next())
        with on.connect() as connection:
            connection.send(b"abc")
            assert await waiting == b"ab"
        waiting = asyncio.ensure_future(on.next())
        with on.connect() as connection:
            connection.send(b"wxyz")
            assert await waiting == b"wxyz"
        await on.source.close()

    async def test_a_new_connection_replaces_a_half_open_one(self, on: Listening) -> None:
        waiting = asyncio.ensure_future(on.next())
        with on.connect() as older, on.connect() as between, on.connect() as newer:
            assert await on.reads(older, LISTENING + TAKEN)
            assert await on.reads(between, LISTENING + TAKEN)
            assert await on.reads(newer, LISTENING)
            newer.send(b"new!")
            assert await waiting == b"new!"
            with pytest.raises(BrokenPipeError):
                older.send(b"old!")
        await on.source.close()

    async def test_sound_sent_before_a_takeover_is_still_heard(self, on: Listening) -> None:
        waiting = asyncio.ensure_future(on.next())
        with on.connect() as older:
            older.send(b"first")
            assert await waiting == b"firs"
            older.send(b"t.")
            with on.connect() as newer:
                newer.send(b"next")
                assert [await on.next(), await on.next()] == [b"tt", b"next"]
        await on.source.close()

    async def test_a_connection_reset_ends_a_stream(self, on: Listening) -> None:
        waiting = asyncio.ensure_future(on.next())
        on.connect().close()  # with its message unread, or before it is accepted
        with on.connect() as connection:
            connection.send(b"more")
            assert await waiting == b"more"
        await on.source.close()

    async def test_closing_ends_the_connections(self, on: Listening) -> None:
        waiting = asyncio.ensure_future(on.next())
        with on.connect() as connection:
            assert await on.reads(connection, LISTENING)
            await on.source.close()
            with pytest.raises(StopAsyncIteration):
                await waiting
            assert await on.reads(connection, b"")

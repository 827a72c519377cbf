"""Requests for help from keys, buttons and messages, in the order of their arrival."""

from __future__ import annotations

import asyncio
import os
from pathlib import Path

import pytest

from tangy_hw.perception.requests.buttons import EVENT, ButtonBox, KeyEventParser, find_boxes
from tangy_hw.perception.requests.help_request_source import RequestError, RequestSource
from tangy_hw.perception.requests.mqtt import Topic
from tangy_hw.perception.requests.sources import Keyboard, open_requests
from tangy_profiles.health import OK, STALE
from tangy_profiles.room import load_room

PEOPLE = ("ada", "ben", "cleo", "dot")


def seats(source: RequestSource) -> list[int]:
    return [ask.seat for ask in source.asking]


class TestKeyboard:
    def test_a_number_key_toggles_a_request(self) -> None:
        keys = Keyboard("keyboard", 4, PEOPLE)
        assert [keys.press(key) for key in "3159x "] == [True, True, False, False, False, False]
        assert [(ask.seat, ask.person, ask.sure) for ask in keys.asking] == [
            (3, "cleo", 1.0), (1, "ada", 1.0),
        ]  # fmt: skip
        keys.press("3")
        assert seats(keys) == [1]
        keys.answered(1)
        keys.answered(1)
        assert keys.asking == ()
        assert (keys.reading().device, keys.reading().state) == ("requests", OK)

    async def test_each_change_is_reported_once(self) -> None:
        keys = Keyboard("keyboard", 4)
        given: list[list[int]] = []

        async def listen() -> None:
            async for asks in keys:
                given.append([ask.seat for ask in asks])

        listening = asyncio.create_task(listen())
        for key in "2 4xx4":
            keys.press(key)
            await asyncio.sleep(0)
        await asyncio.sleep(0)
        await keys.close()
        await asyncio.wait_for(listening, 5)
        assert given == [[2], [2, 4], [2]]


def events(*presses: tuple[int, int, int]) -> bytes:
    """Return events as the kernel writes them: type, code, value."""
    return b"".join(EVENT.pack(1_700_000_000, 5, *press) for press in presses)


PRESS_2 = events((4, 4, 0x7001F), (1, 3, 1), (0, 0, 0), (1, 3, 2), (0, 0, 0), (1, 3, 0), (0, 0, 0))
"""As a keypad sends it: scan code, key down, report; held; released."""


class TestButtons:
    def test_a_press_counts_once_however_the_bytes_arrive(self) -> None:
        for size in (1, 7, EVENT.size, 1000):
            read = KeyEventParser()
            parts = [PRESS_2[place : place + size] for place in range(0, len(PRESS_2), size)]
            assert [code for part in parts for code in read.pressed(part)] == [3]

    def test_key_presses_in_a_dropped_packet_are_ignored(self) -> None:
        read = KeyEventParser()
        content = events((0, 3, 0), (1, 2, 1), (0, 0, 0), (1, 4, 1), (0, 0, 0))
        assert read.pressed(content) == [4]

    async def test_a_button_box_survives_being_unplugged(self, tmp_path: Path) -> None:
        path = tmp_path / "event7"
        os.mkfifo(path)
        box = ButtonBox("buttons", str(path), 4, PEOPLE)
        told: list[str] = []
        box.tell = told.append
        assert box.reading().state == STALE

        async def until(*wanted: int) -> None:
            async with asyncio.timeout(20):
                async for asks in box:
                    if sorted(ask.seat for ask in asks) == list(wanted):
                        return

        # Both ends, so that bytes written before the box opens are not lost.
        descriptor = os.open(path, os.O_RDWR | os.O_NONBLOCK)
        async with box:
            os.write(descriptor, PRESS_2 + PRESS_2)
            await until(2)
            assert (box.asking[0].person, box.reading().state) == ("ben", OK)
            os.write(descriptor, events((1, 81, 1), (0, 0, 0), (1, 0x103, 1), (1, 30, 1)))
            await until(2, 3)
            box.answered(2)
            await until(3)
            os.close(descriptor)
            async with asyncio.timeout(20):
                while box.reading().state == OK:  # noqa: ASYNC110 - nobody tells
                    await asyncio.sleep(0.01)
            descriptor = os.open(path, os.O_RDWR | os.O_NONBLOCK)
            os.write(descriptor, events((1, 0x120, 1), (0, 0, 0)))
            await until(1, 3)
        os.close(descriptor)
        assert told[0] == "The button box was unplugged. It is waited for."

    async def test_a_missing_button_box_is_reported_and_awaited(self, tmp_path: Path) -> None:
        box = ButtonBox("buttons", str(tmp_path / "event9"), 4)
        waiting: asyncio.Future[str] = asyncio.get_running_loop().create_future()
        box.tell = waiting.set_result
        async with box:
            said = await asyncio.wait_for(waiting, 20)
        assert said.startswith("The button box is not there (No such file or directory)")

    def test_button_boxes_are_found_in_the_device_files_of_the_system(self, tmp_path: Path) -> None:
        for name, title, keys in (("event4", "Number Pad", "8000 0 fe"), ("event11", "Lid", "0")):
            (tmp_path / name / "device" / "capabilities").mkdir(parents=True)
            (tmp_path / name / "device" / "name").write_text(f"{title}\n")
            (tmp_path / name / "device" / "capabilities" / "key").write_text(f"{keys}\n")
            (tmp_path / f"dev-{name}").write_bytes(b"")
        devices = tmp_path / "dev"
        devices.mkdir()
        (devices / "event4").write_bytes(b"")
        assert find_boxes(tmp_path, devices) == [(str(devices / "event4"), "Number Pad")]


class TestMessages:
    @pytest.mark.parametrize(
        ("topic", "payload", "asks"),
        [
            ("2", b"1", [2]),
            ("seat-2", b" ON ", [2]),
            ("cleo", b'{"action": "single", "battery": 90}', [3]),
            ("seat_4", b"true", [4]),
            ("3", b'{"state": "ON"}', [3]),
            ("2", b"0", []),
            ("2", b"what?", []),
            ("2", b"\xff\x00", []),
            ("2", b"[" * 900, []),
            ("2", b"1" * 2_000, []),
            ("9", b"1", []),
            ("0", b"1", []),
            ("nobody", b"1", []),
            ("", b"1", []),
        ],
    )
    def test_a_message_sets_or_clears_a_request(
        self, topic: str, payload: bytes, asks: list[int]
    ) -> None:
        source = Topic("mqtt://host/tangy/requests", 4, PEOPLE)
        source.hear(f"tangy/requests/{topic}", payload)
        assert seats(source) == asks
        source.hear(f"tangy/requests/{topic}", b'{"action": "long"}')
        assert seats(source) == []

    def test_an_unreadable_message_is_reported_once(self) -> None:
        source, told = Topic("mqtt://host/tangy/requests", 4), list[str]()
        source.tell = told.append
        for _ in range(3):
            source.hear("tangy/requests/7", b"1")
            source.hear("tangy/requests/2", b"perhaps")
        assert [sentence.split(" of ")[1] for sentence in told] == [
            "tangy/requests/7 names no seat; it is not heeded.",
            "tangy/requests/2 says neither yes nor no; it is not heeded.",
        ]

    def test_the_name_of_a_topic_leaves_out_its_password(self) -> None:
        source = Topic("mqtts://staff:secret@host/t", 4)
        assert source.name == "mqtt://host:8883/t"


class TestNames:
    def test_sources_by_name(self) -> None:
        room = load_room()
        assert isinstance(open_requests("keyboard", room, PEOPLE), Keyboard)
        assert isinstance(open_requests("mqtt://host/t", room, PEOPLE), Topic)
        assert isinstance(open_requests("buttons:/dev/input/event0", room, PEOPLE), ButtonBox)

    @pytest.mark.parametrize(
        ("name", "word"),
        [
            ("keybord", "did you mean 'keyboard'"),
            ("mqtt://host", "give mqtt://HOST/TOPIC"),
            ("mqtt://host/a/#", "without # and"),
            ("mqtt://host:99999/a", "give mqtt://HOST/TOPIC"),
            ("buttons:nothing of this name", "no box called 'nothing of this name'"),
            ("signs:", "names no camera"),
            ("signs:0", "corners of the table"),
        ],
    )
    def test_an_invalid_source_is_refused_in_one_sentence(self, name: str, word: str) -> None:
        with pytest.raises(RequestError, match=word) as refused:
            open_requests(name, load_room(), PEOPLE)
        assert "\n" not in str(refused.value)

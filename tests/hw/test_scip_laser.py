"""A laser scanner behind SCIP: its scans, and the facts that the diagnosis needs."""

from __future__ import annotations

import asyncio
import math
from collections.abc import AsyncIterator

import numpy as np
import pytest
from numpy.typing import NDArray

from tangy_hw.drivers import scip
from tangy_hw.drivers.scip import ScipLaser
from tangy_sim.servers.scip_server import ScipServer
from tangy_sim.servers.scip_session import URG, UTM, Scanner
from tests.hw.waiting import PATIENCE, until

ROOM = np.linspace(0.3, 4.0, URG.beams)


class Bench:
    """A scanner and its driver, on a clock that the test advances."""

    def __init__(self) -> None:
        self.server = ScipServer(URG)
        self.now = 100.0
        self.turns = 0
        self.laser: ScipLaser

    async def attach(self, **settings: float | bool) -> None:
        self.laser = ScipLaser(self.server.url, clock=lambda: self.now, **settings)  # type: ignore[arg-type]
        await self.laser.start()
        await self.measuring()

    async def measuring(self) -> None:
        async with asyncio.timeout(PATIENCE):
            await self.server.somebody()

    async def turn(self, ranges: NDArray[np.float64], *, lost: int = 0) -> NDArray[np.float64]:
        """Let the scanner turn, a tenth of a second later; return the scan."""
        self.turns += 1 + lost
        self.now += 0.1 * (1 + lost)
        seq = self.laser.scan.seq if self.laser.scan else 0
        assert self.server.send(ranges, 100 * self.turns) == 1
        async with asyncio.timeout(PATIENCE):
            return (await self.laser.after(seq)).value.ranges

    async def state(self, wanted: str) -> None:
        """Wait until it is in a state."""
        await until(lambda: self.laser.reading().state == wanted)


@pytest.fixture
async def bench() -> AsyncIterator[Bench]:
    made = Bench()
    await made.server.start()
    yield made
    await made.laser.close()
    await made.server.close()


class TestScans:
    async def test_distances_arrive_as_measured(self, bench: Bench) -> None:
        await bench.attach()
        assert bench.laser.scan is None and bench.laser.reading().state == "STALE"
        read = await bench.turn(ROOM)
        scan = bench.laser.scan
        assert scan is not None
        assert np.abs(read - ROOM).max() <= 0.0005
        assert (scan.seq, scan.stamp) == (1, bench.now)
        assert scan.value.first == pytest.approx(-math.radians(120))
        assert scan.value.step == pytest.approx(math.tau / 540)
        assert scan.value.farthest == 5.6
        assert bench.laser.reading().state == "OK"
        assert bench.laser.about["PROT"] == "SCIP 2.0"

    async def test_beams_without_a_valid_distance_are_infinite(self, bench: Bench) -> None:
        await bench.attach()
        ranges = ROOM.copy()
        ranges[:4] = [math.inf, 5.7, 0.019, math.nan]
        read = await bench.turn(ranges)
        assert np.isinf(read[:4]).all() and np.isfinite(read[4:]).all()

    async def test_scans_are_read_only(self, bench: Bench) -> None:
        await bench.attach()
        read = await bench.turn(ROOM)
        with pytest.raises(ValueError, match="read-only"):
            read[0] = 1.0

    async def test_lost_scans_are_counted(self, bench: Bench) -> None:
        await bench.attach()
        for lost in (0, 0, 3, 0, 1):
            await bench.turn(ROOM, lost=lost)
        assert bench.laser.missed == 4
        assert bench.laser.scan is not None and bench.laser.scan.seq == 5

    async def test_a_wrapped_scanner_clock_loses_no_scan(self, bench: Bench) -> None:
        await bench.attach()
        bench.turns = (1 << 24) // 100 - 2
        for _ in range(5):
            await bench.turn(ROOM)
        assert bench.laser.missed == 0

    async def test_a_scanner_mounted_upside_down_is_mirrored(self, bench: Bench) -> None:
        await bench.attach(flipped=True, turned=math.pi)
        read = await bench.turn(ROOM)
        scan = bench.laser.scan
        assert scan is not None
        assert np.abs(read - ROOM[::-1]).max() <= 0.0005
        # The beam that was straight ahead still is, behind the robot.
        ahead = round((math.pi - scan.value.first) / scan.value.step)
        assert read[ahead] == pytest.approx(ROOM[URG.front], abs=0.0005)

    @pytest.mark.parametrize("scanner", [URG, UTM])
    async def test_angles_are_those_of_the_scanner(self, scanner: Scanner) -> None:
        server = ScipServer(scanner)
        await server.start()
        laser = ScipLaser(server.url)
        await laser.start()
        async with asyncio.timeout(PATIENCE):
            await server.somebody()
            server.send(np.full(scanner.beams, 1.0), 0)
            scan = (await laser.after(0)).value
        assert scan.first == pytest.approx(scanner.first)
        assert scan.step == pytest.approx(scanner.step)
        assert scan.farthest == scanner.farthest
        await laser.close()
        await server.close()


class TestFacts:
    async def test_a_share_of_beams_is_near(self, bench: Bench) -> None:
        await bench.attach()
        ranges = ROOM.copy()
        ranges[:90] = 0.06
        await bench.turn(ranges)
        assert bench.laser.reading().facts["near_share"] == pytest.approx(0.25)

    async def test_variety_is_reported_after_the_first_second(self, bench: Bench) -> None:
        await bench.attach()
        rng = np.random.default_rng(1)
        for turn in range(12):
            ranges = ROOM.copy()
            ranges[180:] += rng.normal(0, 0.01, 180)
            await bench.turn(ranges)
            if turn in (7, 9):
                assert ("variety" in bench.laser.reading().facts) == (turn == 9)
        assert bench.laser.reading().facts["variety"] == pytest.approx(0.5, abs=0.02)

    async def test_a_covered_scanner_with_flickering_error_codes_has_no_variety(
        self, bench: Bench
    ) -> None:
        await bench.attach()
        rng = np.random.default_rng(1)
        for _ in range(12):
            # Below its nearest distance it writes flickering reasons instead of distances.
            await bench.turn(rng.uniform(0, 0.019, URG.beams))
        assert bench.laser.reading().facts["variety"] == 0

    async def test_variety_counts_only_changes_of_the_last_second(self, bench: Bench) -> None:
        await bench.attach()
        await bench.turn(ROOM + 0.1)
        for _ in range(11):
            await bench.turn(ROOM)
        assert bench.laser.reading().facts["variety"] == 0


class TestRate:
    async def test_the_rate_of_scans_is_measured(self, bench: Bench) -> None:
        await bench.attach()
        for turn in range(25):
            await bench.turn(ROOM)
            if turn in (8, 12):
                assert (bench.laser.reading().rate is None) == (turn == 8)
        assert bench.laser.reading().rate == pytest.approx(10, abs=0.5)
        bench.now += 1.0
        assert bench.laser.reading().rate == pytest.approx(5, abs=0.5)


class TestFaults:
    async def test_the_age_of_a_scan_grows(self, bench: Bench) -> None:
        await bench.attach()
        await bench.turn(ROOM)
        bench.now += 0.3
        reading = bench.laser.reading()
        assert reading.state == "STALE" and reading.age == pytest.approx(0.3)
        assert not reading.facts

    async def test_a_scanner_reconnects_after_its_cable_was_pulled(self, bench: Bench) -> None:
        await bench.attach()
        await bench.turn(ROOM)
        bench.server.closed = True
        await until(lambda: bool(bench.laser.why))
        bench.server.closed = False
        await bench.measuring()
        await bench.turn(ROOM)
        assert (bench.laser.reading().state, bench.laser.why) == ("OK", "")
        assert bench.laser.connected == 2
        assert bench.laser.scan is not None and bench.laser.scan.seq == 2

    @pytest.mark.parametrize("noise", [b"\xff\x00?\n", b"noise", b"99b\n0000\n", b"MD"])
    async def test_noise_before_a_reply_loses_no_scan(self, bench: Bench, noise: bytes) -> None:
        bench.server.cable = lambda sent: noise + sent
        await bench.attach()
        for _ in range(5):
            assert np.abs(await bench.turn(ROOM) - ROOM).max() <= 0.0005
        assert bench.laser.missed == 0 and bench.laser.spoilt >= 5
        assert bench.laser.reading().state == "WARN"  # the cable needs a check

    async def test_a_truncated_reply_spoils_no_other_reply(self, bench: Bench) -> None:
        await bench.attach()
        sent = 0

        def cuts(reply: bytes) -> bytes:
            nonlocal sent
            sent += 1
            return reply[: len(reply) * 2 // 3] if sent % 2 else reply

        bench.server.cable = cuts
        for turn in range(1, 6):
            assert bench.server.send(ROOM, 100 * turn) == 1  # this one is cut
            bench.turns = turn
            assert np.abs(await bench.turn(ROOM) - ROOM).max() <= 0.0005

    async def test_a_silent_scanner_is_asked_again(
        self, bench: Bench, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(scip, "ANSWER_SECONDS", 0.05)
        await bench.attach()
        await bench.turn(ROOM)
        bench.server.silent = True
        await asyncio.sleep(0.2)
        assert not bench.laser.why  # the clock stands still: so may the scanner
        bench.now += 3
        await until(lambda: "does not answer" in bench.laser.why)
        assert bench.laser.reading().state == "STALE"
        bench.server.silent = False
        await bench.measuring()
        await bench.turn(ROOM)
        assert (bench.laser.reading().state, bench.laser.why) == ("OK", "")

    @pytest.mark.parametrize("status", ["0L", "70"])
    async def test_a_stalled_motor_is_reported_until_it_recovers(
        self, bench: Bench, status: str
    ) -> None:
        await bench.attach()
        await bench.turn(ROOM)
        bench.server.fault = status
        bench.server.send(ROOM, 200)
        await bench.state("ERROR")
        assert "cannot measure" in bench.laser.why
        bench.server.fault = ""
        await bench.measuring()
        await bench.turn(ROOM)
        assert (bench.laser.reading().state, bench.laser.why) == ("OK", "")

    async def test_a_missing_scanner_is_awaited(self) -> None:
        server = ScipServer()
        await server.start()
        port = server.port
        await server.close()
        laser = ScipLaser(f"tcp://127.0.0.1:{port}")
        await laser.start()
        await until(lambda: "nobody listens" in laser.why)
        async with asyncio.timeout(PATIENCE):
            await server.start(port=port)
            await server.somebody()
            server.send(ROOM, 0)
            await laser.after(0)
        await laser.close()
        await server.close()

    @pytest.mark.parametrize(
        "address",
        ["tcp://", "udp://a:1", "tcp://x:y", "tcp://a..b:1", "", "/dev/null", "/dev/no-such-port"],
    )
    async def test_an_invalid_address_is_reported(self, address: str) -> None:
        laser = ScipLaser(address)
        await laser.start()
        await until(lambda: "not answered yet" not in laser.why)
        assert laser.reading().state == "STALE"
        assert address in laser.why and laser.why.endswith(".")
        await laser.close()

    async def test_damaged_scans_are_dropped_and_reported(self) -> None:
        """A cable that spoils every third reply, and cuts and joins the others at random."""
        server = ScipServer()
        await server.start()
        tasks: set[asyncio.Task[None]] = set()

        async def cable(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            there, back = await asyncio.open_connection("127.0.0.1", server.port)

            async def ask() -> None:
                while came := await reader.read(100):
                    back.write(came)

            tasks.add(asyncio.create_task(ask()))
            scans, held = 0, b""
            while came := await there.read(777):
                held += came
                *whole, held = held.split(b"\n\n")
                out = b""
                for one in whole:
                    scans += b"\n99b\n" in one
                    if b"\n99b\n" in one and scans % 3 == 0:
                        one = one[:-30] + b"\x7f" + one[-29:]
                    out += one + b"\n\n"
                for begin in range(0, len(out), 333):
                    writer.write(out[begin : begin + 333])
                    await writer.drain()

        between = await asyncio.start_server(cable, "127.0.0.1", 0)
        port = between.sockets[0].getsockname()[1]
        laser = ScipLaser(f"tcp://127.0.0.1:{port}")
        await laser.start()
        async with asyncio.timeout(PATIENCE):
            await server.somebody()
            for turn in range(9):
                server.send(ROOM, 100 * turn)
        await until(lambda: laser.spoilt == 3 and laser.scan is not None and laser.scan.seq == 6)
        assert laser.reading().state == "WARN"
        assert laser.missed == 2  # the ninth was spoilt, too, but no scan came after it
        await laser.close()
        between.close()
        await server.close()
        for task in tasks:
            task.cancel()

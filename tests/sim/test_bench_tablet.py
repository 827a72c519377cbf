"""The bench's tablet behaves like a real one towards the driver of the chest screen."""

from __future__ import annotations

import asyncio

import pytest

from tangy_hw.device_protocols import Picture
from tangy_hw.drivers import chest
from tangy_hw.drivers.chest import WebChestScreen
from tangy_hw.drivers.chest_pairing import Pairing
from tangy_sim.device_simulator.tablet import Tablet
from tests.hw.waiting import PATIENCE, until


@pytest.mark.slow
async def test_the_tablet_shows_each_picture_until_it_is_switched_off(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(chest, "GONE_SECONDS", 1.0)
    screen = WebChestScreen(port=0, stale_after=0.9)
    await screen.start()
    tablet = Tablet(screen.url, screen.code)
    await until(lambda: screen.reading().state == "OK")
    async with asyncio.timeout(PATIENCE):
        await screen.show(Picture("Next \u2028\n", "B-12", ("N-40",), "Ana"))
    assert tablet.picture["text"] == "Next \u2028\n" and tablet.picture["before"] == ["N-40"]
    tablet.on = False
    await until(lambda: screen.reading().state == "STALE" and not screen.pages)
    await screen.show(Picture("for whoever comes"))
    tablet.on = True
    await until(lambda: tablet.picture["text"] == "for whoever comes")
    # The robot's process ends, and another one begins; the tablet is still paired.
    port = screen.port
    await screen.close()
    again = WebChestScreen(port=port, pairing=Pairing(screen.pairing.key, "00000000"))
    await again.start()
    await until(lambda: again.reading().state == "OK")
    await asyncio.to_thread(tablet.close)
    await again.close()

"""A simulated tablet does to the chest screen's driver what a real one does."""

from __future__ import annotations

import asyncio

import pytest

from tangy_hw.devices import DeviceError, Picture
from tangy_hw.drivers import chest
from tangy_hw.drivers.chest import WebChestScreen
from tangy_sim.wires.chest_tablet import ChestTablet
from tests.hw.waiting import PATIENCE, until


async def test_it_shows_what_it_is_told_and_its_faults_are_noticed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name, seconds in (("ALIVE_SECONDS", 0.02), ("SHOW_SECONDS", 0.15), ("GONE_SECONDS", 0.4)):
        monkeypatch.setattr(chest, name, seconds)
    screen = WebChestScreen(port=0, stale_after=0.15)
    await screen.start()
    tablet = ChestTablet(screen.url)
    await tablet.start()
    await until(lambda: screen.reading().state == "OK")
    async with asyncio.timeout(PATIENCE):
        await screen.show(Picture("Next \u2028\n", "B-12", ("N-40",), "Ana"))
    assert tablet.shown["text"] == "Next \u2028\n" and tablet.shown["before"] == ["N-40"]
    tablet.hangs = True
    with pytest.raises(DeviceError):
        await screen.show(Picture("nobody sees this"))
    await until(lambda: screen.reading().state == "STALE")
    tablet.hangs = False
    await until(lambda: screen.reading().state == "OK")
    tablet.off = True
    await until(lambda: screen.reading().state == "STALE" and not screen.pages)
    await screen.show(Picture("for whoever comes"))
    tablet.off = False
    await until(lambda: tablet.shown["text"] == "for whoever comes")
    # The robot's process ends, and begins anew.
    port = screen.port
    await screen.close()
    again = WebChestScreen(port=port)
    await again.start()
    await until(lambda: again.reading().state == "OK")
    await tablet.close()
    await again.close()

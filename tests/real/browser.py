"""Headless Chromium, driven over its own debugging protocol."""

from __future__ import annotations

import asyncio
import base64
import json
import shutil
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from websockets.asyncio.client import ClientConnection, connect

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
PATIENCE = 30.0

# Without these it looks up its maker's hosts, which a machine without a network refuses.
QUIETLY = (
    "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--disable-dev-shm-usage", "--hide-scrollbars", "--remote-debugging-port=0",
)  # fmt: skip


class Tab:
    """A page in the browser."""

    def __init__(self, socket: ClientConnection) -> None:
        self._socket = socket
        self._session: dict[str, str] = {}  # none: commands go to the browser itself
        self._asked = 0

    async def ask(self, method: str, **given: Any) -> dict[str, Any]:
        """Send the browser a command, and return its response."""
        self._asked += 1
        await self._socket.send(
            json.dumps({"id": self._asked, "method": method, "params": given, **self._session})
        )
        async with asyncio.timeout(PATIENCE):
            while True:
                said: dict[str, Any] = json.loads(await self._socket.recv())
                if said.get("id") == self._asked:
                    if "error" in said:
                        raise RuntimeError(f"{method}: {said['error']}")
                    answer: dict[str, Any] = said["result"]
                    return answer

    async def attach(self) -> None:
        """Make it a new, empty page."""
        target = await self.ask("Target.createTarget", url="about:blank")
        attached = await self.ask(
            "Target.attachToTarget", targetId=target["targetId"], flatten=True
        )
        self._session = {"sessionId": attached["sessionId"]}

    async def close(self) -> None:
        """Close the page and its connection."""
        await self.ask("Page.close")
        await self._socket.close()

    async def open(self, url: str, width: int, height: int) -> None:
        """Open an address in a window of this size."""
        await self.ask(
            "Emulation.setDeviceMetricsOverride", width=width, height=height,
            deviceScaleFactor=1, mobile=False,
        )  # fmt: skip
        await self.ask("Page.navigate", url=url)

    async def value(self, script: str) -> Any:
        """Return the value of an expression on the page."""
        said = await self.ask("Runtime.evaluate", expression=script, returnByValue=True)
        if "exceptionDetails" in said:
            raise RuntimeError(str(said["exceptionDetails"]))
        return said["result"].get("value")

    async def until(self, script: str) -> None:
        """Wait until an expression is true on the page."""
        # While a page is loading, the objects of the expression may not exist.
        safely = f"(() => {{ try {{ return Boolean({script}); }} catch (e) {{}} }})()"
        for _ in range(round(20 * PATIENCE)):
            if await self.value(safely):
                return
            await asyncio.sleep(0.05)
        raise AssertionError(f"never so on the page: {script}")

    async def screenshot(self, path: Path) -> None:
        """Save a screenshot as a PNG."""
        said = await self.ask("Page.captureScreenshot", format="png")
        await asyncio.to_thread(path.write_bytes, base64.b64decode(said["data"]))


class Browser:
    """A running browser, by its address; each tab has its own connection to it."""

    def __init__(self, address: str) -> None:
        self._address = address
        self._tabs: list[Tab] = []

    async def tab(self) -> Tab:
        """Open an empty tab."""
        socket = await connect(self._address, max_size=None)
        tab = Tab(socket)
        self._tabs.append(tab)
        await tab.attach()
        return tab

    async def close(self) -> None:
        """Close the open tabs."""
        for tab in self._tabs:
            await tab.close()


@contextmanager
def chromium(folder: Path) -> Iterator[str]:
    """Run a browser with an empty profile; yields the address of its debugging protocol."""
    assert CHROMIUM is not None
    said = folder / "DevToolsActivePort"
    process = subprocess.Popen(  # noqa: S603 - found on the path
        [CHROMIUM, *QUIETLY, f"--user-data-dir={folder}", "about:blank"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        for _ in range(round(20 * PATIENCE)):
            if said.exists() and said.read_text().count("\n") == 1:
                break
            time.sleep(0.05)
        port, path = said.read_text().split("\n")
        yield f"ws://127.0.0.1:{port}{path}"
    finally:
        process.terminate()
        process.wait(PATIENCE)

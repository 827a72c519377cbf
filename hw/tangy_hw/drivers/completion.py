"""The completion of what a device does for a while: a movement, or a drive."""

from __future__ import annotations

import asyncio

from tangy_hw.device_protocols import DeviceError


class Completion:
    """Ends once: with success, or with a `DeviceError`; later ends do not count."""

    def __init__(self) -> None:
        """Begin; needs a running event loop."""
        self.over: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        # An error that nobody waits for any more is no warning at exit.
        self.over.add_done_callback(lambda over: over.cancelled() or over.exception())

    def end(self, why: str = "") -> None:
        """End; `why` is the error's sentence, "" for success."""
        if not self.over.done():
            if why:
                self.over.set_exception(DeviceError(why))
            else:
                self.over.set_result(None)

"""Runs pieces of work on an existing Dask cluster, which is never started or stopped."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from concurrent.futures import CancelledError
from importlib import import_module
from typing import TYPE_CHECKING, Any

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.experiments.provenance import code_digest

if TYPE_CHECKING:
    from tangy_tui.experiments.sweep import Case, Piece, Settings

REACHED_WITHIN = 3.0
"""Timeout (s) of the connection to a scheduler."""


def on_cluster(
    address: str, piece: Piece, settings: Settings, cases: Sequence[Case]
) -> Iterator[tuple[int, Any]]:
    """Yield (index of the case, result) as the cluster's workers finish them.

    Raises:
        TangyError: Dask is not installed, there is no scheduler at the address, it has no workers,
            or they have another version of this code.
    """
    distributed = _distributed()
    with _connected(distributed, address) as client:
        _check_workers(client, address)
        futures = {
            client.submit(piece, dict(settings), case, pure=False): index
            for index, case in enumerate(cases)
        }
        try:
            for future in distributed.as_completed(list(futures), loop=client.loop):
                if future.status not in ("finished", "error"):
                    raise CancelledError
                yield futures[future], future.result()
        except (distributed.KilledWorker, CancelledError, OSError):
            raise TangyError(
                plain(f"--dask {address}: the cluster was lost; what was done is kept.")
            ) from None
        finally:  # cancel the rest if the caller stops early
            if client.status == "running":
                client.cancel(list(futures))


def _distributed() -> Any:
    try:
        return import_module("distributed")
    except ImportError:
        raise TangyError(
            "--dask needs Dask, which is not installed: install the extra tangy[cluster]."
        ) from None


def _connected(distributed: Any, address: str) -> Any:
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # the error below is enough
    try:
        return distributed.Client(address, timeout=REACHED_WITHIN, set_as_default=False)
    except (OSError, ValueError, TypeError):  # for an invalid address or no answer
        raise TangyError(
            plain(f"--dask {address}: no Dask scheduler answers there; is its address right?")
        ) from None


def versions_there(client: Any) -> dict[str, str]:
    """Return the digest of each worker's code."""
    found: dict[str, str] = client.run(code_digest)
    return found


def _check_workers(client: Any, address: str) -> None:
    """Check that there are workers, and that they have the same code."""
    try:
        theirs = set(versions_there(client).values())
    except Exception:  # unpickling fails on a worker without this package
        theirs = {"none"}
    if not theirs:
        raise TangyError(plain(f"--dask {address}: the scheduler has no workers yet."))
    if theirs != {code_digest()}:
        raise TangyError(
            plain(f"--dask {address}: its workers do not have this version of Tangy installed.")
        )

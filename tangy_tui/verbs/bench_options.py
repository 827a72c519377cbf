"""Options of `tangy live` for a bench game on a busy machine, or over a bad network."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from tangy_profiles.errors import TangyError

if TYPE_CHECKING:
    from tangy_sim.servers.link_relay import LinkQuality

Load = Annotated[
    int,
    typer.Option(
        min=0,
        max=64,
        help="Keep this many processes busy beside a bench game, to try it on a busy machine.",
    ),
]
LinkDelay = Annotated[
    float,
    typer.Option(
        min=0,
        max=2000,
        metavar="MS",
        help="Delay the robot's link to its devices on the bench, in each direction.",
    ),
]
LinkLoss = Annotated[
    float,
    typer.Option(
        min=0,
        max=50,
        metavar="PERCENT",
        help="Lose packets of the robot's link to its devices on the bench; they are sent again.",
    ),
]


def check_load(load: int, *, bench: bool) -> None:
    """Check that a machine is kept busy only beside a bench game.

    Raises:
        TangyError: it is not on the bench.
    """
    if load and not bench:
        raise TangyError("--load: only a bench game is played on a busy machine: add --bench.")


def link_of(delay: float, loss: float, *, bench: bool) -> LinkQuality | None:
    """Return the quality of the bench's link (delay in ms, loss in percent); None: it is perfect.

    Raises:
        TangyError: it is not on the bench.
    """
    if not (delay or loss):
        return None
    if not bench:
        raise TangyError("--link-delay, --link-loss: only the bench's link is bad: add --bench.")
    from tangy_sim.servers.link_relay import LinkQuality

    return LinkQuality(delay / 1000, loss / 100)

"""How much Tangy does of itself, and what staff have said yes to where it asks them first."""

from __future__ import annotations

from tangy_tui.app.game_commands import Autonomy, Proposal
from tangy_tui.learning.policy import Decision

SURE = 0.9
"""The share of votes from which a decision is not asked about where Tangy asks when unsure."""


class AutonomyDial:
    """The dial that staff turn. Where it asks first, `propose` keeps what it would do."""

    def __init__(self) -> None:
        """Begin where Tangy does all of it by itself."""
        self.level: Autonomy = "alone"
        self.proposal: Proposal | None = None
        """What Tangy would do next, and asks staff about."""
        self._confirmed: tuple[str, str | None] | None = None

    def turn(self, level: Autonomy) -> None:
        """Turn it; what was asked about is asked no more."""
        self.level, self.proposal = level, None

    def reset(self) -> None:
        """Forget what was asked, and what staff said yes to."""
        self.proposal = self._confirmed = None

    def propose(self, decision: Decision, target: str | None) -> None:
        """Keep what would be done next, for staff to be asked about."""
        self.proposal = Proposal(decision.behaviour, target, decision.share, decision.seen)

    def confirm(self, *, yes: bool) -> bool:
        """Keep what staff said to the proposal: it alone is done next. False: there was none."""
        proposal, self.proposal = self.proposal, None
        if proposal is not None and yes:
            self._confirmed = proposal.behaviour, proposal.target
        return proposal is not None

    def done(self) -> None:
        """Take the yes back: a behaviour was done by it."""
        self._confirmed = None

    def permits(self, decision: Decision, target: str | None) -> bool:
        """Say, as a step is done, whether staff said yes to it: they may have to be asked anew.

        People ask for things while a question stands, and what would be done is another then.
        """
        unsure = self.level == "unsure" and decision.share < SURE
        asks = self.level == "each" or unsure
        return not asks or self._confirmed == (decision.behaviour, target)

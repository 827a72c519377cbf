"""How much Tangy does of itself, and what staff have said yes to where it asks them first."""

from __future__ import annotations

from tangy_tui.app.game_commands import Autonomy, Proposal
from tangy_tui.learning.policy import Decision

SURE = 0.9
"""The share of votes from which a decision is not asked about where Tangy asks when unsure."""


class AutonomyDial:
    """The dial that staff turn. Where it asks first, `propose` keeps what it would do."""

    def __init__(self) -> None:
        """Begin at full autonomy."""
        self.level: Autonomy = "alone"
        self.proposal: Proposal | None = None
        """What Tangy would do next, and asks staff about."""
        self._confirmed: tuple[str, str | None] | None = None

    def turn(self, level: Autonomy) -> None:
        """Change the level of autonomy, and drop the open proposal."""
        self.level, self.proposal = level, None

    def reset(self) -> None:
        """Drop the open proposal and what staff have approved."""
        self.proposal = self._confirmed = None

    def propose(self, decision: Decision, target: str | None) -> None:
        """Keep the next action as a proposal for staff."""
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
        """Return whether staff approved this step; if the situation changed, they are asked again.

        People ask for things while a question stands, and what would be done is another then.
        """
        unsure = self.level == "unsure" and decision.share < SURE
        asks = self.level == "each" or unsure
        return not asks or self._confirmed == (decision.behaviour, target)

"""How much Tangy decides by itself, and which proposals staff have approved."""

from __future__ import annotations

from tangy_tui.app.game_commands import Autonomy
from tangy_tui.app.staff_notes import Proposal
from tangy_tui.learning.policy import Decision

SURE = 0.9
"""At the level `unsure`, Tangy asks about a decision with a smaller share of votes than this."""


class AutonomyDial:
    """The level of autonomy that staff set; keeps the proposal if Tangy must ask first."""

    def __init__(self) -> None:
        """Begin at full autonomy."""
        self.level: Autonomy = "alone"
        self.proposal: Proposal | None = None
        """The next action, on which staff are asked."""
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
        """Record the answer to the proposal; a yes permits only that action. False: no proposal."""
        proposal, self.proposal = self.proposal, None
        if proposal is not None and yes:
            self._confirmed = proposal.behaviour, proposal.target
        return proposal is not None

    def done(self) -> None:
        """Drop the approval after its behaviour was carried out."""
        self._confirmed = None

    def permits(self, decision: Decision, target: str | None) -> bool:
        """Return whether staff approved this step; if the situation changed, Tangy asks again.

        The situation can change while a proposal is open, for example if a person asks for help.
        """
        unsure = self.level == "unsure" and decision.share < SURE
        asks = self.level == "each" or unsure
        return not asks or self._confirmed == (decision.behaviour, target)

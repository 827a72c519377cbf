"""The whole story in a minute, as it is told: what is shown, what is learnt, what Tangy does."""

from __future__ import annotations

LEARNS = "2. Tangy learns what to do, and what happens then."
PLAYS = "3. Tangy runs a game by itself."
BELIEVES = "4. Tangy now believes this about the strategies for each person:"


def demonstrates(title: str, times: int) -> str:
    """Say what a teacher demonstrates, and how often."""
    return f"1. A teacher demonstrates {title} {times} times."


def shown_so_far(steps: int, shown: int, situations: int) -> str:
    """Say how long a demonstration was, and how much has been shown with it."""
    return f"   {steps} steps; {shown} of {situations} situations were shown."


def effects_known(behaviours: int) -> str:
    """Say of how many behaviours it is known what follows."""
    return f"   Tangy knows the effects of {behaviours} behaviours."

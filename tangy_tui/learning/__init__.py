"""Demonstration learning (paper, section III-A): commands, demonstrations, policy, effects."""

"""The demonstration learning sub-system (III-A): commands, demonstrations, policy, effects."""

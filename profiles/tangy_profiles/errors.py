"""Errors that a person can cause or fix: one sentence each, shown without a traceback."""


class TangyError(Exception):
    """An error that a person can fix; its text is the whole message."""


class ProfileError(TangyError):
    """A profile (TOML) has a mistake; the message says where."""


class StoreError(TangyError):
    """The data folder cannot be used as asked."""


class StoreBusy(StoreError):
    """Another process writes to this data folder."""

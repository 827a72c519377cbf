"""The errors that a person can cause or mend: one sentence each, shown without a traceback."""


class TangyError(Exception):
    """Something a person can put right; its text is the whole message."""


class ProfileError(TangyError):
    """A profile (TOML) says something Tangy does not understand, and where."""


class StoreError(TangyError):
    """The data folder cannot be used as asked."""


class StoreBusy(StoreError):
    """Another Tangy writes to this data folder."""

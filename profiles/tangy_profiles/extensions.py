"""Extensions by other packages through entry points: drivers, activities, methods of persuasion.

A package is never imported before what it adds is asked for by its name. What has the name of
something of our own is not used, and `problems` tells it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, get_args

from tangy_profiles.errors import ProfileError
from tangy_profiles.reading import plain

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

Group = Literal["drivers", "activities", "methods"]
GROUPS: tuple[Group, ...] = get_args(Group)


@dataclass(frozen=True, slots=True)
class Extension:
    """One thing that another package adds.

    `value` is where it is in the package, `package` the distribution with its version.
    """

    group: Group
    name: str
    value: str
    package: str
    point: EntryPoint

    def load(self) -> Any:
        """Import the package, and return what the entry point names.

        Raises:
            ProfileError: the package cannot be imported, or does not have it.
        """
        try:
            return self.point.load()
        except Exception as error:
            raise ProfileError(plain(f"{self}: {self.value} cannot be loaded: {error}")) from None

    def __str__(self) -> str:
        return f"{self.name} of {self.package} (tangy.{self.group})"


@cache
def extensions(group: Group) -> Mapping[str, Extension]:
    """Return what other packages add to a group, by its name; of two with one name the first."""
    from importlib.metadata import entry_points  # here, or every start reads how packages are kept

    found: dict[str, Extension] = {}
    for point in sorted(entry_points(group=f"tangy.{group}"), key=lambda point: point.value):
        dist = point.dist
        package = "a package" if dist is None else f"{dist.name} {dist.version}"
        found.setdefault(point.name, Extension(group, point.name, point.value, package, point))
    return found


def activity_files() -> dict[str, Path]:
    """Return the activities that other packages bring: NAME.toml in the package that is named."""
    from importlib.resources import files

    found: dict[str, Path] = {}
    for name, extension in extensions("activities").items():
        try:
            path = Path(str(files(extension.value) / f"{name}.toml"))
        except (ImportError, TypeError):
            continue  # `problems` says so
        if path.is_file():
            found[name] = path
    return found


def problems(
    own: Mapping[Group, Iterable[str]], check: Mapping[Group, Callable[[Extension], str]]
) -> Iterator[tuple[Extension, str]]:
    """Yield every extension with why it cannot be used, "" if it can.

    Args:
        own: the names that are ours, which nobody else can take.
        check: returns the problem of an extension of a group; "" if there is none.
    """
    for group in GROUPS:
        for name, extension in extensions(group).items():
            if name in own[group]:
                yield extension, "this name is taken; ours is used."
                continue
            try:
                yield extension, check[group](extension)
            except ProfileError as error:
                yield extension, str(error)

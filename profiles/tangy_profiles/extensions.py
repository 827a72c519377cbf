"""Extensions by other packages through entry points: drivers, activities, methods of persuasion.

A package is imported only when its extension is used by name. Built-in names cannot be replaced;
`problems` reports conflicts.
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
    """One extension of another package.

    `value` is the object reference of its entry point, `package` the distribution with its version.
    """

    group: Group
    name: str
    value: str
    package: str
    point: EntryPoint

    def load(self) -> Any:
        """Import the package, and return the object of the entry point.

        Raises:
            ProfileError: the package cannot be imported, or lacks the object.
        """
        try:
            return self.point.load()
        except Exception as error:
            raise ProfileError(plain(f"{self}: {self.value} cannot be loaded: {error}")) from None

    def __str__(self) -> str:
        return f"{self.name} of {self.package} (tangy.{self.group})"


@cache
def extensions(group: Group) -> Mapping[str, Extension]:
    """Return the extensions of a group by name; the first one of each name."""
    from importlib.metadata import entry_points  # slow to import

    found: dict[str, Extension] = {}
    for point in sorted(entry_points(group=f"tangy.{group}"), key=lambda point: point.value):
        dist = point.dist
        package = "a package" if dist is None else f"{dist.name} {dist.version}"
        found.setdefault(point.name, Extension(group, point.name, point.value, package, point))
    return found


def activity_files() -> dict[str, Path]:
    """Return the activities of other packages: the file NAME.toml in the named package."""
    from importlib.resources import files

    found: dict[str, Path] = {}
    for name, extension in extensions("activities").items():
        try:
            path = Path(str(files(extension.value) / f"{name}.toml"))
        except (ImportError, TypeError):
            continue  # `problems` reports it
        if path.is_file():
            found[name] = path
    return found


def problems(
    own: Mapping[Group, Iterable[str]], check: Mapping[Group, Callable[[Extension], str]]
) -> Iterator[tuple[Extension, str]]:
    """Yield every extension with the reason why it cannot be used; "" if it can.

    Args:
        own: the built-in names.
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

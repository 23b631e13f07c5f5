"""`[[overrides]]` of the project file: rules for some of its files, such as those of a vendor.

One invariant: for each rule the last override that names it counts, before `[rules]` of the project.  What the project
or the command line leaves out with `select` and `ignore` stays out everywhere.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from typing import TypeAlias

from btq_lang.diagnostics.rules import Severity
from btq_lang.util.record import Record

Severities: TypeAlias = tuple[tuple[str, Severity | None], ...]

# The keys of an override, and a line for editors.
KEYS = {
    "include": "patterns of the paths of the files it is for",
    "ignore": "rules that are off in these files",
    "rules": "the severities of rules in these files",
}


class Override(Record):
    """The severities of rules in files whose paths match a pattern; None is off."""

    include: tuple[str, ...]
    severities: Severities


@lru_cache(64)  # each item of a file asks
def severities_at(
    root: str, severities: Severities, overrides: tuple[Override, ...], path: str
) -> Mapping[str, Severity | None]:
    """The severities of rules in a file."""
    effective = dict(severities)
    for number in overrides_at(root, overrides, path):
        effective.update(overrides[number].severities)
    return effective


def overrides_at(root: str, overrides: tuple[Override, ...], path: str) -> Iterator[int]:
    """The numbers of the overrides that are for a file."""
    return (number for number, override in enumerate(overrides) if _matcher(override.include, root)(path))


@lru_cache(64)
def _matcher(patterns: tuple[str, ...], root: str) -> Callable[[str], bool]:
    from btq_lang.util.globs import path_matcher  # few projects have overrides

    return path_matcher(patterns, root)

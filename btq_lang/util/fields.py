"""The fields of a record, or of another class with `__match_args__`, as the compiled parts of the tree are."""

from __future__ import annotations

from typing import Any


def as_dict(part: object) -> dict[str, Any]:
    """The values of the fields, in order, by name."""
    return {field: getattr(part, field) for field in fields_of(part)}


def fields_of(part: object) -> tuple[str, ...]:
    """The names of the fields, in order."""
    return type(part).__match_args__  # type: ignore[attr-defined, no-any-return]  # `part` may be of any class

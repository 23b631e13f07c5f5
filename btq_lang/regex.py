"""Regular expressions that are compiled when they are first used, as is `re` imported: a small file needs none.

To import `re` takes a tenth of a small check, and to compile one of them as long as to read ten nodes.
"""

from __future__ import annotations

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    import re
    from typing import Any


def regex(pattern: str) -> re.Pattern[str]:
    """A pattern, to be used as if it were compiled; its flags stand in it: `(?x)`."""
    late: Any = _Late(pattern)
    return late  # type: ignore[no-any-return]  # it has all that a compiled one has


class _Late:
    """What looks like a compiled pattern to those who call its methods."""

    def __init__(self, pattern: str) -> None:
        self._pattern = pattern

    def __getattr__(self, name: str) -> object:
        import re

        value = getattr(re.compile(self._pattern), name)
        setattr(self, name, value)
        return value

"""The clauses of nodes: satisfices, satisfies and tags, and what they list.

One invariant: as in `words`, they are plain classes without decorators, so that they can be compiled.  The clauses of
requirements are in `clauses`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Final, TypeAlias

from btq_lang.util.text import Span

if TYPE_CHECKING:
    from mypy_extensions import i64

    from btq_lang.syntax.clauses import Argument, Clause, Parameter
    from btq_lang.syntax.words import Word


class _Part:
    """The base of all: equal if all fields are."""

    __slots__ = ()
    __match_args__: ClassVar[tuple[str, ...]] = ()

    @property
    def _values(self) -> tuple[object, ...]:
        return tuple([getattr(self, field) for field in self.__match_args__])

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Part) and type(other) is type(self) and self._values == other._values

    def __hash__(self) -> int:
        return hash(self._values)

    def __repr__(self) -> str:
        return f"{type(self).__name__}{self._values!r}"


class QualityPath(_Part):
    """`performance-efficiency.time-behaviour`, or in the paper's form: `performance <time-behavior>`."""

    __slots__ = ("names",)
    __match_args__: ClassVar = ("names",)

    def __init__(self, names: tuple[Word, ...]) -> None:
        self.names: Final = names

    @property
    def text(self) -> str:
        """Its names, joined by dots."""
        return ".".join([name.text for name in self.names])

    @property
    def span(self) -> Span:
        return Span(self.names[0].start, self.names[-1].end)


class Quality(_Part):
    """A quality in a satisfices list, with the requirements it encloses in the classic form."""

    __slots__ = ("path", "requirements")
    __match_args__: ClassVar = ("path", "requirements")

    def __init__(self, path: QualityPath, requirements: tuple[Requirement, ...] = ()) -> None:
        self.path: Final = path
        self.requirements: Final = requirements


class Satisfices(_Part):
    """`satisfices Quality, …`: a concern, not yet measured."""

    __slots__ = ("end", "qualities", "start")
    __match_args__: ClassVar = ("start", "end", "qualities")

    def __init__(self, start: i64, end: i64, qualities: tuple[Quality, ...]) -> None:
        self.start: Final = start
        self.end: Final = end
        self.qualities: Final = qualities


class ReqRef(_Part):
    """A reference to a requirement: `rq1`, `slow(limit = 0.1 m/s)`."""

    __slots__ = ("arguments", "name")
    __match_args__: ClassVar = ("name", "arguments")

    def __init__(self, name: Word, arguments: tuple[Argument, ...] = ()) -> None:
        self.name: Final = name
        self.arguments: Final = arguments


class Satisfies(_Part):
    """`satisfies rq1, QualityReq rq2 …`: requirements attached to the node."""

    __slots__ = ("end", "start", "uses")
    __match_args__: ClassVar = ("start", "end", "uses")

    def __init__(self, start: i64, end: i64, uses: tuple[Requirement | ReqRef, ...]) -> None:
        self.start: Final = start
        self.end: Final = end
        self.uses: Final = uses


class Tags(_Part):
    """`tags heavy, indoor`."""

    __slots__ = ("end", "names", "start")
    __match_args__: ClassVar = ("start", "end", "names")

    def __init__(self, start: i64, end: i64, names: tuple[Word, ...]) -> None:
        self.start: Final = start
        self.end: Final = end
        self.names: Final = names


class Requirement(_Part):
    """A requirement, defined in place or, as an item, at file level.

    Attributes:
        name: its ID; None if it is missing.
        classic: written `QualityReq ID = … description = …`.
        text: its title, or the classic description.
    """

    __slots__ = ("classic", "clauses", "end", "name", "parameters", "quality", "start", "text")
    __match_args__: ClassVar = ("start", "end", "name", "classic", "parameters", "quality", "text", "clauses")

    def __init__(
        self,
        start: i64,
        end: i64,
        name: Word | None,
        classic: bool,
        parameters: tuple[Parameter, ...],
        quality: QualityPath | None,
        text: Word | None,
        clauses: tuple[Clause, ...],
    ) -> None:
        self.start: Final = start
        self.end: Final = end
        self.name: Final = name
        self.classic: Final = classic
        self.parameters: Final = parameters
        self.quality: Final = quality
        self.text: Final = text
        self.clauses: Final = clauses

    @property
    def is_reference(self) -> bool:
        """`QualityReq ID = "rq3"` alone names a requirement that is defined elsewhere."""
        return self.text is None and self.quality is None and not self.clauses and not self.parameters


NodeClause: TypeAlias = Satisfices | Satisfies | Tags

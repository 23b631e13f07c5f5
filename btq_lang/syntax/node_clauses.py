"""The clauses of nodes: satisfices, satisfies and tags, and what they list.  The clauses of requirements are in
`clauses`."""

from __future__ import annotations

from typing import TypeAlias

from btq_lang.syntax.clauses import METADATA, Argument, Clause, Parameter
from btq_lang.syntax.words import Word
from btq_lang.util.record import Part, Record
from btq_lang.util.text import Span


class QualityPath(Record):
    """`performance-efficiency.time-behaviour`, or in the paper's form: `performance <time-behavior>`."""

    names: tuple[Word, ...]

    @property
    def text(self) -> str:
        """Its names, joined by dots."""
        return ".".join([name.text for name in self.names])

    @property
    def span(self) -> Span:
        return Span(self.names[0].start, self.names[-1].end)


class SatisficedQuality(Record):
    """A quality in a satisfices list, with the requirements it encloses in the classic form."""

    path: QualityPath
    requirements: tuple[Requirement, ...] = ()


class Satisfices(Part):
    """`satisfices Quality, …`: a concern, not yet measured."""

    qualities: tuple[SatisficedQuality, ...]


class ReqRef(Record):
    """A reference to a requirement: `rq1`, `slow(limit = 0.1 m/s)`."""

    name: Word
    arguments: tuple[Argument, ...] = ()


class Satisfies(Part):
    """`satisfies rq1, QualityReq rq2 …`: requirements attached to the node."""

    uses: tuple[Requirement | ReqRef, ...]


class Tags(Part):
    """`tags heavy, indoor`."""

    names: tuple[Word, ...]


class Requirement(Part):
    """A requirement, defined in place or, as an item, at file level.

    Attributes:
        name: its ID; None if it is missing.
        classic: written `QualityReq ID = … description = …`.
        further: the qualities after the first one.
        text: its title, or the classic description.
    """

    name: Word | None
    classic: bool
    parameters: tuple[Parameter, ...]
    quality: QualityPath | None
    further: tuple[QualityPath, ...]
    text: Word | None
    clauses: tuple[Clause, ...]

    @property
    def qualities(self) -> tuple[QualityPath, ...]:
        """All its qualities."""
        return () if self.quality is None else (self.quality, *self.further)

    @property
    def is_text(self) -> bool:
        """Whether what it demands can only be in its text."""
        return all(type(clause) in METADATA for clause in self.clauses)

    @property
    def is_reference(self) -> bool:
        """`QualityReq ID = "rq3"` alone names a requirement that is defined elsewhere."""
        return self.text is None and self.quality is None and not self.clauses and not self.parameters


NodeClause: TypeAlias = Satisfices | Satisfies | Tags

"""Facts of the tree about single tokens, so that a line can be laid out without the tree.

One invariant: a mark is the offset of a token of the file.  Only the tree tells whether `/` divides or joins a path,
whether `-` subtracts, and which brackets hold attributes.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from btq_lang.parser import Parsed
from btq_lang.syntax import tree as syntax
from btq_lang.syntax.tokens import BLANK, CLOSE, NAME, NEWLINE, NUMBER, OPEN, QUANTITY, STRING
from btq_lang.util.record import Record, fields_of
from btq_lang.util.text import LINE_END, Span


class Clauses(Record):
    """The clauses of a requirement.

    Attributes:
        start: where the requirement begins.
        spans: where each clause begins and ends, in order.
        ranks: the positions, in the order of all blocks, of the clauses that begin at these offsets.
        claims: how many of them are claims.
    """

    start: int
    spans: tuple[Span, ...]
    ranks: Mapping[int, int]
    claims: int


class Marks:
    """Offsets of tokens that need special layout.

    Attributes:
        tight: no blank comes before them.
        attributes: the `(` of attributes, and of the requirements that a quality encloses.
        arguments: the `(` of parameters and of their values.
        elements: what has its own line in brackets over several lines.
        breaks: where an element that is too long is broken.
        atoms: start and end of units and types, which are kept verbatim though they are several tokens.
        clauses: those of every requirement that has any.
    """

    def __init__(self) -> None:
        self.tight: Final[set[int]] = set()
        self.attributes: Final[set[int]] = set()
        self.arguments: Final[set[int]] = set()
        self.elements: Final[set[int]] = set()
        self.breaks: Final[set[int]] = set()
        self.atoms: Final[dict[int, int]] = {}
        self.clauses: Final[list[Clauses]] = []


def marks_of(parsed: Parsed) -> Marks:
    """The marks of a file without syntax errors."""
    marker = _Marker(parsed)
    for entry in parsed.entries:
        parts: list[object] = [entry.item]
        while parts:
            part = parts.pop()
            if isinstance(part, tuple):
                parts += part
            elif not isinstance(part, syntax.Word | str | int | None):
                marker.mark(part, entry.start)
                parts += [getattr(part, field) for field in fields_of(part)]
    return marker.marks


class _Marker:
    """The words and signs of a file, and the marks set so far."""

    def __init__(self, parsed: Parsed) -> None:
        self.text: Final = parsed.text
        self.tokens: Final = [token for token in parsed.tokens if token.kind < BLANK]
        self.index: Final = {token.start: index for index, token in enumerate(self.tokens)}
        self.marks: Final = Marks()

    def mark(self, part: object, base: int) -> None:
        """Mark the tokens of a part of the tree whose offsets count from `base`."""
        marks = self.marks
        match part:
            case syntax.Pair():
                at = self.index[base + part.key.start]
                before = self.tokens[at - 1]
                if before.kind == NAME and before.text == "parameters":
                    at -= 1
                marks.elements.add(self.tokens[at].start)
            case syntax.Node():
                last = part.label or part.kind or part.category
                assert last is not None, "a node has a kind or a category"
                self.mark_bracket(marks.attributes, self.index[base + last.start] + 1)
            case syntax.Root() | syntax.Tree() | syntax.Model() | syntax.Include() | syntax.Meta() | syntax.Port():
                at = self.index[base + part.start]
                while self.tokens[at].kind not in (OPEN, NEWLINE):
                    at += 1
                self.mark_bracket(marks.attributes, at)
                if isinstance(part, syntax.Port):
                    self.mark_atom(part.type, base)
            case syntax.Satisfices() | syntax.Satisfies() | syntax.Tags():
                marks.elements.add(base + part.start)
            case syntax.Quality():
                self.mark_bracket(marks.attributes, self.path_end(part.path, base))
                marks.elements.update(base + requirement.start for requirement in part.requirements)
            case syntax.QualityPath():
                first = self.index[base + part.names[0].start]
                inside = self.tokens[first + 1 : self.path_end(part, base)]
                marks.tight.update(token.start for token in inside if token.text != "<")
            case syntax.Path():
                first, last_one = (self.index[base + name.start] for name in (part.names[0], part.names[-1]))
                marks.tight.update(token.start for token in self.tokens[first + 1 : last_one + 1])
            case syntax.Requirement():
                self.mark_requirement(part, base)
            case syntax.ReqRef():
                self.mark_arguments(part.name, base)
            case syntax.Argument():
                marks.elements.add(base + part.name.start)
            case syntax.Parameter():
                marks.elements.add(base + part.name.start)
                self.mark_atom(part.unit, base)
            case syntax.Signal():
                self.mark_atom(part.unit, base)
            case syntax.Call():
                self.mark_bracket(marks.tight, self.index[base + part.function.start] + 1)
            case syntax.Negative():
                self.mark_signed(self.index[base + part.start])
            case syntax.Amount(negative=True):
                self.mark_signed(self.index[base + part.word.start] - 1)

    def mark_bracket(self, marks: set[int], at: int) -> None:
        """Mark the token there if it is a `(`."""
        if self.tokens[at].kind == OPEN:
            marks.add(self.tokens[at].start)

    def mark_arguments(self, name: syntax.Word, base: int) -> None:
        """Mark the `(` after the name of a requirement: its parameters, or their values."""
        at = self.index[base + name.start] + 1
        self.mark_bracket(self.marks.arguments, at)
        self.mark_bracket(self.marks.tight, at)

    def mark_atom(self, word: syntax.Word | None, base: int) -> None:
        if word is not None:
            self.marks.atoms[base + word.start] = base + word.end

    def path_end(self, path: syntax.QualityPath, base: int) -> int:
        """The token after a quality's path."""
        last = self.index[base + path.names[-1].start]
        return last + 2 if self.tokens[last - 1].text == "<" else last + 1

    def mark_requirement(self, requirement: syntax.Requirement, base: int) -> None:
        """Mark its parameters, and where a long one is broken: before the classic description and before its
        clauses.
        """
        if requirement.name is not None and not requirement.classic:
            self.mark_arguments(requirement.name, base)
        if requirement.text is not None and requirement.classic:
            self.marks.breaks.add(self.tokens[self.index[base + requirement.text.start] - 2].start)
        self.marks.breaks.update(base + clause.start for clause in requirement.clauses)
        if requirement.clauses:
            spans = tuple(Span(clause.start, clause.end).shifted(base) for clause in requirement.clauses)
            ranks = {base + clause.start: _ORDER.index(type(clause)) for clause in requirement.clauses}
            claims = sum(isinstance(clause, syntax.Claim) for clause in requirement.clauses)
            self.marks.clauses.append(Clauses(base + requirement.start, spans, ranks, claims))

    def mark_signed(self, at: int) -> None:
        """Mark the number after a `-` that is not part of it.

        If the lexer reads a `-` as a token of its own because of the word before it, no blank is needed; elsewhere only
        a blank separates it (docs/language.md, NUMBER).
        """
        before = self.tokens[at - 1]
        if before.kind in _OPERANDS and not LINE_END.search(self.text, before.end, self.tokens[at].start):
            self.marks.tight.add(self.tokens[at + 1].start)


# The order of clauses in a block: what is demanded, where and how often, what follows, why, and how it is verified.
_ORDER: Final = (
    syntax.Claim,
    syntax.Scope,
    syntax.Odds,
    syntax.Confidence,
    syntax.Window,
    syntax.OnViolation,
    syntax.Goal,
    syntax.Because,
    syntax.How,
)
_OPERANDS: Final = (NAME, NUMBER, QUANTITY, STRING, CLOSE)

"""Facts of the tree about single tokens, so that a line can be laid out without the tree.

One invariant: a mark is the offset of a token of the file.  Only the tree tells whether `/` divides or joins a path,
whether `-` subtracts, and which brackets hold attributes.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from btq_lang.parser import Parsed
from btq_lang.syntax import tree as syntax
from btq_lang.syntax.scenarios import When
from btq_lang.syntax.tokens import BLANK, CLOSE, NAME, NEWLINE, NUMBER, OPEN, QUANTITY, STRING
from btq_lang.util.record import Record
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
    """Offsets of tokens that need special layout, in a file without syntax errors.

    Attributes:
        tight: no blank comes before them.
        attributes: the `(` of attributes, and of the requirements that a quality encloses.
        arguments: the `(` of parameters and of their values.
        elements: what has its own line in brackets over several lines.
        breaks: where an element that is too long is broken.
        atoms: start and end of units and types, which are kept verbatim though they are several tokens.
        clauses: those of every requirement that has any.
    """

    def __init__(self, parsed: Parsed) -> None:
        self.tight: Final[set[int]] = set()
        self.attributes: Final[set[int]] = set()
        self.arguments: Final[set[int]] = set()
        self.elements: Final[set[int]] = set()
        self.breaks: Final[set[int]] = set()
        self.atoms: Final[dict[int, int]] = {}
        self.clauses: Final[list[Clauses]] = []
        self._text: Final = parsed.text
        self._tokens: Final = [token for token in parsed.tokens if token.kind < BLANK]
        self._index: Final = {token.start: index for index, token in enumerate(self._tokens)}
        for entry in parsed.entries:
            for part in syntax.walk(entry.item):
                if not isinstance(part, syntax.Word):
                    self._mark(part, entry.start)

    def _mark(self, part: object, base: int) -> None:
        """Mark the tokens of a part of the tree whose offsets count from `base`."""
        match part:
            case syntax.Pair():
                index = self._index[base + part.key.start]
                before = self._tokens[index - 1]
                if before.kind == NAME and before.text == "parameters":
                    index -= 1
                self.elements.add(self._tokens[index].start)
            case syntax.Node():
                last = part.label or part.kind or part.category
                assert last is not None, "a node has a kind or a category"
                self._mark_bracket(self.attributes, self._index[base + last.start] + 1)
            case syntax.Root() | syntax.Tree() | syntax.Model() | syntax.Include() | syntax.Meta() | syntax.Port():
                index = self._index[base + part.start]
                while self._tokens[index].kind not in (OPEN, NEWLINE):
                    index += 1
                self._mark_bracket(self.attributes, index)
                if isinstance(part, syntax.Port):
                    self._mark_atom(part.type, base)
            case syntax.Satisfices() | syntax.Satisfies() | syntax.Tags():
                self.elements.add(base + part.start)
            case syntax.SatisficedQuality():
                self._mark_bracket(self.attributes, self._path_end(part.path, base))
                self.elements.update(base + requirement.start for requirement in part.requirements)
            case syntax.QualityPath():
                first = self._index[base + part.names[0].start]
                inside = self._tokens[first + 1 : self._path_end(part, base)]
                self.tight.update(token.start for token in inside if token.text != "<")
            case syntax.Path():
                first, last_one = (self._index[base + name.start] for name in (part.names[0], part.names[-1]))
                self.tight.update(token.start for token in self._tokens[first + 1 : last_one + 1])
            case syntax.Requirement():
                self._mark_requirement(part, base)
            case syntax.ReqRef():
                self._mark_arguments(part.name, base)
            case syntax.Argument():
                self.elements.add(base + part.name.start)
            case syntax.Parameter():
                self.elements.add(base + part.name.start)
                self._mark_atom(part.unit, base)
            case When() if part.trigger is not None:
                index = self._index[base + part.start]
                while self._tokens[index].start < base + part.trigger.end:
                    index += 1
                self.tight.add(self._tokens[index].start)
            case syntax.Signal():
                self._mark_atom(part.unit, base)
            case syntax.Call():
                self._mark_bracket(self.tight, self._index[base + part.function.start] + 1)
            case syntax.Negative():
                self._mark_signed(self._index[base + part.start])
            case syntax.Amount(negative=True):
                self._mark_signed(self._index[base + part.word.start] - 1)

    def _mark_bracket(self, marks: set[int], index: int) -> None:
        """Mark the token there if it is a `(`."""
        if self._tokens[index].kind == OPEN:
            marks.add(self._tokens[index].start)

    def _mark_arguments(self, name: syntax.Word, base: int) -> None:
        """Mark the `(` after the name of a requirement: its parameters, or their values."""
        index = self._index[base + name.start] + 1
        self._mark_bracket(self.arguments, index)
        self._mark_bracket(self.tight, index)

    def _mark_atom(self, word: syntax.Word | None, base: int) -> None:
        if word is not None:
            self.atoms[base + word.start] = base + word.end

    def _path_end(self, path: syntax.QualityPath, base: int) -> int:
        """The token after a quality's path."""
        last = self._index[base + path.names[-1].start]
        return last + 2 if self._tokens[last - 1].text == "<" else last + 1

    def _mark_requirement(self, requirement: syntax.Requirement, base: int) -> None:
        """Mark its parameters, and where a long one is broken: before the classic description and before its
        clauses.
        """
        if requirement.name is not None and not requirement.classic:
            self._mark_arguments(requirement.name, base)
        if requirement.text is not None and requirement.classic:
            self.breaks.add(self._tokens[self._index[base + requirement.text.start] - 2].start)
        self.breaks.update(base + clause.start for clause in requirement.clauses)
        if requirement.clauses:
            spans = tuple(Span(clause.start, clause.end).shifted(base) for clause in requirement.clauses)
            ranks = {base + clause.start: _ORDER.index(type(clause)) for clause in requirement.clauses}
            claims = sum(isinstance(clause, syntax.Claim) for clause in requirement.clauses)
            self.clauses.append(Clauses(base + requirement.start, spans, ranks, claims))

    def _mark_signed(self, index: int) -> None:
        """Mark the number after a `-` that is not part of it.

        If the lexer reads a `-` as a token of its own because of the word before it, no blank is needed; elsewhere only
        a blank separates it (docs/language.md, NUMBER).
        """
        before = self._tokens[index - 1]
        if before.kind in _OPERANDS and not LINE_END.search(self._text, before.end, self._tokens[index].start):
            self.tight.add(self._tokens[index + 1].start)


# The order of clauses in a block: what is demanded, where and how often, what follows, why, how it is verified, where
# it is from, what it belongs to, and who approved it.
_ORDER: Final = (
    syntax.Claim,
    syntax.ScopeClause,
    syntax.FromUntil,
    syntax.Assuming,
    syntax.Average,
    syntax.Odds,
    syntax.Confidence,
    syntax.Window,
    syntax.OnViolation,
    syntax.Goal,
    syntax.Because,
    syntax.How,
    syntax.Source,
    syntax.Refines,
    syntax.Mitigates,
    syntax.Priority,
    syntax.Approval,
)
_OPERANDS: Final = (NAME, NUMBER, QUANTITY, STRING, CLOSE)

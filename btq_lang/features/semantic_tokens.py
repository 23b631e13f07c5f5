"""Semantic tokens: what each word is, for colouring, in the five integers a token of LSP 3.16.

One invariant: tokens are in the order of the text, none overlaps another, none goes over a line end.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise
from operator import itemgetter

from btq_lang.catalog.nodes import lookup
from btq_lang.claims import HAPPENINGS, VERBS
from btq_lang.clauses import ACTIONS as ON_VIOLATION
from btq_lang.clauses import EXPERIMENTS, METHODS
from btq_lang.conditions import FUNCTIONS, HEADS
from btq_lang.features.legend import MODIFIERS, TYPES
from btq_lang.features.meaning import edition, match_of
from btq_lang.file import File
from btq_lang.mentions import Mention, What
from btq_lang.parser import Parsed
from btq_lang.record import Record
from btq_lang.symbols import Kind
from btq_lang.syntax import Entry, Requirement
from btq_lang.text import LINE_END, Encoding, Span
from btq_lang.token_list import pieces
from btq_lang.tokens import (
    BRACED,
    CATEGORIES,
    COMMENT,
    DIRECTIONS,
    NAME,
    NODE_CLAUSES,
    NUMBER,
    OPERATOR,
    QUANTITY,
    STRING,
    SYMBOL,
)
from btq_lang.workspace import Workspace


class SemanticToken(Record):
    """A coloured stretch.  type: one of TYPES; modifiers: some of MODIFIERS."""

    span: Span
    type: str
    modifiers: tuple[str, ...] = ()


def semantic_tokens(workspace: Workspace, path: str, within: Span | None = None) -> tuple[SemanticToken, ...]:
    """The tokens of a file, or those that touch a stretch of it."""
    file = workspace.files[path]
    known = Known(workspace, path)
    found: list[SemanticToken] = []
    for stretch in stretches(file.parsed, len(file.text)):
        if within is None or (stretch.start <= within.end and stretch.end >= within.start):
            by = stretch.start
            found += [
                SemanticToken(one.span.shifted(by), one.type, one.modifiers)
                for one in tokens_of_stretch(file, stretch, known)
            ]
    if within is not None:
        found = [one for one in found if one.span.end >= within.start and one.span.start <= within.end]
    return tuple(found)


class Known:
    """What is asked of the rest of the workspace to colour a file.

    Attributes:
        world: all that there is to know.
        asked: the names that were asked for.
    """

    def __init__(self, workspace: Workspace, path: str) -> None:
        scope = workspace.scope(path)
        self.world = (edition(workspace, path), scope.names(Kind.TREE), scope.names(Kind.QUALITY))
        self.asked: set[str] = set()
        self._edition = self.world[0]
        self._trees, self._qualities = map(frozenset, self.world[1:])

    def is_tree(self, name: str) -> bool:
        self.asked.add(name)
        return name in self._trees

    def is_standard(self, name: str) -> bool:
        """Whether a quality is one of the standard, and not one's own."""
        self.asked.add(name)
        return name not in self._qualities and match_of(name, self._edition).quality is not None

    def answers(self, names: frozenset[str]) -> tuple[str, frozenset[str], frozenset[str]]:
        """What changes when an answer about one of these names does."""
        return self._edition, names & self._trees, names & self._qualities


class Stretch(Record):
    """A part of a file that can be cut into tokens by itself: an item, seldom more, and what stands behind it."""

    start: int
    end: int
    entries: tuple[Entry, ...]


def stretches(parsed: Parsed, size: int) -> Iterator[Stretch]:
    """The stretches of a file, joined they are the file; what stands before the first item has none."""
    entries = parsed.entries
    begins = [index for index, start in enumerate(parsed.starts) if start is not None or index == 0]
    if not entries or entries[0].start:
        yield Stretch(0, entries[0].start if entries else size, ())
    for begin, end in pairwise((*begins, len(entries))):
        yield Stretch(entries[begin].start, entries[end].start if end < len(entries) else size, entries[begin:end])


def tokens_of_stretch(file: File, stretch: Stretch, known: Known) -> list[SemanticToken]:
    """The tokens of a stretch, counted from its start."""
    text = file.text[stretch.start : stretch.end]
    named: list[tuple[Span, Mention]] = []
    for entry in stretch.entries:
        by = entry.start - stretch.start
        named += [(mention.span.shifted(by), mention) for mention in file.mentions_of(entry)]
    named.sort(key=itemgetter(0))
    found: list[SemanticToken] = []
    index = 0
    before = ""
    for kind, start, raw in pieces(text):
        end = start + len(raw)
        while index < len(named) and named[index][0].end <= start:
            index += 1
        inside: list[tuple[Span, Mention]] = []
        while index < len(named) and named[index][0].end <= end:
            place, mention = named[index]
            inside.append((place if place.start >= start else Span(start, place.end), mention))
            index += 1
        if index < len(named) and named[index][0].start < end and kind in (NAME, STRING):
            # A path of a quality or a compound unit: several tokens, one name.
            inside.append((Span(start, end), named[index][1]))
        if inside or kind in _COLOURED:
            for one in _of_token(known, kind, Span(start, end), raw, inside, before):
                found += _lines(one, text) if kind in _OVER_LINES else (one,)
        if kind in _WORDS:
            before = raw
    return found


def encode(tokens: Iterable[SemanticToken], text: str, encoding: Encoding) -> list[int]:
    """Five integers a token: lines and columns from the token before, length, type, modifiers as bits."""
    starts = [0, *(end.end() for end in LINE_END.finditer(text))]
    plain = encoding == "code-points" or text.isascii()
    data: list[int] = []
    line = last_line = last_column = 0
    for token in tokens:
        start, end = token.span
        while line + 1 < len(starts) and starts[line + 1] <= start:
            line += 1
        column, length = start - starts[line], end - start
        if not plain:
            column = _width(text[starts[line] : start], encoding)
            length = _width(text[start:end], encoding)
        same = line == last_line
        bits = 0
        for modifier in token.modifiers:
            bits |= _BITS[modifier]
        data += (line - last_line, column - last_column if same else column, length, _NUMBERS[token.type], bits)
        last_line, last_column = line, column
    return data


def _width(text: str, encoding: Encoding) -> int:
    if encoding == "utf-8":
        return len(text.encode("utf-8", "surrogatepass"))
    return len(text) + sum(character > "\uffff" for character in text)


def _of_token(
    known: Known, kind: int, span: Span, raw: str, inside: list[tuple[Span, Mention]], before: str
) -> list[SemanticToken]:
    if inside and kind in (NAME, STRING, SYMBOL) and inside[0][0] == span:
        named = _of_mention(known, inside[0][1])
        return [SemanticToken(span, *named)] if named else []
    plain = _PLAIN.get(kind)
    if kind == NAME and raw in KEYWORDS and before != "=":
        plain = "keyword"
    elif kind == NAME and before == ":":
        plain = "type"
    elif kind == NAME and before == "=":
        plain = "string"
    found: list[SemanticToken] = []
    at = span.start
    for place, mention in inside:  # keys in braces and scripts
        named = _of_mention(known, mention)
        if named is None or not at <= place.start:
            continue
        if plain is not None and at < place.start:
            found.append(SemanticToken(Span(at, place.start), plain))
        found.append(SemanticToken(place, *named))
        at = place.end
    if plain is not None and at < span.end:
        found.append(SemanticToken(Span(at, span.end), plain))
    return found


def _of_mention(known: Known, mention: Mention) -> tuple[str, tuple[str, ...]] | None:
    what = mention.what
    modifiers: tuple[str, ...] = ("definition",) if mention.defines else ()
    if what is What.NODE:
        if mention.word.kind == SYMBOL:
            return "operator", ("defaultLibrary",)
        builtin = None if mention.defines else lookup(mention.name, mention.word.quoted)
        if builtin is None:
            return "function", modifiers
        return "function" if builtin.category in ("Action", "Condition") else "type", ("defaultLibrary",)
    if what is What.QUALITY:
        is_standard = not mention.defines and known.is_standard(mention.name)
        return "enumMember", ("defaultLibrary",) if is_standard else modifiers
    if what is What.VALUE:
        owner = mention.owner
        if isinstance(owner, Requirement) and any(one.name.text == mention.name for one in owner.parameters):
            return "parameter", ()
        return "variable", ("readonly",)
    if what is What.PLACE:
        return ("class" if known.is_tree(mention.name) else "function"), ()
    if what is What.KEY and mention.writes:
        return "variable", ("modification",)
    type_ = _TYPES.get(what)
    return (type_, modifiers) if type_ is not None else None


def _lines(token: SemanticToken, text: str) -> Iterable[SemanticToken]:
    """A token cut at line ends."""
    piece = text[token.span.start : token.span.end]
    if "\n" not in piece and "\r" not in piece:
        return (token,)
    pieces = []
    at = 0
    for end in (*LINE_END.finditer(piece), None):
        stop = end.start() if end else len(piece)
        if stop > at:
            pieces.append(SemanticToken(Span(at, stop).shifted(token.span.start), token.type, token.modifiers))
        at = end.end() if end else stop
    return pieces


_WORDS = frozenset((NAME, OPERATOR, STRING, NUMBER, QUANTITY, SYMBOL, BRACED))
_NUMBERS = {type_: number for number, type_ in enumerate(TYPES)}
_BITS = {modifier: 1 << number for number, modifier in enumerate(MODIFIERS)}
_OVER_LINES = frozenset((COMMENT, STRING, BRACED, QUANTITY))  # what may go over a line end, or have one in it
_PLAIN = {
    COMMENT: "comment",
    STRING: "string",
    NUMBER: "number",
    QUANTITY: "number",
    SYMBOL: "operator",
    BRACED: "variable",
}
_COLOURED = frozenset((NAME, *_PLAIN))  # where no word names anything
_TYPES = {
    What.TREE: "class",
    What.REQUIREMENT: "interface",
    What.SIGNAL: "variable",
    What.CONTEXT: "variable",
    What.PARAMETER: "parameter",
    What.PORT: "property",
    What.ATTRIBUTE: "property",
    What.KEY: "variable",
    What.INSTANCE: "label",
    What.TAG: "decorator",
    What.INCLUDE: "string",
    What.QUANTITY: "number",
    What.UNIT: "type",
    What.EDITION: "enumMember",
}
# Every word that the grammar knows by its place; a name that looks like one is a mention and comes before.
KEYWORDS = frozenset(
    {"BehaviorTree", "Root", "include", "signal", "context", "apply", "quality", "qualities", "QualityReq"}
    | {"TreeNodesModel", "xml", "parameters", "metadata", "Quality", "ID", "description", "true", "false"}
    | {"and", "or", "not", "if", "else", "node", "at", "to", "except", "of", "per", "under", "tagged", "within"}
    | {"most", "least", "less", "more", "than", "between", "after", "violation", "probability", "last", "by", "fresh"}
    | {"from", "level", "counter", "gauge", "initially", *ON_VIOLATION, *METHODS}
    | CATEGORIES
    | NODE_CLAUSES
    | DIRECTIONS
    | HEADS
    | VERBS
    | HAPPENINGS
    | EXPERIMENTS
    | FUNCTIONS
)

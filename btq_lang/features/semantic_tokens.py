"""Semantic tokens: what each word is, for colouring, in the five integers a token of LSP 3.16.

One invariant: tokens are in the order of the text, none overlaps another, none goes over a line end.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Iterable
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING

from btq_lang.catalog.nodes import lookup
from btq_lang.claims import HAPPENINGS, VERBS
from btq_lang.clauses import ACTIONS as ON_VIOLATION
from btq_lang.clauses import EXPERIMENTS, METHODS
from btq_lang.conditions import FUNCTIONS, HEADS
from btq_lang.features.legend import MODIFIERS, TYPES
from btq_lang.features.meaning import edition, match_of
from btq_lang.mentions import Listener, What, tell
from btq_lang.name_kinds import Kind
from btq_lang.parser import Parsed
from btq_lang.record import Record
from btq_lang.syntax import Entry, Requirement
from btq_lang.text import LINE_END, Span
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

if TYPE_CHECKING:
    from typing import NamedTuple, TypeAlias

    from btq_lang.mentions import Mention, Owner
    from btq_lang.syntax import Node, Pair, Word
    from btq_lang.text import Encoding
    from btq_lang.workspace import Workspace

    class _Token(NamedTuple):
        start: int
        end: int
        number: int
        bits: int
else:
    _Token = namedtuple("_Token", ("start", "end", "number", "bits"))

Look: TypeAlias = tuple[int, int]  # the number of its type, and bits for its modifiers
Token: TypeAlias = tuple[int, int, int, int]  # where a token starts and ends, and its look
Place: TypeAlias = tuple[int, int, int, Look]  # where a name starts and ends, the how manyth it is, and its look


class SemanticToken(_Token):
    """A coloured stretch: where it starts and ends, the number of its type in TYPES, and a bit for each modifier."""

    __slots__ = ()

    @property
    def span(self) -> Span:
        return Span(self.start, self.end)

    @property
    def type(self) -> str:
        return TYPES[self.number]

    @property
    def modifiers(self) -> tuple[str, ...]:
        return tuple([modifier for bit, modifier in enumerate(MODIFIERS) if self.bits & 1 << bit])


def semantic_tokens(workspace: Workspace, path: str, within: Span | None = None) -> tuple[SemanticToken, ...]:
    """The tokens of a file, or those that touch a stretch of it."""
    file = workspace.files[path]
    entries = file.parsed.entries
    known = Known(workspace, path)
    found: list[SemanticToken] = []
    for begin, end in groups(file.parsed):
        if within is not None:
            if end and entries[begin].start > within.end:
                break
            if end < len(entries) and entries[end].start < within.start:
                continue
        stretch = stretch_of(file.parsed, len(file.text), begin, end)
        by = stretch.start
        tokens = tokens_of_stretch(file.text[by : stretch.end], stretch, known)
        found += [SemanticToken(start + by, end + by, number, bits) for start, end, number, bits in tokens]
    if within is not None:
        found = [one for one in found if one.end >= within.start and one.start <= within.end]
    return tuple(found)


def encoded_within(workspace: Workspace, path: str, within: Span, encoding: Encoding) -> list[int]:
    """The tokens that touch a stretch, as `encode` has them; what stands before them is not looked at."""
    tokens = semantic_tokens(workspace, path, within)
    if not tokens:
        return []
    file = workspace.files[path]
    line, column = file.lines.position(tokens[0].start)
    by = tokens[0].start - column
    moved = [(start - by, end - by, number, bits) for start, end, number, bits in tokens]
    data = encode(moved, file.text[by : tokens[-1].end], encoding)
    data[0] += line
    return data


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


def groups(parsed: Parsed) -> list[tuple[int, int]]:
    """The entries of each stretch of a file: the first one, and the one behind the last.  Joined, the stretches are the
    file; what stands before the first item has none."""
    entries = parsed.entries
    begins = [index for index, start in enumerate(parsed.starts) if start is not None or index == 0]
    found = [*pairwise((*begins, len(entries)))]
    return found if entries and not entries[0].start else [(0, 0), *found]


def stretch_of(parsed: Parsed, size: int, begin: int, end: int) -> Stretch:
    """The stretch of these entries."""
    entries = parsed.entries
    start = entries[begin].start if end else 0
    return Stretch(start, entries[end].start if end < len(entries) else size, entries[begin:end])


def tokens_of_stretch(text: str, stretch: Stretch, known: Known) -> list[Token]:
    """The tokens of a stretch with this text, counted from its start."""
    named = _names(stretch, known)
    index = 0
    place, place_end, _, look = named[0]
    found: list[Token] = []
    before = ""
    for kind, start, raw in pieces(text):
        end = start + len(raw)
        if place == start and place_end == end and kind in _NAMING:
            tokens = [(start, end, *look)]
            index += 1
            place, place_end, _, look = named[index]
        elif place < end:
            while named[index][1] <= start:
                index += 1
            inside: list[Place] = []
            while named[index][1] <= end:
                inside.append(named[index])
                index += 1
            place, place_end, _, look = named[index]
            if place < end and kind in (NAME, STRING):
                inside.append((start, end, 0, look))  # a path of a quality or a compound unit: several tokens, one name
            tokens = _of_token(kind, start, end, _plain(kind, raw, before), inside)
        else:
            plain = _plain(kind, raw, before)
            tokens = [(start, end, *plain)] if plain is not None else []
        found += _by_line(tokens, text) if kind in _OVER_LINES and _has_line_end(raw) else tokens
        if kind <= OPERATOR:
            before = raw
    return found


def _names(stretch: Stretch, known: Known) -> list[Place]:
    """The words of a stretch that name something, in the order of the text, and an end of them."""
    names = _Names(known)
    for entry in stretch.entries:
        names.by = entry.start - stretch.start
        tell(entry.item, names)
    names.found.sort()
    end = stretch.end - stretch.start + 1
    return [*names.found, (end, end, 0, _KEYWORD)]


class _Names(Listener):
    """How the words look that name something.

    Attributes:
        by: where the item begins whose words are told.
    """

    def __init__(self, known: Known) -> None:
        self.by = 0
        self.found: list[Place] = []
        self._known = known

    def word(
        self,
        what: What,
        word: Word | None,
        defines: bool = False,
        node: Node | None = None,
        owner: Owner = None,
        pair: Pair | None = None,
    ) -> None:
        if word is not None and word.raw:
            look = (_DEFINED if defines else _USED).get(what)
            if look is None:
                look = self._look(what, word, word.text, defines, owner)
            start = word.start + self.by
            self.found.append((start, start + len(word.raw), len(self.found), look))

    def part(self, mention: Mention) -> None:
        start, end = mention.span
        if start < end:
            look = _WRITTEN if mention.writes else (_DEFINED if mention.defines else _USED).get(mention.what)
            if look is None:
                look = self._look(mention.what, mention.word, mention.name, mention.defines, mention.owner)
            self.found.append((start + self.by, end + self.by, len(self.found), look))

    def _look(self, what: What, word: Word, name: str, defines: bool, owner: Owner) -> Look:
        """Of what can be several things."""
        if what is What.NODE:
            return _OWN_NODES[1] if defines and word.kind != SYMBOL else _look_of_node(name, word.kind)
        if what is What.QUALITY:
            return _STANDARD if not defines and self._known.is_standard(name) else _OWN_QUALITIES[defines]
        if what is What.VALUE:
            is_own = isinstance(owner, Requirement) and any(one.name.text == name for one in owner.parameters)
            return _USED[What.PARAMETER] if is_own else _VALUE
        assert what is What.PLACE, "rules stand in no item, and of all others it is known how they look"
        return _USED[What.TREE] if self._known.is_tree(name) else _OWN_NODES[0]


@lru_cache(2_000)  # most kinds stand in a file many times
def _look_of_node(name: str, kind: int) -> Look:
    if kind == SYMBOL:
        return _SIGN
    builtin = lookup(name, kind == STRING)
    if builtin is None:
        return _OWN_NODES[0]
    return _ACTION if builtin.category in ("Action", "Condition") else _BUILTIN


def encode(tokens: Iterable[Token], text: str, encoding: Encoding) -> list[int]:
    """Five integers a token: lines and columns from the token before, length, type, modifiers as bits."""
    ends = [end.end() for end in LINE_END.finditer(text)]
    ends.append(len(text) + 1)
    plain = encoding == "code-points" or text.isascii()
    data: list[int] = []
    begin = line = last_line = last_column = 0
    next_line = ends[0]
    for start, end, number, bits in tokens:
        while next_line <= start:
            begin = next_line
            line += 1
            next_line = ends[line]
        column, length = start - begin, end - start
        if not plain:
            column = _width(text[begin:start], encoding)
            length = _width(text[start:end], encoding)
        if line == last_line:
            data += (0, column - last_column, length, number, bits)
        else:
            data += (line - last_line, column, length, number, bits)
            last_line = line
        last_column = column
    return data


def _width(text: str, encoding: Encoding) -> int:
    if encoding == "utf-8":
        return len(text.encode("utf-8", "surrogatepass"))
    return len(text) + sum(character > "\uffff" for character in text)


def _plain(kind: int, raw: str, before: str) -> Look | None:
    """How a token looks that names nothing; None: it has no colour."""
    if kind != NAME:
        return _PLAIN.get(kind)
    if before == "=":
        return _TEXT
    if raw in KEYWORDS:
        return _KEYWORD
    return _TYPE if before == ":" else None


def _of_token(kind: int, start: int, end: int, plain: Look | None, inside: list[Place]) -> list[Token]:
    """The tokens of a piece with names in it: all of it, or keys in braces and scripts."""
    if inside and kind in _NAMING and inside[0][0] <= start and inside[0][1] == end:
        return [(start, end, *inside[0][3])]
    found: list[Token] = []
    at = start
    for place, place_end, _, look in inside:
        begin = max(place, start)
        if begin < at:
            continue
        if plain is not None and at < begin:
            found.append((at, begin, *plain))
        found.append((begin, place_end, *look))
        at = place_end
    if plain is not None and at < end:
        found.append((at, end, *plain))
    return found


def _by_line(tokens: list[Token], text: str) -> list[Token]:
    """Tokens cut at line ends."""
    found: list[Token] = []
    for start, end, number, bits in tokens:
        for line in LINE_END.finditer(text, start, end):
            if line.start() > start:
                found.append((start, line.start(), number, bits))
            start = line.end()
        if start < end:
            found.append((start, end, number, bits))
    return found


def _has_line_end(raw: str) -> bool:
    return "\n" in raw or "\r" in raw


def _look(type_: str, modifier: str | None = None) -> Look:
    return TYPES.index(type_), 1 << MODIFIERS.index(modifier) if modifier is not None else 0


_NAMING = (NAME, STRING, SYMBOL)  # what may be a name as it stands
_OVER_LINES = frozenset((COMMENT, STRING, BRACED, QUANTITY))  # what may go over a line end, or have one in it
_KEYWORD, _TEXT, _TYPE = _look("keyword"), _look("string"), _look("type")
_PLAIN = {
    COMMENT: _look("comment"),
    STRING: _TEXT,
    NUMBER: _look("number"),
    QUANTITY: _look("number"),
    SYMBOL: _look("operator"),
    BRACED: _look("variable"),
}
_SIGN = _look("operator", "defaultLibrary")
_ACTION, _BUILTIN = _look("function", "defaultLibrary"), _look("type", "defaultLibrary")
_OWN_NODES = _look("function"), _look("function", "definition")
_STANDARD = _look("enumMember", "defaultLibrary")
_OWN_QUALITIES = _look("enumMember"), _look("enumMember", "definition")
_VALUE = _look("variable", "readonly")
_WRITTEN = _look("variable", "modification")
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
_USED = {what: _look(type_) for what, type_ in _TYPES.items()}
_DEFINED = {what: _look(type_, "definition") for what, type_ in _TYPES.items()}
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

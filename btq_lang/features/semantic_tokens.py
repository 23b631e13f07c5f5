"""Semantic tokens: what each word is, for colouring, in the five integers a token of LSP 3.16.

One invariant: tokens are in the order of the text, none overlaps another, none goes over a line end.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from btq_lang.catalog.nodes import lookup
from btq_lang.clauses import ACTIONS as ON_VIOLATION
from btq_lang.clauses import EXPERIMENTS, HAPPENINGS, METHODS, VERBS
from btq_lang.conditions import FUNCTIONS, HEADS
from btq_lang.features.legend import MODIFIERS, TYPES
from btq_lang.features.meaning import quality_match
from btq_lang.mentions import Mention, What
from btq_lang.record import record
from btq_lang.symbols import Kind
from btq_lang.syntax import Requirement
from btq_lang.text import LINE_END, Encoding, Span
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
    Token,
)
from btq_lang.workspace import Workspace


@record
class SemanticToken:
    """A coloured stretch.  type: one of TYPES; modifiers: some of MODIFIERS."""

    span: Span
    type: str
    modifiers: tuple[str, ...] = ()


def semantic_tokens(workspace: Workspace, path: str, within: Span | None = None) -> tuple[SemanticToken, ...]:
    """The tokens of a file, or those that touch a stretch of it."""
    file = workspace.files[path]
    named: list[tuple[Span, Mention]] = []
    for entry in file.parsed.entries:
        if within is None or (entry.start <= within.end and entry.start + _end(entry.item) >= within.start):
            named += [(mention.span.shifted(entry.start), mention) for mention in file.mentions_of(entry)]
    named.sort(key=lambda one: one[0])
    found: list[SemanticToken] = []
    index = 0
    before = ""
    for token in file.parsed.tokens:
        if within is not None and (token.end < within.start or token.start > within.end):
            before = token.text if token.kind in _WORDS else before
            continue
        while index < len(named) and named[index][0].end <= token.start:
            index += 1
        inside: list[tuple[Span, Mention]] = []
        while index < len(named) and named[index][0].end <= token.end:
            place, mention = named[index]
            inside.append((Span(max(place.start, token.start), place.end), mention))
            index += 1
        if index < len(named) and named[index][0].start < token.end and token.kind in (NAME, STRING):
            # A path of a quality or a compound unit: several tokens, one name.
            inside.append((Span(token.start, token.end), named[index][1]))
        found += _of_token(workspace, path, token, inside, before)
        if token.kind in _WORDS:
            before = token.text
    return tuple(piece for token in found for piece in _lines(token, file.text))


def _end(item: object) -> int:
    end = getattr(item, "end", 0)
    block = max((child.block_end for child in getattr(item, "children", ()) if hasattr(child, "block_end")), default=0)
    return max(end if isinstance(end, int) else 0, block)


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


def delta(before: Sequence[int], after: Sequence[int]) -> tuple[int, int, list[int]] | None:
    """What to replace in `before` to have `after`: from where, how many integers, and by what; None: nothing."""
    if list(before) == list(after):
        return None
    start = 0
    shorter = min(len(before), len(after))
    while start < shorter and before[start] == after[start]:
        start += 1
    start -= start % 5
    end = 0
    while end < shorter - start and before[-1 - end] == after[-1 - end]:
        end += 1
    end -= end % 5
    return start, len(before) - end - start, list(after[start : len(after) - end])


def _width(text: str, encoding: Encoding) -> int:
    if encoding == "utf-8":
        return len(text.encode("utf-8", "surrogatepass"))
    return len(text) + sum(character > "\uffff" for character in text)


def _of_token(
    workspace: Workspace, path: str, token: Token, inside: list[tuple[Span, Mention]], before: str
) -> list[SemanticToken]:
    span = Span(token.start, token.end)
    if inside and token.kind in (NAME, STRING, SYMBOL) and inside[0][0] == span:
        named = _of_mention(workspace, path, inside[0][1])
        return [SemanticToken(span, *named)] if named else []
    plain = _PLAIN.get(token.kind)
    if token.kind == NAME and token.text in KEYWORDS and before != "=":
        plain = "keyword"
    elif token.kind == NAME and before == ":":
        plain = "type"
    elif token.kind == NAME and before == "=":
        plain = "string"
    found: list[SemanticToken] = []
    at = span.start
    for place, mention in inside:  # keys in braces and scripts
        named = _of_mention(workspace, path, mention)
        if named is None or not at <= place.start:
            continue
        if plain is not None and at < place.start:
            found.append(SemanticToken(Span(at, place.start), plain))
        found.append(SemanticToken(place, *named))
        at = place.end
    if plain is not None and at < span.end:
        found.append(SemanticToken(Span(at, span.end), plain))
    return found


def _of_mention(workspace: Workspace, path: str, mention: Mention) -> tuple[str, tuple[str, ...]] | None:
    what = mention.what
    modifiers: tuple[str, ...] = ("definition",) if mention.defines else ()
    if what is What.NODE:
        if mention.word.kind == SYMBOL:
            return "operator", ("defaultLibrary",)
        is_builtin = not mention.defines and lookup(mention.name, mention.word.quoted) is not None
        return ("type", ("defaultLibrary",)) if is_builtin else ("function", modifiers)
    if what is What.QUALITY:
        known = workspace.scope(path).find(Kind.QUALITY, mention.name) is None
        is_standard = known and not mention.defines and quality_match(workspace, path, mention.name).quality is not None
        return "enumMember", ("defaultLibrary",) if is_standard else modifiers
    if what is What.VALUE:
        owner = mention.owner
        if isinstance(owner, Requirement) and any(one.name.text == mention.name for one in owner.parameters):
            return "parameter", ()
        return "variable", ("readonly",)
    if what is What.PLACE:
        is_tree = workspace.scope(path).find(Kind.TREE, mention.name) is not None
        return ("class" if is_tree else "function"), ()
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
_PLAIN = {
    COMMENT: "comment",
    STRING: "string",
    NUMBER: "number",
    QUANTITY: "number",
    SYMBOL: "operator",
    BRACED: "variable",
}
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

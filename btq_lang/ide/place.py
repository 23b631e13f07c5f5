"""The place of the cursor: what precedes it on its logical line, and the block it is in.

One invariant: only the text before the cursor counts, so results do not depend on what is still to come; they come from
tokens, not from the tree, which does not have the line that is being typed yet.
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from collections.abc import Sequence

from btq_lang.ide.block import blanks_before
from btq_lang.ide.clause_words import opens_condition
from btq_lang.lexer import tokens as tokens_of
from btq_lang.syntax.scan import line_start
from btq_lang.syntax.tokens import (
    BLANK,
    CATEGORIES,
    CLOSE,
    COMMENT,
    DEDENT,
    ERROR,
    INDENT,
    NAME,
    NEWLINE,
    NODE_CLAUSES,
    OPEN,
    OPERATOR,
    STRING,
    SYMBOL,
    Token,
)
from btq_lang.syntax.tree import Item, Node, Tree, unquote
from btq_lang.util.record import Record
from btq_lang.util.text import Span
from btq_lang.workspace.file import File
from btq_lang.workspace.workspace import Workspace


class LineNode(Record):
    """The node of a line, as far as it is written."""

    name: str
    quoted: bool
    category: str | None

    @property
    def is_subtree(self) -> bool:
        return self.category == "SubTree"


class OpenBrace(Record):
    """The `{` before an offset.

    Attributes:
        span: what is typed after it, which a completion replaces.
        is_root: whether the entry is of the root blackboard: `{@`.
        closing: the `}` that is missing; empty if it is there.
    """

    span: Span
    is_root: bool
    closing: str


def open_brace(text: str, offset: int) -> OpenBrace | None:
    """The `{` before an offset on its line, in whatever language; None if there is none, or it is closed."""
    line = text[line_start(text, 0, offset) : offset]
    begun = re.search(r"\{(@?)([^{}\"'\s]*)$", line)
    if begun is None:
        return None
    rest = re.match(r"[\w./-]*(\s*\})?", text[offset:])
    end = offset + (len(rest[0]) - len(rest[1] or "") if rest else 0)
    return OpenBrace(Span(offset - len(begun[2]), end), bool(begun[1]), "" if rest and rest[1] else "}")


class CursorPlace(Record):
    """The place of the cursor.

    Attributes:
        inside: code, comment or string; `text`: the part of the comment or string before the cursor.
        span: the word that is being typed, which a completion replaces; `prefix`: the part before the cursor.
        block: items (of a file or a Root), models (of a TreeNodesModel), ports (of a model), hazard, scenario, tree,
            node or clauses (of a requirement).
        parent: the words of the line that opened the block; none at the top level.
        words: the words of the logical line before the one that is being typed.
        group: those in the innermost open brackets; brackets of a condition are ordinary words of it.
        depth: number of open brackets.
        callee: the name before the innermost open brackets, if they are not a node's.
        node: the node in whose brackets or after whose kind the cursor is; None at the start of a line.
    """

    inside: str
    text: str
    prefix: str
    span: Span
    block: str
    parent: tuple[Token, ...]
    words: tuple[Token, ...]
    group: tuple[Token, ...]
    depth: int
    callee: str
    node: LineNode | None

    @property
    def key(self) -> str | None:
        """The attribute whose value is being written."""
        if len(self.group) >= 2 and self.group[-1].text == "=" and self.depth:
            return word_text(self.group[-2])
        return None

    @property
    def is_of_parameters(self) -> bool:
        """Whether the innermost brackets are those of a requirement's parameters: `QualityReq slow(limit : m/s)`."""
        head = len(self.words) - _length(self.words) - 3 if self.depth else -1
        return head >= 0 and self.words[head].text == "QualityReq"

    @property
    def given(self) -> tuple[str, ...]:
        """The attributes that have a value in the innermost brackets."""
        return tuple(
            word_text(word)
            for word, following in zip(self.group, self.group[1:], strict=False)
            if following.kind == OPERATOR and following.text == "="
        )

    @property
    def last(self) -> str:
        """The word before the one that is being typed; empty at the start of the line or of the brackets."""
        return self.group[-1].text if self.group else ""


def place_at(workspace: Workspace, path: str, offset: int) -> CursorPlace:
    """The place of an offset.

    Raises:
        KeyError: the file does not exist.
    """
    file = workspace.files[path]
    tokens = item_tokens(file, offset)
    index = bisect_left(tokens, offset, key=lambda token: token.start) - 1
    inside, text, span = "code", "", Span(offset, offset)
    if index >= 0 and (token := tokens[index]).end >= offset:
        if token.kind == COMMENT and (offset < token.end or not token.text.endswith("*/")):
            inside, text = "comment", file.text[token.start : offset]
        elif token.kind == STRING and (offset < token.end or not _is_closed(token.text)):
            inside, text = "string", file.text[token.start + 1 : offset]
            index -= 1
        elif token.kind in (NAME, SYMBOL, ERROR):
            span = Span(token.start, max(token.end, offset))
            index -= 1
    words = words_before(tokens, index)
    group, depth = _innermost(words)
    blanks = blanks_before(file.text, words[0].start if words else span.start)
    parents = _parents(file.text, tokens, words[0].start if words else span.start, blanks)
    block, parent = _block(parents)
    node = _node(words) if block in ("node", "tree") else None
    callee = ""
    if depth:
        before = words[: len(words) - _length(words)]
        if depth > 1 or node is None or any(word.kind == NAME and word.text in NODE_CLAUSES for word in before):
            callee = word_text(before[-2]) if len(before) > 1 else ""
            node = None
    prefix = file.text[span.start : offset]
    return CursorPlace(inside, text, prefix, span, block, parent, words, group, depth, callee, node)


def item_tokens(file: File, offset: int) -> Sequence[Token]:
    """The tokens that the place of an offset depends on: those of the item around it or before it; of a tree only the
    lines of the nodes around it, and all from the last node before it up to the next one."""
    tokens: list[Token] = []
    for start, end in _stretches(file, offset):
        if tokens:
            tokens.append(Token(NEWLINE, start, ""))  # a line without a line end, as in open brackets, ends here too
        cut = tokens_of(file.text[start:end])
        tokens += [Token(token.kind, token.start + start, token.text) for token in cut] if start else cut
    return tokens


def _stretches(file: File, offset: int) -> list[Span]:
    """The spans of a text that the place of an offset depends on."""
    entries = file.parsed.entries
    index = bisect_right(entries, offset, key=lambda entry: entry.start)
    start = base = entries[index - 1].start if index else 0
    end = entries[index].start if index < len(entries) else len(file.text)
    spans: list[Span] = []
    around: Item | Node | None = entries[index - 1].item if index else None
    while isinstance(around, Tree | Node) and around.children:
        index = bisect_right(around.children, offset - base, key=lambda child: child.start)
        if index < len(around.children):
            end = base + around.children[index].start
        if index == 0:
            break
        spans.append(Span(start, line_start(file.text, start, base + around.children[0].start)))
        last = around.children[index - 1]
        start = line_start(file.text, start, base + last.start)
        around = last if isinstance(last, Node) else None
    return [*spans, Span(start, end)]


def word_text(token: Token) -> str:
    """The text of a word, unquoted."""
    return unquote(token.text) if token.kind == STRING else token.text


def _is_closed(raw: str) -> bool:
    return len(raw) > 1 and raw[-1] == raw[0]


def words_before(tokens: Sequence[Token], index: int) -> tuple[Token, ...]:
    """The words of the logical line up to a token."""
    words: list[Token] = []
    while index >= 0 and tokens[index].kind != NEWLINE:
        if tokens[index].kind not in _NO_WORDS and tokens[index].text:
            words.append(tokens[index])
        index -= 1
    return tuple(reversed(words))


def _innermost(words: tuple[Token, ...]) -> tuple[tuple[Token, ...], int]:
    """The words in the innermost open brackets, other than those of conditions, and the number of open brackets."""
    opened: list[list[Token]] = [[]]
    of_condition: list[bool] = []
    for word in words:
        if word.kind == OPEN:
            of_condition.append(opens_condition(opened[-1]))
            opened.append([*opened[-1], word] if of_condition[-1] else [])
        elif word.kind != CLOSE:
            opened[-1].append(word)
        elif of_condition:  # words in closed brackets do not count
            opened.pop()
            if of_condition.pop():
                opened[-1].append(word)
    return tuple(opened[-1]), len(of_condition)


def _length(words: tuple[Token, ...]) -> int:
    """The number of words in the innermost open brackets, including those in closed ones."""
    depth = 0
    for count, word in enumerate(reversed(words)):
        depth += (word.kind == CLOSE) - (word.kind == OPEN)
        if depth < 0:
            return count
    return len(words)


def _parents(text: str, tokens: Sequence[Token], start: int, blanks: str) -> list[tuple[Token, ...]]:
    """The lines in whose blocks a line is, the nearest first."""
    lines: list[tuple[Token, ...]] = []
    width = len(blanks.expandtabs(4))
    index = bisect_left(tokens, start, key=lambda token: token.start) - 1
    while index >= 0 and width > 0:
        line = words_before(tokens, index)
        while index >= 0 and tokens[index].kind != NEWLINE:
            index -= 1
        index -= 1
        if line:
            column = len(blanks_before(text, line[0].start).expandtabs(4))
            if column < width:
                lines.append(line)
                width = column
    return lines


def _block(parents: list[tuple[Token, ...]]) -> tuple[str, tuple[Token, ...]]:
    if parents and parents[-1][0].text == "Root":
        parents = parents[:-1]
    if not parents:
        return "items", ()
    nearest, outermost = parents[0], parents[-1][0].text
    if any(word.kind == NAME and word.text == "QualityReq" for word in _innermost(nearest)[0]):
        return "clauses", nearest
    if outermost in ("hazard", "scenario"):
        return outermost, nearest
    if outermost == "BehaviorTree":
        return ("tree" if len(parents) == 1 else "node"), nearest
    if outermost == "TreeNodesModel":
        return ("models" if len(parents) == 1 else "ports"), nearest
    return ("ports" if outermost in CATEGORIES else "none"), nearest


def _node(words: tuple[Token, ...]) -> LineNode | None:
    """[ category ] kind, at the start of a line"""
    if not words or words[0].text in NODE_CLAUSES:
        return None
    first = words[0]
    if first.kind == NAME and first.text in CATEGORIES:
        category = first.text
        if len(words) > 1 and words[1].kind in (NAME, STRING):
            return LineNode(word_text(words[1]), words[1].kind == STRING, category)
        for word, equals, value in zip(words, words[1:], words[2:], strict=False):
            if word.text == "ID" and equals.text == "=":
                return LineNode(word_text(value), False, category)
        return LineNode("", False, category)
    if first.kind in (NAME, STRING, SYMBOL):
        return LineNode(word_text(first), first.kind == STRING, None)
    return None


_NO_WORDS = frozenset((BLANK, COMMENT, INDENT, DEDENT))

"""The semantic tokens of an item: the words that its tree names, and the text between and after them.

One invariant: tokens are in the order of the text, none overlaps another, none crosses a line end.  The text between
two words of a tree is nearly always one of a few, so its tokens are cached by text.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Final, TypeAlias

from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks.lookups import edition
from btq_lang.ide.appearance import (
    DEFINED,
    NEW_NODE,
    NEW_QUALITY,
    OWN_NODE,
    OWN_QUALITY,
    PLAIN,
    STANDARD_QUALITY,
    TEXT,
    USED,
    VALUE,
    WRITTEN,
    appearance_of_node,
    plain_appearance,
)
from btq_lang.ide.meaning import match_of
from btq_lang.lexer import pieces
from btq_lang.syntax.tokens import COMMENT, OPERATOR, SYMBOL
from btq_lang.syntax.tree import Node, Pair, Requirement, Word
from btq_lang.util.text import LINE_END, Encoding, Span, width_of
from btq_lang.workspace.inputs import definition
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.references import Mention, Owner, ReferenceListener, What, report
from btq_lang.workspace.workspace import Workspace

Token: TypeAlias = tuple[int, int, str]  # start, end and appearance


def encoded(
    store: Store[Workspace], path: str, item: Facts | None, text: str, encoding: Encoding
) -> tuple[list[str], int]:
    """The tokens of a text that an item begins, or none, as `encode` returns them."""
    words = _Words(store, path)
    if item is not None:
        report(item.item, words)
    words.tokens.sort()
    tokens: list[Token] = []
    offset = 0
    for token in words.tokens:
        start, end, _ = token
        if start >= offset:
            tokens += _between(text, offset, start)
            tokens.append(token)
            offset = end
    tokens += _between(text, offset, len(text))
    return encode(text, tokens, encoding)


class _Words(ReferenceListener):
    """The words of an item as tokens."""

    def __init__(self, store: Store[Workspace], path: str) -> None:
        super().__init__()
        self.tokens: list[Token] = []
        self._store = store
        self._path = path

    def word(
        self,
        what: What,
        word: Word | None,
        defines: bool = False,
        node: Node | None = None,
        owner: Owner = None,
        pair: Pair | None = None,
    ) -> None:
        if word is not None and (raw := word.raw):
            appearance = (DEFINED if defines else USED).get(what)
            if appearance is None:
                appearance = self._appearance(what, word, word.text, defines, owner)
            self.tokens.append((word.start, word.start + len(raw), appearance))

    def words(self, what: What, words: tuple[Word, ...], span: Span, node: Node | None = None) -> None:
        appearance = self._appearance(what, words[-1], ".".join([word.text for word in words]), False, None)
        for word in words:
            self.tokens.append((word.start, word.start + len(word.raw), appearance))

    def value(self, word: Word) -> None:
        self.tokens.append((word.start, word.start + len(word.raw), PLAIN.get(word.kind, TEXT)))

    def part(self, mention: Mention) -> None:
        """Split the word around a reference, if it was the previous one."""
        begin, end = mention.span
        if begin == end:
            return
        appearance = WRITTEN if mention.writes else (DEFINED if mention.defines else USED).get(mention.what)
        if appearance is None:
            appearance = self._appearance(mention.what, mention.word, mention.name, mention.defines, mention.owner)
        tokens = self.tokens
        if tokens and tokens[-1][0] <= begin and end <= tokens[-1][1]:
            start, stop, around = tokens.pop()
            if start < begin:
                tokens.append((start, begin, around))
            tokens.append((begin, end, appearance))
            if end < stop:
                tokens.append((end, stop, around))
        else:
            tokens.append((begin, end, appearance))

    def _appearance(self, what: What, word: Word, name: str, defines: bool, owner: Owner) -> str:
        """The appearance of a word that can be several things."""
        if what is What.NODE:
            return NEW_NODE if defines and word.kind != SYMBOL else appearance_of_node(name, word.kind)
        if what is What.QUALITY:
            if defines:
                return NEW_QUALITY
            is_own = self._store.ask(definition, self._path, Kind.QUALITY, name) is not None
            is_standard = not is_own and match_of(name, self._store.ask(edition, self._path)).quality is not None
            return STANDARD_QUALITY if is_standard else OWN_QUALITY
        if what is What.VALUE:
            is_own = isinstance(owner, Requirement) and any(one.name.text == name for one in owner.parameters)
            return USED[What.PARAMETER] if is_own else VALUE
        assert what is What.PLACE, "a rule belongs to no item, and the appearance of all other words is known"
        return OWN_NODE if self._store.ask(definition, self._path, Kind.TREE, name) is None else USED[What.TREE]


def _between(text: str, start: int, end: int) -> list[Token]:
    """The tokens between two words of a tree, before the first or after the last.

    Comments do not get into the cache, for each is a different one.
    """
    between = text[start:end]
    if "#" not in between and "//" not in between:
        return _tokens_of(between, start)
    tokens: list[Token] = []
    while commented := _COMMENTED.match(text, start, end):
        tokens += _tokens_of(commented[1], start)
        tokens.append((*commented.span(2), PLAIN[COMMENT]))
        start = commented.end()
    return [*tokens, *_tokens_of(text[start:end], start)]


def _tokens_of(text: str, by: int) -> list[Token]:
    tokens = _lexed(text)
    return [(start + by, end + by, appearance) for start, end, appearance in tokens] if tokens else tokens


@lru_cache(2_000)
def _lexed(text: str) -> list[Token]:
    tokens: list[Token] = []
    before = ""
    for kind, start, raw in pieces(text):
        appearance = plain_appearance(kind, raw, before)
        if appearance is not None:
            tokens.append((start, start + len(raw), appearance))
        if kind <= OPERATOR:
            before = raw
    return tokens


def encode(text: str, tokens: list[Token], encoding: Encoding) -> tuple[list[str], int]:
    """The five integers of each token in JSON, and the line of the last one; lines and columns count from the previous
    token, or from the start of the text.

    Args:
        tokens: in the order of the text; one that crosses a line end becomes one on each line.
    """
    begins = [*(each.end() for each in LINE_END.finditer(text)), len(text) + 1]  # of the lines after each line
    integers: list[str] = []
    line = column = 0  # of the last token
    next_line = begin = 0  # the line of the next one, and where it begins
    waiting = tokens[::-1]
    while waiting:
        start, stop, appearance = waiting.pop()
        while begins[next_line] <= start:
            begin = begins[next_line]
            next_line += 1
        if stop >= begins[next_line]:
            waiting += [(first, last, appearance) for first, last in reversed(_lines(text, start, stop))]
            continue
        place, length = width_of(text[begin:start], encoding), width_of(text[start:stop], encoding)
        integers.append(f"{next_line - line},{place - column if next_line == line else place},{length}{appearance}")
        line, column = next_line, place
    return integers, line


def _lines(text: str, start: int, end: int) -> list[tuple[int, int]]:
    """The start and end of each line of a token that has text."""
    lines: list[tuple[int, int]] = []
    for line in LINE_END.finditer(text, start, end):
        if line.start() > start:
            lines.append((start, line.start()))
        start = line.end()
    if start < end:
        lines.append((start, end))
    return lines


# A comment to the end of its line.  Before it is nothing that may continue after a line end, or that a comment must not
# follow.
_COMMENTED: Final = re.compile(r"([^\"'={:/\r#]*(?<![^ \t\n]))((?:#|//)[^\r\n]*)(?![^\n])")

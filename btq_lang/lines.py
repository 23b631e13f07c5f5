"""Lines of a tree, one after another, as the interpreter reads them fastest: a pattern a line, and no calls between.

One invariant: a line read here is the line that `plain` reads, as `patterns` says it; the first that is spelt in
another way is left to `NodeParser.tree_block`, which comes back when it has read it.  What is open, columns and
blocks, is at every line what it would be had the lexer opened the line.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from btq_lang import patterns
from btq_lang.blocks import MAX_DEPTH, Block
from btq_lang.patterns import NO_NODE, VALUE_KINDS, BlankNode, BlankPair, BlankWord, pair_of, role_of
from btq_lang.plain import Unusual, attributes, line_clauses, plain_clauses
from btq_lang.syntax import Node, NodeClause, Pair, Word
from btq_lang.tokens import NAME, NODE_CLAUSES

if TYPE_CHECKING:
    from btq_lang.lexer import Lexer


def read_lines(lexer: Lexer, blocks: list[Block], base: int) -> tuple[int, Node | None]:
    """{ Kind [ Label ] [ Attributes ] { NodeClause } NL | NodeClause { NodeClause } NL }

    Args:
        lexer: stands on a line of the last block; `columns` follow the lines read.
        blocks: what is open, the tree itself first; the lines read go into them.
        base: where the item begins; offsets in the tree count from there.

    Returns:
        Where what was not read begins, or -1 if nothing was; and the node that the last line is, if it is one.
    """
    read_line = patterns.read_line
    text, columns = lexer.text, lexer.columns
    column = lexer.blanks
    top = blocks[0].level
    block = blocks[-1]
    children = block.children
    node: Node | None = None
    found: list[NodeClause] | None
    kind: Any  # as all that is blank at first
    at = lexer.line_start
    behind = -1
    while match := read_line(text, at):
        indent, first, second, third, key, value, key2, value2, key3, value3, end = match.groups()
        if first is None:
            at = match.end()
            if behind >= 0:
                behind = at
            continue
        if indent != column:
            if indent.startswith(column):
                if node is None:
                    break
                columns.append(indent)
                block = Block(len(columns) - 2, node)
                blocks.append(block)
                if len(blocks) > MAX_DEPTH:
                    break
            else:
                level = len(columns) - 2
                while len(columns[level]) > len(indent):
                    level -= 1
                if level <= top or columns[level] != indent:
                    break
                del columns[level + 1 :]
                while block.level >= level:
                    block.close()
                    blocks.pop()
                    block = blocks[-1]
            column = indent
            children = block.children
        at += len(indent)
        start = at - base
        role = role_of(first, NAME)
        if role >= 0:
            if third is not None:
                break
            category = None
            kind = BlankWord()
            kind.kind = role
            kind.start = start
            kind.raw = first
            label = None if second is None else Word(VALUE_KINDS[second[0]], start + len(first) + 1, second)
        elif role == NO_NODE:
            if first not in NODE_CLAUSES or children or second == "QualityReq":
                break
            found, at = plain_clauses(text, at, base)
            if found is None:
                break
            block.clauses += found
            behind = at
            node = None
            continue
        else:
            category = Word(NAME, start, first)
            kind = label = None
            if second is not None:
                at = start + len(first) + 1
                kind = Word(VALUE_KINDS[second[0]], at, second)
                if third is not None:
                    label = Word(VALUE_KINDS[third[0]], at + len(second) + 1, third)
        pairs: tuple[Pair, ...] = ()
        if key is not None:
            pair = BlankPair()  # as `pair_of` makes the further ones, of which few lines have any
            pair.key = word = BlankWord()
            word.kind = NAME
            word.start = match.start(5) - base
            word.raw = key
            pair.value = word = BlankWord()
            word.kind = VALUE_KINDS[value[0]]
            word.start = match.start(6) - base
            word.raw = value
            if key2 is None:
                pairs = (pair,)
            else:
                pairs = (pair, pair_of(key2, match.start(7) - base, value2, match.start(8) - base))
                if key3 is not None:
                    pairs += (pair_of(key3, match.start(9) - base, value3, match.start(10) - base),)
        at = match.end()
        clauses: tuple[NodeClause, ...] = ()
        if end is not None:
            node_end = at - base - len(end)
        else:
            try:
                node_end = at
                found = []
                if pairs or text.startswith(("(", " ("), at):
                    further = [*pairs]
                    at = node_end = _further_attributes(text, at, indent, base, further, found)
                    pairs = tuple(further)
                elif text[at] != " ":
                    break
                if text[at] == "\n":
                    at += 1
                    node_end -= base
                else:
                    known = len(found)
                    at = line_clauses(text, at, base, found)
                    node_end = found[-1].end if len(found) > known else node_end - base
            except (Unusual, IndexError):
                break
            clauses = tuple(found)
        made = BlankNode()
        made.start = start
        made.end = node_end
        made.category = category
        made.kind = kind
        made.label = label
        made.attributes = pairs
        made.clauses = clauses
        made.children = ()
        node = made
        behind = at
        children.append(made)
    return behind, node


def _further_attributes(
    text: str, at: int, blanks: str, base: int, pairs: list[Pair], clauses: list[NodeClause]
) -> int:
    """What is left of the attributes in brackets, from behind the last pair or before the opening bracket"""
    if not pairs:
        at = text.index("(", at) + 1
    elif text[at] == ",":
        at += 1
    elif text[at] not in " \r\n)":
        raise Unusual
    return attributes(text, at, blanks, base, pairs, clauses)

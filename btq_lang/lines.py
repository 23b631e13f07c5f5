"""Lines of a tree, one after another, as the interpreter reads them fastest: a pattern a line, and no calls between.

One invariant: a line read here is the line that `plain` reads, as `patterns` says it; the first that is spelt in
another way is left to `NodeParser.tree_block`, which comes back when it has read it.  What is open, columns and
blocks, is at every line what it would be had the lexer opened the line.
"""

from __future__ import annotations

from btq_lang import patterns
from btq_lang.blocks import MAX_DEPTH, Block
from btq_lang.lexer import Lexer
from btq_lang.patterns import NO_NODE, role_of, value_kind
from btq_lang.plain import Unusual, attributes, line_clauses, plain_clauses
from btq_lang.syntax import Node, NodeClause, Pair, Word
from btq_lang.tokens import NAME, NODE_CLAUSES

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    import re


def read_lines(lexer: Lexer, blocks: list[Block], base: int) -> tuple[int, Node | None]:
    """{ Kind [ Label ] [ Attributes ] { NodeClause } NL | NodeClause { NodeClause } NL }

    Args:
        lexer: stands on a line of the last block; `columns` follow the lines read.
        blocks: what is open, the tree itself first; the lines read go into them.
        base: where the item begins; offsets in the tree count from there.

    Returns:
        Where the next line begins, or -1 if none was read; and the node that the last line is, if it is one.
    """
    read_line, read_between = patterns.read_line, patterns.read_between
    text, columns = lexer.text, lexer.columns
    column = lexer.blanks
    top = blocks[0].level
    block = blocks[-1]
    children = block.children
    node: Node | None = None
    found: list[NodeClause] | None
    at = lexer.line_start
    behind = -1
    while True:
        match = read_line(text, at)
        if match is None:
            between = read_between(text, at)
            if between is None or (match := read_line(text, between.end())) is None:
                break
            at = between.end()
        indent, first, second, third, bracket, end = match.group(1, 2, 3, 4, 11, 12)
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
            kind: Word | None = Word(role, start, first)
            label = None if second is None else Word(value_kind(second[0], NAME), start + len(first) + 1, second)
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
                kind = Word(value_kind(second[0], NAME), at, second)
                if third is not None:
                    label = Word(value_kind(third[0], NAME), at + len(second) + 1, third)
        at = match.end()
        if end and bracket is None:
            node = Node(start, match.start(12) - base, category, kind, label, (), (), ())
        elif end and bracket:
            node = Node(start, match.start(12) - base, category, kind, label, tuple(_pairs(match, base)), (), ())
        else:
            try:
                found = []
                node_end = match.end(11)
                pairs: list[Pair] = []
                if bracket is None:
                    node_end = at
                    if text[at] not in " ":
                        break
                else:
                    pairs = _pairs(match, base)
                    if not bracket:
                        at = node_end = attributes(text, node_end, indent, base, pairs, found)
                if text[at] == "\n":
                    at += 1
                    node_end -= base
                else:
                    known = len(found)
                    at = line_clauses(text, at, base, found)
                    node_end = found[-1].end if len(found) > known else node_end - base
            except (Unusual, IndexError):
                break
            node = Node(start, node_end, category, kind, label, tuple(pairs), tuple(found), ())
        behind = at
        children.append(node)
    return behind, node


def _pairs(line: re.Match[str], base: int) -> list[Pair]:
    """The pairs that stand on a line"""
    key, value, key2, value2, key3, value3 = line.group(5, 6, 7, 8, 9, 10)
    if key is None:
        return []
    start = line.start
    word = Word(value_kind(value[0], NAME), start(6) - base, value)
    found = [Pair(Word(NAME, start(5) - base, key), word)]
    if key2 is not None:
        word = Word(value_kind(value2[0], NAME), start(8) - base, value2)
        found.append(Pair(Word(NAME, start(7) - base, key2), word))
        if key3 is not None:
            word = Word(value_kind(value3[0], NAME), start(10) - base, value3)
            found.append(Pair(Word(NAME, start(9) - base, key3), word))
    return found

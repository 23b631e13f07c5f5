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
    at = lexer.line_start
    behind = -1
    while True:
        match = read_line(text, at)
        if match is None:
            between = read_between(text, at)
            if between is None or (match := read_line(text, between.end())) is None:
                break
            at = between.end()
        indent, first, second, third, key, value, next_key, next_value, bracket, end = match.groups()
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
            if (line := plain_clauses(text, at, base)) is None:
                break
            block.clauses += line[0]
            at = behind = line[1]
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
        if key is None:
            pairs: tuple[Pair, ...] = ()
        else:
            pair = Pair(
                Word(NAME, match.start(5) - base, key), Word(value_kind(value[0], NAME), match.start(6) - base, value)
            )
            if next_key is None:
                pairs = (pair,)
            else:
                pairs = (
                    pair,
                    Pair(
                        Word(NAME, match.start(7) - base, next_key),
                        Word(value_kind(next_value[0], NAME), match.start(8) - base, next_value),
                    ),
                )
        at = match.end()
        clauses: tuple[NodeClause, ...] = ()
        if end and bracket != "":
            node_end = match.start(10) - base
        else:
            try:
                found: list[NodeClause] = []
                node_end = match.end(9)
                if bracket == "":
                    more = list(pairs)
                    at = node_end = attributes(text, node_end, indent, base, more, found)
                    pairs = tuple(more)
                elif bracket is None:
                    node_end = at
                    if text[at] not in " ":
                        break
                if text[at] == "\n":
                    at += 1
                    node_end -= base
                else:
                    known = len(found)
                    at = line_clauses(text, at, base, found)
                    node_end = found[-1].end if len(found) > known else node_end - base
                clauses = tuple(found)
            except (Unusual, IndexError):
                break
        behind = at
        node = Node(start, node_end, category, kind, label, pairs, clauses, ())
        children.append(node)
    return behind, node

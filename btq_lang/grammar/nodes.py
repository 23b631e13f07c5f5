"""The part of the parser that reads the block of a tree: nodes, and the requirements between them.

Nodes nest by indentation, so their blocks are a stack of open nodes, without recursion.
"""

from __future__ import annotations

from typing import Final

from btq_lang.diagnostics.model import Fix, FixEdit, Place, replace_fix, write_fix
from btq_lang.grammar.attributes import (
    misspelt_clause,
    parse_attributes,
    parse_node_clause,
)
from btq_lang.grammar.clauses import parse_clauses
from btq_lang.grammar.cursor import Cursor
from btq_lang.grammar.node_mistakes import (
    STATEMENTS,
    at_bare_value,
    child_on_the_line,
    is_after_dashes,
    is_doc_string,
    leftover,
    no_node,
    other_comment,
    skip_dash,
    skip_xml,
)
from btq_lang.grammar.ports import parse_port, port_below_node
from btq_lang.grammar.requirements import parse_requirement, second_quality
from btq_lang.syntax.scan import line_start
from btq_lang.syntax.tokens import (
    CATEGORIES,
    DIRECTIONS,
    NAME,
    NEWLINE,
    NODE_CLAUSES,
    OPEN,
    OPERATOR,
    STRING,
    SYMBOL,
)
from btq_lang.syntax.tree import (
    Node,
    NodeClause,
    Pair,
    Port,
    Requirement,
    Satisfies,
    Verbatim,
    Word,
)
from btq_lang.util.record import replace
from btq_lang.util.text import Span


def parse_tree_block(
    cursor: Cursor, level: int
) -> tuple[tuple[Port, ...], tuple[NodeClause, ...], tuple[Node | Verbatim, ...]]:
    """INDENT { Port } { ClauseLine } { Node } DEDENT"""
    lexer = cursor.lexer
    ports: list[Port] = []
    block = OpenBlock(level, None)
    blocks = [block]
    is_too_deep_reported = False
    while cursor.more and lexer.level > level:
        inner = lexer.level
        while block.level >= inner:
            blocks.pop().close()
            block = blocks[-1]
        cursor.scan()
        if cursor.kind == NAME and cursor.raw in _NO_KINDS and parse_other_line(cursor, inner, blocks, ports):
            continue
        if len(blocks) > MAX_DEPTH:
            if not is_too_deep_reported:
                is_too_deep_reported = True
                cursor.complain(cursor.here(), _TOO_DEEP, notes=(OF_ITS_OWN,), rule="nested-too-deep")
            blocks.pop().close()
            block = blocks[-1]
        node = parse_node(cursor, inner)
        if node is None:
            continue
        block.children.append(node)
        if cursor.more and lexer.level > inner:
            block = OpenBlock(inner, node)
            blocks.append(block)
    for open_block in blocks:
        open_block.close()
    return tuple(ports), tuple(blocks[0].clauses), tuple(blocks[0].children)


def parse_other_line(cursor: Cursor, level: int, blocks: list[OpenBlock], ports: list[Port]) -> bool:
    """ClauseLine | Port | Verbatim, into the last of the open blocks; False where the current word begins a node"""
    block = blocks[-1]
    word = cursor.raw
    if word in NODE_CLAUSES:
        if len(blocks) > 1 or block.has_nodes():
            block.clauses += parse_clause_line_after(cursor, level, block.children)
        else:  # the tree's own: XML may precede it, as it may be among ports
            block.clauses += parse_clause_line(cursor, level)
    elif word == "QualityReq" and is_requirement(cursor):
        block.clauses.append(parse_requirement_line(cursor, level))
    elif word == "xml":
        block.children.append(parse_verbatim(cursor))
        no_block(cursor, level)
    elif word in DIRECTIONS and len(blocks) == 1 and not block.has_nodes():
        if block.clauses:
            cursor.complain(cursor.here(), "ports go before satisfices, satisfies and tags")
        ports.append(parse_port(cursor))
        no_block(cursor, level)
    elif word in _PARAMETERS and len(blocks) == 1 and not block.has_nodes() and cursor.is_operator(2, ":"):
        port = f"`input {cursor.raws[1]} : type`"
        cursor.complain(cursor.here(), f"a port of a tree is written {port}", write_fix("input", cursor.here()))
        ports.append(parse_port(cursor, "input"))
        no_block(cursor, level)
    elif word in DIRECTIONS and cursor.kinds[cursor.index + 1] == NAME and cursor.is_operator(cursor.index + 2, ":"):
        tree = blocks[0]
        port_below_node(cursor, tree.children[0] if tree.children and not tree.clauses else None)
        ports.append(parse_port(cursor))
        no_block(cursor, level)
    else:
        return False
    return True


def parse_node(cursor: Cursor, level: int) -> Node | None:
    """Kind [ Label ] [ Attributes ] { NodeClause } NL"""
    if is_after_dashes(cursor):
        other_comment(cursor, cursor.here().start + 2)
        cursor.end_line()
        return None
    if cursor.kind == OPERATOR:
        skip_dash(cursor)
    start = cursor.starts[cursor.index] - cursor.base
    category: Word | None = None
    kind: Word | None = None
    if cursor.kind == NAME and cursor.raw in CATEGORIES:
        category = cursor.take()
        cursor.skip_glued_colon()
        if at_label(cursor):
            kind = cursor.take()
    elif cursor.kind == STRING and is_doc_string(cursor):
        other_comment(cursor, cursor.here().start + 3)
        cursor.end_line()
        return None
    elif cursor.kind == NAME or cursor.kind == SYMBOL or cursor.kind == STRING:
        kind = cursor.take()
        if cursor.kind == OPERATOR and kind.raw not in STATEMENTS:
            cursor.skip_last_sign()
    else:
        no_node(cursor)
        cursor.end_line()
        cursor.skip_block(level)
        skip_xml(cursor, level)
        return None
    clauses: list[NodeClause] = []
    label = None
    if cursor.kind == NAME and cursor.kinds[cursor.index + 1] in (NAME, STRING) and (meant := misspelt_clause(cursor)):
        clauses.append(parse_node_clause(cursor, meant))
    elif at_label(cursor):
        label = cursor.take()
    attributes: tuple[Pair, ...] = ()
    if cursor.kind == OPEN:
        attributes = parse_attributes(cursor, clauses)
    while cursor.kind == NAME and cursor.raw in NODE_CLAUSES:
        clauses.append(parse_node_clause(cursor))
    bare = False
    if cursor.kind != NEWLINE:
        # `key = value` after a forgotten bracket
        bare = cursor.index == 1 and at_bare_value(cursor) and OPEN not in cursor.kinds
        if not child_on_the_line(cursor, label):
            leftover(cursor, kind, label is not None, clauses)
    end = cursor.end_line()
    if bare and not cursor.deeper(level):
        return None
    if bare:
        cursor.bare_until = -1  # it has a block, so it is a node, and the next line may be one too
    return Node(start, end, category, kind, label, attributes, tuple(clauses) if clauses else (), ())


def parse_clause_line(cursor: Cursor, level: int) -> list[NodeClause]:
    """NodeClause { NodeClause } NL | "satisfies" { ReqUse "," } ReqItem"""
    clauses: list[NodeClause] = []
    while cursor.kind == NAME and cursor.raw in NODE_CLAUSES:
        clauses.append(parse_node_clause(cursor))
    cursor.end_line()
    last = clauses[-1]
    if isinstance(last, Satisfies) and last.uses and isinstance(use := last.uses[-1], Requirement):
        requirement = parse_clause_block(cursor, use, level)
        clauses[-1] = Satisfies(last.start, requirement.end, (*last.uses[:-1], requirement))
    no_block(cursor, level)
    return clauses


def parse_clause_line_after(cursor: Cursor, level: int, children: list[Node | Verbatim]) -> list[NodeClause]:
    """A clause line in the block of a node; it is reported if it comes after children."""
    start = cursor.lexer.line_start
    place = cursor.here()
    word = cursor.raw
    clauses = parse_clause_line(cursor, level)
    if children:
        end = cursor.starts[-1] + len(cursor.raws[-1])
        moved = cursor.text[start:end]
        first = children[0].start + cursor.base
        first = line_start(cursor.text, min(cursor.base, first), first)
        changes = (
            FixEdit(Place(Span(first, first)), moved if cursor.raws[-1] else f"{moved}\n"),
            FixEdit(Place(Span(start, end)), ""),
        )
        fixes: tuple[Fix, ...] = (Fix("Move it before the children", changes),)
        last = children[-1]
        if isinstance(last, Node) and not last.children and "\n" not in moved.rstrip():
            step = "\t" if moved.startswith("\t") else "    "
            fixes += (replace_fix(f"Move it to `{last.head.text}`", Span(start, start), step),)
        note = f'a node of this name goes in quotes: "{word}"'
        cursor.complain(place, "clauses go before children", *fixes, notes=(note,), rule="clause-after-children")
    return clauses


def parse_requirement_line(cursor: Cursor, level: int) -> Satisfies:
    """Report that `satisfies` is missing before a requirement in the block of a node."""
    word = cursor.here()
    fix = write_fix("satisfies QualityReq", word)
    note = "to share it between nodes, write it outside the tree"
    cursor.complain(word, "a requirement at a node begins with `satisfies`", fix, notes=(note,))
    requirement = parse_requirement(cursor)
    second_quality(cursor, requirement)
    cursor.end_line()
    requirement = parse_clause_block(cursor, requirement, level)
    no_block(cursor, level)
    return Satisfies(requirement.start, requirement.end, (requirement,))


def parse_clause_block(cursor: Cursor, requirement: Requirement, level: int) -> Requirement:
    """[ INDENT { Clause { Clause } NL } DEDENT ]"""
    clauses = list(requirement.clauses)
    end = requirement.end
    while cursor.deeper(level):
        inner = cursor.lexer.level
        cursor.scan()
        clauses += parse_clauses(cursor, at_least_one=True)
        end = cursor.end_line()
        no_block(cursor, inner)
    if end == requirement.end:
        return requirement
    return replace(requirement, end=end, clauses=tuple(clauses))


def parse_verbatim(cursor: Cursor) -> Verbatim:
    """ "xml" STRING NL"""
    start = cursor.take().start
    text = None
    if cursor.kind == STRING:
        text = cursor.take()
    else:
        cursor.expected("one XML element in quotes", ('a node of this name goes in quotes: "xml"',))
    return Verbatim(start, cursor.end_line(), text)


def at_label(cursor: Cursor) -> bool:
    return cursor.kind == STRING or (cursor.kind == NAME and cursor.raw not in NODE_CLAUSES)


def is_requirement(cursor: Cursor) -> bool:
    """Whether the line is a requirement, not a node called QualityReq."""
    following = cursor.index + 1
    if cursor.kinds[following] not in (NAME, STRING) or cursor.raws[following] in NODE_CLAUSES:
        return False
    after = cursor.kinds[following + 1]
    return not (after in (NEWLINE, OPEN) or cursor.raws[following + 1] in NODE_CLAUSES)


def no_block(cursor: Cursor, level: int) -> None:
    """Report and skip lines deeper than the line just read, which takes no block."""
    if not cursor.deeper(level):
        return
    start = cursor.lexer.position
    message = "unexpected indentation: the line above opens no block"
    cursor.complain(Span(start, cursor.lexer.line_end()), message, notes=(_MEANINGFUL,))
    cursor.skip_block(level)


class OpenBlock:
    """The open block of a node, or of the tree itself, with what has been parsed so far."""

    __slots__ = ("children", "clauses", "level", "node")

    def __init__(self, level: int, node: Node | None) -> None:
        self.level: Final = level  # of the line that opened it
        self.node: Final = node
        self.clauses: list[NodeClause] = []
        self.children: list[Node | Verbatim] = []

    def has_nodes(self) -> bool:
        return any(isinstance(child, Node) for child in self.children)

    def close(self) -> None:
        if self.node is not None:
            self.node.children = tuple(self.children)
            if self.clauses:
                self.node.clauses += tuple(self.clauses)


_PARAMETERS: Final = frozenset(("param", "parameter", "argument"))
_NO_KINDS: Final = NODE_CLAUSES | DIRECTIONS | _PARAMETERS | {"QualityReq", "xml"}
MAX_DEPTH: Final = 256  # levels below a BehaviorTree; the engine's limit (4.9 and later)
OF_ITS_OWN: Final = "move a part of them into a BehaviorTree of its own and call it with SubTree"
_TOO_DEEP: Final = f"more than {MAX_DEPTH} levels of nodes, which BehaviorTree.CPP refuses"
_MEANINGFUL: Final = "indentation shows what a line belongs to; align it with its sibling lines"

"""The part of the parser that reads a port of a tree or a model."""

from __future__ import annotations

import re
from typing import Final

from btq_lang.catalog.literals import is_known_type, plain_type
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, replace_fix, write_fix
from btq_lang.grammar.attributes import parse_pairs, parse_value
from btq_lang.grammar.cursor import VALUES, Cursor, shown
from btq_lang.syntax.scan import line_end, line_start
from btq_lang.syntax.tokens import CLOSE, NAME, NEWLINE, NODE_CLAUSES, OPEN, STRING
from btq_lang.syntax.tree import Node, Port, TypeWord, Verbatim, Word, is_name, quote
from btq_lang.syntax.words import unquote
from btq_lang.util.text import Span


def parse_port(cursor: Cursor, meant: str = "") -> Port:
    """( "input" | … ) [ NAME ] [ ":" Name { "::" Name } ] [ "=" Value ] [ Attributes ] [ STRING ] NL

    Args:
        meant: the first letters of the current word, which are read instead of it.
    """
    direction = cursor.take()
    if meant:
        direction = Word(NAME, direction.start, meant)
    name = cursor.take() if cursor.kind == NAME else None
    type_ = None
    if cursor.kind == STRING and name is None and cursor.raws[cursor.index + 1] == ":":
        plain = unquote(cursor.raw)
        fixes = (write_fix(plain, cursor.here(), safe=True),) if is_name(plain) else ()
        cursor.complain(cursor.here(), "a port's name takes no quotes", *fixes)
        name = cursor.take()
    if cursor.accept(":"):
        type_ = parse_type(cursor)
    elif name is not None and cursor.kind == NAME:
        notes = ("a port is written `input name : type`",)
        cursor.expected("`:` and the port's type", notes, (type_first(cursor, name) or cursor.put_before(":"),))
    default = parse_value(cursor) if cursor.accept("=") or skip_default(cursor) else None
    attributes = parse_pairs(cursor)
    text = cursor.take() if cursor.kind == STRING else None
    notes = ("write a port's type after `:`, and its text in quotes",)
    return Port(direction.start, cursor.end_line(notes), direction, name, type_, default, attributes, text)


def parse_type(cursor: Cursor) -> Word | None:
    """Type = Name { "::" Name }; as one word"""
    word = cursor.name("the port's type")
    while word is not None and cursor.at("::"):
        cursor.advance()
        last = cursor.name("the rest of the type")
        if last is not None:
            word = TypeWord(NAME, word.start, cursor.text[cursor.base + word.start : cursor.base + last.end])
    return unquoted_type(cursor, word) if word is not None and goes_on(cursor, word) else word


# ---- what productions ask and report ----


def skip_default(cursor: Cursor) -> bool:
    """Report and skip the word before a default: `input place : string default "home"`."""
    value = cursor.index + 1
    if not cursor.at_word("default") or cursor.kinds[value] not in VALUES:
        return False
    message = f"a default is written `= {shown(cursor.raws[value])}`"
    cursor.complain(cursor.here(), message, write_fix("=", cursor.here()))
    cursor.advance()
    return True


def port_below_node(cursor: Cursor, first: Node | Verbatim | None) -> None:
    """Report `input shelf : string` below a node or after one; the fix moves the line before the tree's first node."""
    at, text = cursor.here(), cursor.text
    own = Span(line_start(text, 0, at.start), line_end(text, at.end))
    newline = "\r\n" if text.startswith("\r\n", own.end) else text[own.end : own.end + 1]
    fixes: tuple[Fix, ...] = ()
    if first is not None and newline:
        start = first.start + cursor.base
        line = line_start(text, 0, start)
        moved = f"{text[line:start]}{text[at.start : own.end]}{newline}"
        changes = (
            FixEdit(Place(Span(line, line)), moved),
            FixEdit(Place(Span(own.start, own.end + len(newline))), ""),
        )
        fixes = (Fix("Move it to the first line below the tree's own", changes),)
    cursor.complain(at, "the ports of a tree go directly below its own line, before its node", *fixes)


def at_ports(cursor: Cursor) -> bool:
    """Whether brackets have ports in them, as the parameters of a function: `(place, speed : double)`."""
    first = cursor.index + 1
    if (
        cursor.kind != OPEN
        or cursor.kinds[first] != NAME
        or cursor.raws[first] in _NO_PORTS
        or ("=" in cursor.raws[first:] and cursor.raws[first + 1] != ":")
    ):
        return False
    return cursor.kinds[first + 1] in (NAME, CLOSE) or cursor.raws[first + 1] in (":", ",", "::")


def ports_in_brackets(cursor: Cursor, owner: str) -> None:
    """Report ports in the brackets of a tree or a model; the fix writes each on its line."""
    bracket = cursor.here()
    note = f"a port goes on a line of its own below the {owner}, indented: `input name : type`"
    closing = cursor.kinds.index(CLOSE, cursor.index) if CLOSE in cursor.kinds[cursor.index :] else -1
    fixes: tuple[Fix, ...] = ()
    if closing > 0 and cursor.raws[closing] and cursor.kinds[closing + 1] == NEWLINE:
        inside = cursor.text[bracket.end : cursor.starts[closing]]
        ports = [_BRACKETED_PORT.fullmatch(part.strip()) for part in inside.split(",")]
        line = line_end(cursor.text, cursor.starts[closing])
        below = _NEXT_MARGIN.match(cursor.text, line)
        step = below[1] if below else "    "
        removal = FixEdit(Place(Span(cursor.last_end() + cursor.base, cursor.starts[closing] + 1)), "")
        lines = [
            f"\n{step}{port['direction'] or 'input'} {port['name']}"
            f"{f' : {type_}' if type_ else ''}{port['default'] or ''}"
            for port in ports
            if port is not None
            for type_ in [port["type"] or port["before"]]
        ]
        if len(lines) == len(ports):
            fixes = (
                Fix("Put them on lines of their own", (removal, FixEdit(Place(Span(line, line)), "".join(lines)))),
            )
    cursor.complain(bracket, "ports do not go in brackets", *fixes, notes=(note,))
    cursor.go_to(len(cursor.kinds) - 1)


def type_first(cursor: Cursor, name: Word) -> Fix | None:
    """The fix for `input int count`, with type and name in the order of C++."""
    start = name.start + cursor.base
    declared = _TYPE_FIRST.match(cursor.text, start)
    if declared is None or not is_known_type(plain_type(declared[1])):
        return None
    return write_fix(f"{declared[2]} : {declared[1]}", Span(start, declared.end()))


def goes_on(cursor: Cursor, type_: Word) -> bool:
    """Whether the type after `:` is more than a C++ name: `vector<int>`, `unsigned int`, `Pose*`."""
    end = type_.end + cursor.base
    if type_.kind != NAME:
        return False
    return cursor.text[end : end + 1] in ("<", "*", "&", "[") or (cursor.kind == NAME and type_.raw in _BEFORE_TYPES)


def unquoted_type(cursor: Cursor, type_: Word) -> Word:
    """`std::map<int, double>`: read all of it as one type, and report that it needs quotes."""
    start = end = type_.start + cursor.base
    depth = 0
    while end < len(cursor.text) and cursor.text[end] not in "\r\n#\"'" and (depth > 0 or cursor.text[end] not in "=("):
        depth += 1 if cursor.text[end] == "<" else -1 if cursor.text[end] == ">" else 0
        end += 1
    span = Span(start, start + len(cursor.text[start:end].rstrip()))
    raw = cursor.text[span.start : span.end]
    fix = replace_fix("Put quotes around it", span, quote(raw), safe=True)
    of_line = cursor.lexer.problems[cursor.known :]
    inside = [problem for problem in of_line if span.start <= problem.span.start < span.end]
    cursor.complain_instead(inside, Diagnostic("syntax-error", span, "this type needs quotes", fixes=(fix,)))
    while cursor.kind != NEWLINE and cursor.starts[cursor.index] < span.end:
        cursor.advance()
    return Word(NAME, type_.start, raw)


_BRACKETED_PORT: Final = re.compile(
    r"(?:(?P<direction>input|output|inout)\s+)?(?:(?P<before>(?:\w+::)*\w+)\s+)?(?P<name>[^\W\d]\w*)"
    r"(?:\s*:\s*(?P<type>(?:\w+::)*\w+)(?P<default>\s*=\s*[\w.'\"-]+)?)?"
)
_TYPE_FIRST: Final = re.compile(r"(\w+)[ \t]+([^\W\d]\w*)(?![ \t]*:)")
_NO_PORTS: Final = NODE_CLAUSES | {"parameters", "QualityReq"}
_NEXT_MARGIN: Final = re.compile(r"(?:[ \t]*\r?\n)+([ \t]+)")
_BEFORE_TYPES: Final = frozenset(("const", "unsigned", "signed", "long", "short"))

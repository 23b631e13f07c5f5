"""The part of the parser that reads the items of a file, except Root, whose block holds items.

Each `parse_…` is a production of docs/grammar.md and named after it; its docstring shows the production.
"""

from __future__ import annotations

import re
from typing import Final

from btq_lang.diagnostics.model import Fix, replace_fix, write_fix
from btq_lang.grammar.attributes import parse_pairs
from btq_lang.grammar.claim_mistakes import blank_in_path, every_meant
from btq_lang.grammar.conditions import parse_cond, parse_path, parse_simple
from btq_lang.grammar.cursor import Cursor
from btq_lang.grammar.nodes import no_block, parse_clause_block, parse_tree_block, parse_verbatim
from btq_lang.grammar.ports import at_ports, parse_port, ports_in_brackets
from btq_lang.grammar.requirements import (
    parse_quality_path,
    parse_req_ref,
    parse_requirement,
    parse_unit,
    second_quality,
    sort_of,
)
from btq_lang.syntax.scan import blanks_end, is_name, is_unit, line_end, number_end, path_end
from btq_lang.syntax.tokens import BRACED, CATEGORIES, CLOSE, DIRECTIONS, ERROR, NAME, NEWLINE, OPEN, QUANTITY, STRING
from btq_lang.syntax.tree import (
    Apply,
    Context,
    Include,
    Meta,
    Model,
    Models,
    Port,
    Qualities,
    QualityDecl,
    ReqRef,
    Requirement,
    Selector,
    Signal,
    Tree,
    Verbatim,
    Word,
    quote,
    unquote,
)
from btq_lang.util.text import Span


def parse_include(cursor: Cursor) -> Include:
    """ "include" STRING [ Attributes ] NL"""
    start = cursor.take().start
    if (
        cursor.at_word("path")
        and cursor.is_operator(cursor.index + 1, "=")
        and cursor.kinds[cursor.index + 2] == STRING
    ):
        gone = Span(cursor.here().start, cursor.starts[cursor.index + 2])
        fix = replace_fix("Remove `path =`", gone, "", safe=True)
        cursor.complain(cursor.here(), "the path of an include needs no `path =`", fix)
        cursor.go_to(cursor.index + 2)
    elif (cursor.at(":") or cursor.at("=")) and cursor.kinds[cursor.index + 1] == STRING:
        after = blanks_end(cursor.text, cursor.starts[cursor.index] + 1, len(cursor.text))
        fix = without_sign(cursor, f"Remove `{cursor.raw}`", after, "", safe=True)
        cursor.complain(cursor.here(), f"unexpected `{cursor.raw}`", fix)
        cursor.advance()
    path = cursor.take() if cursor.kind == STRING else unquoted_path(cursor)
    attributes = parse_pairs(cursor)
    return Include(start, cursor.end_line(), path, attributes)


def parse_qualities(cursor: Cursor) -> Qualities:
    """ "qualities" NAME NL"""
    start = cursor.take().start
    edition = cursor.name("iso25010-2023 or iso25010-2011")
    return Qualities(start, cursor.end_line(), edition)


def parse_quality_decl(cursor: Cursor) -> QualityDecl:
    """ "quality" Name [ ":" QualityPath ] [ STRING ] NL"""
    start = cursor.take().start
    cursor.skip_glued_colon()
    name = cursor.name("the name of the quality")
    parent = parse_quality_path(cursor) if cursor.accept(":") else None
    text = cursor.take() if cursor.kind == STRING else None
    notes = ("write the quality it belongs to after `:`, and its definition in quotes",)
    return QualityDecl(start, cursor.end_line(notes), name, parent, text)


def parse_models(cursor: Cursor, level: int) -> Models:
    """ "TreeNodesModel" NL [ INDENT { Model | Verbatim } DEDENT ]"""
    start = cursor.take().start
    end = cursor.end_line()
    models: list[Model | Verbatim] = []
    while cursor.deeper(level):
        cursor.scan()
        inner = cursor.lexer.level
        if cursor.kind == NAME and cursor.raw in CATEGORIES:
            models.append(parse_model(cursor, inner))
        elif cursor.kind == NAME and cursor.raw == "xml":
            models.append(parse_verbatim(cursor))
        else:
            cursor.expected("a node model: Action, Condition, Control, Decorator or SubTree and its ID")
            cursor.end_line()
            cursor.skip_block(inner)
        no_block(cursor, inner)
    return Models(start, end, tuple(models))


def parse_model(cursor: Cursor, level: int) -> Model:
    """( "Action" | … | "SubTree" ) Name [ Attributes ] [ STRING ] NL [ INDENT { Port | … } DEDENT ]"""
    category = cursor.take()
    cursor.skip_glued_colon()
    name = cursor.name("the node's ID")
    if at_ports(cursor):
        ports_in_brackets(cursor, "node")
    attributes = parse_pairs(cursor)
    text = cursor.take() if cursor.kind == STRING else None
    end = cursor.end_line()
    return Model(category.start, end, category, name, attributes, text, parse_model_block(cursor, level))


def parse_model_block(cursor: Cursor, level: int) -> tuple[Port | Meta | Verbatim, ...]:
    """[ INDENT { Port | Meta | Verbatim } DEDENT ]"""
    body: list[Port | Meta | Verbatim] = []
    while cursor.deeper(level):
        inner = cursor.lexer.level
        cursor.scan()
        if cursor.kind == NAME and cursor.raw in DIRECTIONS:
            body.append(parse_port(cursor))
        elif cursor.kind == NAME and (direction := cursor.raw.removesuffix("_port")) in DIRECTIONS:
            message = f"unknown word `{cursor.raw}`; did you mean `{direction}`?"
            cursor.complain(cursor.here(), message, write_fix(direction, cursor.here(), safe=True))
            body.append(parse_port(cursor, direction))
        elif cursor.kind == NAME and cursor.raw == "metadata":
            body.append(parse_meta(cursor))
        elif cursor.kind == NAME and cursor.raw == "xml":
            body.append(parse_verbatim(cursor))
        else:
            fixes = cursor.replaced_by((*sorted(DIRECTIONS), "metadata", "xml"))
            if cursor.kind == NAME and cursor.raw in ("in", "out"):
                fixes = (write_fix(f"{cursor.raw}put", cursor.here(), safe=True),)
            notes: tuple[str, ...] = ()
            if declared := _OF_CPP.match(cursor.text, cursor.here().start):
                fixes = port_of_cpp(cursor, declared)
                notes = (_A_PORT,)
            cursor.expected("a port (input, output or inout), metadata or xml", notes, fixes)
            cursor.end_line()
            cursor.skip_block(inner)
        no_block(cursor, inner)
    return tuple(body)


def parse_meta(cursor: Cursor) -> Meta:
    """ "metadata" Attributes NL"""
    start = cursor.take().start
    if cursor.kind != OPEN:
        cursor.expected('attributes in brackets: metadata (key = "value")')
    attributes = parse_pairs(cursor)
    return Meta(start, cursor.end_line(), attributes)


def parse_signal(cursor: Cursor) -> Signal:
    """ "signal" NAME ":" UNIT [ "from" BRACED ] [ "level" | … ] [ "fresh" … ] [ "initially" … ] NL"""
    start = cursor.take().start
    cursor.skip_glued_colon()
    if cursor.at_word("from") and cursor.kinds[cursor.index + 1] in (BRACED, STRING):
        cursor.expected("the signal's name", (_a_signal("battery", "{battery}"),))
    name = cursor.plain_name("the signal's name")
    unit = parse_unit(cursor) if name is not None and at_unit(cursor, name) else None
    source = behaviour = fresh = initially = None
    if cursor.accept_word("from") or from_meant(cursor):
        source = parse_entry_key(cursor)
    if cursor.kind == NAME and cursor.raw in _BEHAVIOURS:
        behaviour = cursor.take()
    if cursor.accept_word("fresh"):
        cursor.expect_word("within", forgotten=cursor.kind == QUANTITY)
        fresh = cursor.quantity("a duration: 5 s")
    if cursor.accept_word("initially"):
        initially = parse_simple(cursor, strings=True)
    end = cursor.end_line((_SIGNAL_ORDER,), cursor.replaced_by(_SIGNAL_WORDS))
    return Signal(start, end, name, unit, source, behaviour, fresh, initially)


def parse_context(cursor: Cursor) -> Context:
    """ "context" NAME ":" Cond NL"""
    start = cursor.take().start
    cursor.skip_glued_colon()
    name = cursor.plain_name("the context's name")
    condition = parse_cond(cursor) if cursor.expect(":", " and a condition") else None
    return Context(start, cursor.end_line(), name, condition)


def parse_req_item(cursor: Cursor, level: int) -> Requirement:
    """ReqHead { Clause } NL [ INDENT { Clause { Clause } NL } DEDENT ]"""
    requirement = parse_requirement(cursor)
    second_quality(cursor, requirement)
    cursor.end_line()
    return parse_clause_block(cursor, requirement, level)


def parse_apply(cursor: Cursor) -> Apply:
    """ "apply" ReqRef { "," ReqRef } "to" Selector { "," Selector } [ "except" Selector { "," Selector } ] NL"""
    start = cursor.take().start
    uses = cursor.listed(parse_applied)
    targets = cursor.listed(parse_selector) if cursor.expect_word("to", ("on", "for", "at")) else ()
    exceptions = cursor.listed(parse_selector) if accept_selection(cursor, "except", _EXCEPT) else ()
    return Apply(start, cursor.end_line(), uses, targets, exceptions)


def parse_applied(cursor: Cursor) -> ReqRef | None:
    """ReqRef"""
    name = cursor.missing_word("a requirement") if cursor.at_word("to") else cursor.name("a requirement")
    return parse_req_ref(cursor, name) if name is not None else None


def parse_selector(cursor: Cursor) -> Selector | None:
    """ "every" Name [ "under" Path ] | "every" "node" "tagged" NAME | Path"""
    start = cursor.start()
    if selects_all(cursor):
        return None
    if not (cursor.accept_word("every") or every_meant(cursor)):
        path = parse_path(cursor, "a node, or `every` and a node")
        if not is_selection(cursor, _EXCEPT):
            blank_in_path(cursor, path, _END_SELECTORS)
        return Selector(path.span.start, path.span.end, path=path) if path else None
    if cursor.at_word("node") and cursor.is_word(cursor.index + 1, "tagged"):
        cursor.advance()
        cursor.advance()
        tag = cursor.name("a tag")
        return Selector(start, cursor.last_end(), tag=tag)
    if cursor.at_word("tagged") and cursor.kinds[cursor.index + 1] == NAME:
        message = "nodes with a tag are selected with `every node tagged …`"
        cursor.complain(cursor.here(), message, cursor.put_before("node"))
        cursor.advance()
        return Selector(start, cursor.last_end(), tag=cursor.name("a tag"))
    every = cursor.name("a node's ID or kind")
    under = parse_path(cursor, "a tree or node") if accept_selection(cursor, "under", _UNDER) else None
    return Selector(start, cursor.last_end(), every=every, path=under)


def parse_tree(cursor: Cursor, level: int) -> Tree:
    """ "BehaviorTree" [ [ "ID" "=" ] Name ] [ Attributes ] NL [ INDENT { Port } { ClauseLine } { Node } DEDENT ]"""
    start = cursor.take().start
    if cursor.at_word("ID") and cursor.is_operator(cursor.index + 1, "="):
        cursor.advance()
        cursor.advance()
        name = cursor.name("the tree's ID")
    elif cursor.at_word("ID") and cursor.kinds[cursor.index + 1] in (NAME, STRING):
        fix = replace_fix("Put `=` after it", Span(cursor.here().end, cursor.here().end), " =")
        cursor.complain(cursor.here(), "expected `=` after `ID`", fix)
        cursor.advance()
        name = cursor.take()
    else:
        cursor.skip_glued_colon()
        name = cursor.take() if cursor.kind == NAME or cursor.kind == STRING else None
    if cursor.kind == OPEN and at_ports(cursor):
        ports_in_brackets(cursor, "tree")
    attributes = parse_pairs(cursor)
    end = cursor.end_line()
    ports, clauses, children = parse_tree_block(cursor, level)
    return Tree(start, end, name, attributes, ports, clauses, children)


def parse_entry_key(cursor: Cursor) -> Word | None:
    """BRACED"""
    if cursor.kind == BRACED:
        return cursor.take()
    key = unquote(cursor.raw).strip("{}") if cursor.kind == STRING else cursor.raw
    fixes = (write_fix(f"{{{key}}}", cursor.here()),) if is_name(key) else ()
    notes: tuple[str, ...] = ()
    if topic := _TOPIC.match(cursor.text, cursor.here().start):
        notes = ("the topic from which `btq verify` takes samples goes under `[evidence.signals]` in btq.toml",)
        fixes = (write_fix(f"{{{topic[2]}}}", Span(topic.start(), topic.end())),)
    cursor.expected("a blackboard entry: `{key}`", notes, fixes)
    return None


# ---- what productions ask and report ----


def port_of_cpp(cursor: Cursor, declared: re.Match[str]) -> tuple[Fix, ...]:
    """The fix for `InputPort<double> speed` and `std::string place`, in the words of C++."""
    end = line_end(cursor.text, declared.end())
    direction = _DIRECTIONS_OF_CPP[declared["port"] or "InputPort"]
    type_ = declared["type"] or declared["bare"]
    if cursor.text[declared.end() : end].partition("#")[0].strip():
        return ()
    plain = type_ is not None and _PLAIN_TYPE.fullmatch(type_) is not None
    after = "" if type_ is None else f" : {type_ if plain else quote(type_)}"
    return (write_fix(f"{direction} {declared['name']}{after}", Span(declared.start(), declared.end())),)


def accept_selection(cursor: Cursor, word: str, others: tuple[tuple[str, ...], ...]) -> bool:
    """Skip a word between selectors, or report and skip others for it."""
    length = is_selection(cursor, others)
    if not length:
        return cursor.accept_word(word)
    last = cursor.index + length - 1
    span = Span(cursor.here().start, cursor.starts[last] + len(cursor.raws[last]))
    written = cursor.text[span.start : span.end]
    fix = replace_fix(f"Replace `{written}` with `{word}`", span, word)
    cursor.complain(span, f"expected `{word}`, found `{written}`", fix)
    cursor.go_to(last + 1)
    return True


def is_selection(cursor: Cursor, others: tuple[tuple[str, ...], ...]) -> int:
    """The number of words here that are one of `others` and precede a selector; 0 if none are."""
    if cursor.kind != NAME:
        return 0
    lengths = [len(words) for words in others if tuple(cursor.raws[cursor.index : cursor.index + len(words)]) == words]
    length = max(lengths, default=0)
    return length if cursor.kinds[cursor.index + length] in (NAME, STRING) else 0


def selects_all(cursor: Cursor) -> bool:
    """Report `apply r to *` and `apply r to every node`."""
    is_every = cursor.kind == NAME and cursor.raw in ("every", "all", "each", "any")
    is_further = is_every and cursor.raws[cursor.index + 1] in ("*", "nodes")
    last = cursor.index + is_further
    if not (is_further or cursor.at("*") or cursor.at_word("every")) or cursor.raws[last + 1] not in _END_SELECTORS:
        return False
    span = Span(cursor.here().start, cursor.starts[last] + len(cursor.raws[last]))
    cursor.complain(span, "no selector names all nodes", notes=(SELECTORS,))
    cursor.go_to(last + 1)
    return True


def unquoted_path(cursor: Cursor) -> Word | None:
    """Report `include stations.btq`, whose path lacks quotes."""
    has_sign = cursor.at(":") or cursor.at("=")
    first = cursor.index + 1 if has_sign and cursor.kinds[cursor.index + 1] != NEWLINE else cursor.index
    start = cursor.starts[first]
    end = after = path_end(cursor.text, start)
    for index in range(first, len(cursor.kinds)):
        if cursor.kinds[index] == ERROR and cursor.raws[index] in ("'", '"'):  # only the opening quote is missing
            end, after = cursor.starts[index], cursor.starts[index] + 1
    title, path = "Put quotes around it", quote(cursor.text[start:end])
    fixes: tuple[Fix, ...] = ()
    if cursor.at("<") and (closing := cursor.text.find(">", start, line_end(cursor.text, start))) > start + 1:
        path = quote(cursor.text[start + 1 : closing].strip())
        fixes = (write_fix(path, Span(start, closing + 1)),)
    elif end > start and first > cursor.index:
        fixes = (without_sign(cursor, title, after, path, safe=False),)
    elif end > start and not has_sign:
        fixes = (replace_fix(title, Span(start, after), path),)
    cursor.expected("a file in quotes", (), fixes)
    return None


def without_sign(cursor: Cursor, title: str, end: int, text: str, *, safe: bool) -> Fix:
    """A fix that replaces everything from the `:` or `=` after `include` up to `end`, keeping a blank."""
    start = cursor.starts[cursor.index]
    blank = "" if cursor.text[start - 1] in " \t" else " "
    return replace_fix(title, Span(start, end), f"{blank}{text}", safe=safe)


def at_unit(cursor: Cursor, name: Word) -> bool:
    """ ":" before the unit of a signal; its absence is reported"""
    if cursor.accept(":"):
        return True
    unit = cursor.index + 1
    notes: tuple[str, ...] = ()
    fixes: tuple[Fix, ...] = ()
    if (cursor.at("=") or cursor.kind == NAME) and cursor.kinds[unit] == BRACED:
        notes = (_a_signal(name.raw, cursor.raws[unit]),)
    elif cursor.kind == NAME and sort_of(name.raw):
        notes = (_a_signal(cursor.raw, f"{{{cursor.raw}}}"),)
    elif cursor.at("=") and cursor.kinds[unit] == QUANTITY and cursor.kinds[unit + 1] == NEWLINE:
        raw = cursor.raws[unit]
        symbol = raw[number_end(raw, 0) :].strip()
        span = Span(cursor.here().start, cursor.starts[unit] + len(raw))
        fixes = (write_fix(f": {symbol} initially {raw}", span),)
    elif cursor.kind == OPEN and CLOSE in cursor.kinds[unit:]:
        closing = cursor.kinds.index(CLOSE, unit)
        inside = cursor.text[cursor.here().end : cursor.starts[closing]].strip()
        span = Span(cursor.here().start, cursor.starts[closing] + len(cursor.raws[closing]))
        fixes = (write_fix(f": {inside}", span),) if is_unit(inside) else ()
    elif cursor.at("=") or cursor.at_word("in") or cursor.at_word("is"):
        fixes = (write_fix(":", cursor.here()),)
    cursor.expected("`:` and the signal's unit", notes, fixes)
    return False


def from_meant(cursor: Cursor) -> bool:
    """Report `= {speed}` after the unit of a signal, and read it as `from {speed}`."""
    is_meant = cursor.at("=") or (cursor.kind == NAME and cursor.raw in _NOT_FROM)
    if not is_meant or cursor.kinds[cursor.index + 1] != BRACED:
        return False
    cursor.complain(
        cursor.here(), f"expected `from`, found `{cursor.raw}`", write_fix("from", cursor.here(), safe=True)
    )
    cursor.advance()
    return True


def _a_signal(name: str, entry: str) -> str:
    return f"write `signal {name} : <unit> from {entry}`; a unit is `m/s`, `s`, `%`, `bool`, `text` or `1`"


_A_PORT: Final = "a port is written `input name : type`"
_DIRECTIONS_OF_CPP: Final = {"InputPort": "input", "OutputPort": "output", "BidirectionalPort": "inout"}
_OF_CPP: Final = re.compile(
    r"(?:(?:BT::)?(?P<port>InputPort|OutputPort|BidirectionalPort)[ \t]*(?:<(?P<type>[^()\"\r\n]*)>)?"
    r"|(?P<bare>(?:std::)?(?:string|bool|double|float|int|unsigned|vector<[^()\"\r\n]*>)))"
    r"[ \t(]+(?P<quote>\"?)(?P<name>[^\W\d]\w*)(?P=quote)\)?;?(?![ \t]*:)"
)
_PLAIN_TYPE: Final = re.compile(r"\w+(?:::\w+)*")
_NOT_FROM: Final = frozenset(("in", "is", "of", "at", "reads", "source"))
_TOPIC: Final = re.compile(r"([\"']?)/(?:\w+/)*([^\W\d]\w*)\1")
_BEHAVIOURS: Final = frozenset(("level", "counter", "gauge"))
_SIGNAL_WORDS: Final = ("from", *sorted(_BEHAVIOURS), "fresh", "initially")
_SIGNAL_ORDER: Final = "the order is: signal x : % from {x} level fresh within 5 s initially 100 %"
SELECTORS: Final = (
    "write `every` and an ID or kind, `every MoveBase`; `every node tagged …`; or list the nodes, with `,` between them"
)
_EXCEPT: Final = (
    *(("but",), ("without",), ("excluding",), ("excepting",), ("unless",), ("not",), ("minus",), ("but", "not")),
    *(("other", "than"), ("except", "for"), ("apart", "from"), ("and", "not")),
)
_UNDER: Final = tuple((word,) for word in ("in", "of", "inside", "within", "below", "from", "at", "on"))
_END_SELECTORS: Final = frozenset((",", "except", "\n", "\r\n", "\r", ""))

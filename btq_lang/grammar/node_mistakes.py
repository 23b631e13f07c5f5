"""What people write in place of a node, and the report of it: XML, comments of other languages, missing brackets."""

from __future__ import annotations

import re
from typing import Final

from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, replace_fix, write_fix
from btq_lang.grammar.attributes import attaches_nothing, meant_clause
from btq_lang.grammar.claim_words import VERB_WORDS
from btq_lang.grammar.conditions import COMPARISONS, HEADS
from btq_lang.grammar.cursor import VALUES, Cursor, shown
from btq_lang.syntax.scan import line_end, line_start
from btq_lang.syntax.suggestions import ATTRIBUTES, CHILDREN, are_plain_pairs, attributes_in_braces
from btq_lang.syntax.tokens import (
    BRACED,
    CATEGORIES,
    CLOSE,
    NAME,
    NEWLINE,
    NODE_CLAUSES,
    NUMBER,
    OPEN,
    OPERATOR,
    QUANTITY,
    STRING,
    SYMBOL,
    SYMBOLS,
)
from btq_lang.syntax.tree import NodeClause, Word, quote
from btq_lang.util.text import Span


def no_node(cursor: Cursor) -> None:
    """Report a line in a tree that does not begin a node."""
    start = cursor.starts[cursor.index]
    if cursor.text.startswith("<!--", start):
        other_comment(cursor, start + len("<!--"))
    elif cursor.at("<"):
        found_xml(cursor)
        cursor.go_to(len(cursor.kinds) - 1)
    elif not condition_as_node(cursor):
        is_negation = cursor.raw == "!" and cursor.kinds[cursor.index + 1] in (NAME, STRING)
        notes = ("to negate a node, put an `Inverter` above it, and indent the node",) if is_negation else ()
        fixes = inverter(cursor) if is_negation else symbol_meant(cursor)
        cursor.expected("a node: its kind, or a symbol: -> ? || …", notes, fixes)


def leftover(cursor: Cursor, kind: Word | None, has_label: bool, clauses: list[NodeClause]) -> None:
    """Report what is left of a node's line."""
    if kind is not None and kind.kind == NAME and kind.raw in STATEMENTS and cursor.raws[-2] == ":":
        message = f"expected a node, found the statement `{kind.raw}`"
        cursor.complain(kind.span.shifted(cursor.base), message, notes=(STATEMENTS[kind.raw],))
    elif kind is not None and kind.kind == NAME and (kind.raw in VERB_WORDS or kind.raw in HEADS):
        message = f"unexpected clause `{kind.raw}` in a tree; clauses go in a requirement"
        note = "write `satisfies QualityReq` and an ID before it, or indent it below a line that does"
        if kind.raw == "on" and not cursor.is_word(cursor.index - 1, "violation"):
            note = "after a failure, a Fallback `?` runs its next child; `_onFailure` on a node runs a script"
        cursor.complain(kind.span.shifted(cursor.base), message, notes=(note,))
    elif cursor.kind == SYMBOL and cursor.index == 1 and kind is not None and kind.raw.upper() + cursor.raw in SYMBOLS:
        span = Span(kind.start + cursor.base, cursor.here().end)
        symbol = kind.raw.upper() + cursor.raw
        cursor.complain(span, f"the symbol is written `{symbol}`", write_fix(symbol, span, safe=True))
    elif cursor.at("*") and kind is not None and kind.kind == SYMBOL and cursor.index == 1 and cursor.adjacent(1):
        with_memory(cursor, 0, 0, 1)
    elif cursor.kind == OPERATOR and condition_as_node(cursor):
        pass
    elif cursor.kind == NAME and (meant := meant_clause(cursor.raw)):
        attaches_nothing(cursor, cursor.here(), meant)
    elif cursor.at(",") and kind is not None and kind.kind == NAME and (meant := meant_clause(kind.raw)):
        attaches_nothing(cursor, kind.span.shifted(cursor.base), meant)
    elif at_bare_value(cursor) and cursor.index > 0 and cursor.kinds[cursor.index - 1] in (NAME, STRING):
        bare_attributes(cursor)
    elif cursor.at_key() and has_label and OPEN not in cursor.kinds and not clauses:
        cursor.advance()
        bare_attributes(cursor)
    elif cursor.at_name() and cursor.kinds[cursor.index - 1] == CLOSE and ends_label(cursor, clauses):
        label_after_brackets(cursor, kind, has_label)
    elif cursor.at("-") and cursor.text.startswith("-- ", cursor.here().start):
        other_comment(cursor, cursor.here().start + 2)
    elif clauses and cursor.at_name():
        end = cursor.last_end() + cursor.base
        fixes = (replace_fix("Put `,` before it", Span(end, end), ","),) if cursor.kind in (NAME, STRING) else ()
        cursor.expected("`,` or the end of the line", (), fixes)
    elif cursor.kind == OPEN and cursor.index > 0 and cursor.kinds[cursor.index - 1] == CLOSE:
        cursor.complain(cursor.here(), "all attributes of a node go in one pair of brackets")
    elif cursor.kind == BRACED and (mended := attributes_in_braces(cursor.text, cursor.here().start)):
        cursor.complain(cursor.here(), ATTRIBUTES, mended)
    elif cursor.kind in (NUMBER, QUANTITY, BRACED):
        cursor.expected("the end of the line", ("values go in brackets, with their names: `(key = value)`",))
    elif cursor.at(",") or cursor.kind == SYMBOL:
        cursor.expected("the end of the line", (CHILDREN,))
    elif cursor.kind == NAME and cursor.raw in ("if", "when", "while", "unless"):
        cursor.expected("the end of the line", (_ONLY_IF,))
    else:
        return
    cursor.go_to(len(cursor.kinds) - 1)


def skip_dash(cursor: Cursor) -> None:
    """Report and skip the dash of a list, as in YAML and Markdown: `- Go`."""
    following = cursor.index + 1
    if not (cursor.at("-") or cursor.at("*")) or cursor.kinds[following] not in (NAME, SYMBOL, STRING):
        return
    if symbol_meant(cursor):
        return
    if cursor.at("*") and cursor.kinds[following] == SYMBOL and cursor.adjacent(following):
        with_memory(cursor, following, cursor.index, following)
        cursor.advance()
        return
    fix = replace_fix(f"Remove `{cursor.raw}`", Span(cursor.here().start, cursor.starts[following]), "", safe=True)
    note = "a node needs no dash; its children go below it, indented"
    cursor.complain(cursor.here(), f"unexpected `{cursor.raw}` before a node", fix, notes=(note,))
    cursor.advance()


def is_doc_string(cursor: Cursor) -> bool:
    """Whether the line is a triple-quoted string, as in Python."""
    following = cursor.index + 1
    return cursor.raw in ('""', "''") and cursor.kinds[following] == STRING and cursor.adjacent(following)


def is_after_dashes(cursor: Cursor) -> bool:
    """Whether the line is a comment in the syntax of SQL, Lua and others: `-- drives home`."""
    start = cursor.here().start
    after = cursor.text[start + 2 : start + 3]
    return cursor.at("-") and cursor.text.startswith("--", start) and (after.isalpha() or after.isspace())


def other_comment(cursor: Cursor, inner: int) -> None:
    """Report a comment of another language, which begins at the current token; its text begins at `inner`."""
    start = cursor.here().start
    span = Span(start, line_end(cursor.text, start))
    inside = cursor.text[inner : span.end].rstrip()
    for sign in _COMMENT_ENDS:
        inside = inside.removesuffix(sign)
    fixes = (replace_fix("Write `#`", span, f"# {inside.strip()}"),) if "\n" not in cursor.raw else ()
    cursor.complain(span, "a comment begins with `#`", *fixes)
    cursor.go_to(len(cursor.kinds) - 1)


def inverter(cursor: Cursor) -> tuple[Fix, ...]:
    """The fix for `!Dark`."""
    sign = Span(cursor.here().start, cursor.starts[cursor.index + 1])
    below = line_below(cursor)
    return (replace_fix("Put an `Inverter` above it", sign, f"Inverter{below}"),) if below else ()


def line_below(cursor: Cursor) -> str:
    """The line end and the indentation of a line that is one step deeper than the current one; empty if the current
    one does not begin with its first token.
    """
    margin = cursor.text[line_start(cursor.text, 0, cursor.starts[0]) : cursor.starts[0]]
    step = "\t" if margin.startswith("\t") else "    "
    return "" if margin.strip() else f"\n{margin}{step}"


def found_xml(cursor: Cursor) -> None:
    """Report that the current line is XML; the fix writes an element as a node."""
    start = cursor.starts[cursor.index]
    span = Span(start, start + len(cursor.text[start : line_end(cursor.text, start)].rstrip()))
    tag = _TAG.fullmatch(cursor.text, start, span.end)
    if tag is None or tag[1] in _NOT_NODES:
        cursor.complain(span, "expected btq, found XML", notes=(XML,))
        return
    written = f"{tag[1]} ({tag[2].strip()})" if tag[2].strip() else tag[1]
    fixes = [write_fix(written, span)] if tag[3] else []
    cursor.complain(span, f"expected btq, found XML: a node is written `{written}`", *fixes, notes=(XML,))


def skip_xml(cursor: Cursor, level: int) -> None:
    """Skip the lines of XML that follow a reported one."""
    while cursor.more and cursor.lexer.level == level and cursor.text.startswith("<", cursor.lexer.position):
        count = len(cursor.lexer.problems)
        cursor.scan()
        del cursor.lexer.problems[count:]
        cursor.go_to(len(cursor.kinds) - 1)
        cursor.end_line()
        cursor.skip_block(level)


def at_bare_value(cursor: Cursor) -> bool:
    """Whether the next tokens are `= value` or `: value`, outside brackets."""
    return cursor.at("=") or (cursor.at(":") and cursor.kinds[cursor.index + 1] in VALUES)


def symbol_meant(cursor: Cursor) -> tuple[Fix, ...]:
    """The fix for what is probably meant as a symbol: `-->`, `=>`, `- >`."""
    start = cursor.starts[cursor.index]
    run = _ARROW.match(cursor.text, start)
    return (write_fix("->", Span(start, run.end())),) if run else ()


def with_memory(cursor: Cursor, symbol: int, first: int, last: int) -> None:
    """Report `->*` or `*->`: the tokens from `first` to `last`; one of them is the symbol."""
    plain = cursor.raws[symbol].replace("→", "->").lstrip("M")
    span = Span(cursor.starts[first], cursor.starts[last] + len(cursor.raws[last]))
    if f"M{plain}" in SYMBOLS:
        fixes = write_fix(f"M{plain}", span), write_fix(plain, span)
        cursor.complain(span, f"the symbol with memory is written `M{plain}`", *fixes, notes=(_WITH_MEMORY,))
    else:
        notes = (_MEMORY,) if plain == "?" else ()
        cursor.complain(span, f"the symbol is written `{plain}`", write_fix(plain, span), notes=notes)


def condition_as_node(cursor: Cursor) -> bool:
    """Report `battery > 20` and `speed := 3`, which are a ScriptCondition and a Script."""
    first = 1 if cursor.raws[0] in ("if", "Condition", "when", "unless") else 0
    signs = [index for index in range(first, len(cursor.raws)) if cursor.kinds[index] == OPERATOR]
    signs = [
        index for index in signs if cursor.raws[index] in COMPARISONS or cursor.raws[index : index + 2] == [":", "="]
    ]
    last = len(cursor.kinds) - 2
    if not signs or SYMBOL in cursor.kinds or cursor.raws[0] in ("Script", "ScriptCondition"):
        return False
    right = signs[0] + (2 if cursor.raws[signs[0]] == ":" else 1)
    if signs[0] == first or cursor.kinds[signs[0] - 1] not in VALUES or cursor.kinds[right] not in VALUES:
        return False
    begin, end = cursor.starts[first], cursor.starts[last] + len(cursor.raws[last])
    span = Span(cursor.starts[0], end)
    kind = "Script" if cursor.raws[signs[0]] == ":" else "ScriptCondition"
    code = _ENTRY.sub(r"\1", cursor.text[begin:end])
    for word, sign in ((" and ", " && "), (" or ", " || ")):
        code = code.replace(word, sign)
    has_unit = QUANTITY in cursor.kinds[first:]
    written = f"{kind} (code = {quote(code)})"
    what = "an assignment" if kind == "Script" else "a condition"
    notes = ("a script has numbers without units",) if has_unit else ()
    fixes = (write_fix(written, span),) if not has_unit and cursor.raws[0] != "unless" else ()
    example = written if fixes else f'{kind} (code = "…")'
    cursor.complain(span, f"{what} is not a node: write `{shown(example)}`", *fixes, notes=notes)
    return True


def child_on_the_line(cursor: Cursor, label: Word | None) -> bool:
    """Report `Inverter Condition Dark`, whose child lacks a line of its own; False if there is none."""
    index = cursor.index
    if label is not None and cursor.starts[index - 1] == label.start + cursor.base:
        index -= 1
    if not (index and cursor.kinds[index] == NAME and cursor.raws[index] in CATEGORIES):
        return False
    if cursor.kinds[index + 1] not in (NAME, STRING) or cursor.raws[index + 1] in NODE_CLAUSES:
        return False
    start, end = cursor.starts[index], cursor.starts[-2] + len(cursor.raws[-2])
    before = cursor.starts[index - 1] + len(cursor.raws[index - 1])
    below = line_below(cursor)
    fixes = (replace_fix("Put it on a line of its own", Span(before, start), below),) if below else ()
    cursor.complain(Span(start, end), CHILD, *fixes)
    cursor.go_to(len(cursor.kinds) - 1)
    return True


def ends_label(cursor: Cursor, clauses: list[NodeClause]) -> bool:
    """Whether the current name may be the label of a node: only clauses follow, and the brackets before it are the
    node's own.
    """
    following = cursor.index + 1
    if clauses and clauses[-1].end == cursor.last_end():
        return False
    return cursor.kinds[following] == NEWLINE or cursor.raws[following] in NODE_CLAUSES


def label_after_brackets(cursor: Cursor, kind: Word | None, has_label: bool) -> None:
    """Report `Retry (num_attempts = 5) Again`, where the label belongs before the brackets."""
    opened = cursor.starts[cursor.kinds.index(OPEN)]
    if has_label or kind is None:
        cursor.expected("the end of the line", ("a node has one label, before its brackets",))
        return
    label = Span(cursor.last_end() + cursor.base, cursor.here().end)
    changes = (FixEdit(Place(Span(opened, opened)), f"{cursor.raw} "), FixEdit(Place(label), ""))
    if cursor.text[opened - 1] not in " \t":
        changes = (FixEdit(Place(Span(opened, opened)), f" {cursor.raw} "), changes[1])
    fix = Fix(f"Move `{shown(cursor.raw)}` before the brackets", changes)
    cursor.complain(cursor.here(), "a node's label goes before its brackets", fix, notes=(CHILD,))


def bare_attributes(cursor: Cursor) -> None:
    """Report `MoveBase station = "charger"`, and several lines `key = value` once."""
    lexer = cursor.lexer
    start, end = cursor.starts[cursor.index - 1], cursor.starts[-2] + len(cursor.raws[-2])
    if cursor.index == 1 and OPEN not in cursor.kinds:
        is_next = cursor.bare_until >= 0 and not cursor.text[cursor.bare_until : lexer.line_start].strip()
        cursor.bare_until = lexer.position
        lexer.ended_early = 1  # the `)` after them is not another mistake
        if is_next:
            return
    tail = range(cursor.index, len(cursor.kinds))
    plain = cursor.index > 1
    plain = plain and not any(cursor.kinds[index] == OPEN or cursor.raws[index] in NODE_CLAUSES for index in tail)
    changes: tuple[FixEdit, ...] = (FixEdit(Place(Span(start, start)), "("),)
    for index in tail:
        if cursor.is_operator(index, ":"):
            sign = cursor.starts[index]
            written = "=" if cursor.text[sign - 1] in " \t" else " ="
            changes += (FixEdit(Place(Span(sign, sign + 1)), written),)
    closing = [problem for problem in lexer.problems[cursor.known :] if is_stray_bracket(cursor, problem)]
    if not closing:  # else the `(` is missing
        changes += (FixEdit(Place(Span(end, end)), ")"),)
    safe = plain and not closing and are_plain_pairs(cursor.text[start:end])
    fixes = (Fix("Put brackets around them", changes, safe),) if plain or closing else ()
    cursor.complain_instead(closing[-1:], Diagnostic("syntax-error", Span(start, end), BARE, fixes=fixes))


def is_stray_bracket(cursor: Cursor, problem: Diagnostic) -> bool:
    return problem.rule == "syntax-error" and cursor.text.startswith(")", problem.span.start)


XML: Final = (
    "if this is BehaviorTree.CPP XML, rename the file to .xml, or convert it with `btq import`; "
    "a comment begins with `#`, not `<!--`"
)
BARE: Final = "attributes go in brackets: `(key = value)`"
CHILD: Final = "a child goes on a line of its own below its parent, indented"
STATEMENTS: Final = {
    **dict.fromkeys(("if", "elif", "else"), "to choose, use a Fallback `?` with a Condition, or `_skipIf` on the node"),
    **dict.fromkeys(("while", "for"), "to repeat, use `Repeat`, `Retry` or `KeepRunningUntilFailure`"),
}
_TAG: Final = re.compile(r"""<([^\W\d]\w*)((?:\s+[\w:]+\s*=\s*(?:"[^"<]*"|'[^'<]*'))*)\s*(/?)>""")
_NOT_NODES: Final = frozenset(("root", "BehaviorTree", "TreeNodesModel", "include"))
_COMMENT_ENDS: Final = ("-->", '"""', "'''")
_ONLY_IF: Final = (
    "a node that runs only if something holds goes below a Precondition, or after a Condition in a Sequence `->`"
)
_WITH_MEMORY: Final = (
    "`->` goes on with the child that is running; `M->` goes on with the one that failed too, when it is ticked again"
)
_MEMORY: Final = "`?` goes on with the child that is running; `R?` begins with the first one at every tick"
_ENTRY: Final = re.compile(r"\{(@?[^\W\d]\w*)\}")
_ARROW: Final = re.compile(r"[-=~]+ ?>")

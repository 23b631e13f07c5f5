"""The part of the parser that reads the block of a tree: nodes, ports, and the requirements between them.

Nodes nest by indentation, so their blocks are a stack of open nodes, without recursion.
"""

from __future__ import annotations

import re
from typing import Final

from btq_lang.catalog.literals import is_known_type, plain_type
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, replace_fix, write_fix
from btq_lang.grammar.attributes import AttributeParser, meant_clause
from btq_lang.grammar.claims import VERB_WORDS
from btq_lang.grammar.conditions import COMPARISONS, HEADS
from btq_lang.grammar.cursor import VALUES, shown
from btq_lang.lexer import Lexer
from btq_lang.syntax.scan import line_end, line_start
from btq_lang.syntax.suggestions import ATTRIBUTES, CHILDREN, are_plain_pairs, attributes_in_braces
from btq_lang.syntax.tokens import (
    BRACED,
    CATEGORIES,
    CLOSE,
    DIRECTIONS,
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
from btq_lang.syntax.tree import (
    Node,
    NodeClause,
    Pair,
    Port,
    Requirement,
    Satisfies,
    TypeWord,
    Verbatim,
    Word,
    is_name,
    quote,
)
from btq_lang.syntax.words import unquote
from btq_lang.util.record import replace
from btq_lang.util.text import Span


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


class NodeParser(AttributeParser):
    """A cursor that can read the block of a tree."""

    def __init__(self, lexer: Lexer) -> None:
        super().__init__(lexer)
        self.bare_until = -1  # the end of the last line `key = value` without brackets

    def tree_block(self, level: int) -> tuple[tuple[Port, ...], tuple[NodeClause, ...], tuple[Node | Verbatim, ...]]:
        """INDENT { Port } { ClauseLine } { Node } DEDENT"""
        lexer = self.lexer
        ports: list[Port] = []
        block = OpenBlock(level, None)
        blocks = [block]
        is_too_deep_reported = False
        while self.more and lexer.level > level:
            inner = lexer.level
            while block.level >= inner:
                blocks.pop().close()
                block = blocks[-1]
            self.scan()
            if self.kind == NAME and self.raw in _NO_KINDS and self.other_line(inner, blocks, ports):
                continue
            if len(blocks) > MAX_DEPTH:
                if not is_too_deep_reported:
                    is_too_deep_reported = True
                    self.complain(self.here(), _TOO_DEEP, notes=(OF_ITS_OWN,), rule="nested-too-deep")
                blocks.pop().close()
                block = blocks[-1]
            node = self.node(inner)
            if node is None:
                continue
            block.children.append(node)
            if self.more and lexer.level > inner:
                block = OpenBlock(inner, node)
                blocks.append(block)
        for open_block in blocks:
            open_block.close()
        return tuple(ports), tuple(blocks[0].clauses), tuple(blocks[0].children)

    def other_line(self, level: int, blocks: list[OpenBlock], ports: list[Port]) -> bool:
        """ClauseLine | Port | Verbatim, into the last of the open blocks; False where the current word begins a node"""
        block = blocks[-1]
        word = self.raw
        if word in NODE_CLAUSES:
            if len(blocks) > 1 or block.has_nodes():
                block.clauses += self.clause_line_after(level, block.children)
            else:  # the tree's own: XML may precede it, as it may be among ports
                block.clauses += self.clause_line(level)
        elif word == "QualityReq" and self.is_requirement():
            block.clauses.append(self.requirement_line(level))
        elif word == "xml":
            block.children.append(self.verbatim())
            self.no_block(level)
        elif word in DIRECTIONS and len(blocks) == 1 and not block.has_nodes():
            if block.clauses:
                self.complain(self.here(), "ports go before satisfices, satisfies and tags")
            ports.append(self.port())
            self.no_block(level)
        elif word in DIRECTIONS and self.kinds[self.index + 1] == NAME and self.is_operator(self.index + 2, ":"):
            self.port_below_node(blocks[0])
            ports.append(self.port())
            self.no_block(level)
        else:
            return False
        return True

    def port_below_node(self, tree: OpenBlock) -> None:
        """Report `input shelf : string` below a node or after one; the fix moves the line to the tree's first one."""
        at, text = self.here(), self.text
        own = Span(line_start(text, 0, at.start), line_end(text, at.end))
        newline = "\r\n" if text.startswith("\r\n", own.end) else text[own.end : own.end + 1]
        fixes: tuple[Fix, ...] = ()
        first = tree.children[0] if tree.children and not tree.clauses else None
        if first is not None and newline:
            start = first.start + self.base
            line = line_start(text, 0, start)
            moved = f"{text[line:start]}{text[at.start : own.end]}{newline}"
            changes = (
                FixEdit(Place(Span(line, line)), moved),
                FixEdit(Place(Span(own.start, own.end + len(newline))), ""),
            )
            fixes = (Fix("Move it to the first line below the tree's own", changes),)
        self.complain(at, "the ports of a tree go directly below its own line, before its node", *fixes)

    def node(self, level: int) -> Node | None:
        """Kind [ Label ] [ Attributes ] { NodeClause } NL"""
        if self.is_after_dashes():
            self.other_comment(self.here().start + 2)
            self.end_line()
            return None
        if self.kind == OPERATOR:
            self.skip_dash()
        start = self.starts[self.index] - self.base
        category: Word | None = None
        kind: Word | None = None
        if self.kind == NAME and self.raw in CATEGORIES:
            category = self.take()
            self.skip_glued_colon()
            if self.at_label():
                kind = self.take()
        elif self.kind == STRING and self.is_doc_string():
            self.other_comment(self.here().start + 3)
            self.end_line()
            return None
        elif self.kind == NAME or self.kind == SYMBOL or self.kind == STRING:
            kind = self.take()
            if self.kind == OPERATOR and kind.raw not in _STATEMENTS:
                self.skip_last_sign()
        else:
            self.no_node()
            self.end_line()
            self.skip_block(level)
            self.skip_xml(level)
            return None
        clauses: list[NodeClause] = []
        label = None
        if self.kind == NAME and self.kinds[self.index + 1] in (NAME, STRING) and (meant := self.misspelt_clause()):
            clauses.append(self.node_clause(meant))
        elif self.at_label():
            label = self.take()
        attributes: tuple[Pair, ...] = ()
        if self.kind == OPEN:
            attributes = self.attributes(clauses)
        while self.kind == NAME and self.raw in NODE_CLAUSES:
            clauses.append(self.node_clause())
        bare = False
        if self.kind != NEWLINE:
            bare = self.index == 1 and self.at_bare_value()  # `key = value` after a forgotten bracket
            if not self.child_on_the_line(label):
                self.leftover(kind, label is not None, clauses)
        end = self.end_line()
        if bare and not self.deeper(level):
            return None
        return Node(start, end, category, kind, label, attributes, tuple(clauses) if clauses else (), ())

    def skip_dash(self) -> None:
        """Report and skip the dash of a list, as in YAML and Markdown: `- Go`."""
        following = self.index + 1
        if not (self.at("-") or self.at("*")) or self.kinds[following] not in (NAME, SYMBOL, STRING):
            return
        if self.symbol_meant():
            return
        if self.at("*") and self.kinds[following] == SYMBOL and self.adjacent(following):
            self.with_memory(following, self.index, following)
            self.advance()
            return
        fix = replace_fix(f"Remove `{self.raw}`", Span(self.here().start, self.starts[following]), "", safe=True)
        note = "a node needs no dash; its children go below it, indented"
        self.complain(self.here(), f"unexpected `{self.raw}` before a node", fix, notes=(note,))
        self.advance()

    def is_doc_string(self) -> bool:
        """Whether the line is a triple-quoted string, as in Python."""
        following = self.index + 1
        return self.raw in ('""', "''") and self.kinds[following] == STRING and self.adjacent(following)

    def is_after_dashes(self) -> bool:
        """Whether the line is a comment in the syntax of SQL, Lua and others: `-- drives home`."""
        start = self.here().start
        after = self.text[start + 2 : start + 3]
        return self.at("-") and self.text.startswith("--", start) and (after.isalpha() or after.isspace())

    def other_comment(self, inner: int) -> None:
        """Report a comment of another language, which begins at the current token; its text begins at `inner`."""
        start = self.here().start
        span = Span(start, line_end(self.text, start))
        inside = self.text[inner : span.end].rstrip()
        for sign in _COMMENT_ENDS:
            inside = inside.removesuffix(sign)
        fixes = (replace_fix("Write `#`", span, f"# {inside.strip()}"),) if "\n" not in self.raw else ()
        self.complain(span, "a comment begins with `#`", *fixes)
        self.go_to(len(self.kinds) - 1)

    def no_node(self) -> None:
        """Report a line in a tree that does not begin a node."""
        start = self.starts[self.index]
        if self.text.startswith("<!--", start):
            self.other_comment(start + len("<!--"))
        elif self.at("<"):
            self.found_xml()
            self.go_to(len(self.kinds) - 1)
        elif not self.condition_as_node():
            is_negation = self.raw == "!" and self.kinds[self.index + 1] in (NAME, STRING)
            notes = ("to negate a node, put an `Inverter` above it, and indent the node",) if is_negation else ()
            fixes = self.inverter() if is_negation else self.symbol_meant()
            self.expected("a node: its kind, or a symbol: -> ? || …", notes, fixes)

    def inverter(self) -> tuple[Fix, ...]:
        """The fix for `!Dark`."""
        sign = Span(self.here().start, self.starts[self.index + 1])
        below = self.line_below()
        return (replace_fix("Put an `Inverter` above it", sign, f"Inverter{below}"),) if below else ()

    def line_below(self) -> str:
        """The line end and the indentation of a line that is one step deeper than the current one; empty if the current
        one does not begin with its first token.
        """
        margin = self.text[line_start(self.text, 0, self.starts[0]) : self.starts[0]]
        step = "\t" if margin.startswith("\t") else "    "
        return "" if margin.strip() else f"\n{margin}{step}"

    def found_xml(self) -> None:
        """Report that the current line is XML; the fix writes an element as a node."""
        start = self.starts[self.index]
        span = Span(start, start + len(self.text[start : line_end(self.text, start)].rstrip()))
        tag = _TAG.fullmatch(self.text, start, span.end)
        if tag is None or tag[1] in _NOT_NODES:
            self.complain(span, "expected btq, found XML", notes=(XML,))
            return
        written = f"{tag[1]} ({tag[2].strip()})" if tag[2].strip() else tag[1]
        fixes = [write_fix(written, span)] if tag[3] else []
        self.complain(span, f"expected btq, found XML: a node is written `{written}`", *fixes, notes=(XML,))

    def skip_xml(self, level: int) -> None:
        """Skip the lines of XML that follow a reported one."""
        while self.more and self.lexer.level == level and self.text.startswith("<", self.lexer.position):
            count = len(self.lexer.problems)
            self.scan()
            del self.lexer.problems[count:]
            self.go_to(len(self.kinds) - 1)
            self.end_line()
            self.skip_block(level)

    def at_bare_value(self) -> bool:
        """Whether the next tokens are `= value` or `: value`, outside brackets."""
        return self.at("=") or (self.at(":") and self.kinds[self.index + 1] in VALUES)

    def symbol_meant(self) -> tuple[Fix, ...]:
        """The fix for what is probably meant as a symbol: `-->`, `=>`, `- >`."""
        start = self.starts[self.index]
        run = _ARROW.match(self.text, start)
        return (write_fix("->", Span(start, run.end())),) if run else ()

    def leftover(self, kind: Word | None, has_label: bool, clauses: list[NodeClause]) -> None:
        """Report what is left of a node's line."""
        if kind is not None and kind.kind == NAME and kind.raw in _STATEMENTS and self.raws[-2] == ":":
            message = f"expected a node, found the statement `{kind.raw}`"
            self.complain(kind.span.shifted(self.base), message, notes=(_STATEMENTS[kind.raw],))
        elif kind is not None and kind.kind == NAME and (kind.raw in VERB_WORDS or kind.raw in HEADS):
            message = f"unexpected clause `{kind.raw}` in a tree; clauses go in a requirement"
            note = "write `satisfies QualityReq` and an ID before it, or indent it below a line that does"
            if kind.raw == "on" and not self.is_word(self.index - 1, "violation"):
                note = "after a failure, a Fallback `?` runs its next child; `_onFailure` on a node runs a script"
            self.complain(kind.span.shifted(self.base), message, notes=(note,))
        elif self.kind == SYMBOL and self.index == 1 and kind is not None and kind.raw.upper() + self.raw in SYMBOLS:
            span = Span(kind.start + self.base, self.here().end)
            symbol = kind.raw.upper() + self.raw
            self.complain(span, f"the symbol is written `{symbol}`", write_fix(symbol, span, safe=True))
        elif self.at("*") and kind is not None and kind.kind == SYMBOL and self.index == 1 and self.adjacent(1):
            self.with_memory(0, 0, 1)
        elif self.kind == OPERATOR and self.condition_as_node():
            pass
        elif self.kind == NAME and (meant := meant_clause(self.raw)):
            self.attaches_nothing(self.here(), meant)
        elif self.at(",") and kind is not None and kind.kind == NAME and (meant := meant_clause(kind.raw)):
            self.attaches_nothing(kind.span.shifted(self.base), meant)
        elif self.at_bare_value() and self.index > 0 and self.kinds[self.index - 1] in (NAME, STRING):
            self.bare_attributes()
        elif self.at_name() and self.kinds[self.index - 1] == CLOSE and self.ends_label(clauses):
            self.label_after_brackets(kind, has_label)
        elif self.at("-") and self.text.startswith("-- ", self.here().start):
            self.other_comment(self.here().start + 2)
        elif clauses and self.at_name():
            end = self.last_end() + self.base
            fixes = (replace_fix("Put `,` before it", Span(end, end), ","),) if self.kind in (NAME, STRING) else ()
            self.expected("`,` or the end of the line", (), fixes)
        elif self.kind == OPEN and self.index > 0 and self.kinds[self.index - 1] == CLOSE:
            self.complain(self.here(), "all attributes of a node go in one pair of brackets")
        elif self.kind == BRACED and (mended := attributes_in_braces(self.text, self.here().start)):
            self.complain(self.here(), ATTRIBUTES, mended)
        elif self.kind in (NUMBER, QUANTITY, BRACED):
            self.expected("the end of the line", ("values go in brackets, with their names: `(key = value)`",))
        elif self.at(",") or self.kind == SYMBOL:
            self.expected("the end of the line", (CHILDREN,))
        elif self.kind == NAME and self.raw in ("if", "when", "while", "unless"):
            self.expected("the end of the line", (_ONLY_IF,))
        else:
            return
        self.go_to(len(self.kinds) - 1)

    def with_memory(self, symbol: int, first: int, last: int) -> None:
        """Report `->*` or `*->`: the tokens from `first` to `last`; one of them is the symbol."""
        plain = self.raws[symbol].replace("→", "->").lstrip("M")
        span = Span(self.starts[first], self.starts[last] + len(self.raws[last]))
        if f"M{plain}" in SYMBOLS:
            fixes = write_fix(f"M{plain}", span), write_fix(plain, span)
            self.complain(span, f"the symbol with memory is written `M{plain}`", *fixes, notes=(_WITH_MEMORY,))
        else:
            notes = (_MEMORY,) if plain == "?" else ()
            self.complain(span, f"the symbol is written `{plain}`", write_fix(plain, span), notes=notes)

    def condition_as_node(self) -> bool:
        """Report `battery > 20` and `speed := 3`, which are a ScriptCondition and a Script."""
        first = 1 if self.raws[0] in ("if", "Condition", "when", "unless") else 0
        signs = [index for index in range(first, len(self.raws)) if self.kinds[index] == OPERATOR]
        signs = [
            index for index in signs if self.raws[index] in COMPARISONS or self.raws[index : index + 2] == [":", "="]
        ]
        last = len(self.kinds) - 2
        if not signs or SYMBOL in self.kinds or self.raws[0] in ("Script", "ScriptCondition"):
            return False
        right = signs[0] + (2 if self.raws[signs[0]] == ":" else 1)
        if signs[0] == first or self.kinds[signs[0] - 1] not in VALUES or self.kinds[right] not in VALUES:
            return False
        begin, end = self.starts[first], self.starts[last] + len(self.raws[last])
        span = Span(self.starts[0], end)
        kind = "Script" if self.raws[signs[0]] == ":" else "ScriptCondition"
        code = _ENTRY.sub(r"\1", self.text[begin:end])
        for word, sign in ((" and ", " && "), (" or ", " || ")):
            code = code.replace(word, sign)
        has_unit = QUANTITY in self.kinds[first:]
        written = f"{kind} (code = {quote(code)})"
        what = "an assignment" if kind == "Script" else "a condition"
        notes = ("a script has numbers without units",) if has_unit else ()
        fixes = (write_fix(written, span),) if not has_unit and self.raws[0] != "unless" else ()
        example = written if fixes else f'{kind} (code = "…")'
        self.complain(span, f"{what} is not a node: write `{shown(example)}`", *fixes, notes=notes)
        return True

    def child_on_the_line(self, label: Word | None) -> bool:
        """Report `Inverter Condition Dark`, whose child lacks a line of its own; False if there is none."""
        index = self.index
        if label is not None and self.starts[index - 1] == label.start + self.base:
            index -= 1
        if not (index and self.kinds[index] == NAME and self.raws[index] in CATEGORIES):
            return False
        if self.kinds[index + 1] not in (NAME, STRING) or self.raws[index + 1] in NODE_CLAUSES:
            return False
        start, end = self.starts[index], self.starts[-2] + len(self.raws[-2])
        before = self.starts[index - 1] + len(self.raws[index - 1])
        below = self.line_below()
        fixes = (replace_fix("Put it on a line of its own", Span(before, start), below),) if below else ()
        self.complain(Span(start, end), CHILD, *fixes)
        self.go_to(len(self.kinds) - 1)
        return True

    def ends_label(self, clauses: list[NodeClause]) -> bool:
        """Whether the current name may be the label of a node: only clauses follow, and the brackets before it are the
        node's own.
        """
        following = self.index + 1
        if clauses and clauses[-1].end == self.last_end():
            return False
        return self.kinds[following] == NEWLINE or self.raws[following] in NODE_CLAUSES

    def label_after_brackets(self, kind: Word | None, has_label: bool) -> None:
        """Report `Retry (num_attempts = 5) Again`, where the label belongs before the brackets."""
        opened = self.starts[self.kinds.index(OPEN)]
        if has_label or kind is None:
            self.expected("the end of the line", ("a node has one label, before its brackets",))
            return
        gone = Span(self.last_end() + self.base, self.here().end)
        changes = (FixEdit(Place(Span(opened, opened)), f"{self.raw} "), FixEdit(Place(gone), ""))
        if self.text[opened - 1] not in " \t":
            changes = (FixEdit(Place(Span(opened, opened)), f" {self.raw} "), changes[1])
        fix = Fix(f"Move `{shown(self.raw)}` before the brackets", changes)
        self.complain(self.here(), "a node's label goes before its brackets", fix, notes=(CHILD,))

    def bare_attributes(self) -> None:
        """Report `MoveBase station = "charger"`, and several lines `key = value` once."""
        lexer = self.lexer
        start, end = self.starts[self.index - 1], self.starts[-2] + len(self.raws[-2])
        if self.index == 1:
            is_next = self.bare_until >= 0 and not self.text[self.bare_until : lexer.line_start].strip()
            self.bare_until = lexer.position
            lexer.ended_early = 1  # the `)` after them is not another mistake
            if is_next:
                return
        tail = range(self.index, len(self.kinds))
        plain = self.index > 1
        plain = plain and not any(self.kinds[index] == OPEN or self.raws[index] in NODE_CLAUSES for index in tail)
        changes: tuple[FixEdit, ...] = (FixEdit(Place(Span(start, start)), "("),)
        for index in tail:
            if self.is_operator(index, ":"):
                sign = self.starts[index]
                written = "=" if self.text[sign - 1] in " \t" else " ="
                changes += (FixEdit(Place(Span(sign, sign + 1)), written),)
        closing = [problem for problem in lexer.problems[self.known :] if self.is_stray_bracket(problem)]
        if not closing:  # else the `(` is missing
            changes += (FixEdit(Place(Span(end, end)), ")"),)
        safe = plain and not closing and are_plain_pairs(self.text[start:end])
        fixes = (Fix("Put brackets around them", changes, safe),) if plain or closing else ()
        message = "attributes go in brackets: `(key = value)`"
        self.complain_instead(closing[-1:], Diagnostic("syntax-error", Span(start, end), message, fixes=fixes))

    def is_stray_bracket(self, problem: Diagnostic) -> bool:
        return problem.rule == "syntax-error" and self.text.startswith(")", problem.span.start)

    def at_label(self) -> bool:
        return self.kind == STRING or (self.kind == NAME and self.raw not in NODE_CLAUSES)

    def clause_line(self, level: int) -> list[NodeClause]:
        """NodeClause { NodeClause } NL | "satisfies" { ReqUse "," } ReqItem"""
        clauses: list[NodeClause] = []
        while self.kind == NAME and self.raw in NODE_CLAUSES:
            clauses.append(self.node_clause())
        self.end_line()
        last = clauses[-1]
        if isinstance(last, Satisfies) and last.uses and isinstance(use := last.uses[-1], Requirement):
            requirement = self.clause_block(use, level)
            clauses[-1] = Satisfies(last.start, requirement.end, (*last.uses[:-1], requirement))
        self.no_block(level)
        return clauses

    def clause_line_after(self, level: int, children: list[Node | Verbatim]) -> list[NodeClause]:
        """A clause line in the block of a node; it is reported if it comes after children."""
        start = self.lexer.line_start
        place = self.here()
        word = self.raw
        clauses = self.clause_line(level)
        if children:
            end = self.starts[-1] + len(self.raws[-1])
            moved = self.text[start:end]
            first = children[0].start + self.base
            first = line_start(self.text, min(self.base, first), first)
            changes = (
                FixEdit(Place(Span(first, first)), moved if self.raws[-1] else f"{moved}\n"),
                FixEdit(Place(Span(start, end)), ""),
            )
            fixes: tuple[Fix, ...] = (Fix("Move it before the children", changes),)
            last = children[-1]
            if isinstance(last, Node) and not last.children and "\n" not in moved.rstrip():
                step = "\t" if moved.startswith("\t") else "    "
                fixes += (replace_fix(f"Move it to `{last.head.text}`", Span(start, start), step),)
            note = f'a node of this name goes in quotes: "{word}"'
            self.complain(place, "clauses go before children", *fixes, notes=(note,), rule="clause-after-children")
        return clauses

    def is_requirement(self) -> bool:
        """Whether the line is a requirement, not a node called QualityReq."""
        following = self.index + 1
        if self.kinds[following] not in (NAME, STRING) or self.raws[following] in NODE_CLAUSES:
            return False
        after = self.kinds[following + 1]
        return not (after in (NEWLINE, OPEN) or self.raws[following + 1] in NODE_CLAUSES)

    def requirement_line(self, level: int) -> Satisfies:
        """Report that `satisfies` is missing before a requirement in the block of a node."""
        word = self.here()
        fix = write_fix("satisfies QualityReq", word)
        note = "to share it between nodes, write it outside the tree"
        self.complain(word, "a requirement at a node begins with `satisfies`", fix, notes=(note,))
        requirement = self.requirement()
        self.second_quality(requirement)
        self.end_line()
        requirement = self.clause_block(requirement, level)
        self.no_block(level)
        return Satisfies(requirement.start, requirement.end, (requirement,))

    def clause_block(self, requirement: Requirement, level: int) -> Requirement:
        """[ INDENT { Clause { Clause } NL } DEDENT ]"""
        clauses = list(requirement.clauses)
        end = requirement.end
        while self.deeper(level):
            inner = self.lexer.level
            self.scan()
            clauses += self.clauses(at_least_one=True)
            end = self.end_line()
            self.no_block(inner)
        if end == requirement.end:
            return requirement
        return replace(requirement, end=end, clauses=tuple(clauses))

    def verbatim(self) -> Verbatim:
        """ "xml" STRING NL"""
        start = self.take().start
        text = None
        if self.kind == STRING:
            text = self.take()
        else:
            self.expected("one XML element in quotes", ('a node of this name goes in quotes: "xml"',))
        return Verbatim(start, self.end_line(), text)

    def port(self, meant: str = "") -> Port:
        """( "input" | … ) [ NAME ] [ ":" Name { "::" Name } ] [ "=" Value ] [ Attributes ] [ STRING ] NL

        Args:
            meant: the first letters of the current word, which are read instead of it.
        """
        direction = self.take()
        if meant:
            direction = Word(NAME, direction.start, meant)
        name = self.take() if self.kind == NAME else None
        type_ = None
        if self.kind == STRING and name is None and self.raws[self.index + 1] == ":":
            plain = unquote(self.raw)
            fixes = (write_fix(plain, self.here(), safe=True),) if is_name(plain) else ()
            self.complain(self.here(), "a port's name takes no quotes", *fixes)
            name = self.take()
        if self.accept(":"):
            type_ = self.type_()
        elif name is not None and self.kind == NAME:
            notes = ("a port is written `input name : type`",)
            self.expected("`:` and the port's type", notes, (self.type_first(name) or self.put_before(":"),))
        default = self.value() if self.accept("=") else None
        attributes = self.pairs()
        text = self.take() if self.kind == STRING else None
        notes = ("write a port's type after `:`, and its text in quotes",)
        return Port(direction.start, self.end_line(notes), direction, name, type_, default, attributes, text)

    def type_first(self, name: Word) -> Fix | None:
        """The fix for `input int count`, with type and name in the order of C++."""
        start = name.start + self.base
        declared = _TYPE_FIRST.match(self.text, start)
        if declared is None or not is_known_type(plain_type(declared[1])):
            return None
        return write_fix(f"{declared[2]} : {declared[1]}", Span(start, declared.end()))

    def at_ports(self) -> bool:
        """Whether brackets have ports in them, as the parameters of a function: `(place, speed : double)`."""
        first = self.index + 1
        if self.kind != OPEN or self.kinds[first] != NAME or self.raws[first] in _NO_PORTS or "=" in self.raws[first:]:
            return False
        return self.kinds[first + 1] in (NAME, CLOSE) or self.raws[first + 1] in (":", ",", "::")

    def ports_in_brackets(self, owner: str) -> None:
        """Report ports in the brackets of a tree or a model; the fix writes each on its line."""
        bracket = self.here()
        note = f"a port goes on a line of its own below the {owner}, indented: `input name : type`"
        closing = self.kinds.index(CLOSE, self.index) if CLOSE in self.kinds[self.index :] else -1
        fixes: tuple[Fix, ...] = ()
        if closing > 0 and self.raws[closing] and self.kinds[closing + 1] == NEWLINE:
            inside = self.text[bracket.end : self.starts[closing]]
            ports = [_BRACKETED_PORT.fullmatch(part.strip()) for part in inside.split(",")]
            line = line_end(self.text, self.starts[closing])
            below = _NEXT_MARGIN.match(self.text, line)
            step = below[1] if below else "    "
            gone = FixEdit(Place(Span(self.last_end() + self.base, self.starts[closing] + 1)), "")
            lines = [
                f"\n{step}{port['direction'] or 'input'} {port['name']}{f' : {type_}' if type_ else ''}"
                for port in ports
                if port is not None
                for type_ in [port["type"] or port["before"]]
            ]
            if len(lines) == len(ports):
                fixes = (
                    Fix("Put them on lines of their own", (gone, FixEdit(Place(Span(line, line)), "".join(lines)))),
                )
        self.complain(bracket, "ports do not go in brackets", *fixes, notes=(note,))
        self.go_to(len(self.kinds) - 1)

    def type_(self) -> Word | None:
        """Type = Name { "::" Name }; as one word"""
        word = self.name("the port's type")
        while word is not None and self.at("::"):
            self.advance()
            last = self.name("the rest of the type")
            if last is not None:
                word = TypeWord(NAME, word.start, self.text[self.base + word.start : self.base + last.end])
        return self.unquoted_type(word) if word is not None and self.goes_on(word) else word

    def goes_on(self, type_: Word) -> bool:
        """Whether the type after `:` is more than a C++ name: `vector<int>`, `unsigned int`, `Pose*`."""
        end = type_.end + self.base
        if type_.kind != NAME:
            return False
        return self.text[end : end + 1] in ("<", "*", "&", "[") or (self.kind == NAME and type_.raw in _BEFORE_TYPES)

    def unquoted_type(self, type_: Word) -> Word:
        """`std::map<int, double>`: read all of it as one type, and report that it needs quotes."""
        start = end = type_.start + self.base
        depth = 0
        while end < len(self.text) and self.text[end] not in "\r\n#\"'" and (depth > 0 or self.text[end] not in "=("):
            depth += 1 if self.text[end] == "<" else -1 if self.text[end] == ">" else 0
            end += 1
        span = Span(start, start + len(self.text[start:end].rstrip()))
        raw = self.text[span.start : span.end]
        fix = replace_fix("Put quotes around it", span, quote(raw), safe=True)
        of_line = self.lexer.problems[self.known :]
        inside = [problem for problem in of_line if span.start <= problem.span.start < span.end]
        self.complain_instead(inside, Diagnostic("syntax-error", span, "this type needs quotes", fixes=(fix,)))
        while self.kind != NEWLINE and self.starts[self.index] < span.end:
            self.advance()
        return Word(NAME, type_.start, raw)

    # ---- blocks ----

    def no_block(self, level: int) -> None:
        """Report and skip lines deeper than the line just read, which takes no block."""
        if not self.deeper(level):
            return
        start = self.lexer.position
        message = "unexpected indentation: the line above opens no block"
        self.complain(Span(start, self.lexer.line_end()), message, notes=(_MEANINGFUL,))
        self.skip_block(level)


XML: Final = (
    "if this is BehaviorTree.CPP XML, rename the file to .xml, or convert it with `btq import`; "
    "a comment begins with `#`, not `<!--`"
)
CHILD: Final = "a child goes on a line of its own below its parent, indented"
_TAG: Final = re.compile(r"""<([^\W\d]\w*)((?:\s+[\w:]+\s*=\s*(?:"[^"<]*"|'[^'<]*'))*)\s*(/?)>""")
_NO_KINDS: Final = NODE_CLAUSES | DIRECTIONS | {"QualityReq", "xml"}
_NOT_NODES: Final = frozenset(("root", "BehaviorTree", "TreeNodesModel", "include"))
_COMMENT_ENDS: Final = ("-->", '"""', "'''")
_STATEMENTS: Final = {
    **dict.fromkeys(("if", "elif", "else"), "to choose, use a Fallback `?` with a Condition, or `_skipIf` on the node"),
    **dict.fromkeys(("while", "for"), "to repeat, use `Repeat`, `Retry` or `KeepRunningUntilFailure`"),
}
_ONLY_IF: Final = (
    "a node that runs only if something holds goes below a Precondition, or after a Condition in a Sequence `->`"
)
_WITH_MEMORY: Final = (
    "`->` goes on with the child that is running; `M->` goes on with the one that failed too, when it is ticked again"
)
_MEMORY: Final = "`?` goes on with the child that is running; `R?` begins with the first one at every tick"
_ENTRY: Final = re.compile(r"\{(@?[^\W\d]\w*)\}")
_ARROW: Final = re.compile(r"[-=~]+ ?>")
_BRACKETED_PORT: Final = re.compile(
    r"(?:(?P<direction>input|output|inout)\s+)?(?:(?P<before>(?:\w+::)*\w+)\s+)?(?P<name>[^\W\d]\w*)"
    r"(?:\s*:\s*(?P<type>(?:\w+::)*\w+))?"
)
_TYPE_FIRST: Final = re.compile(r"(\w+)[ \t]+([^\W\d]\w*)(?![ \t]*:)")
_NO_PORTS: Final = NODE_CLAUSES | {"parameters", "QualityReq"}
_NEXT_MARGIN: Final = re.compile(r"(?:[ \t]*\r?\n)+([ \t]+)")
_BEFORE_TYPES: Final = frozenset(("const", "unsigned", "signed", "long", "short"))
MAX_DEPTH: Final = 256  # levels below a BehaviorTree; the engine's limit (4.9 and later)
OF_ITS_OWN: Final = "move a part of them into a BehaviorTree of its own and call it with SubTree"
_TOO_DEEP: Final = f"more than {MAX_DEPTH} levels of nodes, which BehaviorTree.CPP refuses"
_MEANINGFUL: Final = "indentation shows what a line belongs to; align it with its sibling lines"

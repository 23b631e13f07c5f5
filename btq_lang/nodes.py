"""The part of the parser that reads the block of a tree: nodes, their attributes, and the qualities attached to them.

Nodes nest by indentation, so their blocks are a stack of open nodes and no recursion.
"""

from __future__ import annotations

import re

from btq_lang.blocks import MAX_DEPTH, Block
from btq_lang.clauses import VERBS, ClauseParser
from btq_lang.conditions import HEADS
from btq_lang.cursor import VALUES
from btq_lang.diagnostics import Change, Diagnostic, Fix, Place, replace_fix
from btq_lang.lexer import value_meant
from btq_lang.near import near
from btq_lang.plain import plain_clauses, plain_node
from btq_lang.plain_requirements import plain_clause_line, plain_requirement
from btq_lang.scan import COMPILED, line_start, path_end
from btq_lang.syntax import (
    Node,
    NodeClause,
    Pair,
    Port,
    Quality,
    ReqRef,
    Requirement,
    Satisfices,
    Satisfies,
    Tags,
    TypeWord,
    Verbatim,
    Word,
    quote,
)
from btq_lang.text import Span
from btq_lang.tokens import (
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

if not COMPILED:
    from btq_lang.lines import read_lines

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final


class NodeParser(ClauseParser):
    """A cursor that can read the block of a tree."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.bare_until = -1  # where the last line `key = value` without brackets ends

    def tree_block(self, level: int) -> tuple[tuple[Port, ...], tuple[NodeClause, ...], tuple[Node | Verbatim, ...]]:
        """INDENT { Port } { ClauseLine } { Node } DEDENT"""
        lexer = self.lexer
        ports: list[Port] = []
        block = Block(level, None)
        blocks = [block]
        told_too_deep = False
        stopped = -1  # the line that is spelt in another way than `read_lines` knows
        while self.more and lexer.level > level:
            inner = lexer.level
            while block.level >= inner:
                blocks.pop().close()
                block = blocks[-1]
            if not (COMPILED or lexer.line_start == stopped or lexer.ended_early or lexer.adopted):
                behind, node = read_lines(lexer, blocks, self.base)
                if behind >= 0:
                    block = blocks[-1]
                    inner = len(lexer.columns) - 1
                    self.more = lexer.open_behind(behind)
                    if node is None:
                        self.no_block(inner)
                    elif self.more and lexer.level > inner:
                        block = Block(inner, node)
                        blocks.append(block)
                    stopped = lexer.line_start
                    continue
            node = None
            plain = None
            if not block.children and (satisfies := self.plain_satisfies(inner)) is not None:
                block.clauses.append(satisfies)
                continue
            if not lexer.ended_early and len(blocks) <= MAX_DEPTH:
                plain = plain_node(self.text, lexer.position, lexer.blanks, self.base)
            if plain is not None:
                node, behind = plain
                self.open_next(behind)
            elif not block.children and (line := plain_clauses(self.text, lexer.position, self.base)):
                clauses, behind = line
                block.clauses += clauses
                self.open_next(behind)
                self.no_block(inner)
            else:
                self.scan()
                word = self.raw if self.kind == NAME else ""
                if word in NODE_CLAUSES:
                    if len(blocks) > 1 or block.has_nodes():
                        block.clauses += self.clause_line_behind(inner, block.children)
                    else:  # the tree's own: XML may stand before it, as it may among ports
                        block.clauses += self.clause_line(inner)
                elif word == "QualityReq" and self.is_requirement():
                    block.clauses.append(self.requirement_line(inner))
                elif word == "xml":
                    block.children.append(self.verbatim())
                    self.no_block(inner)
                elif word in DIRECTIONS and len(blocks) == 1 and not block.has_nodes():
                    if block.clauses:
                        self.complain("syntax-error", self.here(), "ports stand before satisfices, satisfies and tags")
                    ports.append(self.port())
                    self.no_block(inner)
                else:
                    if len(blocks) > MAX_DEPTH:
                        if not told_too_deep:
                            told_too_deep = True
                            self.complain("nested-too-deep", self.here(), _TOO_DEEP, (_OF_ITS_OWN,))
                        blocks.pop().close()
                        block = blocks[-1]
                    node = self.node(inner)
            if node is not None:
                block.children.append(node)
                if self.more and lexer.level > inner:
                    block = Block(inner, node)
                    blocks.append(block)
        for open_block in blocks:
            open_block.close()
        return tuple(ports), tuple(blocks[0].clauses), tuple(blocks[0].children)

    def node(self, level: int) -> Node | None:
        """Kind [ Label ] [ Attributes ] { NodeClause } NL"""
        start = self.start()
        category: Word | None = None
        kind: Word | None = None
        if self.kind == NAME and self.raw in CATEGORIES:
            category = self.take()
            if self.at_label():
                kind = self.take()
        elif self.kind == NAME or self.kind == SYMBOL or self.kind == STRING:
            kind = self.take()
        else:
            notes = (XML,) if self.at("<") else ()
            self.expected("a node: its kind, or a symbol: -> ? || …", notes, self.symbol_meant())
            self.end_line()
            self.skip_block(level)
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
        bare = self.index == 1 and self.at("=")  # `key = value` behind a forgotten bracket
        if self.kind != NEWLINE:
            self.leftover(kind, clauses)
        end = self.end_line()
        if bare and not self.deeper(level):
            return None
        return Node(start, end, category, kind, label, attributes, tuple(clauses), ())

    def symbol_meant(self) -> tuple[Fix, ...]:
        """The fix for what is probably a symbol: `-->`, `=>`, `- >`."""
        start = self.starts[self.index]
        run = _ARROW.match(self.text, start)
        return (replace_fix("Write `->`", Span(start, run.end()), "->"),) if run else ()

    def leftover(self, kind: Word | None, clauses: list[NodeClause]) -> None:
        """Complain of what is left of a node's line."""
        if kind is not None and kind.kind == NAME and (kind.raw in VERBS or kind.raw in HEADS):
            message = f"`{kind.raw}` begins a clause, and clauses stand in a requirement"
            note = "write `satisfies QualityReq` and an ID before it, or indent it below such a line of its own"
            self.complain("syntax-error", kind.span.shifted(self.base), message, (note,))
        elif self.kind == SYMBOL and self.index == 1 and kind is not None and kind.raw.upper() + self.raw in SYMBOLS:
            span = Span(kind.start + self.base, self.here().end)
            symbol = kind.raw.upper() + self.raw
            fix = replace_fix(f"Write `{symbol}`", span, symbol, safe=True)
            self.complain("syntax-error", span, f"the symbol is written `{symbol}`", (), (fix,))
        elif self.kind == NAME and (meant := meant_clause(self.raw)):
            self.attaches_nothing(self.here(), meant)
        elif self.at(",") and kind is not None and kind.kind == NAME and (meant := meant_clause(kind.raw)):
            self.attaches_nothing(kind.span.shifted(self.base), meant)
        elif self.at("=") and self.index > 0 and self.kinds[self.index - 1] in (NAME, STRING):
            self.bare_attributes()
        elif clauses and self.at_name():
            self.expected("`,` or the end of the line")
        elif self.kind == OPEN and self.index > 0 and self.kinds[self.index - 1] == CLOSE:
            self.complain("syntax-error", self.here(), "all attributes of a node stand in one pair of brackets")
        elif self.kind in (NUMBER, QUANTITY, BRACED):
            self.expected("the end of the line", ("values stand in brackets, with their names: `( key = value )`",))
        else:
            return
        self.go_to(len(self.kinds) - 1)

    def bare_attributes(self) -> None:
        """Complain of `MoveBase station = "charger"`, and once of several lines `key = value`."""
        lexer = self.lexer
        start, end = self.starts[self.index - 1], self.starts[-2] + len(self.raws[-2])
        if self.index == 1:
            is_next = self.bare_until >= 0 and not self.text[self.bare_until : lexer.line_start].strip()
            self.bare_until = lexer.position
            lexer.ended_early = 1  # the `)` that follows them is no mistake of its own
            if is_next:
                return
        rest = range(self.index, len(self.kinds))
        plain = self.index > 1
        plain = plain and not any(self.kinds[index] == OPEN or self.raws[index] in NODE_CLAUSES for index in rest)
        changes: tuple[Change, ...] = (Change(Place(Span(start, start)), "("),)
        if closing := [problem for problem in lexer.problems[self.known :] if self.is_stray_bracket(problem)]:
            lexer.problems.remove(closing[-1])  # what is missing is the `(`
            self.forget()
        else:
            changes += (Change(Place(Span(end, end)), ")"),)
        fixes = (Fix("Put brackets around them", changes),) if plain or closing else ()
        self.complain("syntax-error", Span(start, end), "attributes stand in brackets: `( key = value )`", (), fixes)

    def is_stray_bracket(self, problem: Diagnostic) -> bool:
        return problem.rule == "syntax-error" and self.text.startswith(")", problem.span.start)

    def at_label(self) -> bool:
        return self.kind == STRING or (self.kind == NAME and self.raw not in NODE_CLAUSES)

    def clause_line(self, level: int, moved: bool = False) -> list[NodeClause]:
        """NodeClause { NodeClause } NL | "satisfies" { ReqUse "," } ReqItem

        Args:
            moved: it stands where it should not, so where it ends must be known to the token.
        """
        found: list[NodeClause] = []
        while self.kind == NAME and self.raw in NODE_CLAUSES:
            found.append(self.node_clause())
        self.end_line()
        last = found[-1]
        if isinstance(last, Satisfies) and last.uses and isinstance(use := last.uses[-1], Requirement):
            requirement = self.clause_block(use, level, plain=not moved)
            found[-1] = Satisfies(last.start, requirement.end, (*last.uses[:-1], requirement))
        self.no_block(level)
        return found

    def plain_satisfies(self, level: int) -> Satisfies | None:
        """ "satisfies" ReqItem, the head of it plain"""
        start = self.lexer.position
        if not self.text.startswith("satisfies QualityReq ", start):
            return None
        requirement = self.plain_req_item(start + len("satisfies "), level)
        if requirement is None:
            return None
        self.no_block(level)
        return Satisfies(start - self.base, requirement.end, (requirement,))

    def plain_req_item(self, start: int, level: int) -> Requirement | None:
        """ReqItem, the head of it plain"""
        if self.lexer.ended_early or (head := plain_requirement(self.text, start, self.base)) is None:
            return None
        requirement, behind = head
        self.open_next(behind)
        return self.clause_block(requirement, level)

    def clause_line_behind(self, level: int, children: list[Node | Verbatim]) -> list[NodeClause]:
        """A clause line in the block of a node; behind children, where it should not stand, it is reported."""
        start = self.lexer.line_start
        at = self.here()
        word = self.raw
        found = self.clause_line(level, moved=bool(children))
        if children:
            end = self.starts[-1] + len(self.raws[-1])
            moved = self.text[start:end]
            first = children[0].start + self.base
            first = line_start(self.text, min(self.base, first), first)
            changes = (
                Change(Place(Span(first, first)), moved if self.raws[-1] else f"{moved}\n"),
                Change(Place(Span(start, end)), ""),
            )
            fixes: tuple[Fix, ...] = (Fix("Move it before the children", changes),)
            last = children[-1]
            if isinstance(last, Node) and not last.children and "\n" not in moved.rstrip():
                step = "\t" if moved.startswith("\t") else "    "
                fixes += (replace_fix(f"Give it to `{last.head.text}`", Span(start, start), step),)
            note = f'a node of this name is written in quotes: "{word}"'
            self.complain("clause-after-children", at, "clauses stand before children", (note,), fixes)
        return found

    def is_requirement(self) -> bool:
        """Whether the line cannot be a node called QualityReq."""
        following = self.index + 1
        if self.kinds[following] not in (NAME, STRING) or self.raws[following] in NODE_CLAUSES:
            return False
        behind = self.kinds[following + 1]
        return not (behind in (NEWLINE, OPEN) or self.raws[following + 1] in NODE_CLAUSES)

    def requirement_line(self, level: int) -> Satisfies:
        """A requirement in the block of a node: `satisfies` is missing."""
        at = self.here()
        fix = replace_fix("Write `satisfies QualityReq`", at, "satisfies QualityReq")
        note = "one that several nodes share stands outside the tree"
        self.complain("syntax-error", at, "a requirement at a node begins with `satisfies`", (note,), (fix,))
        requirement = self.requirement()
        self.end_line()
        requirement = self.clause_block(requirement, level)
        self.no_block(level)
        return Satisfies(requirement.start, requirement.end, (requirement,))

    def clause_block(self, requirement: Requirement, level: int, plain: bool = True) -> Requirement:
        """[ INDENT { Clause { Clause } NL } DEDENT ]"""
        clauses = list(requirement.clauses)
        end = requirement.end
        while self.deeper(level):
            inner = self.lexer.level
            line = None
            if plain and not self.lexer.ended_early:
                line = plain_clause_line(self.text, self.lexer.position, self.base)
            if line is not None:
                found, end, behind = line
                clauses += found
                self.open_next(behind)
            else:
                self.scan()
                clauses += self.clauses(at_least_one=True)
                end = self.end_line()
            self.no_block(inner)
        if end == requirement.end:
            return requirement
        return Requirement(
            requirement.start,
            end,
            requirement.name,
            requirement.classic,
            requirement.parameters,
            requirement.quality,
            requirement.text,
            tuple(clauses),
        )

    def verbatim(self) -> Verbatim:
        """ "xml" STRING NL"""
        start = self.take().start
        text = None
        if self.kind == STRING:
            text = self.take()
        else:
            self.expected("one XML element in quotes", ('a node of this name is written in quotes: "xml"',))
        return Verbatim(start, self.end_line(), text)

    def port(self) -> Port:
        """( "input" | … ) [ NAME ] [ ":" Name { "::" Name } ] [ "=" Value ] [ Attributes ] [ STRING ] NL"""
        direction = self.take()
        name = self.take() if self.kind == NAME else None
        type_ = None
        if self.accept(":"):
            type_ = self.name("the port's type")
            while type_ is not None and self.at("::"):
                self.advance()
                last = self.name("the rest of the type")
                if last is not None:
                    type_ = TypeWord(NAME, type_.start, self.text[self.base + type_.start : self.base + last.end])
            if type_ is not None and self.at("<") and self.adjacent(self.index):
                type_ = self.unquoted_type(type_)
        default = self.value() if self.accept("=") else None
        attributes = self.pairs_only()
        text = self.take() if self.kind == STRING else None
        notes = ("a port's type stands behind `:`, its text in quotes",)
        return Port(direction.start, self.end_line(notes), direction, name, type_, default, attributes, text)

    def unquoted_type(self, type_: Word) -> Word:
        """`std::vector<int>`: take all of it for one type, and say that it needs quotes."""
        start = type_.start + self.base
        span = Span(start, start + len(self.text[start : path_end(self.text, start)].partition("=")[0]))
        raw = self.text[span.start : span.end]
        fix = replace_fix("Put quotes around it", span, quote(raw), safe=True)
        self.complain("syntax-error", span, "this type needs quotes", (), (fix,))
        while self.kind != NEWLINE and self.starts[self.index] < span.end:
            self.advance()
        return Word(NAME, type_.start, raw)

    # ---- attributes ----

    def pairs_only(self) -> tuple[Pair, ...]:
        """Attributes of something that takes no qualities."""
        if self.kind != OPEN:
            return ()
        clauses: list[NodeClause] = []
        pairs = self.attributes(clauses)
        if clauses:
            span = Span(clauses[0].start, clauses[0].end).shifted(self.base)
            note = "qualities and requirements stand at a node, or on a line of their own in the block of a tree"
            self.complain("syntax-error", span, "only `key = value` pairs stand in these brackets", (note,))
        return pairs

    def attributes(self, clauses: list[NodeClause]) -> tuple[Pair, ...]:
        """Attributes = "(" { Attribute [ "," ] } ")";  Attribute = "parameters" Pair … | NodeClause | Pair"""
        pairs: list[Pair] = []
        self.advance()
        self.group += 1
        while self.kind != CLOSE and self.kind != NEWLINE:
            if self.kind == NAME or self.kind == STRING:
                following = self.index + 1
                if self.kinds[following] == OPERATOR and self.raws[following] == "=":
                    pairs.append(self.pair())
                elif self.kind == NAME and self.raw in NODE_CLAUSES:
                    clauses.append(self.node_clause())
                elif self.kind == NAME and self.raw == "parameters":
                    self.advance()
                    if not self.at_key():
                        self.expected("`key = value` behind `parameters`")
                    continue
                else:
                    self.not_an_attribute(pairs, clauses)
            else:
                self.not_an_attribute(pairs, clauses)
            if self.kind == OPERATOR and self.raw == ",":
                self.advance()
        self.group -= 1
        self.advance()
        return tuple(pairs)

    def not_an_attribute(self, pairs: list[Pair], clauses: list[NodeClause]) -> None:
        """Complain of what stands in brackets and is no attribute; what it is probably meant for is read as that."""
        at = self.index
        if self.at_name() and (self.is_operator(at + 1, ":") or self.is_operator(at + 1, "==")):
            sign = self.starts[at + 1]
            span = Span(sign, sign + len(self.raws[at + 1]))
            written = "=" if self.text[sign - 1] in " \t" else " ="
            fix = replace_fix("Write `=`", span, written, safe=True)
            self.complain("syntax-error", span, "key and value are joined by `=`", (), (fix,))
            pairs.append(self.pair())
            return
        if self.kind == NAME and self.kinds[at + 1] in (NAME, STRING) and (meant := self.misspelt_clause()):
            clauses.append(self.node_clause(meant))
            return
        notes: tuple[str, ...] = ()
        if self.kinds[at - 1] in (NAME, NUMBER, QUANTITY) and self.kind in (NAME, NUMBER, QUANTITY):
            notes = ("a value or name of several words stands in quotes",)
        self.expected("an attribute: key = value", notes)
        if self.index == at:
            self.advance()

    def pair(self) -> Pair:
        """Pair = Name "=" Value"""
        key = self.take()
        self.advance()
        return Pair(key, self.value())

    def value(self) -> Word | None:
        """Value = STRING | NAME | NUMBER | QUANTITY | BRACED"""
        if self.kind not in VALUES and (self.kind not in (SYMBOL, OPERATOR) or self.raw in ("=", ",")):
            self.expected("a value: a string, a name, a number, a quantity or {key}")
            return None
        whole = self.kind in VALUES
        word = self.take()
        if whole and (self.at_key() or not self.joins()):
            return word
        if self.kind == STRING and word.kind != STRING:
            return self.half_quoted(word)
        return self.needs_quotes(word)

    def half_quoted(self, word: Word) -> Word:
        """`charger" …`: what follows is a string only because a quote is missing."""
        span = word.span.shifted(self.base)
        fix = Fix(f"Put {self.raw[0]} before it", (Change(Place(Span(span.start, span.start)), self.raw[0]),))
        at, lexer = self.starts[self.index], self.lexer
        lexer.problems = [problem for problem in lexer.problems if problem.span.start != at]  # that it is not closed
        self.forget()
        self.complain("syntax-error", span, f"a quote is missing at `{word.raw}`", (), (fix,))
        self.inside_out = min(self.inside_out, span.end)
        self.recover()
        return word

    def joins(self) -> bool:
        """Whether the token at hand makes one value with the one before it: there is no blank between."""
        if self.kind in (NEWLINE, OPEN, CLOSE) or self.raw == "," or self.raw == "=":
            return False
        return self.adjacent(self.index)

    def ends_value(self) -> bool:
        """Whether what may follow a value follows."""
        return self.kind in (NEWLINE, CLOSE) or self.raw == "," or self.raw in _ATTRIBUTE_WORDS or self.at_key()

    def needs_quotes(self, word: Word) -> Word:
        """`map/frame`, `/map`: take what is written without a blank as one value, and say that it needs quotes."""
        cause = self.lost_quote() or self.wrong_unit()
        while self.joins():
            self.advance()
        start = word.start + self.base
        end = self.last_end() + self.base
        raw = self.text[start:end]
        if cause is not None:
            self.report(cause)
        elif word.kind == STRING:
            note = "a quote in a string is written \\\", in a script '; or a closing quote is missing further up"
            self.complain("syntax-error", Span(start, end), "something stands right behind a string", (note,))
        else:
            # A quote or a brace in it means that more went wrong than this.
            safe = self.ends_value() and not set(raw) & set("\"'{}\\")
            fix = value_meant(self.text, start, end, safe=safe)
            self.complain("syntax-error", Span(start, end), "this value needs quotes", (), (fix,))
        return Word(NAME, word.start, raw)

    # ---- qualities and requirements on nodes ----

    def misspelt_clause(self) -> str | None:
        """The word that is probably meant by the one at hand, reported: `satisfys rq1`."""
        meant = meant_clause(self.raw) if self.raw not in _ATTRIBUTE_WORDS else None
        if meant is not None:
            self.attaches_nothing(self.here(), meant)
        return meant

    def attaches_nothing(self, span: Span, meant: str) -> None:
        """Complain of a misspelt satisfices, satisfies or tags."""
        word = self.text[span.start : span.end]
        fix = replace_fix(f"Replace `{word}` by `{meant}`", span, meant)
        message = f"`{word}` attaches nothing to a node: did you mean `{meant}`?"
        self.complain("syntax-error", span, message, (), (fix,))

    def node_clause(self, meant: str = "") -> NodeClause:
        """ "satisfices" Quality { "," Quality } | "satisfies" ReqUse { "," ReqUse } | "tags" Name { "," Name }

        Args:
            meant: the word to read instead of the one at hand.
        """
        start = self.start()
        word = self.take().raw
        if meant:
            word = meant
        if word == "satisfices":
            qualities = self.satisfices()
            return Satisfices(start, self.last_end(), qualities)
        if word == "satisfies":
            uses = self.satisfies()
            return Satisfies(start, self.last_end(), uses)
        names: list[Word] = []
        while name := self.name("a tag"):
            names.append(name)
            if not self.list_goes_on():
                break
        return Tags(start, self.last_end(), tuple(names))

    def satisfices(self) -> tuple[Quality, ...]:
        """Quality { "," Quality };  classic files leave the commas out"""
        found: list[Quality] = []
        while True:
            quality = self.quality()
            if quality is None:
                break
            found.append(quality)
            if not (self.at_quality() or self.list_goes_on(qualities=True)):
                break
        return tuple(found)

    def at_quality(self) -> bool:
        return self.kind == NAME and self.raw == "Quality" and self.is_operator(self.index + 1, "=")

    def quality(self) -> Quality | None:
        """ "Quality" "=" QualityPath [ "(" Requirement { [ "," ] Requirement } ")" ] | QualityPath"""
        classic = self.at_quality()
        if classic:
            self.advance()
            self.advance()
        elif self.at_word("Quality") and self.is_behind_quality(self.index + 1):
            self.advance()
            self.expected("`=` behind `Quality`")
            return None
        path = self.quality_path()
        if path is None:
            return None
        if not classic or self.kind != OPEN:
            return Quality(path)
        self.advance()
        self.group += 1
        requirements: list[Requirement] = []
        while self.at_word("QualityReq"):
            requirements.append(self.requirement())
            self.accept(",")
        self.close_group("QualityReq or `)`")
        return Quality(path, tuple(requirements))

    def is_behind_quality(self, index: int) -> bool:
        """Whether a name stands there, so that `Quality` before it lacks its `=`."""
        if self.kinds[index] not in (NAME, STRING) or self.raws[index] in _ATTRIBUTE_WORDS:
            return False
        return not self.is_operator(index + 1, "=")

    def satisfies(self) -> tuple[Requirement | ReqRef, ...]:
        """ReqUse { "," ReqUse };  classic files leave the commas out"""
        found: list[Requirement | ReqRef] = []
        while True:
            if self.at_word("QualityReq"):
                found.append(self.requirement())
            else:
                name = self.name("a requirement: its ID, or QualityReq and a definition")
                if name is None:
                    break
                found.append(self.req_ref(name))
            if not (self.at_word("QualityReq") or self.list_goes_on()):
                break
        return tuple(found)

    def list_goes_on(self, qualities: bool = False) -> bool:
        """Pass a comma if another element follows it; in brackets an attribute may follow it instead."""
        if not self.at(","):
            return False
        following = self.index + 1
        if self.group:
            if self.kinds[following] == CLOSE:
                return False
            if self.is_operator(following + 1, "=") and not (qualities and self.is_word(following, "Quality")):
                return False
            if self.kinds[following] == NAME and (
                self.raws[following] in NODE_CLAUSES or self.raws[following] == "parameters"
            ):
                return False
        self.advance()
        return True

    # ---- blocks ----

    def no_block(self, level: int) -> None:
        """Complain of lines deeper than the line just read, which takes no block, and pass over them."""
        if not self.deeper(level):
            return
        at = self.lexer.position
        message = "this line is indented, but the line above it opens no block"
        self.complain("syntax-error", Span(at, self.lexer.line_end()), message, (_MEANINGFUL,))
        self.skip_block(level)


def meant_clause(word: str) -> str | None:
    """Which of satisfices, satisfies and tags is probably meant by another word."""
    if likely := near(word, NODE_CLAUSES, limit=1):
        return likely[0]
    return "satisfies" if word.startswith("satisf") else None


XML: Final = "`btq check` reads XML files as they are, `btq import` makes .btq files of them; comments begin with `#`"
_ARROW: Final = re.compile(r"[-=~]+ ?>")
_ATTRIBUTE_WORDS: Final = NODE_CLAUSES | {"parameters"}
_TOO_DEEP: Final = f"more than {MAX_DEPTH} levels of nodes: the engine reads no more"
_OF_ITS_OWN: Final = "move a part of them into a BehaviorTree of its own and call it with SubTree"
_MEANINGFUL: Final = "indentation says what a line belongs to: give it the column of the line it belongs beside"

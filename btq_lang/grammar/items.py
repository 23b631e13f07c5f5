"""The part of the parser that reads the items of a file, except Root, whose block holds items.

Each function is a production of docs/grammar.md and named after it; its docstring shows the production.
"""

from __future__ import annotations

import re
from typing import Final

from btq_lang.diagnostics.model import Fix, replace_fix, write_fix
from btq_lang.grammar.nodes import NodeParser
from btq_lang.grammar.requirements import sort_of
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


class ItemParser(NodeParser):
    """A cursor that can read items."""

    def include(self) -> Include:
        """ "include" STRING [ Attributes ] NL"""
        start = self.take().start
        if self.at_word("path") and self.is_operator(self.index + 1, "=") and self.kinds[self.index + 2] == STRING:
            gone = Span(self.here().start, self.starts[self.index + 2])
            fix = replace_fix("Remove `path =`", gone, "", safe=True)
            self.complain(self.here(), "the path of an include needs no `path =`", fix)
            self.go_to(self.index + 2)
        elif (self.at(":") or self.at("=")) and self.kinds[self.index + 1] == STRING:
            after = blanks_end(self.text, self.starts[self.index] + 1, len(self.text))
            fix = self.without_sign(f"Remove `{self.raw}`", after, "", safe=True)
            self.complain(self.here(), f"unexpected `{self.raw}`", fix)
            self.advance()
        path = self.take() if self.kind == STRING else self.unquoted_path()
        attributes = self.pairs()
        return Include(start, self.end_line(), path, attributes)

    def qualities(self) -> Qualities:
        """ "qualities" NAME NL"""
        start = self.take().start
        edition = self.name("iso25010-2023 or iso25010-2011")
        return Qualities(start, self.end_line(), edition)

    def quality_decl(self) -> QualityDecl:
        """ "quality" Name [ ":" QualityPath ] [ STRING ] NL"""
        start = self.take().start
        self.skip_glued_colon()
        name = self.name("the name of the quality")
        parent = self.quality_path() if self.accept(":") else None
        text = self.take() if self.kind == STRING else None
        notes = ("write the quality it belongs to after `:`, and its definition in quotes",)
        return QualityDecl(start, self.end_line(notes), name, parent, text)

    def models(self, level: int) -> Models:
        """ "TreeNodesModel" NL [ INDENT { Model | Verbatim } DEDENT ]"""
        start = self.take().start
        end = self.end_line()
        models: list[Model | Verbatim] = []
        while self.deeper(level):
            self.scan()
            inner = self.lexer.level
            if self.kind == NAME and self.raw in CATEGORIES:
                models.append(self.model(inner))
            elif self.kind == NAME and self.raw == "xml":
                models.append(self.verbatim())
            else:
                self.expected("a node model: Action, Condition, Control, Decorator or SubTree and its ID")
                self.end_line()
                self.skip_block(inner)
            self.no_block(inner)
        return Models(start, end, tuple(models))

    def model(self, level: int) -> Model:
        """( "Action" | … | "SubTree" ) Name [ Attributes ] [ STRING ] NL [ INDENT { Port | … } DEDENT ]"""
        category = self.take()
        self.skip_glued_colon()
        name = self.name("the node's ID")
        if self.at_ports():
            self.ports_in_brackets("node")
        attributes = self.pairs()
        text = self.take() if self.kind == STRING else None
        end = self.end_line()
        return Model(category.start, end, category, name, attributes, text, self.model_block(level))

    def model_block(self, level: int) -> tuple[Port | Meta | Verbatim, ...]:
        """[ INDENT { Port | Meta | Verbatim } DEDENT ]"""
        body: list[Port | Meta | Verbatim] = []
        while self.deeper(level):
            inner = self.lexer.level
            self.scan()
            if self.kind == NAME and self.raw in DIRECTIONS:
                body.append(self.port())
            elif self.kind == NAME and (direction := self.raw.removesuffix("_port")) in DIRECTIONS:
                message = f"unknown word `{self.raw}`; did you mean `{direction}`?"
                self.complain(self.here(), message, write_fix(direction, self.here(), safe=True))
                body.append(self.port(direction))
            elif self.kind == NAME and self.raw == "metadata":
                body.append(self.meta())
            elif self.kind == NAME and self.raw == "xml":
                body.append(self.verbatim())
            else:
                fixes = self.replaced_by((*sorted(DIRECTIONS), "metadata", "xml"))
                if self.kind == NAME and self.raw in ("in", "out"):
                    fixes = (write_fix(f"{self.raw}put", self.here(), safe=True),)
                notes: tuple[str, ...] = ()
                if declared := _OF_CPP.match(self.text, self.here().start):
                    fixes = self.port_of_cpp(declared)
                    notes = (_A_PORT,)
                self.expected("a port (input, output or inout), metadata or xml", notes, fixes)
                self.end_line()
                self.skip_block(inner)
            self.no_block(inner)
        return tuple(body)

    def port_of_cpp(self, declared: re.Match[str]) -> tuple[Fix, ...]:
        """The fix for `InputPort<double> speed` and `std::string place`, in the words of C++."""
        end = line_end(self.text, declared.end())
        direction = _DIRECTIONS_OF_CPP[declared["port"] or "InputPort"]
        type_ = declared["type"] or declared["bare"]
        if self.text[declared.end() : end].partition("#")[0].strip():
            return ()
        plain = type_ is not None and _PLAIN_TYPE.fullmatch(type_) is not None
        after = "" if type_ is None else f" : {type_ if plain else quote(type_)}"
        return (write_fix(f"{direction} {declared['name']}{after}", Span(declared.start(), declared.end())),)

    def meta(self) -> Meta:
        """ "metadata" Attributes NL"""
        start = self.take().start
        if self.kind != OPEN:
            self.expected('attributes in brackets: metadata (key = "value")')
        attributes = self.pairs()
        return Meta(start, self.end_line(), attributes)

    def signal(self) -> Signal:
        """ "signal" NAME ":" UNIT [ "from" BRACED ] [ "level" | … ] [ "fresh" … ] [ "initially" … ] NL"""
        start = self.take().start
        self.skip_glued_colon()
        if self.at_word("from") and self.kinds[self.index + 1] in (BRACED, STRING):
            self.expected("the signal's name", (_a_signal("battery", "{battery}"),))
        name = self.plain_name("the signal's name")
        unit = self.unit() if name is not None and self.at_unit(name) else None
        source = behaviour = fresh = initially = None
        if self.accept_word("from") or self.from_meant():
            source = self.entry_key()
        if self.kind == NAME and self.raw in _BEHAVIOURS:
            behaviour = self.take()
        if self.accept_word("fresh"):
            self.expect_word("within", forgotten=self.kind == QUANTITY)
            fresh = self.quantity("a duration: 5 s")
        if self.accept_word("initially"):
            initially = self.simple(strings=True)
        end = self.end_line((_SIGNAL_ORDER,), self.replaced_by(_SIGNAL_WORDS))
        return Signal(start, end, name, unit, source, behaviour, fresh, initially)

    def context(self) -> Context:
        """ "context" NAME ":" Cond NL"""
        start = self.take().start
        self.skip_glued_colon()
        name = self.plain_name("the context's name")
        condition = self.cond() if self.expect(":", " and a condition") else None
        return Context(start, self.end_line(), name, condition)

    def req_item(self, level: int) -> Requirement:
        """ReqHead { Clause } NL [ INDENT { Clause { Clause } NL } DEDENT ]"""
        requirement = self.requirement()
        self.second_quality(requirement)
        self.end_line()
        return self.clause_block(requirement, level)

    def apply(self) -> Apply:
        """ "apply" ReqRef { "," ReqRef } "to" Selector { "," Selector } [ "except" Selector { "," Selector } ] NL"""
        start = self.take().start
        uses = self.listed(self.applied)
        targets = self.listed(self.selector) if self.expect_word("to", ("on", "for", "at")) else ()
        exceptions = self.listed(self.selector) if self.accept_selection("except", _EXCEPT) else ()
        return Apply(start, self.end_line(), uses, targets, exceptions)

    def applied(self) -> ReqRef | None:
        """ReqRef"""
        name = self.missing_word("a requirement") if self.at_word("to") else self.name("a requirement")
        return self.req_ref(name) if name is not None else None

    def selector(self) -> Selector | None:
        """ "every" Name [ "under" Path ] | "every" "node" "tagged" NAME | Path"""
        start = self.start()
        if self.selects_all():
            return None
        if not (self.accept_word("every") or self.every_meant()):
            path = self.path("a node, or `every` and a node")
            if not self.is_selection(_EXCEPT):
                self.blank_in_path(path, _END_SELECTORS)
            return Selector(path.span.start, path.span.end, path=path) if path else None
        if self.at_word("node") and self.is_word(self.index + 1, "tagged"):
            self.advance()
            self.advance()
            tag = self.name("a tag")
            return Selector(start, self.last_end(), tag=tag)
        if self.at_word("tagged") and self.kinds[self.index + 1] == NAME:
            message = "nodes with a tag are selected with `every node tagged …`"
            self.complain(self.here(), message, self.put_before("node"))
            self.advance()
            return Selector(start, self.last_end(), tag=self.name("a tag"))
        every = self.name("a node's ID or kind")
        under = self.path("a tree or node") if self.accept_selection("under", _UNDER) else None
        return Selector(start, self.last_end(), every=every, path=under)

    def accept_selection(self, word: str, others: tuple[tuple[str, ...], ...]) -> bool:
        """Skip a word between selectors, or report and skip others for it."""
        length = self.is_selection(others)
        if not length:
            return self.accept_word(word)
        last = self.index + length - 1
        span = Span(self.here().start, self.starts[last] + len(self.raws[last]))
        written = self.text[span.start : span.end]
        fix = replace_fix(f"Replace `{written}` with `{word}`", span, word)
        self.complain(span, f"expected `{word}`, found `{written}`", fix)
        self.go_to(last + 1)
        return True

    def is_selection(self, others: tuple[tuple[str, ...], ...]) -> int:
        """The number of words here that are one of `others` and precede a selector; 0 if none are."""
        if self.kind != NAME:
            return 0
        lengths = [len(words) for words in others if tuple(self.raws[self.index : self.index + len(words)]) == words]
        length = max(lengths, default=0)
        return length if self.kinds[self.index + length] in (NAME, STRING) else 0

    def selects_all(self) -> bool:
        """Report `apply r to *` and `apply r to every node`."""
        is_every = self.kind == NAME and self.raw in ("every", "all", "each", "any")
        is_further = is_every and self.raws[self.index + 1] in ("*", "nodes")
        last = self.index + is_further
        if not (is_further or self.at("*") or self.at_word("every")) or self.raws[last + 1] not in _END_SELECTORS:
            return False
        span = Span(self.here().start, self.starts[last] + len(self.raws[last]))
        self.complain(span, "no selector names all nodes", notes=(SELECTORS,))
        self.go_to(last + 1)
        return True

    def tree(self, level: int) -> Tree:
        """ "BehaviorTree" [ [ "ID" "=" ] Name ] [ Attributes ] NL [ INDENT { Port } { ClauseLine } { Node } DEDENT ]"""
        start = self.take().start
        if self.at_word("ID") and self.is_operator(self.index + 1, "="):
            self.advance()
            self.advance()
            name = self.name("the tree's ID")
        elif self.at_word("ID") and self.kinds[self.index + 1] in (NAME, STRING):
            fix = replace_fix("Put `=` after it", Span(self.here().end, self.here().end), " =")
            self.complain(self.here(), "expected `=` after `ID`", fix)
            self.advance()
            name = self.take()
        else:
            self.skip_glued_colon()
            name = self.take() if self.kind == NAME or self.kind == STRING else None
        if self.kind == OPEN and self.at_ports():
            self.ports_in_brackets("tree")
        attributes = self.pairs()
        end = self.end_line()
        ports, clauses, children = self.tree_block(level)
        return Tree(start, end, name, attributes, ports, clauses, children)

    def unquoted_path(self) -> Word | None:
        """Report `include stations.btq`, whose path lacks quotes."""
        has_sign = self.at(":") or self.at("=")
        first = self.index + 1 if has_sign and self.kinds[self.index + 1] != NEWLINE else self.index
        start = self.starts[first]
        end = after = path_end(self.text, start)
        for index in range(first, len(self.kinds)):
            if self.kinds[index] == ERROR and self.raws[index] in ("'", '"'):  # only the opening quote is missing
                end, after = self.starts[index], self.starts[index] + 1
        title, path = "Put quotes around it", quote(self.text[start:end])
        fixes: tuple[Fix, ...] = ()
        if self.at("<") and (closing := self.text.find(">", start, line_end(self.text, start))) > start + 1:
            path = quote(self.text[start + 1 : closing].strip())
            fixes = (write_fix(path, Span(start, closing + 1)),)
        elif end > start and first > self.index:
            fixes = (self.without_sign(title, after, path, safe=False),)
        elif end > start and not has_sign:
            fixes = (replace_fix(title, Span(start, after), path),)
        self.expected("a file in quotes", (), fixes)
        return None

    def without_sign(self, title: str, end: int, text: str, *, safe: bool) -> Fix:
        """A fix that replaces everything from the `:` or `=` after `include` up to `end`, keeping a blank."""
        start = self.starts[self.index]
        blank = "" if self.text[start - 1] in " \t" else " "
        return replace_fix(title, Span(start, end), f"{blank}{text}", safe=safe)

    def at_unit(self, name: Word) -> bool:
        """ ":" before the unit of a signal; its absence is reported"""
        if self.accept(":"):
            return True
        unit = self.index + 1
        notes: tuple[str, ...] = ()
        fixes: tuple[Fix, ...] = ()
        if (self.at("=") or self.kind == NAME) and self.kinds[unit] == BRACED:
            notes = (_a_signal(name.raw, self.raws[unit]),)
        elif self.kind == NAME and sort_of(name.raw):
            notes = (_a_signal(self.raw, f"{{{self.raw}}}"),)
        elif self.at("=") and self.kinds[unit] == QUANTITY and self.kinds[unit + 1] == NEWLINE:
            raw = self.raws[unit]
            symbol = raw[number_end(raw, 0) :].strip()
            span = Span(self.here().start, self.starts[unit] + len(raw))
            fixes = (write_fix(f": {symbol} initially {raw}", span),)
        elif self.kind == OPEN and CLOSE in self.kinds[unit:]:
            closing = self.kinds.index(CLOSE, unit)
            inside = self.text[self.here().end : self.starts[closing]].strip()
            span = Span(self.here().start, self.starts[closing] + len(self.raws[closing]))
            fixes = (write_fix(f": {inside}", span),) if is_unit(inside) else ()
        elif self.at("=") or self.at_word("in") or self.at_word("is"):
            fixes = (write_fix(":", self.here()),)
        self.expected("`:` and the signal's unit", notes, fixes)
        return False

    def from_meant(self) -> bool:
        """Report `= {speed}` after the unit of a signal, and read it as `from {speed}`."""
        is_meant = self.at("=") or (self.kind == NAME and self.raw in _NOT_FROM)
        if not is_meant or self.kinds[self.index + 1] != BRACED:
            return False
        self.complain(self.here(), f"expected `from`, found `{self.raw}`", write_fix("from", self.here(), safe=True))
        self.advance()
        return True

    def entry_key(self) -> Word | None:
        """BRACED"""
        if self.kind == BRACED:
            return self.take()
        key = unquote(self.raw).strip("{}") if self.kind == STRING else self.raw
        fixes = (write_fix(f"{{{key}}}", self.here()),) if is_name(key) else ()
        notes: tuple[str, ...] = ()
        if topic := _TOPIC.match(self.text, self.here().start):
            notes = ("the topic from which `btq verify` takes samples goes under `[evidence.signals]` in btq.toml",)
            fixes = (write_fix(f"{{{topic[2]}}}", Span(topic.start(), topic.end())),)
        self.expected("a blackboard entry: `{key}`", notes, fixes)
        return None


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

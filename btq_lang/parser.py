"""The parser: text to tree, one function a production of the grammar (docs/grammar.md), named as it.

One invariant: it takes every string and never raises; what it cannot understand is one diagnostic, and the next
attribute, line or item is read as if nothing had happened.  It knows the shape of things, not their meaning: `Retry`
and a misspelt `Rety` parse alike.  Nodes, attributes and requirements are in `grammar`.
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.diagnostics.model import Diagnostic, Fix, replace_fix, shifted
from btq_lang.grammar.claims import VERBS
from btq_lang.grammar.conditions import HEADS
from btq_lang.grammar.item_words import ITEM_WORDS, item_word_meant, read_as
from btq_lang.grammar.nodes import NodeParser
from btq_lang.syntax.scan import blanks_end, is_name, is_unit, line_end, number_end, path_end
from btq_lang.syntax.tokens import (
    BRACED,
    CATEGORIES,
    CLOSE,
    DIRECTIONS,
    ERROR,
    NAME,
    NEWLINE,
    NODE_CLAUSES,
    OPEN,
    QUANTITY,
    STRING,
    SYMBOL,
    Token,
)
from btq_lang.syntax.tree import (
    Apply,
    Context,
    Entry,
    Include,
    Item,
    Meta,
    Model,
    Models,
    Port,
    Qualities,
    QualityDecl,
    ReqRef,
    Requirement,
    Root,
    Selector,
    Signal,
    Skipped,
    Tree,
    Verbatim,
    Word,
    moved_by,
    quote,
    unquote,
)
from btq_lang.util.garbage import NotCollecting
from btq_lang.util.record import replace
from btq_lang.util.text import Span, changed

if TYPE_CHECKING:
    from btq_lang.lexer import State

# What an item begins in: the state of the lexer, the levels of the open Roots, and whether there was a Root.
Start: TypeAlias = "tuple[State, tuple[int, ...], bool]"

_BEHAVIOURS: Final = frozenset(("level", "counter", "gauge"))


class Parsed:
    """One file, parsed.

    Attributes:
        text: the file.
        entries: its items in order; those in the block of a `Root` follow their Root.
        starts: for each entry, what the parser stood in when it began; None where it cannot begin again there.
    """

    __slots__ = ("_diagnostics", "_tokens", "entries", "starts", "text")

    def __init__(self, text: str, entries: tuple[Entry, ...], starts: tuple[Start | None, ...]) -> None:
        self.text: Final = text
        self.entries: Final = entries
        self.starts: Final = starts
        self._tokens: tuple[Token, ...] | None = None
        self._diagnostics: tuple[Diagnostic, ...] | None = None

    @property
    def tokens(self) -> tuple[Token, ...]:
        """All tokens, blanks and comments included: joined, their texts are the file.  Made when first asked for."""
        from btq_lang.lexer import tokens  # a check does not ask

        if self._tokens is None:
            self._tokens = tokens(self.text)
        return self._tokens

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """What is wrong with the syntax; spans count from the start of the file."""
        if self._diagnostics is None:
            self._diagnostics = tuple(
                shifted(problem, entry.start) for entry in self.entries for problem in entry.diagnostics
            )
        return self._diagnostics

    @property
    def trees(self) -> tuple[Tree, ...]:
        """The behavior trees, in order."""
        return tuple(entry.item for entry in self.entries if isinstance(entry.item, Tree))


def parse(text: str) -> Parsed:
    """Parse a file.

        >>> from btq_lang import parse
        >>> (tree,) = parse("BehaviorTree Main\\n    Retry\\n        Dock\\n").trees
        >>> [node.head.text for node in tree.walk()]
        ['Retry', 'Dock']

    Args:
        text: any string at all.

    Returns:
        The tree of what could be understood, with a diagnostic for every mistake.
    """
    with NotCollecting():
        parser = Parser(text)
        return Parsed(text, parser.file(), tuple(parser.begun))


def reparse(before: Parsed, text: str, change: Span | None = None) -> Parsed:
    """Parse a file after an edit: the same as `parse(text)`, but what the edit does not touch is taken over.

    From the last item before the change that the parser can begin at, it reads until it comes to an item behind the
    change as it came to it before; items that it did not read anew are the same objects.
    """
    change = change or changed(before.text, text)
    if change is None:
        return before
    first = _first_touched(before, change.start)
    by = len(text) - len(before.text)
    old = before.entries
    behind = {
        old[index].start + by: index
        for index in range(bisect_left(old, change.end, first, key=lambda entry: entry.start), len(old))
        if before.starts[index] is not None
    }
    with NotCollecting():
        parser = Parser(text)
        if first:
            parser.begin_at(old[first].start, before.starts[first])
        entries = parser.file({start: before.starts[index] for start, index in behind.items()})
    if not parser.has_met:
        return Parsed(text, old[:first] + entries, (*before.starts[:first], *parser.begun))
    last = behind[parser.lexer.line_start]
    moved = tuple([entry if by == 0 else moved_by(entry, by) for entry in old[last:]])
    return Parsed(text, old[:first] + entries + moved, (*before.starts[:first], *parser.begun, *before.starts[last:]))


def _first_touched(before: Parsed, change: int) -> int:
    """The first entry that may be another after a change there: an item's first line says where the one before it
    ends, so a change in that line touches both."""
    first = bisect_right(before.entries, change, key=lambda entry: entry.start) - 1
    if first > 0:
        entry = before.entries[first]
        if change <= line_end(before.text, entry.start + entry.item.start):
            first -= 1
    while first > 0 and before.starts[first] is None:
        first -= 1
    return max(first, 0)


class Parser(NodeParser):
    """The state of one parse: the cursor, the open item, and what was found so far.

    Attributes:
        begun: for each entry, the state that it began in.
        has_met: it stands where an earlier parse stood in the same state, and need read no further.
    """

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.entries: list[Entry] = []
        self.begun: list[Start | None] = []
        self.has_met = False
        self.has_root = False
        self.roots: list[int] = []  # the levels of the Roots whose blocks are open, for more than one is a mistake
        self.stray_level = -1  # the level of lines indented for no reason, reported once

    # ---- file and items ----

    def file(self, meeting: dict[int, Start | None] | None = None) -> tuple[Entry, ...]:
        """File = { Item }

        Args:
            meeting: where an earlier parse stood, by the start of the line, in which state.
        """
        self.more = self.lexer.open_line()
        while self.more:
            while self.roots and self.lexer.level <= self.roots[-1]:
                self.roots.pop()
            state = self.state()
            if meeting is not None and state is not None and meeting.get(self.lexer.line_start) == state:
                self.has_met = True
                return tuple(self.entries)
            self.begun.append(state)
            self.item(self.roots[-1] + 1 if self.roots else 0, bool(self.roots))
        if self.problems or self.lexer.problems:  # behind the last item, or in a file without any
            self.base = 0
            self.begun.append(None)
            self.entry(Skipped(len(self.text), len(self.text)), False)
        return tuple(self.entries)

    def state(self) -> Start | None:
        """What the next item depends on besides its text; None where that is more than can be said in short: after
        mistakes whose traces go on, and where the rest of the file was searched for the end of something."""
        if self.problems or self.stray_level >= 0 or self.inside_out <= len(self.text) or self.is_in_wake():
            return None
        lexer = self.lexer.state()
        return None if lexer is None else (lexer, tuple(self.roots), self.has_root)

    def begin_at(self, start: int, state: Start | None) -> None:
        """Go on from the start of a line, as a parser does that has come there in this state."""
        assert state is not None, "a parse begins again only where that can be said"
        lexer, roots, self.has_root = state
        self.roots = list(roots)
        self.lexer.begin_at(start, lexer)

    def item(self, level: int, in_root: bool) -> None:
        """Item = Include | Qualities | QualityDecl | Models | Model | Signal | Context | ReqItem | Apply | Root | …"""
        self.base = self.lexer.line_start
        found_at = self.lexer.level
        self.scan()
        if found_at > level and found_at != self.stray_level:
            self.complain("syntax-error", self.here(), "unexpected indentation: no block is open above this line")
        self.stray_level = found_at if found_at > level else -1
        word = self.item_word()
        item: Item
        if word == "BehaviorTree":
            item = self.tree(found_at)
        elif word == "Root":
            self.root(found_at, in_root)
            return
        elif word in CATEGORIES:
            item = self.model(found_at)
        elif word == "QualityReq":
            item = self.req_item(found_at)
        elif word == "TreeNodesModel":
            item = self.models(found_at)
        elif word == "include":
            item = self.include()
        elif word == "signal":
            item = self.signal()
        elif word == "context":
            item = self.context()
        elif word == "apply":
            item = self.apply()
        elif word == "quality":
            item = self.quality_decl()
        elif word == "qualities":
            item = self.qualities()
        elif word == "xml":
            item = self.verbatim()
        else:
            item = self.skipped(found_at)
        if self.deeper(found_at) and not self.begins_item():
            self.no_block(found_at)
        self.entry(item, in_root)

    def item_word(self) -> str:
        """The word that begins the item; a misspelt one is reported and mostly read as the word that was meant."""
        if self.kind != NAME:
            return ""
        if self.raw in ITEM_WORDS:
            return self.raw
        meant = item_word_meant(self.raw)
        following = self.kinds[self.index + 1]
        other = _OTHER_ITEMS.get(self.raw.lower())
        if other is not None and following in (NAME, STRING) and self.raws[self.index + 1] not in VERBS:
            message = f"unknown word `{self.raw}`; did you mean `{other}`?"
            self.complain("syntax-error", self.here(), message, (), (self.other_item(other),))
            return "" if other == "include" or self.raw in ("def", "class") else other
        if not meant or not (following in (NAME, STRING) or (meant in _ALONE and following in (NEWLINE, OPEN))):
            return ""
        fix = replace_fix(f"Replace `{self.raw}` with `{meant}`", self.here(), meant)
        message = f"unknown word `{self.raw}`; did you mean `{meant}`?"
        self.complain("syntax-error", self.here(), message, (), (fix,))
        return read_as(self.raw)

    def begins_item(self) -> bool:
        """Whether the open line looks like an item, wherever it stands; a node may look like a model."""
        if not self.more:
            return False
        word = self.lexer.first_word()
        return word in ITEM_WORDS and word not in CATEGORIES and word != "xml"

    def entry(self, item: Item, in_root: bool) -> None:
        """File the item with the problems found before the line now open; they count from the item's start."""
        found = self.problems + self.lexer.problems
        self.problems = []
        self.lexer.problems = []
        if found:
            end = self.lexer.line_start if self.more else len(self.text) + 1
            self.lexer.problems = [problem for problem in found if problem.span.start >= end]
            found = sorted(
                (shifted(problem, -self.base) for problem in found if problem.span.start < end),
                key=lambda problem: problem.span,
            )
        causes = _root_causes(found, self.inside_out - self.base) if found else ()
        self.entries.append(Entry(self.base, item, in_root, causes))

    def include(self) -> Include:
        """ "include" STRING [ Attributes ] NL"""
        start = self.take().start
        if self.at_word("path") and self.is_operator(self.index + 1, "=") and self.kinds[self.index + 2] == STRING:
            gone = Span(self.here().start, self.starts[self.index + 2])
            fix = replace_fix("Remove `path =`", gone, "", safe=True)
            self.complain("syntax-error", self.here(), "the path of an include needs no `path =`", (), (fix,))
            self.go_to(self.index + 2)
        elif (self.at(":") or self.at("=")) and self.kinds[self.index + 1] == STRING:
            behind = blanks_end(self.text, self.starts[self.index] + 1, len(self.text))
            fix = self.without_sign(f"Remove `{self.raw}`", behind, "", safe=True)
            self.complain("syntax-error", self.here(), f"unexpected `{self.raw}`", (), (fix,))
            self.advance()
        path = self.take() if self.kind == STRING else self.unquoted_path()
        attributes = self.pairs_only()
        return Include(start, self.end_line(), path, attributes)

    def unquoted_path(self) -> Word | None:
        """Complain of `include stations.btq`; there is no path."""
        has_sign = self.at(":") or self.at("=")
        first = self.index + 1 if has_sign and self.kinds[self.index + 1] != NEWLINE else self.index
        start = self.starts[first]
        end = behind = path_end(self.text, start)
        for index in range(first, len(self.kinds)):
            if self.kinds[index] == ERROR and self.raws[index] in ("'", '"'):  # only the opening quote is missing
                end, behind = self.starts[index], self.starts[index] + 1
        title, path = "Put quotes around it", quote(self.text[start:end])
        fixes: tuple[Fix, ...] = ()
        if self.at("<") and (closing := self.text.find(">", start, line_end(self.text, start))) > start + 1:
            path = quote(self.text[start + 1 : closing].strip())
            fixes = (replace_fix(f"Write `{path}`", Span(start, closing + 1), path),)
        elif end > start and first > self.index:
            fixes = (self.without_sign(title, behind, path, safe=False),)
        elif end > start and not has_sign:
            fixes = (replace_fix(title, Span(start, behind), path),)
        self.expected("a file in quotes", (), fixes)
        return None

    def without_sign(self, title: str, end: int, text: str, *, safe: bool) -> Fix:
        """Write a text from the `:` or `=` behind `include` on, up to `end`; a blank stays before it."""
        start = self.starts[self.index]
        blank = "" if self.text[start - 1] in " \t" else " "
        return replace_fix(title, Span(start, end), f"{blank}{text}", safe=safe)

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
        if self.kind == OPEN and self.kinds[self.index + 1] in (NAME, CLOSE) and self.is_operator(self.index + 2, ":"):
            note = "a port goes on a line of its own below the node, indented: `input name : type`"
            self.complain("syntax-error", self.here(), "ports do not go in brackets", (note,))
            self.go_to(len(self.kinds) - 1)
        attributes = self.pairs_only()
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
                fix = replace_fix(f"Write `{direction}`", self.here(), direction, safe=True)
                message = f"unknown word `{self.raw}`; did you mean `{direction}`?"
                self.complain("syntax-error", self.here(), message, (), (fix,))
                body.append(self.port(direction))
            elif self.kind == NAME and self.raw == "metadata":
                body.append(self.meta())
            elif self.kind == NAME and self.raw == "xml":
                body.append(self.verbatim())
            else:
                fixes = self.replaced_by((*sorted(DIRECTIONS), "metadata", "xml"))
                if self.kind == NAME and self.raw in ("in", "out"):
                    fixes = (replace_fix(f"Write `{self.raw}put`", self.here(), f"{self.raw}put", safe=True),)
                self.expected("a port (input, output or inout), metadata or xml", (), fixes)
                self.end_line()
                self.skip_block(inner)
            self.no_block(inner)
        return tuple(body)

    def meta(self) -> Meta:
        """ "metadata" Attributes NL"""
        start = self.take().start
        if self.kind != OPEN:
            self.expected('attributes in brackets: metadata (key = "value")')
        attributes = self.pairs_only()
        return Meta(start, self.end_line(), attributes)

    def signal(self) -> Signal:
        """ "signal" NAME ":" UNIT [ "from" BRACED ] [ "level" | … ] [ "fresh" … ] [ "initially" … ] NL"""
        start = self.take().start
        self.skip_glued_colon()
        name = self.plain_name("the signal's name")
        unit = self.unit() if self.at_unit() else None
        source = behaviour = fresh = initially = None
        if self.accept_word("from"):
            source = self.entry_key()
        if self.kind == NAME and self.raw in _BEHAVIOURS:
            behaviour = self.take()
        if self.accept_word("fresh"):
            self.expect_word("within", forgotten=self.kind == QUANTITY)
            fresh = self.quantity("a duration: 5 s")
        if self.accept_word("initially"):
            initially = self.amount(strings=True)
        end = self.end_line((_SIGNAL_ORDER,), self.replaced_by(_SIGNAL_WORDS))
        return Signal(start, end, name, unit, source, behaviour, fresh, initially)

    def at_unit(self) -> bool:
        """ ":" before the unit of a signal, whose absence is reported"""
        if self.accept(":"):
            return True
        unit = self.index + 1
        fixes: tuple[Fix, ...] = ()
        if self.at("=") and self.kinds[unit] == QUANTITY and self.kinds[unit + 1] == NEWLINE:
            raw = self.raws[unit]
            symbol = raw[number_end(raw, 0) :].strip()
            span = Span(self.here().start, self.starts[unit] + len(raw))
            fixes = (replace_fix(f"Write `: {symbol} initially {raw}`", span, f": {symbol} initially {raw}"),)
        elif self.kind == OPEN and CLOSE in self.kinds[unit:]:
            closing = self.kinds.index(CLOSE, unit)
            inside = self.text[self.here().end : self.starts[closing]].strip()
            span = Span(self.here().start, self.starts[closing] + len(self.raws[closing]))
            fixes = (replace_fix(f"Write `: {inside}`", span, f": {inside}"),) if is_unit(inside) else ()
        elif self.at("=") or self.at_word("in") or self.at_word("is"):
            fixes = (replace_fix("Write `:`", self.here(), ":"),)
        self.expected("`:` and the signal's unit", (), fixes)
        return False

    def entry_key(self) -> Word | None:
        """BRACED"""
        if self.kind == BRACED:
            return self.take()
        key = unquote(self.raw).strip("{}") if self.kind == STRING else self.raw
        fixes = (replace_fix(f"Write `{{{key}}}`", self.here(), f"{{{key}}}"),) if is_name(key) else ()
        self.expected("a blackboard entry: `{key}`", (), fixes)
        return None

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
        uses: list[ReqRef] = []
        while name := self.missing_word("a requirement") if self.at_word("to") else self.name("a requirement"):
            uses.append(self.req_ref(name))
            if not self.accept(","):
                break
        targets = self.selectors() if self.expect_word("to", ("on", "for", "at")) else ()
        exceptions = self.selectors() if self.accept_word("except") else ()
        return Apply(start, self.end_line(), tuple(uses), targets, exceptions)

    def selectors(self) -> tuple[Selector, ...]:
        """Selector { "," Selector }"""
        found: list[Selector] = []
        while selector := self.selector():
            found.append(selector)
            if not self.accept(","):
                break
        return tuple(found)

    def selector(self) -> Selector | None:
        """ "every" Name [ "under" Path ] | "every" "node" "tagged" NAME | Path"""
        start = self.start()
        if not (self.accept_word("every") or self.every_meant()):
            path = self.path("a node, or `every` and a node")
            self.blank_in_path(path, _END_SELECTORS)
            return Selector(path.span.start, path.span.end, path=path) if path else None
        if self.at_word("node") and self.is_word(self.index + 1, "tagged"):
            self.advance()
            self.advance()
            tag = self.name("a tag")
            return Selector(start, self.last_end(), tag=tag)
        if self.at_word("tagged") and self.kinds[self.index + 1] == NAME:
            fix = replace_fix("Put `node` before it", Span(self.here().start, self.here().start), "node ")
            self.complain(
                "syntax-error", self.here(), "nodes with a tag are selected with `every node tagged …`", (), (fix,)
            )
            self.advance()
            return Selector(start, self.last_end(), tag=self.name("a tag"))
        every = self.name("a node's ID or kind")
        under = self.path("a tree or node") if self.accept_word("under") else None
        return Selector(start, self.last_end(), every=every, path=under)

    def root(self, level: int, in_root: bool) -> None:
        """ "Root" [ Name ] [ Attributes ] NL [ INDENT { Item } DEDENT ]: at most one, none inside a Root"""
        word = self.take()
        self.skip_sign(":", "=")
        self.skip_root_key()
        name = self.take() if self.kind == NAME or self.kind == STRING else None
        bracketed = self.kind == OPEN
        attributes = self.pairs_only()
        if self.has_root:
            where = "unexpected Root inside another Root" if in_root else "unexpected second Root in this file"
            note = "a mission begins in one place: keep the Root that names its main tree, or move one to another file"
            self.complain("second-root", word.span.shifted(self.base), where, (note,))
        self.has_root = True
        end = self.end_line()
        item = Root(word.start, end, name, attributes, bracketed)
        self.entry(item, in_root)
        self.roots.append(level)

    def skip_root_key(self) -> None:
        """Report the attribute of XML before the name of the main tree, and pass over it: `Root ID = Main`."""
        value = self.index + 2
        if not self.at_key() or self.kinds[value] not in (NAME, STRING):
            return
        fix = replace_fix(f"Remove `{self.raw} =`", Span(self.here().start, self.starts[value]), "")
        message = "expected the main tree's name after `Root`"
        self.complain("syntax-error", self.here(), message, ("attributes go in brackets: `(key = value)`",), (fix,))
        self.go_to(value)

    def tree(self, level: int) -> Tree:
        """ "BehaviorTree" [ [ "ID" "=" ] Name ] [ Attributes ] NL [ INDENT { Port } { ClauseLine } { Node } DEDENT ]"""
        start = self.take().start
        if self.at_word("ID") and self.is_operator(self.index + 1, "="):
            self.advance()
            self.advance()
            name = self.name("the tree's ID")
        elif self.at_word("ID") and self.kinds[self.index + 1] in (NAME, STRING):
            fix = replace_fix("Put `=` after it", Span(self.here().end, self.here().end), " =")
            self.complain("syntax-error", self.here(), "expected `=` after `ID`", (), (fix,))
            self.advance()
            name = self.take()
        else:
            self.skip_glued_colon()
            name = self.take() if self.kind == NAME or self.kind == STRING else None
        attributes = self.pairs_only()
        end = self.end_line()
        ports, clauses, children = self.tree_block(level)
        return Tree(start, end, name, attributes, ports, clauses, children)

    def skipped(self, level: int) -> Skipped:
        """Lines that begin no item: the first is reported, all of them and their blocks are passed over."""
        start = self.start()
        notes: tuple[str, ...] = ()
        if self.at_word("from") and "import" in self.raws[self.index + 2 : self.index + 3]:
            notes = ('another file is read with `include "stations.btq"`',)
        elif self.kind == NAME and self.raw in NODE_CLAUSES:
            notes = ("write it after a node, or indented in the block of a node or BehaviorTree",)
        elif self.kind == NAME and (self.raw in VERBS or self.raw in HEADS):
            notes = ("a clause goes in the block of a QualityReq, indented",)
        elif self.kind == NAME and self.raw in DIRECTIONS:
            notes = ("a port goes in the block of a model or BehaviorTree, indented",)
        elif self.kind == STRING and unquote(self.raw) in ITEM_WORDS:
            notes = ("a word in quotes is a name, not a keyword; remove the quotes",)
        elif self.text.startswith("<!--", self.here().start):
            self.other_comment(self.here().start + len("<!--"))
        elif self.at("<"):
            self.complain("syntax-error", *self.xml_here())
        elif self.kind == SYMBOL or (self.at_name() and self.kinds[self.index + 1] in (NEWLINE, OPEN)):
            notes = ("a node goes in the block of a BehaviorTree, indented",)
        if self.kind != NEWLINE:
            self.expected("an item: BehaviorTree, QualityReq, include, signal, …", notes)
        end = self.end_line()
        while self.more and not self.ends_skipping(level):
            known = len(self.lexer.problems)
            self.scan()
            del self.lexer.problems[known:]
            self.go_to(len(self.kinds) - 1)
            end = self.end_line()
        return Skipped(start, end)

    def other_item(self, meant: str) -> Fix:
        """The fix for an item as another language writes it: `import stations`, `def main():`."""
        at = self.here()
        rest = Span(self.starts[self.index + 1], line_end(self.text, at.start))
        title = f"Replace `{self.raw}` with `{meant}`"
        if meant == "include" and self.kinds[self.index + 1] == NAME and self.kinds[self.index + 2] == NEWLINE:
            end = path_end(self.text, rest.start)
            name = self.text[rest.start : end]
            return replace_fix(title, Span(at.start, end), f"include {quote(name if '.' in name else f'{name}.btq')}")
        if meant == "BehaviorTree" and (head := _PYTHON_HEAD.match(self.text, rest.start)):
            return replace_fix(title, Span(at.start, head.end()), f"BehaviorTree {head[1]}")
        return replace_fix(title, at, meant)

    def ends_skipping(self, level: int) -> bool:
        """Whether the open line is an item again, or what is meant for one, or stands further left."""
        if self.lexer.level > level:
            return self.begins_item()
        word = self.lexer.first_word()
        if self.lexer.level < level or word in ITEM_WORDS:
            return True
        return not word.startswith("<") and bool(item_word_meant(word))


_ALONE: Final = ("BehaviorTree", "Root", "TreeNodesModel")  # items that may go without a name
_OTHER_ITEMS: Final = {  # what people write for them, in small letters
    **dict.fromkeys(("import", "require", "use"), "include"),
    **dict.fromkeys(("requirement", "req", "qualityrequirement"), "QualityReq"),
    **dict.fromkeys(("mission", "tree", "behaviourtree", "bt", "def", "class"), "BehaviorTree"),
    **dict.fromkeys(("sensor", "variable", "var", "measure", "metric"), "signal"),
    **dict.fromkeys(("mode", "situation"), "context"),
}
_PYTHON_HEAD: Final = re.compile(r"([^\W\d]\w*)[ \t]*(?:\([^()\r\n]*\))?[ \t]*:(?=[ \t]*[\r\n])")
_END_SELECTORS: Final = frozenset((",", "except", "\n", "\r\n", "\r", ""))
_SIGNAL_WORDS: Final = ("from", *sorted(_BEHAVIOURS), "fresh", "initially")
_SIGNAL_ORDER: Final = "the order is: signal x : % from {x} level fresh within 5 s initially 100 %"


def _root_causes(found: list[Diagnostic], inside_out: int) -> tuple[Diagnostic, ...]:
    """Where a quote is missing, and what follows makes no sense, the string that lacks it is the one mistake.

    Args:
        inside_out: where the parser has noticed that.
    """
    kept: list[Diagnostic] = []
    for index, problem in enumerate(found):
        if problem.span.start >= inside_out:
            break
        if problem.rule == "string-over-items":
            if any(other.rule in ("syntax-error", "unclosed-string") for other in found[index + 1 :]):
                notes = ("add the closing quote",)
                return (*kept, replace(problem, rule="unclosed-string", notes=notes))
            return (*found[: index + 1], *(other for other in found[index + 1 :] if other.rule != problem.rule))
        kept.append(problem)
    return tuple(kept)

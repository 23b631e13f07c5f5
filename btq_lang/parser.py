"""The parser: text to tree, one function for each production of the grammar (docs/grammar.md), named after it.

One invariant: it accepts every string and never raises; each mistake is one diagnostic, after which parsing resumes at
the next attribute, line or item.  It knows syntax, not meaning: `Retry` and a misspelt `Rety` parse alike.  This module
has the productions for the file, its sequence of items, and Root; all others are in `grammar`.
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from typing import Final, TypeAlias

from btq_lang.diagnostics.model import Diagnostic, Fix, replace_fix, shifted
from btq_lang.grammar.claims import VERB_WORDS
from btq_lang.grammar.conditions import HEADS
from btq_lang.grammar.item_words import ITEM_WORDS, item_word_meant, read_as
from btq_lang.grammar.items import ItemParser
from btq_lang.lexer import Lexer, State, tokens
from btq_lang.syntax.scan import Maps, line_end, path_end
from btq_lang.syntax.tokens import CATEGORIES, DIRECTIONS, NAME, NEWLINE, NODE_CLAUSES, OPEN, STRING, SYMBOL, Token
from btq_lang.syntax.tree import Entry, Item, Root, SkippedLines, Tree, moved_by, quote, unquote
from btq_lang.util.garbage import NotCollecting
from btq_lang.util.record import replace
from btq_lang.util.text import Span, changed

# The state at the start of an item: that of the lexer, the levels of the open Roots, and whether there was a Root.
Start: TypeAlias = "tuple[State, tuple[int, ...], bool]"


class Parsed:
    """One file, parsed.

    Attributes:
        text: of the file.
        entries: its items in order; those in the block of a `Root` follow their Root.
        starts: for each entry, the parser's state at its start; None if parsing cannot restart there.
        maps: of the text, for the next parse.
    """

    __slots__ = ("_tokens", "entries", "maps", "starts", "text")

    def __init__(self, text: str, maps: Maps, entries: tuple[Entry, ...], starts: tuple[Start | None, ...]) -> None:
        self.text: Final = text
        self.maps: Final = maps
        self.entries: Final = entries
        self.starts: Final = starts
        self._tokens: tuple[Token, ...] | None = None

    @property
    def tokens(self) -> tuple[Token, ...]:
        """All tokens, blanks and comments included: joined, their texts are the file.  Computed on first use."""
        if self._tokens is None:
            self._tokens = tokens(self.text)
        return self._tokens

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The syntax diagnostics; spans count from the start of the file."""
        return tuple(shifted(problem, entry.start) for entry in self.entries for problem in entry.diagnostics)

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
        text: any string.

    Returns:
        The tree of all valid parts, with a diagnostic for every mistake.
    """
    with NotCollecting():
        parser = Parser(Lexer(text))
        return Parsed(text, parser.lexer.maps, parser.file(), tuple(parser.begun))


def reparse(before: Parsed, text: str, change: Span | None = None) -> Parsed:
    """Parse a file after an edit: equal to `parse(text)`, but reuses what the edit does not touch.

    Parsing restarts at the last possible item before the change and stops at an item after it that the earlier parse
    reached in the same state; all other items are the same objects.
    """
    change = change or changed(before.text, text)
    if change is None:
        return before
    first = _first_touched(before, change.start)
    by = len(text) - len(before.text)
    maps = before.maps.edited(change.start, change.end, text[change.start : change.end + by])
    old = before.entries
    after = {
        old[index].start + by: index
        for index in range(bisect_left(old, change.end, first, key=lambda entry: entry.start), len(old))
        if before.starts[index] is not None
    }
    with NotCollecting():
        parser = Parser(Lexer(text, maps))
        if first:
            parser.begin_at(old[first].start, before.starts[first])
        entries = parser.file({start: before.starts[index] for start, index in after.items()})
    if not parser.has_met:
        return Parsed(text, maps, old[:first] + entries, (*before.starts[:first], *parser.begun))
    last = after[parser.lexer.line_start]
    moved = tuple([entry if by == 0 else moved_by(entry, by) for entry in old[last:]])
    starts = (*before.starts[:first], *parser.begun, *before.starts[last:])
    return Parsed(text, maps, old[:first] + entries + moved, starts)


def _first_touched(before: Parsed, change: int) -> int:
    """The first entry that a change may affect: an item's first line determines where the one before it ends, so a
    change in that line affects both.
    """
    first = bisect_right(before.entries, change, key=lambda entry: entry.start) - 1
    if first > 0:
        entry = before.entries[first]
        if change <= line_end(before.text, entry.start + entry.item.start):
            first -= 1
    while first > 0 and before.starts[first] is None:
        first -= 1
    return max(first, 0)


class Parser(ItemParser):
    """The state of one parse: the cursor, the open item, and what was found so far.

    Attributes:
        begun: for each entry, the state that it began in.
        has_met: it has reached a place and state of an earlier parse, and can stop.
    """

    def __init__(self, lexer: Lexer) -> None:
        super().__init__(lexer)
        self.entries: list[Entry] = []
        self.begun: list[Start | None] = []
        self.has_met = False
        self.has_root = False
        self.roots: list[int] = []  # the levels of the Roots whose blocks are open; more than one is a mistake
        self.stray_level = -1  # the level of wrongly indented lines, reported once

    # ---- file and items ----

    def file(self, meeting: dict[int, Start | None] | None = None) -> tuple[Entry, ...]:
        """File = { Item }

        Args:
            meeting: the states of an earlier parse, by the start of the line.
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
        if self.problems or self.lexer.problems:  # after the last item, or in a file without any
            self.base = 0
            self.begun.append(None)
            self.entry(SkippedLines(len(self.text), len(self.text)), False)
        return tuple(self.entries)

    def state(self) -> Start | None:
        """What the next item depends on besides its text; None if that is not a small state: after mistakes with
        lasting effects, and if the rest of the file was searched for the end of something.
        """
        if self.problems or self.stray_level >= 0 or self.inside_out <= len(self.text) or self.is_in_wake():
            return None
        lexer = self.lexer.state()
        return None if lexer is None else (lexer, tuple(self.roots), self.has_root)

    def begin_at(self, start: int, state: Start | None) -> None:
        """Continue from the start of a line in this state."""
        assert state is not None, "a parse begins again only where that can be said"
        lexer, roots, self.has_root = state
        self.roots = list(roots)
        self.lexer.begin_at(start, lexer)

    def item(self, level: int, in_root: bool) -> None:
        """Item = Include | Qualities | QualityDecl | Models | Model | Signal | Context | ReqItem | Apply | Root | …"""
        self.base = self.lexer.line_start
        own_level = self.lexer.level
        self.scan()
        if own_level > level and own_level != self.stray_level:
            self.complain(self.here(), "unexpected indentation: no block is open above this line")
        self.stray_level = own_level if own_level > level else -1
        word = self.item_word()
        item: Item
        if word == "BehaviorTree":
            item = self.tree(own_level)
        elif word == "Root":
            self.root(own_level, in_root)
            return
        elif word in CATEGORIES:
            item = self.model(own_level)
        elif word == "QualityReq":
            item = self.req_item(own_level)
        elif word == "TreeNodesModel":
            item = self.models(own_level)
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
            item = self.skipped(own_level)
        if self.deeper(own_level) and not self.begins_item():
            self.no_block(own_level)
        self.entry(item, in_root)

    def item_word(self) -> str:
        """The word that begins the item; a misspelt one is reported, and usually read as the word that was meant."""
        if self.kind != NAME:
            return ""
        if self.raw in ITEM_WORDS:
            return self.raw
        meant = item_word_meant(self.raw)
        following = self.kinds[self.index + 1]
        other = _OTHER_ITEMS.get(self.raw.lower())
        if other is not None and following in (NAME, STRING) and self.raws[self.index + 1] not in VERB_WORDS:
            self.complain(self.here(), f"unknown word `{self.raw}`; did you mean `{other}`?", self.other_item(other))
            return "" if other == "include" or self.raw in ("def", "class") else other
        if not meant or not (following in (NAME, STRING) or (meant in _ALONE and following in (NEWLINE, OPEN))):
            return ""
        self.misspelt(self.here(), self.raw, meant)
        return read_as(self.raw)

    def begins_item(self) -> bool:
        """Whether the open line looks like an item, wherever it is; a node may look like a model."""
        if not self.more:
            return False
        word = self.lexer.first_word()
        return word in ITEM_WORDS and word not in CATEGORIES and word != "xml"

    def entry(self, item: Item, in_root: bool) -> None:
        """Add the item, with the problems found before the open line; their offsets count from the item's start."""
        problems = self.problems + self.lexer.problems
        self.problems = []
        self.lexer.problems = []
        if problems:
            end = self.lexer.line_start if self.more else len(self.text) + 1
            self.lexer.problems = [problem for problem in problems if problem.span.start >= end]
            problems = sorted(
                (shifted(problem, -self.base) for problem in problems if problem.span.start < end),
                key=lambda problem: problem.span,
            )
        causes = _root_causes(problems, self.inside_out - self.base) if problems else ()
        self.entries.append(Entry(self.base, item, in_root, causes))

    def root(self, level: int, in_root: bool) -> None:
        """ "Root" [ Name ] [ Attributes ] NL [ INDENT { Item } DEDENT ]: at most one, none inside a Root"""
        word = self.take()
        self.skip_sign(":", "=")
        self.skip_root_key()
        name = self.take() if self.kind == NAME or self.kind == STRING else None
        bracketed = self.kind == OPEN
        attributes = self.pairs()
        if self.has_root:
            where = "unexpected Root inside another Root" if in_root else "unexpected second Root in this file"
            note = "a mission begins in one place: keep the Root that names its main tree, or move one to another file"
            self.complain(word.span.shifted(self.base), where, notes=(note,), rule="second-root")
        self.has_root = True
        end = self.end_line()
        item = Root(word.start, end, name, attributes, bracketed)
        self.entry(item, in_root)
        self.roots.append(level)

    def skip_root_key(self) -> None:
        """Report and skip the XML attribute before the name of the main tree: `Root ID = Main`."""
        value = self.index + 2
        if not self.at_key() or self.kinds[value] not in (NAME, STRING):
            return
        fix = replace_fix(f"Remove `{self.raw} =`", Span(self.here().start, self.starts[value]), "")
        message = "expected the main tree's name after `Root`"
        self.complain(self.here(), message, fix, notes=("attributes go in brackets: `(key = value)`",))
        self.go_to(value)

    def skipped(self, level: int) -> SkippedLines:
        """Skip lines that do not begin an item, with their blocks; report the first."""
        start = self.start()
        notes: tuple[str, ...] = ()
        fixes: tuple[Fix, ...] = ()
        if self.kind == STRING and self.is_doc_string():
            self.other_comment(self.here().start + 3)
        elif self.is_after_dashes():
            self.other_comment(self.here().start + 2)
        elif self.at_key() and self.raw == "main_tree_to_execute":
            span = Span(self.here().start, self.starts[self.index + 2])
            notes, fixes = ("`Root` names the main tree",), (replace_fix("Write `Root`", span, "Root "),)
        elif self.at_key():
            notes = (_A_VALUE,)
        elif self.at("/") and self.kinds[self.index + 1] == NAME and self.kinds[self.index + 2] == NEWLINE:
            span = Span(self.here().start, line_end(self.text, self.here().start))
            notes = ("a block ends where its indentation does, without a line of its own",)
            fixes = (replace_fix("Remove it", span, ""),)
        elif self.at_word("from") and "import" in self.raws[self.index + 2 : self.index + 3]:
            notes = ('another file is read with `include "stations.btq"`',)
        elif self.kind == NAME and self.raw in NODE_CLAUSES:
            notes = ("write it after a node, or indented in the block of a node or BehaviorTree",)
        elif self.kind == NAME and (self.raw in VERB_WORDS or self.raw in HEADS):
            notes = ("a clause goes in the block of a QualityReq, indented",)
        elif self.kind == NAME and self.raw in DIRECTIONS:
            notes = ("a port goes in the block of a model or BehaviorTree, indented",)
        elif self.kind == STRING and unquote(self.raw) in ITEM_WORDS:
            notes = ("a word in quotes is a name, not a keyword; remove the quotes",)
        elif self.text.startswith("<!--", self.here().start):
            self.other_comment(self.here().start + len("<!--"))
        elif self.at("<"):
            self.found_xml()
        elif self.kind == SYMBOL or (self.at_name() and self.kinds[self.index + 1] in (NEWLINE, OPEN)):
            notes = ("a node goes in the block of a BehaviorTree, indented",)
        if self.kind != NEWLINE:
            self.expected("an item: BehaviorTree, QualityReq, include, signal, …", notes, fixes)
        end = self.end_line()
        while self.more and not self.ends_skipping(level):
            count = len(self.lexer.problems)
            self.scan()
            del self.lexer.problems[count:]
            self.go_to(len(self.kinds) - 1)
            end = self.end_line()
        return SkippedLines(start, end)

    def other_item(self, meant: str) -> Fix:
        """The fix for an item in the syntax of another language: `import stations`, `def main():`."""
        word = self.here()
        tail = Span(self.starts[self.index + 1], line_end(self.text, word.start))
        title = f"Replace `{self.raw}` with `{meant}`"
        if meant == "include" and self.kinds[self.index + 1] == NAME and self.kinds[self.index + 2] == NEWLINE:
            end = path_end(self.text, tail.start)
            name = self.text[tail.start : end]
            return replace_fix(title, Span(word.start, end), f"include {quote(name if '.' in name else f'{name}.btq')}")
        if meant == "BehaviorTree" and (head := _PYTHON_HEAD.match(self.text, tail.start)):
            return replace_fix(title, Span(word.start, head.end()), f"BehaviorTree {head[1]}")
        return replace_fix(title, word, meant)

    def ends_skipping(self, level: int) -> bool:
        """Whether the open line is an item, is probably meant as one, or has less indentation."""
        if self.lexer.level > level:
            return self.begins_item()
        word = self.lexer.first_word()
        if self.lexer.level < level or word in ITEM_WORDS:
            return True
        return not word.startswith("<") and bool(item_word_meant(word))


_A_VALUE: Final = 'a value goes to a port: `MoveBase (speed = 0.5)`; or to an entry: `Script (code = "speed := 0.5")`'
_ALONE: Final = ("BehaviorTree", "Root", "TreeNodesModel")  # items whose name is optional
_OTHER_ITEMS: Final = {  # words of other languages, in lower case
    **dict.fromkeys(("import", "require", "use"), "include"),
    **dict.fromkeys(("requirement", "req", "qualityrequirement"), "QualityReq"),
    **dict.fromkeys(("mission", "tree", "behaviourtree", "bt", "def", "class"), "BehaviorTree"),
    **dict.fromkeys(("sensor", "variable", "var", "measure", "metric"), "signal"),
    **dict.fromkeys(("mode", "situation"), "context"),
}
_PYTHON_HEAD: Final = re.compile(r"([^\W\d]\w*)[ \t]*(?:\([^()\r\n]*\))?[ \t]*:(?=[ \t]*[\r\n])")


def _root_causes(problems: list[Diagnostic], inside_out: int) -> tuple[Diagnostic, ...]:
    """If a quote is missing and makes what follows invalid, only the string that lacks it is reported.

    Args:
        inside_out: where the parser noticed that.
    """
    kept: list[Diagnostic] = []
    for index, problem in enumerate(problems):
        if problem.span.start >= inside_out:
            break
        if problem.rule == "string-over-items":
            if any(other.rule in ("syntax-error", "unclosed-string") for other in problems[index + 1 :]):
                notes = ("add the closing quote",)
                return (*kept, replace(problem, rule="unclosed-string", notes=notes))
            return (*problems[: index + 1], *(other for other in problems[index + 1 :] if other.rule != problem.rule))
        kept.append(problem)
    return tuple(kept)

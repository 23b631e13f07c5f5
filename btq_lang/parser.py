"""The parser: text to tree, a function `parse_…` for each production of the grammar (docs/grammar.md).

One invariant: it accepts every string and never raises; each mistake is one diagnostic, after which parsing resumes at
the next attribute, line or item.  It knows syntax, not meaning: `Retry` and a misspelt `Rety` parse alike.  This module
has the productions for the file, its sequence of items, and Root; all others are in `grammar`.
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from typing import Final, TypeAlias

from btq_lang.diagnostics.model import Diagnostic, Fix, replace_fix, shifted
from btq_lang.grammar.attributes import parse_pairs
from btq_lang.grammar.claim_mistakes import report_slip
from btq_lang.grammar.claim_words import VERB_WORDS
from btq_lang.grammar.clause_slips import OF_MISSION
from btq_lang.grammar.conditions import HEADS, METADATA_HEADS
from btq_lang.grammar.cursor import Cursor
from btq_lang.grammar.hazards import parse_hazard
from btq_lang.grammar.item_words import ITEM_WORDS, item_word_meant, read_as
from btq_lang.grammar.items import (
    parse_apply,
    parse_context,
    parse_include,
    parse_model,
    parse_models,
    parse_qualities,
    parse_quality_decl,
    parse_req_item,
    parse_signal,
    parse_tree,
)
from btq_lang.grammar.node_mistakes import found_xml, is_after_dashes, is_doc_string, other_comment
from btq_lang.grammar.nodes import no_block, parse_verbatim
from btq_lang.lexer import Lexer, State, tokens
from btq_lang.syntax.scan import Maps, line_end, path_end
from btq_lang.syntax.tokens import CATEGORIES, DIRECTIONS, NAME, NEWLINE, NODE_CLAUSES, OPEN, STRING, SYMBOL, Token
from btq_lang.syntax.tree import Entry, Given, Item, Root, Scenario, SkippedLines, Tree, moved_by, quote, unquote
from btq_lang.util.garbage import NotCollecting
from btq_lang.util.record import replace
from btq_lang.util.text import Span, changed

# The state at the start of an item: that of the lexer, the levels of the open Roots, and whether there was a Root, and
# a scenario.
Start: TypeAlias = "tuple[State, tuple[int, ...], bool, bool]"


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
        return Parsed(text, parser.cursor.lexer.maps, parse_file(parser), tuple(parser.begun))


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
        entries = parse_file(parser, {start: before.starts[index] for start, index in after.items()})
    if not parser.has_met:
        return Parsed(text, maps, old[:first] + entries, (*before.starts[:first], *parser.begun))
    last = after[parser.cursor.lexer.line_start]
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


def parse_file(parser: Parser, meeting: dict[int, Start | None] | None = None) -> tuple[Entry, ...]:
    """File = { Item }

    Args:
        meeting: the states of an earlier parse, by the start of the line.
    """
    cursor = parser.cursor
    cursor.more = cursor.lexer.open_line()
    while cursor.more:
        while parser.roots and cursor.lexer.level <= parser.roots[-1]:
            parser.roots.pop()
        state = parser.state()
        if meeting is not None and state is not None and meeting.get(cursor.lexer.line_start) == state:
            parser.has_met = True
            return tuple(parser.entries)
        parser.begun.append(state)
        parse_item(parser, parser.roots[-1] + 1 if parser.roots else 0, bool(parser.roots))
    if cursor.problems or cursor.lexer.problems:  # after the last item, or in a file without any
        cursor.base = 0
        parser.begun.append(None)
        parser.entry(SkippedLines(len(cursor.text), len(cursor.text)), False)
    return tuple(parser.entries)


def parse_item(parser: Parser, level: int, in_root: bool) -> None:
    """Item = Include | Qualities | QualityDecl | Models | Model | Signal | Context | ReqItem | Apply | Root | …"""
    cursor = parser.cursor
    cursor.base = cursor.lexer.line_start
    own_level = cursor.lexer.level
    cursor.scan()
    if own_level > level and own_level != parser.stray_level:
        cursor.complain(cursor.here(), "unexpected indentation: no block is open above this line")
    parser.stray_level = own_level if own_level > level else -1
    word = item_word(cursor)
    item: Item
    if word == "BehaviorTree":
        item = parse_tree(cursor, own_level)
    elif word == "Root":
        parse_root(parser, own_level, in_root)
        return
    elif word in CATEGORIES:
        item = parse_model(cursor, own_level)
    elif word == "QualityReq":
        item = parse_req_item(cursor, own_level)
    elif word == "TreeNodesModel":
        item = parse_models(cursor, own_level)
    elif word == "include":
        item = parse_include(cursor)
    elif word == "signal":
        item = parse_signal(cursor)
    elif word == "context":
        item = parse_context(cursor)
    elif word == "apply":
        item = parse_apply(cursor)
    elif word == "quality":
        item = parse_quality_decl(cursor)
    elif word == "qualities":
        item = parse_qualities(cursor)
    elif word == "hazard":
        item = parse_hazard(cursor, own_level)
    elif word == "scenario" or word == "given":
        item = scenario_or_given(parser, word, own_level, in_root)
    elif word == "xml":
        item = parse_verbatim(cursor)
    else:
        item = skipped(cursor, own_level)
    if cursor.deeper(own_level) and not begins_item(cursor):
        no_block(cursor, own_level)
    parser.entry(item, in_root)


def parse_root(parser: Parser, level: int, in_root: bool) -> None:
    """ "Root" [ Name ] [ Attributes ] NL [ INDENT { Item } DEDENT ]: at most one, none inside a Root"""
    cursor = parser.cursor
    word = cursor.take()
    cursor.skip_sign(":", "=")
    skip_root_key(cursor)
    name = cursor.take() if cursor.kind == NAME or cursor.kind == STRING else None
    bracketed = cursor.kind == OPEN
    attributes = parse_pairs(cursor)
    if parser.has_root:
        where = "unexpected Root inside another Root" if in_root else "unexpected second Root in this file"
        note = "a mission begins in one place: keep the Root that names its main tree, or move one to another file"
        cursor.complain(word.span.shifted(cursor.base), where, notes=(note,), rule="second-root")
    parser.has_root = True
    end = cursor.end_line()
    item = Root(word.start, end, name, attributes, bracketed)
    parser.entry(item, in_root)
    parser.roots.append(level)


# ---- what productions ask and report ----


def scenario_or_given(parser: Parser, word: str, level: int, in_root: bool) -> Scenario | Given:
    """A scenario, or a `given` for all scenarios of the file; report one that is not before the first of them."""
    from btq_lang.grammar.scenarios import parse_given, parse_scenario  # few files have any

    cursor = parser.cursor
    if word == "scenario":
        parser.has_scenario = True
        return parse_scenario(cursor, level)
    if in_root or parser.has_scenario:
        where = "in a Root block" if in_root else "after the first scenario of its file"
        note = "a given for all scenarios goes before the first one, at the top level; any other in a scenario's block"
        cursor.complain(cursor.here(), f"unexpected given {where}", notes=(note,))
    item = parse_given(cursor)
    cursor.end_line()
    return item


def item_word(cursor: Cursor) -> str:
    """The word that begins the item; a misspelt one is reported, and usually read as the word that was meant."""
    if cursor.kind != NAME:
        return ""
    if cursor.raw in ITEM_WORDS:
        return cursor.raw
    meant = item_word_meant(cursor.raw)
    following = cursor.kinds[cursor.index + 1]
    other = _OTHER_ITEMS.get(cursor.raw.lower())
    if other is not None and following in (NAME, STRING) and cursor.raws[cursor.index + 1] not in _NO_NAMES:
        cursor.complain(
            cursor.here(), f"unknown word `{cursor.raw}`; did you mean `{other}`?", other_item(cursor, other)
        )
        return "" if other == "include" or cursor.raw in ("def", "class") else other
    has_name = following in (NAME, STRING) or (meant == "scenario" and cursor.is_operator(cursor.index + 1, ":"))
    if not meant or not (has_name or (meant in _ALONE and following in (NEWLINE, OPEN))):
        return ""
    cursor.misspelt(cursor.here(), cursor.raw, meant)
    return read_as(cursor.raw)


def begins_item(cursor: Cursor) -> bool:
    """Whether the open line looks like an item, wherever it is; a node may look like a model."""
    if not cursor.more:
        return False
    word = cursor.lexer.first_word()
    return word in ITEM_WORDS and word not in CATEGORIES and word != "xml"


def skip_root_key(cursor: Cursor) -> None:
    """Report and skip the XML attribute before the name of the main tree: `Root ID = Main`."""
    value = cursor.index + 2
    if not cursor.at_key() or cursor.kinds[value] not in (NAME, STRING):
        return
    fix = replace_fix(f"Remove `{cursor.raw} =`", Span(cursor.here().start, cursor.starts[value]), "")
    message = "expected the main tree's name after `Root`"
    cursor.complain(cursor.here(), message, fix, notes=("attributes go in brackets: `(key = value)`",))
    cursor.go_to(value)


def skipped(cursor: Cursor, level: int) -> SkippedLines:
    """Skip lines that do not begin an item, with their blocks; report the first."""
    start = cursor.start()
    notes: tuple[str, ...] = ()
    fixes: tuple[Fix, ...] = ()
    if cursor.kind == STRING and is_doc_string(cursor):
        other_comment(cursor, cursor.here().start + 3)
    elif is_after_dashes(cursor):
        other_comment(cursor, cursor.here().start + 2)
    elif cursor.at_key() and cursor.raw == "main_tree_to_execute":
        span = Span(cursor.here().start, cursor.starts[cursor.index + 2])
        notes, fixes = ("`Root` names the main tree",), (replace_fix("Write `Root`", span, "Root "),)
    elif cursor.at_key():
        notes = (_A_VALUE,)
    elif cursor.at("/") and cursor.kinds[cursor.index + 1] == NAME and cursor.kinds[cursor.index + 2] == NEWLINE:
        span = Span(cursor.here().start, line_end(cursor.text, cursor.here().start))
        notes = ("a block ends where its indentation does, without a line of its own",)
        fixes = (replace_fix("Remove it", span, ""),)
    elif cursor.at_word("from") and "import" in cursor.raws[cursor.index + 2 : cursor.index + 3]:
        notes = ('another file is read with `include "stations.btq"`',)
    elif cursor.kind == NAME and cursor.raw.lower() in _ASSUMPTIONS:
        notes = ("what is taken for granted is a clause of the requirement: `assuming visibility >= 1 m`",)
    elif cursor.at_word("mission") and cursor.raws[cursor.index + 1] in NODE_CLAUSES:
        notes = (OF_MISSION,)
    elif cursor.kind == NAME and cursor.raw in NODE_CLAUSES:
        notes = ("write it after a node, or indented in the block of a node or BehaviorTree",)
    elif cursor.at_word("expect") or (cursor.at_word("when") and ":" in cursor.raws):
        notes = ("a step goes in the block of a scenario, indented",)
    elif cursor.kind == NAME and (cursor.raw in VERB_WORDS or cursor.raw in HEADS or cursor.raw in METADATA_HEADS):
        notes = ("a clause goes in the block of a QualityReq, indented",)
    elif cursor.kind == NAME and cursor.raw in DIRECTIONS:
        notes = ("a port goes in the block of a model or BehaviorTree, indented",)
    elif cursor.kind == STRING and unquote(cursor.raw) in ITEM_WORDS:
        notes = ("a word in quotes is a name, not a keyword; remove the quotes",)
    elif cursor.text.startswith("<!--", cursor.here().start):
        other_comment(cursor, cursor.here().start + len("<!--"))
    elif cursor.at("<"):
        found_xml(cursor)
    elif cursor.kind == SYMBOL or (cursor.at_name() and cursor.kinds[cursor.index + 1] in (NEWLINE, OPEN)):
        notes = ("a node goes in the block of a BehaviorTree, indented",)
    if cursor.kind != NEWLINE:
        cursor.expected("an item: BehaviorTree, QualityReq, include, signal, …", notes, fixes)
    end = cursor.end_line()
    while cursor.more and not ends_skipping(cursor, level):
        count = len(cursor.lexer.problems)
        cursor.scan()
        del cursor.lexer.problems[count:]
        cursor.go_to(len(cursor.kinds) - 1)
        end = cursor.end_line()
    return SkippedLines(start, end)


def other_item(cursor: Cursor, meant: str) -> Fix:
    """The fix for an item in the syntax of another language: `import stations`, `def main():`."""
    word = cursor.here()
    tail = Span(cursor.starts[cursor.index + 1], line_end(cursor.text, word.start))
    title = f"Replace `{cursor.raw}` with `{meant}`"
    if meant == "include" and cursor.kinds[cursor.index + 1] == NAME and cursor.kinds[cursor.index + 2] == NEWLINE:
        end = path_end(cursor.text, tail.start)
        name = cursor.text[tail.start : end]
        return replace_fix(title, Span(word.start, end), f"include {quote(name if '.' in name else f'{name}.btq')}")
    if meant == "BehaviorTree" and (head := _PYTHON_HEAD.match(cursor.text, tail.start)):
        return replace_fix(title, Span(word.start, head.end()), f"BehaviorTree {head[1]}")
    return replace_fix(title, word, meant)


def ends_skipping(cursor: Cursor, level: int) -> bool:
    """Whether the open line is an item, is probably meant as one, or has less indentation."""
    if cursor.lexer.level > level:
        return begins_item(cursor)
    word = cursor.lexer.first_word()
    if cursor.lexer.level < level or word in ITEM_WORDS:
        return True
    return not word.startswith("<") and bool(item_word_meant(word))


class Parser:
    """The state of one parse: a cursor, the open Roots, and what was found so far.

    Attributes:
        cursor: where it is.
        begun: for each entry, the state that it began in.
        has_met: it has reached a place and state of an earlier parse, and can stop.
    """

    def __init__(self, lexer: Lexer) -> None:
        self.cursor: Final = Cursor(lexer, report_slip)
        self.entries: list[Entry] = []
        self.begun: list[Start | None] = []
        self.has_met = False
        self.has_root = False
        self.has_scenario = False
        self.roots: list[int] = []  # the levels of the Roots whose blocks are open; more than one is a mistake
        self.stray_level = -1  # the level of wrongly indented lines, reported once

    def state(self) -> Start | None:
        """What the next item depends on besides its text; None if that is not a small state: after mistakes with
        lasting effects, and if the rest of the file was searched for the end of something.
        """
        cursor = self.cursor
        if cursor.problems or self.stray_level >= 0 or cursor.inside_out <= len(cursor.text) or cursor.is_in_wake():
            return None
        lexer = cursor.lexer.state()
        return None if lexer is None else (lexer, tuple(self.roots), self.has_root, self.has_scenario)

    def begin_at(self, start: int, state: Start | None) -> None:
        """Continue from the start of a line in this state."""
        cursor = self.cursor
        assert state is not None, "a parse begins again only where that can be said"
        lexer, roots, self.has_root, self.has_scenario = state
        self.roots = list(roots)
        cursor.lexer.begin_at(start, lexer)

    def entry(self, item: Item, in_root: bool) -> None:
        """Add the item, with the problems found before the open line; their offsets count from the item's start."""
        cursor = self.cursor
        problems = cursor.problems + cursor.lexer.problems
        cursor.problems = []
        cursor.lexer.problems = []
        if problems:
            end = cursor.lexer.line_start if cursor.more else len(cursor.text) + 1
            cursor.lexer.problems = [problem for problem in problems if problem.span.start >= end]
            problems = sorted(
                (shifted(problem, -cursor.base) for problem in problems if problem.span.start < end),
                key=lambda problem: problem.span,
            )
        causes = _root_causes(problems, cursor.inside_out - cursor.base) if problems else ()
        self.entries.append(Entry(cursor.base, item, in_root, causes))


_A_VALUE: Final = 'a value goes to a port: `MoveBase (speed = 0.5)`; or to an entry: `Script (code = "speed := 0.5")`'
_ALONE: Final = ("BehaviorTree", "Root", "TreeNodesModel")  # items whose name is optional
_OTHER_ITEMS: Final = {  # words of other languages, in lower case
    **dict.fromkeys(("import", "require", "use"), "include"),
    **dict.fromkeys(("requirement", "req", "qualityrequirement"), "QualityReq"),
    **dict.fromkeys(("mission", "tree", "behaviourtree", "bt", "def", "class"), "BehaviorTree"),
    **dict.fromkeys(("sensor", "variable", "var", "measure", "metric"), "signal"),
    **dict.fromkeys(("mode", "situation"), "context"),
    **dict.fromkeys(("risk", "danger", "threat", "harm"), "hazard"),
    **dict.fromkeys(("test", "testcase", "case", "example", "feature"), "scenario"),
}
_NO_NAMES: Final = frozenset((*VERB_WORDS, *NODE_CLAUSES))
_ASSUMPTIONS: Final = ("assumption", "assumptions", "assume", "assumes", "assuming")
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

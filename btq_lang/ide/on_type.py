"""Edits while typing: the indentation of a new line, the place of a `)`, and names that change together."""

from __future__ import annotations

from bisect import bisect_left

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import lookup
from btq_lang.ide.block import blanks_before, deeper
from btq_lang.ide.meaning import at, everywhere, subject
from btq_lang.ide.place import item_tokens, place_at, word_text, words_before
from btq_lang.syntax.scan import line_start
from btq_lang.syntax.tokens import CATEGORIES, CLOSE, NAME, NODE_CLAUSES, OPEN, STRING, SYMBOL, Token
from btq_lang.syntax.tree import Model
from btq_lang.util.text import Edit, Span
from btq_lang.workspace.file import File
from btq_lang.workspace.references import What
from btq_lang.workspace.workspace import Workspace


def on_type(workspace: Workspace, path: str, offset: int, typed: str) -> tuple[Edit, ...]:
    """The edits after a character was typed: to the indentation of the line with the offset.

    A new line, or the rest of one that was split, goes one level deeper after what opens a block (a tree, a
    requirement, a control or a decorator) and in brackets; else it is indented as the line above.  A line that was only
    moved down keeps its indentation, which determines what it belongs to.  A level is a tab if the file is indented
    with tabs, whatever the editor's setting, for the language allows no mixture.  A `)` that begins a line is indented
    as the line that opened the brackets.
    """
    text = workspace.files[path].text
    start = line_start(text, 0, offset)
    place = place_at(workspace, path, offset)
    if place.inside != "code":
        return ()
    line = text[start:]
    blanks = line[: len(line) - len(line.lstrip(" \t"))]
    moved_from = _moved_from(workspace.files[path], start) if typed == "\n" else None
    if moved_from is not None:
        margin = blanks if offset > start else moved_from + blanks  # whether or not the editor indented it
    elif typed == ")":
        if text[start:offset].strip() != ")" or not place.words:
            return ()
        margin = blanks_before(text, place.words[0].start)
    elif place.words and place.depth:
        margin = deeper(text, blanks_before(text, place.words[0].start))
    else:
        above = _line_above(workspace, path, start)
        if not above:
            return ()
        margin = blanks_before(text, above[0].start)
        if _opens(workspace, path, above):
            margin = deeper(text, margin)
    return (Edit(Span(start, start + len(blanks)), margin),) if blanks != margin else ()


def linked_ranges(workspace: Workspace, path: str, offset: int) -> tuple[Span, ...]:
    """The places that change together with the name at a place, if all of them are near: the parameter of a requirement
    in its clauses, an entry of a tree's blackboard, an instance name and the paths that name it."""
    reference = at(workspace, path, offset)
    if reference is None:
        return ()
    referent = subject(workspace, reference)
    if referent.what not in (What.PARAMETER, What.KEY, What.INSTANCE) or referent.home.startswith("@"):
        return ()
    places = tuple(everywhere(workspace, referent))
    text = workspace.files[path].text
    same = all(one.path == path and text[one.span.start : one.span.end] == referent.name for one in places)
    return tuple(one.span for one in places) if same and len(places) > 1 else ()


def _moved_from(file: File, start: int) -> str | None:
    """If Enter was typed before all words of a line, the blanks that it left on the line above; None if it split a line
    between words, or made an empty one."""
    number = file.lines.position(start).line
    above = file.lines.line(number - 1) if number else ""
    return None if above.strip() or not file.lines.line(number).strip() else above


def _line_above(workspace: Workspace, path: str, start: int) -> tuple[Token, ...]:
    """The words of the last logical line with words before an offset."""
    tokens = item_tokens(workspace.files[path], start)
    index = bisect_left(tokens, start, key=lambda token: token.start) - 1
    while index >= 0:
        words = words_before(tokens, index - 1 if tokens[index].kind not in (NAME, STRING, SYMBOL, CLOSE) else index)
        if words:
            return words
        index -= 1
    return ()


def _opens(workspace: Workspace, path: str, words: tuple[Token, ...]) -> bool:
    """Whether a line needs a block."""
    first = words[0]
    if any(word.kind == NAME and word.text == "QualityReq" for word in words):
        depth = sum((word.kind == OPEN) - (word.kind == CLOSE) for word in words)
        return depth == 0 and first.text in ("QualityReq", "satisfies")
    if first.kind == NAME and (first.text in _OPENERS or first.text in NODE_CLAUSES):
        return first.text in _OPENERS
    if first.kind == NAME and first.text in CATEGORIES:
        file = workspace.files[path]
        is_model = not blanks_before(file.text, first.start) or item_tokens(file, first.start)[0].text == _MODELS
        return is_model or first.text in ("Control", "Decorator")
    kind = lookup(word_text(first), first.kind == STRING)
    if kind is not None:
        return kind.category in ("Control", "Decorator")
    target = workspace.scope(path).target(Kind.MODEL, word_text(first))
    return isinstance(target, Model) and target.category.raw in ("Control", "Decorator")


_MODELS = "TreeNodesModel"
_OPENERS = frozenset(("BehaviorTree", _MODELS))

"""From the classic form to the short one, for a node or for a whole file: another spelling of the same tree."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

from btq_lang.catalog.nodes import PLACEHOLDERS
from btq_lang.checks import check
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.ide.block import nodes_at
from btq_lang.ide.meaning import entry_at
from btq_lang.ide.refactor import Action
from btq_lang.syntax.tokens import CLOSE, NODE_CLAUSES, OPEN
from btq_lang.syntax.tree import Entry, Node, Pair, Satisfices, Tree, is_name, quote
from btq_lang.util.text import Edit, Span, apply_edits
from btq_lang.workspace.file import File
from btq_lang.workspace.workspace import Workspace

_Rewrites: TypeAlias = Mapping[int, tuple[Edit, ...]]


def short_form(
    workspace: Workspace, path: str, offset: int, diagnostics: Sequence[Diagnostic] | None = None
) -> Iterator[Action]:
    """The refactorings of the node at a place, and of the whole file, to the short form, unless they have it
    already."""
    file = workspace.files[path]
    entry = entry_at(workspace, path, offset)
    if entry is None or file.is_foreign:
        return
    rewrites = _placeholders(workspace, path, diagnostics)
    line = nodes_at(file, entry, offset)
    if line and (edits := tuple(_of_node(file, entry, line[-1], rewrites))):
        yield Action("Write the node in the short form", "refactor.rewrite", {path: edits})
    text = _whole_file(file, rewrites)
    if text != file.text:
        whole = (Edit(Span(0, len(file.text)), text),)
        yield Action("Write the file in the short form", "refactor.rewrite", {path: whole})


def _placeholders(workspace: Workspace, path: str, diagnostics: Sequence[Diagnostic] | None) -> _Rewrites:
    """The rewrites of classic placeholders, as their rule offers them, by start."""
    if not any(word in workspace.files[path].text for word in PLACEHOLDERS):
        return {}
    return {
        diagnostic.span.start: tuple(Edit(change.place.span, change.text) for change in diagnostic.fixes[0].changes)
        for diagnostic in (check(workspace, path) if diagnostics is None else diagnostics)
        if diagnostic.rule == "classic-placeholder" and diagnostic.fixes
    }


def _whole_file(file: File, rewrites: _Rewrites) -> str:
    """The text of a file in the short form."""
    edits: list[Edit] = []
    for entry in file.parsed.entries:
        if isinstance(entry.item, Tree) and not entry.diagnostics:
            edits += _of_tree(file, entry, entry.item)
            for node in entry.item.walk():
                edits += _of_node(file, entry, node, rewrites)
    return apply_edits(file.text, edits)


def _of_tree(file: File, entry: Entry, tree: Tree) -> Iterator[Edit]:
    """`BehaviorTree ID = mainTree`"""
    if tree.name is not None:
        head = file.text[entry.start + tree.start : entry.start + tree.name.start]
        if head.split() == ["BehaviorTree", "ID", "="] or head.replace(" ", "") == "BehaviorTreeID=":
            yield Edit(Span(tree.start, tree.name.start).shifted(entry.start), "BehaviorTree ")


def _of_node(file: File, entry: Entry, node: Node, rewrites: _Rewrites) -> Iterator[Edit]:
    yield from rewrites.get(entry.start + node.head.start) or _head(file, entry, node)
    for clause in node.clauses:
        if isinstance(clause, Satisfices):
            yield from _qualities(file, entry, clause)


def _head(file: File, entry: Entry, node: Node) -> Iterator[Edit]:
    """`SubTree (ID = PickPlace name = "Pick")` is `SubTree PickPlace Pick`, and `-> (name = "x")` is `-> x`."""
    moved: list[Pair] = []
    words: list[str] = []
    for key, is_free in (("ID", node.kind is None and node.category is not None), ("name", node.label is None)):
        pair = next((pair for pair in node.attributes if pair.key.text == key and pair.value is not None), None)
        if pair is None or pair.value is None or not is_free:
            continue
        text = pair.value.text
        words.append(text if is_name(text) and text not in NODE_CLAUSES else quote(text))
        moved.append(pair)
    if not moved or (node.kind is None and (node.attribute("ID") is None or moved[0].key.text != "ID")):
        return
    head = node.kind or node.category
    assert head is not None, "a node has a kind or a category"
    yield Edit(Span(head.end, head.end).shifted(entry.start), f" {' '.join(words)}")
    text = file.text
    opened = text.find("(", entry.start + head.end)
    if len(moved) == len(node.attributes) and (closed := _closing(file, opened)) is not None:
        gone = [Edit(pair.span.shifted(entry.start - opened - 1), "") for pair in moved]
        inside = apply_edits(text[opened + 1 : closed], gone)
        if not inside.strip(" ,\t\r\n"):
            before = len(text[:opened]) - len(text[:opened].rstrip(" \t"))
            yield Edit(Span(opened - before, closed + 1), "")
            return
    for pair in moved:
        start, end = pair.span.shifted(entry.start)
        following = text[end:].lstrip(" \t")
        following = following[1:].lstrip(" \t") if following.startswith(",") else following
        yield Edit(Span(start, len(text) - len(following)), "")


def _closing(file: File, opened: int) -> int | None:
    """Where the brackets that open at an offset close."""
    depth = 0
    for token in file.parsed.tokens:
        if token.start < opened or token.kind not in (OPEN, CLOSE):
            continue
        depth += 1 if token.kind == OPEN else -1
        if depth == 0:
            return token.start if token.text else None
    return None


def _qualities(file: File, entry: Entry, clause: Satisfices) -> Iterator[Edit]:
    """`satisfices Quality = performance` is `satisfices performance`; one that encloses requirements stays."""
    for quality in clause.qualities:
        start = entry.start + quality.path.span.start
        head = file.text[entry.start + clause.start : start]
        before = head.rstrip().removesuffix("=").rstrip()
        if not quality.requirements and head.rstrip().endswith("=") and before.endswith("Quality"):
            yield Edit(Span(entry.start + clause.start + len(before) - len("Quality"), start), "")

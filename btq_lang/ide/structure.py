"""The structure of a text: folding, growing selections, and links to other files."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.ide.external import external_links
from btq_lang.ide.meaning import at, entry_at
from btq_lang.syntax.tokens import BLANK, CLOSE, COMMENT, DEDENT, INDENT, NEWLINE, OPEN, STRING
from btq_lang.syntax.tree import Include, Tree
from btq_lang.util.record import Record
from btq_lang.util.text import Span
from btq_lang.workspace.workspace import Workspace


class Fold(Record):
    """A stretch that can be folded to its first line.  kind: block, brackets, comment or includes."""

    span: Span
    kind: str


class FileLink(Record):
    """A word that leads to a file or a web page.

    Attributes:
        target: its path or address; None if the file does not exist.
        line: in the file, from 1; 0: it leads to the file.
    """

    span: Span
    target: str | None
    line: int = 0


def folding_ranges(workspace: Workspace, path: str) -> tuple[Fold, ...]:
    """Blocks, brackets over several lines, runs of comment lines, and the includes at the top."""
    file = workspace.files[path]
    text = file.text
    folds: list[Fold] = []
    blocks: list[int] = []  # where the line above each open block begins
    line = end = 0  # where the current logical line begins, and where its last word ends
    at_start = True
    for token in file.parsed.tokens:
        if token.kind == INDENT:
            blocks.append(line)
        elif token.kind == DEDENT:
            if blocks:
                folds.append(Fold(Span(blocks.pop(), end), "block"))
        elif token.kind == NEWLINE:
            at_start = True
        elif token.kind not in (BLANK, COMMENT):
            if at_start:
                line, at_start = token.start, False
            end = token.end
    folds += [Fold(span, "brackets") for span in _brackets(workspace, path)]
    folds += _comment_runs(workspace, path)
    includes = [entry for entry in file.parsed.entries if isinstance(entry.item, Include)]
    if len(includes) > 1:
        first, last = includes[0], includes[-1]
        folds.append(Fold(Span(first.start + first.item.start, last.start + last.item.end), "includes"))
    several_lines = (fold for fold in folds if "\n" in text[slice(*fold.span)] or "\r" in text[slice(*fold.span)])
    return tuple(sorted(several_lines, key=lambda fold: fold.span))


def _comment_runs(workspace: Workspace, path: str) -> Iterator[Fold]:
    file = workspace.files[path]
    run: Span | None = None
    begins = True
    for token in file.parsed.tokens:
        if token.kind == COMMENT and begins:
            run = Span(run.start if run else token.start, token.end)
        elif token.kind not in (BLANK, INDENT, DEDENT):
            if run is not None:
                yield Fold(run, "comment")
            run, begins = None, token.kind == NEWLINE
        elif token.kind == BLANK:
            lines = token.text.count("\n") or token.text.count("\r")
            begins = begins or lines > 0
            if lines > 1 and run is not None:
                yield Fold(run, "comment")
                run = None
    if run is not None:
        yield Fold(run, "comment")


def selection_range(workspace: Workspace, path: str, offset: int) -> tuple[Span, ...]:
    """The selections around a place, the smallest first: the word, the contents of a string, the pair, the brackets,
    the node, the node with its block, those around it, the item, the file."""
    file = workspace.files[path]
    spans = {Span(0, len(file.text))}
    for token in file.parsed.tokens:
        if token.start <= offset <= token.end and token.kind not in (BLANK, NEWLINE, INDENT, DEDENT):
            spans.add(Span(token.start, token.end))
            if token.kind == STRING and token.start < offset < token.end:
                spans.add(Span(token.start + 1, max(token.end - 1, token.start + 1)))
    reference = at(workspace, path, offset)
    if reference is not None:
        spans.add(reference.span)
    entry = entry_at(workspace, path, offset)
    if entry is not None:
        item = entry.item
        spans.add(Span(item.start, item.end).shifted(entry.start))
        if isinstance(item, Tree):
            spans.add(Span(item.start, item.block_end).shifted(entry.start))
            for node in item.walk():
                spans.add(node.span.shifted(entry.start))
                spans.add(Span(node.start, node.block_end).shifted(entry.start))
                spans.update(pair.span.shifted(entry.start) for pair in node.attributes)
    for start, end in _brackets(workspace, path):
        spans.update((Span(start, end), Span(start + 1, max(end - 1, start + 1))))
    around = [span for span in spans if span.start <= offset <= span.end]
    around.sort(key=lambda span: (span.end - span.start, span.start))
    nested: list[Span] = []
    for span in around:
        if not nested or (span != nested[-1] and span.start <= nested[-1].start and nested[-1].end <= span.end):
            nested.append(span)
    return tuple(nested)


def _brackets(workspace: Workspace, path: str) -> Iterator[Span]:
    opened: list[int] = []
    for token in workspace.files[path].parsed.tokens:
        if token.kind == OPEN:
            opened.append(token.start)
        elif token.kind == CLOSE and opened:
            yield Span(opened.pop(), token.end)


def document_links(workspace: Workspace, path: str) -> tuple[FileLink, ...]:
    """The paths of includes, and the names of imported requirements."""
    file = workspace.files[path]
    links = []
    for include in file.includes:
        if include.path is not None:
            span = include.path.span.shifted(file.start_of(include))
            inside = Span(span.start + 1, max(span.end - 1, span.start + 1)) if include.path.quoted else span
            links.append(FileLink(inside, workspace.included_by(path, include)))
    for span, requirement in external_links(workspace, path):
        links.append(FileLink(span, requirement.url or requirement.path, 0 if requirement.url else requirement.line))
    return tuple(links)

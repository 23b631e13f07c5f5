"""Semantic tokens: the type of each word, for colouring, as LSP 3.16 encodes it, in five integers a token."""

from __future__ import annotations

import json
from itertools import pairwise
from typing import TYPE_CHECKING

from btq_lang.catalog.name_kinds import Kind
from btq_lang.ide.stretches import Known, Stretch, encoded
from btq_lang.parser import Parsed
from btq_lang.util.text import Encoding, Span

if TYPE_CHECKING:
    from btq_lang.workspace.workspace import Workspace


def encoded_within(workspace: Workspace, path: str, within: Span, encoding: Encoding) -> list[int]:
    """The tokens on the lines that a span touches; computed without those before them."""
    file = workspace.files[path]
    known = known_of(workspace, path)
    first, last = (file.lines.position(offset).line for offset in within)
    data: list[int] = []
    at = 0
    for begin, end in groups(file.parsed):
        stretch = stretch_of(file.parsed, len(file.text), begin, end)
        if stretch.start > within.end or stretch.end < within.start:
            continue
        line = file.lines.position(stretch.start).line
        for token in encoded(file.text[stretch.start : stretch.end], stretch, known, encoding).tokens:
            down, *others = json.loads(f"[{token}]")
            line += down
            if first <= line <= last:
                data += (line - at, *others)
                at = line
    return data


def known_of(workspace: Workspace, path: str) -> Known:
    """What a file's workspace knows of names."""
    scope = workspace.scope(path)
    return Known((workspace.edition(path), scope.names(Kind.TREE), scope.names(Kind.QUALITY)))


def groups(parsed: Parsed) -> list[tuple[int, int]]:
    """The entries of each stretch of a file: the indices of the first and after the last.  Joined, the stretches are
    the file; there are none before the first item."""
    entries = parsed.entries
    begins = [index for index, start in enumerate(parsed.starts) if start is not None or index == 0]
    found = [*pairwise((*begins, len(entries)))]
    return found if entries and not entries[0].start else [(0, 0), *found]


def stretch_of(parsed: Parsed, size: int, begin: int, end: int) -> Stretch:
    """The stretch of these entries."""
    entries = parsed.entries
    start = entries[begin].start if end else 0
    return Stretch(start, entries[end].start if end < len(entries) else size, entries[begin:end])

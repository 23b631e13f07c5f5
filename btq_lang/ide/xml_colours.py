"""Semantic tokens in XML: the entries and scripts in attributes; all else has the colours of the editor's own XML.

One invariant: an entry has the colour that it has in a mission.
"""

from __future__ import annotations

import json
from collections.abc import Iterator

from btq_lang.ide.appearance import PLAIN, TEXT, USED, WRITTEN
from btq_lang.ide.colours import Colours, part_of
from btq_lang.ide.stretches import Token, encode
from btq_lang.syntax.script import tokens as script
from btq_lang.syntax.tokens import NUMBER, SYMBOL
from btq_lang.syntax.tree import Tree
from btq_lang.util.text import Encoding, Span
from btq_lang.workspace.file import File
from btq_lang.workspace.references import Mention, What
from btq_lang.workspace.workspace import Workspace


def colours_in_xml(workspace: Workspace, path: str, encoding: Encoding) -> Colours:
    """The tokens of a file's XML."""
    file = workspace.files[path]
    part = part_of(encode(file.source, _tokens(file), encoding)[0], 0)
    return Colours(((part.first, 0, part.others),) if part.others else ())


def encoded_in_xml(workspace: Workspace, path: str, within: Span, encoding: Encoding) -> list[int]:
    """The tokens that touch a span of the XML."""
    file = workspace.files[path]
    tokens = [token for token in _tokens(file) if token[0] <= within.end and within.start <= token[1]]
    data: list[int] = json.loads(f"[{','.join(encode(file.source, tokens, encoding)[0])}]")
    return data


def _tokens(file: File) -> list[Token]:
    """The start, the end and the appearance of each, in the order of the XML."""
    tokens: list[Token] = []
    for entry in file.parsed.entries:
        if isinstance(entry.item, Tree):
            for span, appearance in _coloured(file.mentions_of(entry)):
                start, end = file.on_disk(span.shifted(entry.start))
                tokens.append((start, end, appearance))
    return sorted(tokens)


def _coloured(mentions: tuple[Mention, ...]) -> Iterator[tuple[Span, str]]:
    seen: set[int] = set()
    for mention in mentions:
        if mention.what is not What.KEY or mention.pair is None or mention.pair.value is not mention.word:
            continue
        yield mention.span, WRITTEN if mention.writes else USED[What.KEY]
        word = mention.word
        if id(word) not in seen and not word.text.startswith("{") and word.text != mention.name:
            seen.add(id(word))
            tokens = script.tokenize(word.text)
            begin = word.start + word.quoted
            for kind, start, end in zip(tokens.kinds, tokens.starts, tokens.ends, strict=True):
                appearance = _SCRIPT.get(kind, _OPERATOR if kind not in _SILENT else "")
                if appearance:
                    yield Span(begin + start, begin + end), appearance


_OPERATOR = PLAIN[SYMBOL]
_SCRIPT = {script.NUMBER: PLAIN[NUMBER], script.BOOL: PLAIN[NUMBER], script.TEXT: TEXT}
_SILENT = frozenset((script.NAME, script.ERROR, script.END, "(", ")", ";"))

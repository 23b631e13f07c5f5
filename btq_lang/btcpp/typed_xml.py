"""XML while it is typed: the tag at the cursor, the elements that are open there, and the text made sound without it.

    document  = { text | comment | CDATA | declaration | tag }
    tag       = "<" [ "/" ] [ name { attribute } ] [ "/" ] [ ">" ]
    attribute = name [ "=" [ value ] ]
    value     = '"' { character } '"' | "'" { character } "'" | quote { character }

One invariant: every string has a reading. A tag without `>` ends where the next one begins, a value without its closing
quote at the end of its line or of its tag.  What is closed wrongly is for `reader`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

from btq_lang.btcpp.document import WORD
from btq_lang.util.record import Record
from btq_lang.util.text import Span


class TypedTag(Record):
    """The tag around an offset, and what is typed there.

    Attributes:
        part: end (the name of an end tag), tag (that of a start tag), attribute (the name of one) or value.
        word: the word or the value at the offset, which a completion replaces.
        name: of the tag; empty: nothing is written yet.
        attributes: the others, each with its value as it is spelt.
        key: the attribute of a value.
        parents: the names of the open elements, the outermost first.
        span: the whole tag.
        has_end: whether it ends with `>` alone, so that its element has an end tag.
    """

    part: str
    word: Span
    name: str
    attributes: tuple[tuple[str, str], ...]
    key: str
    parents: tuple[str, ...]
    span: Span
    has_end: bool


def typed_tag(xml: str, offset: int) -> TypedTag | None:
    """The tag that an offset is in; None outside tags, and at a place in one where nothing can be typed."""
    parents: list[str] = []
    for match in _MARKUP.finditer(xml):
        is_closed = match["close"] if match["start"] is not None else match[0][-1:] == ">"
        if match.start() >= offset or (is_closed and match.end() > offset) or (not is_closed and match.end() >= offset):
            return _in_tag(match, offset, tuple(parents)) if match.start() < offset and match["start"] else None
        if match["name"] is None:
            continue
        if match["start"] == "<" and not match["empty"]:
            parents.append(match["name"])
        elif match["start"] == "</" and match["name"] in parents:
            while parents.pop() != match["name"]:
                pass
    return None


def without(xml: str, tag: TypedTag) -> Iterator[str]:
    """The XML with what is typed at a place left out, in some ways: which of them is sound is for the caller to find.

    The tag may become one of an empty element, or one that an end tag follows, or the last one that is written so far.
    """
    before, after = xml[: tag.span.start], xml[tag.span.end :]
    alone, opening = "", "<_>"
    if tag.part in ("attribute", "value"):
        pairs = "".join(f" {key}={raw}" for key, raw in dict(tag.attributes).items())
        alone, opening = f"<{tag.name}{pairs}/>", f"<{tag.name}{pairs}>"
    for replacement in (opening, alone) if tag.has_end else (alone, opening):
        yield before + replacement + after
    yield before + alone + "".join(f"</{each}>" for each in reversed(tag.parents))


def _in_tag(match: re.Match[str], offset: int, parents: tuple[str, ...]) -> TypedTag | None:
    span, has_end = Span(*match.span()), bool(match["close"]) and not match["empty"]
    start = match.end("start")
    name = match["name"] or ""
    if offset <= start + len(name):
        if offset < start:
            return None
        part = "tag" if match["start"] == "<" else "end"
        return TypedTag(part, Span(start, start + len(name)), name, (), "", parents, span, has_end)
    if match["start"] == "</":
        return None
    attributes: list[tuple[str, str]] = []
    typed_part: tuple[str, Span, str] | None = None  # the part, the word and the key
    for attribute in _ATTRIBUTE.finditer(match.string, start + len(name), match.end("rest")):
        raw = attribute["raw"]
        is_open = raw is not None and (len(raw) < 2 or raw[-1] != raw[0])
        if attribute.start("key") <= offset <= attribute.end("key"):
            typed_part = "attribute", Span(*attribute.span("key")), ""
        elif raw is not None and attribute.start("raw") < offset and (offset < attribute.end("raw") or is_open):
            end = max(offset, attribute.start("raw") + 1) if is_open else attribute.end("raw") - 1
            typed_part = "value", Span(attribute.start("raw") + 1, end), attribute["key"]
        elif raw is not None and not is_open:
            attributes.append((attribute["key"], raw))
    if typed_part is None and match.string[offset - 1] in _BLANKS:
        before = match.string[start + len(name) : offset].rstrip(_BLANKS)
        typed_part = ("attribute", Span(offset, offset), "") if not before.endswith("=") else None
    if typed_part is None:
        return None
    return TypedTag(typed_part[0], typed_part[1], name, tuple(attributes), typed_part[2], parents, span, has_end)


_BLANKS: Final = " \t\r\n"
# A value that contains the beginning of a tag has lost its quote.
_CLOSED: Final = r"""(?:"(?:[^"<]|<(?![\w/!?]))*"|'(?:[^'<]|<(?![\w/!?]))*')"""
_MARKUP: Final = re.compile(
    r"<!--.*?(?:-->|\Z)|<!\[CDATA\[.*?(?:\]\]>|\Z)|<\?.*?(?:\?>|\Z)|<![^<>]*>?"
    rf"|(?P<start></?)(?P<name>{WORD})?(?P<rest>(?:{_CLOSED}|[^<>/]|/(?!>))*)(?P<empty>/?)(?P<close>>?)",
    re.DOTALL,
)
_ATTRIBUTE: Final = re.compile(rf"""(?P<key>{WORD})(?:\s*=\s*(?P<raw>{_CLOSED}|["'][^\r\n<>]*)?)?""")

"""Why other XML tools refuse a text that the engine reads: the first place that is not well-formed.

One invariant: the answer follows from the text alone, whatever tool refuses it.  The text is one that the engine's
reader accepts, so tags match and quotes are closed.  It knows neither prefixes nor what a DOCTYPE declares.

Source: XML 1.0, fifth edition, https://www.w3.org/TR/xml/.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

from btq_lang.btcpp.spelling import FORBIDDEN
from btq_lang.btcpp.strict import VERSION
from btq_lang.catalog.names import NAME_CHARACTERS, NAME_START
from btq_lang.util.record import Record
from btq_lang.util.text import Span


class Mistake(Record):
    """What other tools refuse, and what to do about it."""

    span: Span
    message: str
    advice: str


def first_mistake(text: str) -> Mistake | None:
    """The first mistake in a text that other tools refuse; None if the tools only reach limits of their own.

    A mistake in the declarations of a DOCTYPE is placed at the DOCTYPE.
    """
    return next(_mistakes(text), None)


def _mistakes(text: str) -> Iterator[Mistake]:
    """All mistakes; those after the first may be its consequences."""
    first = 1 if text.startswith("\ufeff") else 0
    depth, has_root = 0, False
    doctype: re.Match[str] | None = None
    entities: frozenset[str] | None = _PREDEFINED  # None: any, for a file that the DOCTYPE names may declare them
    for piece in _PIECE.finditer(text, first):  # no gaps, for it matches any character
        start, end = piece.span()
        kind = piece.lastgroup
        if kind == "comment":
            yield from _characters(text, _BAD_IN_COMMENT, start + 4, end - 3)
        elif kind == "instruction":
            yield from _instruction(text, start, end, start == first)
        elif kind == "doctype" and doctype is None and not has_root:
            doctype = piece
            yield from _characters(text, FORBIDDEN, start, end)
            entities = None if piece["external"] else _PREDEFINED.union(_ENTITY.findall(piece["declarations"] or ""))
        elif kind in ("doctype", "declaration"):
            yield Mistake(Span(start, start + 2), "unexpected declaration", "the engine does not read it: remove it")
        elif depth == 0 and (kind != "tag" or has_root):
            if outside := _NO_BLANK.search(text, start, end):
                yield _outside(outside.start(), kind, has_root)
        elif kind == "tag":
            yield from _tag(text, start, end, entities)
            has_root = True
            depth += -1 if text[start + 1] == "/" else text[end - 2] != "/"
        else:
            yield from _characters(text, _BAD_IN_TEXT if kind == "text" else FORBIDDEN, start, end, entities)
    if doctype is not None and doctype["declarations"]:
        where = Span(doctype.start(), doctype.start("declarations"))
        yield Mistake(where, "malformed declarations in a DOCTYPE", "the engine does not read them: remove them")


def _outside(offset: int, kind: str | None, has_root: bool) -> Mistake:
    """Content at the top level, which may have one element and no text."""
    what = {"tag": "a tag", "section": "a CDATA section"}.get(kind or "", "text")
    where = "after" if has_root else "before"
    advice = "one element contains the whole file: remove the text after it" if has_root else _REMOVE_BEFORE
    return Mistake(Span(offset, offset + 1), f"{what} {where} the document element", advice)


def _instruction(text: str, start: int, end: int, is_first: bool) -> Iterator[Mistake]:
    """What is wrong with a processing instruction, or with an XML declaration, which has its form."""
    name = _NAME(text, start + 2)
    if name is None:
        yield Mistake(Span(start, start + 2), "a processing instruction without a name", "remove it")
    elif name[0].lower() != "xml":
        if name.end() < end - 2 and not _BLANKS(text, name.end())[0]:  # type: ignore[index]  # it matches nothing at least
            yield _unexpected(text, name.end())
        yield from _characters(text, FORBIDDEN, start, end)
    elif not is_first:
        advice = "put the declaration first in the file, without a space before it"
        yield Mistake(Span(*name.span()), "an XML declaration after other content", advice)
    elif not _DECLARATION(text, start, end):
        version = _VERSION.search(text, start, end)
        if version is not None and not re.fullmatch(VERSION, version[1]):
            yield Mistake(Span(*version.span(1)), f"unsupported version `{version[1]}`", 'write version="1.0"')
        advice = 'write <?xml version="1.0" encoding="UTF-8"?>'
        yield Mistake(Span(start, end), "malformed XML declaration", advice)


def _tag(text: str, start: int, end: int, entities: frozenset[str] | None) -> Iterator[Mistake]:
    """What is wrong with a tag."""
    if _PLAIN_TAG(text, start, end):
        return
    is_end = text[start + 1] == "/"
    name = _NAME(text, start + 1 + is_end)
    if name is None:
        yield _unexpected(text, start + 1 + is_end)
        return
    offset = name.end()
    while True:
        blanks = _BLANKS(text, offset)
        assert blanks is not None  # it matches nothing at least
        offset = blanks.end()
        if text[offset] in "/>":
            return
        name = _NAME(text, offset)
        if name is None:
            yield _unexpected(text, offset)
            return
        if is_end:
            yield Mistake(Span(*name.span()), "an attribute in an end tag", "remove it")
        if not blanks[0]:
            yield Mistake(Span(*name.span()), "no space between attributes", "put a space between attributes")
        equals = _EQUALS(text, name.end())
        if equals is None:
            odd = _ODD.search(text, name.end())
            yield _unexpected(text, odd.start() if odd else name.end())
            return
        offset = text.index(equals[1], equals.end())
        yield from _characters(text, _BAD_IN_VALUE, equals.end(), offset, entities)
        offset += 1


def _characters(
    text: str, bad: re.Pattern[str], start: int, end: int, entities: frozenset[str] | None = None
) -> Iterator[Mistake]:
    """The characters that are not allowed in a part of the text."""
    for match in bad.finditer(text, start, end):
        if match[0] == "&":
            yield from _reference(text, match.start(), entities)
        elif match[0] in _MENDING:
            yield Mistake(Span(*match.span()), *_MENDING[match[0]])
        else:
            yield _unexpected(text, match.start())


def _reference(text: str, offset: int, entities: frozenset[str] | None) -> Iterator[Mistake]:
    """What is wrong with a reference, or with a `&` that begins none."""
    match = _REFERENCE(text, offset)
    if match is None:
        yield Mistake(Span(offset, offset + 1), "`&` does not begin a reference", "write `&` as `&amp;`")
    elif match["name"] is None:
        digits = (match["decimal"] or match["hexadecimal"]).lstrip("0")
        code = int(digits or "0", 10 if match["decimal"] else 16) if len(digits) < _MOST_DIGITS else _BEYOND
        if not 0 < code < _BEYOND or FORBIDDEN.match(chr(code)):
            yield Mistake(Span(*match.span()), f"`{match[0]}` is not a character of XML", _REMOVE)
    elif entities is not None and match["name"] not in entities:
        advice = "only &lt; &gt; &amp; &quot; &apos; and numbers are known: write `&` as `&amp;`"
        yield Mistake(Span(*match.span()), f"the entity `{match['name']}` is not defined", advice)


def _unexpected(text: str, offset: int) -> Mistake:
    """A character where XML does not allow it."""
    character = text[offset]
    if character in " \t\r\n":
        advice = "put no space between `<` and the name"
        return Mistake(Span(offset, offset + 1), "a space before the name of a tag", advice)
    if character in "\v\f" or FORBIDDEN.match(character):
        return Mistake(Span(offset, offset + 1), f"the character U+{ord(character):04X}", _REMOVE)
    shown = f"`{character}`" if character.isprintable() else f"U+{ord(character):04X}"
    return Mistake(Span(offset, offset + 1), f"{shown} in a name", "write letters, digits, `_`, `-` and `.`")


_REMOVE_BEFORE: Final = "remove the text before the document element"
_REMOVE: Final = "XML does not allow a character like this: remove it"
_MENDING: Final = {
    "<": ("`<` in a value", "write `<` in a value as `&lt;`"),
    "]]>": ("`]]>` in a text", "write `]]>` in a text as `]]&gt;`"),
    **dict.fromkeys(("-", "--"), ("`--` in a comment", "write `- -` in comments")),
}
_PREDEFINED: Final = frozenset(("lt", "gt", "amp", "quot", "apos"))
_BEYOND: Final = 0x110000  # no character has this number or a greater one
_MOST_DIGITS: Final = 8  # of a number that may be one
_S: Final = r"[ \t\r\n]"
_WORD: Final = f"[{NAME_START}:][{NAME_CHARACTERS}:]*"
_LITERAL: Final = r"""(?:"[^"]*"|'[^']*')"""
_PUBLIC: Final = r"""(?:"[-a-zA-Z0-9_ \r\n'()+,./:=?;!*#@$%]*"|'[-a-zA-Z0-9_ \r\n()+,./:=?;!*#@$%]*')"""
# In both, what follows tells the alternatives apart, so there is only one way to match: the time is linear.
_DECLARATIONS: Final = (
    r"""(?P<declarations>(?:[^\]"'<]|"[^"]*"|'[^']*'|<!--(?:(?!-->).)*-->|<\?(?:(?!\?>).)*\?>|<(?!!--|\?))*)"""
)
_PIECE: Final = re.compile(
    rf"""(?P<comment><!--.*?-->)|(?P<section><!\[CDATA\[.*?\]\]>)|(?P<instruction><\?.*?\?>)
    |(?P<doctype><!DOCTYPE{_S}+{_WORD}(?P<external>{_S}+(?:SYSTEM|PUBLIC{_S}+{_PUBLIC}){_S}+{_LITERAL})?{_S}*
        (?:\[{_DECLARATIONS}\]{_S}*)?>)
    |(?P<declaration><![^>]*>)|(?P<tag><(?:[^<>"']|{_LITERAL})*>)|(?P<text>[^<]+|<)""",
    re.DOTALL | re.VERBOSE,
)
_ENTITY: Final = re.compile(rf"<!ENTITY{_S}+({_WORD})")
_NO_BLANK: Final = re.compile(r"[^ \t\r\n]")
_BLANKS: Final = re.compile(f"{_S}*").match
_NAME: Final = re.compile(_WORD).match
_EQUALS: Final = re.compile(rf"{_S}*={_S}*([\"'])").match
_ODD: Final = re.compile(r"[^= \t\r\n]")
_PLAIN: Final = "[A-Za-z_:][-A-Za-z0-9_:.]*"
_PLAIN_TAG: Final = re.compile(
    rf"""<(?:/{_PLAIN}|{_PLAIN}(?:{_S}+{_PLAIN}{_S}*={_S}*(?:"[ !#-%'-;=-~]*"|'[ -%(-;=-~]*'))*{_S}*/?)>"""
).match
_BAD_IN_TEXT: Final = re.compile(rf"[<&]|\]\]>|{FORBIDDEN.pattern}")
_BAD_IN_VALUE: Final = re.compile(f"[<&]|{FORBIDDEN.pattern}")
_BAD_IN_COMMENT: Final = re.compile(rf"--|-\Z|{FORBIDDEN.pattern}")
_REFERENCE: Final = re.compile(rf"&(?:#(?P<decimal>[0-9]+)|#x(?P<hexadecimal>[0-9a-fA-F]+)|(?P<name>{_WORD}));").match
_DECLARATION: Final = re.compile(
    rf"""<\?xml{_S}+version{_S}*={_S}*(?:"{VERSION}"|'{VERSION}')
    (?:{_S}+encoding{_S}*={_S}*(?:"[A-Za-z][-A-Za-z0-9._]*"|'[A-Za-z][-A-Za-z0-9._]*'))?
    (?:{_S}+standalone{_S}*={_S}*(?:"(?:yes|no)"|'(?:yes|no)'))?{_S}*\?>""",
    re.VERBOSE,
).match
_VERSION: Final = re.compile(rf"""{_S}version{_S}*={_S}*["']([^"']*)["']""")

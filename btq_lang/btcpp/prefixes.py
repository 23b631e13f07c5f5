"""Prefixes of names that other XML tools refuse; to the engine a `:` is a letter like others.

One invariant: only what concerns prefixes is reported, of a document that is well-formed otherwise.

Source: Namespaces in XML 1.0, third edition, https://www.w3.org/TR/xml-names/; of `xml:id`, https://www.w3.org/TR/xml-id/.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Final

from btq_lang.btcpp.document import Attribute, Element
from btq_lang.btcpp.malformed import Mistake
from btq_lang.catalog.names import NAME_CHARACTERS, NAME_START
from btq_lang.util.text import Span


def wrong_prefix(root: Element) -> Mistake | None:
    """The first name of a document, by its document element, whose prefix other tools refuse; None if there is none."""
    return next(_mistakes(root), None)


def _mistakes(root: Element) -> Iterator[Mistake]:
    for match in _INSTRUCTION.finditer(root.source, 0, root.start):
        if ":" in (match[1] or ""):
            yield _misplaced(match[1], match.start(1))
    stack: list[tuple[Element, Mapping[str, str]]] = [(root, {"xml": _XML})]
    while stack:
        element, spaces = stack.pop()
        prefixed = [each for each in element.attributes if ":" in each.name or each.name == "xmlns"]
        if prefixed or ":" in element.tag:
            declarations = [each for each in prefixed if each.name == "xmlns" or each.name.startswith("xmlns:")]
            spaces = {**spaces, **{each.name[6:]: each.value for each in declarations}}
            for attribute in declarations:
                yield from _declaration(element, attribute)
            yield from _names(element, [each for each in prefixed if each not in declarations], spaces)
        stack += reversed([(child, spaces) for child in element.elements])


def _declaration(element: Element, attribute: Attribute) -> Iterator[Mistake]:
    """What is wrong with the declaration of a prefix, or of what names without one belong to."""
    start, value_start = element.place(attribute)
    name, uri = attribute.name, attribute.value
    prefix = name[6:]
    value = Span(value_start, value_start + len(attribute.raw))
    if name != "xmlns" and not _WORD(prefix):
        yield _misplaced(name, start)
    elif prefix == "xmlns" or uri == _XMLNS or (prefix == "xml") != (uri == _XML):
        yield Mistake(Span(start, value.end), "`xml` and `xmlns` are declared by XML itself", "remove this declaration")
    elif prefix and not uri:
        yield Mistake(value, f"`{name}` declares no namespace", _WRITE_URI)
    elif not _URI(uri):
        yield Mistake(value, f"the value of `{name}` is not a URI", _WRITE_URI)


def _names(element: Element, attributes: list[Attribute], spaces: Mapping[str, str]) -> Iterator[Mistake]:
    """What is wrong with the name of an element and those of its attributes that have a prefix."""
    if ":" in element.tag:
        yield from _name(element.tag, element.tag_span.start, spaces)
    names: set[tuple[str, str]] = set()
    for attribute in attributes:
        start, value_start = element.place(attribute)
        yield from _name(attribute.name, start, spaces)
        prefix, _, word = attribute.name.partition(":")
        if (spaces[prefix], word) in names:
            message = f"duplicate attribute `{word}` in <{element.tag}>: two prefixes mean the same"
            yield Mistake(Span(start, start + len(attribute.name)), message, "keep one of them")
        names.add((spaces[prefix], word))
        if attribute.name == "xml:id" and not _WORD(attribute.value.strip(" \t\r\n")):
            value = Span(value_start, value_start + len(attribute.raw))
            yield Mistake(value, "the value of `xml:id` is not a name", "write a name without `:`, or leave it out")


def _name(name: str, start: int, spaces: Mapping[str, str]) -> Iterator[Mistake]:
    """What is wrong with a name that has a `:`."""
    prefix, _, word = name.partition(":")
    if not _WORD(prefix) or not _WORD(word):
        yield _misplaced(name, start)
    elif prefix not in spaces:
        advice = f'write xmlns:{prefix}="…" in an element around it, or remove the prefix'
        yield Mistake(Span(start, start + len(prefix)), f"the prefix of `{name}` is not declared", advice)


def _misplaced(name: str, start: int) -> Mistake:
    return Mistake(Span(start, start + len(name)), f"misplaced `:` in `{name}`", "write the name without it")


_XML: Final = "http://www.w3.org/XML/1998/namespace"
_XMLNS: Final = "http://www.w3.org/2000/xmlns/"
_WRITE_URI: Final = "write a URI between the quotes"
_INSTRUCTION: Final = re.compile(r"<!--.*?-->|<\?([^\s?]*)", re.DOTALL)
_WORD: Final = re.compile(f"[{NAME_START}][{NAME_CHARACTERS}]*").fullmatch
_PART: Final = r"(?:[-A-Za-z0-9._~!$&'()*+,;=:@/?\[\]]|%[0-9A-Fa-f]{2})*"  # RFC 3986
_URI: Final = re.compile(rf"{_PART}(?:#{_PART})?").fullmatch

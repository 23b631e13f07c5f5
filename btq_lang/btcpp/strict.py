"""What other XML tools refuse, though the engine reads it: lxml's message, and what to write instead.

One invariant: lxml gets bytes and may use no network, no files, no entities and no huge documents.  It is imported only
if there is XML to check.
"""

from __future__ import annotations

import re
from typing import Final

from btq_lang.diagnostics.model import Diagnostic
from btq_lang.util.text import LineIndex, Position, Span


def not_well_formed(text: str, with_prefixes: bool = False) -> tuple[Diagnostic, ...] | None:
    """A warning at the place where lxml refuses a text, with prefixes of names, which takes three times as long, or
    without; None if it reads it, empty if it only reached limits of its own, which XML does not have."""
    from lxml import etree

    parser = etree.XMLParser(
        target=None if with_prefixes else _Nobody(),
        encoding="utf-8",
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        huge_tree=False,
        remove_pis=True,
    )
    try:
        etree.fromstring(text.encode("utf-8", "replace"), parser)
    except etree.XMLSyntaxError as error:
        if error.code in _LIMITS:
            return ()
        line, column = error.position
        return (_refused(text, error.msg or "it is not well-formed", line, column),)
    return None


class _Nobody:
    """A target that ignores what lxml reads, so that no tree is built; such a parser does not check prefixes."""

    def close(self) -> None:
        """The end of the document."""


def _refused(text: str, message: str, line: int, column: int) -> Diagnostic:
    said = _POSITION.sub("", message).rstrip()
    lines = LineIndex(text)
    at = min(lines.offset(Position(max(line, 1) - 1, max(column, 1) - 1)), max(len(text) - 1, 0))
    notes = tuple(note for pattern, note in _MENDING if pattern in said)
    shown = f"the engine reads this, but no other XML tool does: {said}"
    return Diagnostic("xml-not-well-formed", Span(at, min(at + 1, len(text))), shown, notes=notes)


_POSITION: Final = re.compile(r", line \d+, column \d+.*\Z", re.DOTALL)
_LIMITS: Final = (1, 114)  # XML_ERR_INTERNAL_ERROR, which older versions of libxml2 report for XML_ERR_RESOURCE_LIMIT

# Messages of libxml2, and what to do about each.
_MENDING: Final = (
    ("Unescaped '<'", "write `<` in a value as `&lt;`"),
    ("EntityRef", "write `&` as `&amp;`"),
    ("Entity '", "only &lt; &gt; &amp; &quot; &apos; and numbers are known: write `&` as `&amp;`"),
    ("xmlParseCharRef", "XML does not allow a character like this: remove it"),
    ("PCDATA invalid Char", "XML does not allow a control character: remove it"),
    ("invalid character", "XML does not allow a control character: remove it"),
    ("Double hyphen", "write `- -` in comments"),
    ("Unsupported version", 'write version="1.0"'),
    ("attributes construct error", "put a space between attributes"),
    ("XML or text declaration", "put the declaration first in the file, without a space before it"),
    ("XML declaration allowed", "put the declaration first in the file, without a space before it"),
    ("Start tag expected", "remove the text before the document element"),
    ("Extra content", "one element contains the whole file: remove the text after it"),
    ("StartTag: invalid element name", "put no space between `<` and the name"),
)

"""An edit of a text that was imported from XML, as the edit of the XML that has the same effect.

One invariant: after `exact_edits` the import of the XML is the edited text.  So an edit is placed only where it
replaces a word that both texts have letter by letter, by one that needs no other spelling in either.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Final

from btq_lang.btcpp.document import escape
from btq_lang.btcpp.marks import is_generated
from btq_lang.btcpp.wording import kind, name, string, value
from btq_lang.syntax.tokens import CATEGORIES
from btq_lang.syntax.tree import unquote
from btq_lang.util.text import Edit, Span

if TYPE_CHECKING:
    from btq_lang.workspace.file import File


def exact_edits(file: File, edit: Edit) -> tuple[Edit, ...] | None:
    """The edits of a file's XML for one of its text; None if there are none that do exactly that.

    XML that a build wrote has none: its source is to be changed.
    """
    if file.places is None or not file.is_understood or is_generated(file.source):
        return None
    xml, replaced = file.source, edit.span
    word = file.text[replaced.start : replaced.end]
    is_string = len(word) > 2 and word[0] == word[-1] == '"'
    if is_string:  # by a word without quotes, which XML spells as it is
        replaced = Span(replaced.start + 1, replaced.end - 1)
    for start, end, begin, stop in file.places.containing(replaced):
        old = file.text[start:end]
        if is_string and old == word and xml[begin - 1 : stop] == f"<{word[1:-1]}":  # in quotes here alone
            ends = [Span(begin, stop), *closing_name(xml, begin, word[1:-1])] if _is_tag(edit.text, edit.text) else []
            return tuple(Edit(span, edit.text) for span in ends) or None
        if replaced.start < replaced.end and old == xml[begin:stop]:
            new = file.text[start : replaced.start] + edit.text + file.text[replaced.end : end]
            if not new or _SPECIAL.search(new):
                return None
            if xml[begin - 1] == "<":
                ends = [Span(begin, stop), *closing_name(xml, begin, old)] if _is_tag(old, new) else []
                return tuple(Edit(span, new) for span in ends) or None
            if xml[stop : stop + 1] not in _QUOTES and not _PLACED.isdisjoint((old, new)):
                return None
            # What follows a reference is in a value, and a value with one is in quotes.
            is_quoted = (file.text[start - 1 : start] == '"' or xml[begin - 1] == ";") and not is_string
            is_same = string(new) == f'"{new}"' if is_quoted else new in (name(new), value(new))
            return (Edit(Span(begin, stop), new),) if is_same else None
    return None


def respelt(file: File, edits: Iterable[Edit]) -> Iterator[Edit]:
    """Edits that replace words, or names in words, as edits of the file on the disk, which spells them as XML does.

    Whether the result means what it should is for the caller to find.
    """
    if not file.is_foreign:
        yield from edits
        return
    xml = file.source
    for edit in edits:
        span = file.on_disk(edit.span)
        new = escape(unquote(edit.text) if edit.text[:1] in _QUOTES else edit.text)
        yield Edit(span, new)
        if xml[span.start - 1 : span.start] == "<":
            yield from (Edit(end, new) for end in closing_name(xml, span.start, xml[span.start : span.end]))


def _is_tag(old: str, new: str) -> bool:
    """Whether both tags are written as they are, and neither or both are a category in front of an ID."""
    if old in CATEGORIES or new in CATEGORIES:
        return old in CATEGORIES and new in CATEGORIES
    return all(kind(tag, has_code=False, symbols=False) == tag for tag in (old, new))


def closing_name(xml: str, begin: int, tag: str) -> Iterator[Span]:
    """The name in the end tag of the element whose name begins at an offset; nothing if it has none."""
    depth = 0
    for match in _TAG.finditer(xml, begin - 1):
        if match["closing"]:
            depth -= 1
        elif match["name"] and not match["empty"]:
            depth += 1
        if depth == 0 and match["name"]:
            if match["closing"] and match["name"] == tag:
                yield Span(*match.span("name"))
            return


_QUOTES: Final = ('"', "'")
# Attributes whose place in a line says what they are, or that say how others are read.
_PLACED: Final = frozenset(
    ("ID", "name", "type", "default", "path", "ros_pkg", "code", "BTCPP_format", "main_tree_to_execute")
)
_SPECIAL: Final = re.compile("[<&\"'\\\\\r\n\t]")
_TAG: Final = re.compile(
    r"""<!--.*?-->|<!\[CDATA\[.*?\]\]>|<\?.*?\?>"""
    r"""|<(?P<closing>/?)(?P<name>[^\s/>!?"']+)(?:[^>"'/]|/(?!>)|"[^"]*"|'[^']*')*(?P<empty>/?)>""",
    re.DOTALL,
)

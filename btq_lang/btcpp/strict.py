"""Whether other XML tools read a text: lxml's judgement, or where it is not installed that of Python's own expat.

One invariant: the judge builds no tree, opens neither files nor connections, and limits how much the entities of a
DOCTYPE grow.  Why it refuses a text is for `malformed`, which finds the same for both judges.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from typing import Final


def is_well_formed(text: str) -> bool:
    """Whether a text is well-formed, prefixes of names aside; False too if it reaches limits that XML does not have."""
    return judge()(text)


@cache
def judge() -> Callable[[str], bool]:
    """The judge that is installed; imported only if there is XML to check."""
    try:
        from lxml import etree
    except ImportError:
        return _by_expat

    def by_lxml(text: str) -> bool:
        parser = etree.XMLParser(
            target=_IgnoringTarget(),
            encoding="utf-8",
            resolve_entities=False,
            no_network=True,
            load_dtd=False,
            huge_tree=False,
            remove_pis=True,
        )
        try:
            etree.fromstring(text.encode("utf-8", "replace"), parser)
        except etree.XMLSyntaxError:
            return False
        return True

    return by_lxml


class _IgnoringTarget:
    """A target that ignores what lxml reads, so that no tree is built; such a parser does not check prefixes."""

    def close(self) -> None:
        """The end of the document."""


def _by_expat(text: str) -> bool:
    from xml.parsers import expat

    parser = expat.ParserCreate("utf-8")
    versions: list[str] = []
    parser.XmlDeclHandler = lambda version, encoding, standalone: versions.append(version)
    try:
        parser.Parse(_as_in_fourth_edition(text).encode("utf-8", "replace"), True)
    except expat.ExpatError:
        return False
    return all(re.fullmatch(VERSION, version) for version in versions)


def _as_in_fourth_edition(text: str) -> str:
    """The text with names that expat knows, for it refuses some that are new in XML's fifth edition."""
    text = text.removeprefix("\ufeff")
    if text.isascii():
        return text
    from btq_lang.catalog.names import BEGINNING, FOLLOWING  # as above

    return re.sub(f"[{FOLLOWING}]", "\u00b7", re.sub(f"[{BEGINNING}]", "\u00e9", text))


VERSION: Final = r"1\.[0-9]*"  # of XML, as lxml accepts it

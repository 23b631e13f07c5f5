"""How names, values, node kinds and comments of XML are spelt in a .btq file.

One invariant: the spelling reads as what it was made of: a literal line end or tab in a value of the XML stays literal,
while one written as a reference (`&#10;`) becomes an escape (`\\n`), so the way back gives the same XML. It knows
neither elements nor lines.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Final

from btq_lang.btcpp.document import unescape
from btq_lang.catalog.nodes import BUILTINS, PLACEHOLDERS, xml_tag
from btq_lang.grammar.claim_words import VERB_WORDS
from btq_lang.grammar.conditions import HEADS
from btq_lang.grammar.item_words import ITEM_WORDS
from btq_lang.syntax.tokens import CATEGORIES, DIRECTIONS, NODE_CLAUSES
from btq_lang.syntax.tree import is_name


def value(raw: str) -> str:
    """A Value for the text between the quotes of the XML: blackboard entries and numbers bare, everything else in
    quotes."""
    match = _SIMPLE(raw)
    if match is not None:
        return raw if match.lastindex else f'"{raw}"'
    if "&" in raw:
        text = unescape(raw)
        if _BARE(text):
            return text
    return string(raw)


@lru_cache(maxsize=4096)
def pair(key: str, raw: str) -> str:
    """A Pair, from an attribute; cached, for most of a file's occur more than once."""
    return f"{name(key)} = {value(raw)}"


def string(raw: str) -> str:
    """A STRING, from the text between the quotes of the XML."""
    if _PLAIN(raw):
        return f'"{raw}"'
    return _quoted("".join([written for written, _ in spelt_parts(raw)]))


def spelt_parts(raw: str) -> list[tuple[str, str]]:
    """The parts of a value in quotes, each as it is written there, and as the XML spells it."""
    return [(_written(part), part[0]) for part in _PARTS(raw)]


def string_of(text: str) -> str:
    """A STRING for a text, its line ends and tabs kept as they are."""
    return _quoted(_LINE_END.sub("\n", text).replace("\\", "\\\\"))


@lru_cache(maxsize=4096)
def name(raw: str) -> str:
    """A Name for a label, an ID or a key."""
    text = unescape(raw) if "&" in raw else raw
    return text if is_name(text) and text not in NODE_CLAUSES else string(raw)


@lru_cache(maxsize=4096)
def kind(tag: str, category: bool = False, has_code: bool = True, symbols: bool = True) -> str:
    """The kind of a node: a symbol where it has one, and in quotes where the bare word would mean something else.

    Args:
        category: the word follows `Action`, `Control` …, where symbols are not allowed.
        has_code: the node has a script: without one, `Script` is a placeholder.
        symbols: whether to write symbols.
    """
    builtin = BUILTINS.get(tag)
    if builtin is not None and builtin.symbols and symbols and not category:
        return builtin.symbols[0]
    changes = not is_name(tag) or xml_tag(tag) != tag or (tag in PLACEHOLDERS and not has_code)
    return string(tag) if changes or tag in (NODE_CLAUSES if category else _MEANING) else tag


@lru_cache(maxsize=512)
def type_(raw: str) -> str:
    """The type of a port."""
    return raw if _TYPE(raw) and all(is_name(part) for part in raw.split("::")) else string(raw)


def comment(text: str) -> str:
    """A comment, from the text between `<!--` and `-->` (docs/language.md)."""
    if "\n" not in text and "*/" in text:
        return f"#{text.rstrip(_BLANKS)}"
    if "\n" not in text:
        begins_blank = text[:1] in _FIRST_BLANKS
        line = text[:-1] if begins_blank and text[-1:] == " " and len(text) > 1 else text
        if line == line.rstrip(_BLANKS) and begins_blank == (line is not text):
            return f"#{line}"
    return f"/*{text.replace('*/', '* /')}*/"


def is_kept(text: str) -> bool:
    """Whether `comment` keeps all of a comment: it cannot keep both `*/` and trailing blanks."""
    written = comment(text)
    if written.startswith("/*"):
        return written[2:-2] == text
    line = written[1:]
    return (f"{line} " if line[:1] in _FIRST_BLANKS else line) == text


def _written(part: re.Match[str]) -> str:
    """A piece of a value: a line end, a reference, a backslash, or plain text."""
    piece = part[0]
    first = piece[0]
    if first in "\r\n":
        return "\n"
    if first == "\\":
        return "\\\\"
    if first == "&":
        return _ESCAPED.get(said := unescape(piece), said)
    return piece


def _quoted(inside: str) -> str:
    if '"' not in inside:
        return f'"{inside}"'
    if "'" not in inside:
        return f"'{inside}'"
    return '"' + inside.replace('"', '\\"') + '"'


_MEANING: Final = frozenset((*CATEGORIES, *DIRECTIONS, *NODE_CLAUSES, *ITEM_WORDS, *HEADS, *VERB_WORDS))
_BLANKS: Final = " \t"
_FIRST_BLANKS: Final = (" ", "\t")
_ESCAPED: Final = {"\n": "\\n", "\r": "\\n", "\t": "\\t", "\\": "\\\\"}
_NUMBER: Final = r"-?[0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?"
_BARE: Final = re.compile(rf"\{{[^{{}}\"'\r\n&]*\}}|{_NUMBER}").fullmatch
_PLAIN: Final = re.compile(r"[^0-9\-{&\"\\\r\n][^&\"\\\r\n]*|").fullmatch
_SIMPLE: Final = re.compile(rf"(\{{[^{{}}\"'\r\n&]*\}}|{_NUMBER})|[^0-9\-{{&\"\\\r\n][^&\"\\\r\n]*|").fullmatch
_PARTS: Final = re.compile(r"\r\n|\n\r|[\r\n]|&#?\w+;|[&\\]|[^\r\n&\\]+").finditer
_LINE_END: Final = re.compile(r"\r\n|\n|\r")
_TYPE: Final = re.compile(r"\w+(?:::\w+)*").fullmatch

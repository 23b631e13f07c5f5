"""Which names the engine refuses, and why.

One invariant: a name that passes here passes the engine's own check of the same version (src/xml_parsing.cpp,
validateModelName and its neighbours; src/basic_types.cpp, findForbiddenChar).  It does not know whether a name is
taken.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Final

from btq_lang.catalog.attributes import RESERVED_ATTRIBUTES
from btq_lang.catalog.versions import DEFAULT_VERSION, NAME_RULES

_KEPT: Final = 1_000  # cache size: a mission repeats its names


@lru_cache(_KEPT)
def model_name_problem(name: str, version: str = DEFAULT_VERSION) -> str | None:
    """Why the engine refuses the ID of a tree, the tree that a SubTree names, or the tag of a node; None if it does
    not.

    The ID of the explicit form, `<Action ID="my node"/>`, is not checked by any version.
    """
    if not NAME_RULES.holds(version):
        return None
    if name == "":
        return "it is empty"
    if name in ("Root", "root"):
        return "`Root` is a reserved name"
    return _refused_character(name, _REFUSED)


def port_name_problem(name: str, version: str = DEFAULT_VERSION) -> str | None:
    """Why the engine refuses the name of a port in the model of a SubTree; None if it does not."""
    if not NAME_RULES.holds(version):
        return None
    if name == "":
        return "it is empty"
    if name[0] in "0123456789":
        return "it begins with a digit"
    return _refused_character(name, _REFUSED) or _reserved(name)


@lru_cache(_KEPT)
def instance_name_problem(name: str, version: str = DEFAULT_VERSION) -> str | None:
    """Why the engine refuses the `name` of a node; None if it does not.  Only control characters are refused."""
    return _refused_character(name, _UNPRINTABLE) if NAME_RULES.holds(version) else None


@lru_cache(_KEPT)
def is_port_name(name: str, version: str = DEFAULT_VERSION) -> bool:
    """Whether the engine takes an attribute of that name for a port.  If not, it keeps it and never reads it."""
    if name[:1] not in _LETTERS or name in ("name", "ID"):
        return False
    return not NAME_RULES.holds(version) or _refused_character(name, _REFUSED) is None


def is_entry_name(name: str) -> bool:
    """Whether a text is likely the name of a blackboard entry: `goal`, `stop_sign.wall_id`, and not `a}_{b`."""
    return all(piece.isidentifier() for piece in name.split("."))


def is_xml_name(name: str) -> bool:
    """Whether a name can be a tag or the name of an attribute for every reader of XML, namespaces aside."""
    if name.isascii():
        return name[:1] not in ("-", ".") and name.replace("-", "_").replace(".", "_").isidentifier()
    return re.fullmatch(_XML_NAME, name) is not None


def legal_name(name: str) -> str:
    """A name made legal as a node's ID: `BatteryLow?` is BatteryLow, `Move Base` Move_Base, `3 Tubes` _3_Tubes.

    The result is accepted by every version of the engine, is an XML tag, and needs no quotes in a file: letters,
    digits, `_`, and `-` inside.  Other characters at the ends are dropped, those between two pieces become one `_`.
    """
    if name.isascii() and name.isidentifier() and name not in ("Root", "root"):
        return name  # nearly all are
    plain = (character if character in "_-0123456789" or character.isalpha() else " " for character in name)
    pieces = "".join(plain).split()
    legal = "_".join(kept for piece in pieces if (kept := piece.strip("-")))
    if legal in ("", "Root", "root"):
        return f"{legal}_"
    return f"_{legal}" if legal[0] in "0123456789" else legal


def _refused_character(name: str, refused: frozenset[str]) -> str | None:
    """The first character of a name that is refused, as a reason; None if none is."""
    if refused.isdisjoint(name):
        return None
    character = next(character for character in name if character in refused)
    if character in _CONTROLS:
        return f"it contains the control character U+{ord(character):04X}"
    return "it contains a space" if character == " " else f"it contains `{character}`"


def _reserved(name: str) -> str | None:
    reserved = name in ("name", "ID") or (name in RESERVED_ATTRIBUTES and RESERVED_ATTRIBUTES[name].group != "tool")
    return "it is the name of a reserved attribute" if reserved else None


_FORBIDDEN: Final = " <>&\"'/\\:*?|."
_CONTROLS: Final = "".join(map(chr, range(32))) + "\x7f"
_REFUSED: Final = frozenset(_FORBIDDEN + _CONTROLS)
_UNPRINTABLE: Final = frozenset(_CONTROLS) - frozenset("\t\n\r")
_LETTERS: Final = frozenset("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz")
# Ranges of characters of names in XML beyond ASCII: with which one may begin, and which only follow others.
BEGINNING: Final = (
    "\u00c0-\u00d6\u00d8-\u00f6\u00f8-\u02ff\u0370-\u037d\u037f-\u1fff\u200c-\u200d\u2070-\u218f"
    "\u2c00-\u2fef\u3001-\ud7ff\uf900-\ufdcf\ufdf0-\ufffd\U00010000-\U000effff"
)
FOLLOWING: Final = "\u00b7\u0300-\u036f\u203f-\u2040"
# Strings, for `re` takes 5 ms to compile them and few missions have a name that needs it.
NAME_START: Final = f"A-Z_a-z{BEGINNING}"
NAME_CHARACTERS: Final = f"-.0-9{FOLLOWING}{NAME_START}"
_XML_NAME: Final = f"[{NAME_START}][{NAME_CHARACTERS}]*"

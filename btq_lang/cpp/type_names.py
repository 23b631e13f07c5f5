"""C++ types as texts: their parts, and what the parameters of a template mean in them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Final


def plain(text: str) -> str:
    """A type without superfluous blanks: `std::vector<int>`."""
    text = _BLANKS.sub(" ", text.strip()).removeprefix("typename ").removeprefix("::")
    return _AROUND.sub(r"\1", text).replace(",", ", ")


def parts(text: str) -> tuple[str, list[str]]:
    """The name of a type and the arguments of its template: `Base` and `int` of `Base<int>`."""
    text = plain(text)
    name, sign, inside = text.partition("<")
    if not sign or not text.endswith(">"):
        return text, []
    depth, begin, found = 0, 0, []
    for at, sign in enumerate(inside[:-1]):
        depth += sign in "<({"
        depth -= sign in ">)}"
        if sign == "," and not depth:
            found.append(inside[begin:at].strip())
            begin = at + 1
    return name, [*found, inside[begin:-1].strip()]


def substituted(text: str, meanings: Mapping[str, str]) -> str:
    """A type in which the parameters of a template are replaced by what they mean."""
    return plain(_WORD.sub(lambda match: meanings.get(match[0], match[0]), text))


_BLANKS: Final = re.compile(r"\s+")
_AROUND: Final = re.compile(r" ?(::|[<>,]) ?")
_WORD: Final = re.compile(r"(?<![\w:])[A-Za-z_]\w*")

"""ANSI colours: the styles, and whether to use colour at all."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeAlias

Paint: TypeAlias = "Callable[[str, str], str]"

# Select Graphic Rendition parameters of ECMA-48: 1 bold, 31 to 36 colours.
_CODES = {
    "error": "1;31",
    "warning": "1;33",
    "info": "1;36",
    "hint": "1;32",
    "message": "1",
    "gutter": "1;34",
    "-": "31",
    "+": "32",
    "~": "33",
    ">": "36",
}


def painter(colour: bool) -> Paint:
    """A function of a style and a text that returns the text in that style, or unchanged without colour."""
    if not colour:
        return lambda style, text: text
    return lambda style, text: f"\x1b[{_CODES[style]}m{text}\x1b[0m" if text else ""


def wants_colour(isatty: bool, environ: Mapping[str, str]) -> bool:
    """Whether `--color auto` means yes; the order of the checks is CPython's (`_colorize.can_colorize`).

    See no-color.org and force-color.org: a variable that is set and not empty counts.
    """
    if environ.get("NO_COLOR"):
        return False
    if environ.get("FORCE_COLOR"):
        return True
    return isatty and environ.get("TERM") != "dumb"

"""The parser of argparse with suggestions for invalid choices, and with options and paths in any order."""

from __future__ import annotations

import re
from argparse import ArgumentParser
from typing import Any, NoReturn

from btq_lang.util.spelling import near


class SuggestingParser(ArgumentParser):
    """A parser that suggests what an invalid choice was probably meant to be, as argparse does since Python 3.14."""

    add = ArgumentParser.add_argument
    _is_mixing = False

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """As in argparse, but a command's options and paths may come in any order, except with `--`."""
        if self._subparsers is not None or self._is_mixing or "--" in args:
            return super().parse_known_args(args, namespace)
        self._is_mixing = True  # it parses twice: without paths, and what is left
        try:
            return self.parse_known_intermixed_args(args, namespace)
        finally:
            self._is_mixing = False

    def flag(self, name: str, help: str) -> None:
        """Add an option without a value."""
        self.add(name, action="store_true", help=help)

    def error(self, message: str) -> NoReturn:
        """End the program with the usage and the error."""
        if wrong := re.search(r"invalid choice: '([^']*)' \(choose from (.*)\)$", message):
            close = near(wrong[1], wrong[2].replace("'", "").split(", "), limit=1)
            message += f"; did you mean {close[0]}?" if close else ""
        super().error(message)

"""`btq compare`: what got slower, less reliable or newly violated from one label, robot or folder to another."""

from __future__ import annotations

import os
import re
import sys
from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager

from btq_lang.commands.output import form_of, form_problem, write_output
from btq_lang.commands.stored import NO_STORE, store_of_project
from btq_lang.evidence.compare import FORMATS, write
from btq_lang.projects.options import Refused, refuse


def run(options: Namespace) -> int:
    """Compare, and print what was found; returns the exit code."""
    store, sides = _named(options)
    refuse(_problem(options, sides) or form_problem(options, FORMATS))
    at_least = _share(options.at_least)
    if store is not None:
        return _compared(options, store, sides, at_least)
    if options.by != "label" or not all(map(os.path.isdir, sides)):
        one = f"one {options.by} given; compare two, as in btq compare {sides[0]} A B"
        raise Refused(one if os.path.isdir(sides[0]) else NO_STORE)
    with _judged(sides) as of_logs:
        return _compared(options, of_logs, sides, at_least)


def _compared(options: Namespace, store: str, sides: tuple[str, str], at_least: float) -> int:
    from btq_lang.evidence.compare.comparison import UnknownSide, compare
    from btq_lang.evidence.store.engine import NoEngine, asked

    try:
        comparisons = compare(asked(store, options.label), options.by, sides, at_least)
    except (NoEngine, UnknownSide) as error:
        of = f" with the label {options.label}" if options.label is not None and isinstance(error, UnknownSide) else ""
        raise Refused(f"{error}{of}") from error
    form = form_of(options, FORMATS)
    write_output(options.output, write(comparisons, options.by, sides, form), form)
    return int(any(each.is_worse for each in comparisons))


@contextmanager
def _judged(folders: tuple[str, str]) -> Iterator[str]:
    """A store for the time being, of the logs in two folders, which are the labels."""
    from contextlib import redirect_stderr
    from io import StringIO
    from tempfile import TemporaryDirectory

    from btq_lang.commands.arguments import build_parser
    from btq_lang.commands.verify import run as verify

    with TemporaryDirectory(prefix="btq-") as temporary:
        store, verdicts = (os.path.join(temporary, name) for name in ("store", "verdicts.json"))
        notes = StringIO()
        for folder in folders:
            kept = ("--store", store, "--label", folder, "--exit-zero", "-o", verdicts)
            with redirect_stderr(notes):
                verify(build_parser().parse_args(["verify", folder, *kept]))
        for note in dict.fromkeys(notes.getvalue().splitlines()):  # those of both folders once
            print(note.replace("btq verify:", "btq compare:", 1), file=sys.stderr)
        yield store


def _problem(options: Namespace, sides: tuple[str, str]) -> str | None:
    if options.label is not None and options.by != "robot":
        return "--label goes with --by robot"
    return f"both sides are {sides[0]}" if sides[0] == sides[1] else None


def _named(options: Namespace) -> tuple[str | None, tuple[str, str]]:
    """The store and the two sides; argparse has two names alone as `store` and `before`."""
    if options.after is None:
        return store_of_project(), (options.store, options.before)
    return options.store, (options.before, options.after)


def _share(text: str) -> float:
    """A percentage, such as `5 %`, as a fraction of one."""
    number = re.fullmatch(r"\s*(\d+\.?\d*|\.\d+)\s*%?\s*", text, re.ASCII)
    if number is None:
        raise Refused(f"--at-least {text}: expected a percentage, such as 5 %")
    return float(number[1]) / 100

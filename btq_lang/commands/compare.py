"""`btq compare`: what got slower, less reliable or newly violated from one label, robot or folder to another."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager

from btq_lang.commands.output import form_of, form_problem, write_output
from btq_lang.commands.stored import NO_STORE, store_of_project
from btq_lang.evidence.compare import FORMATS, write
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import Refused, refuse
from btq_lang.util.record import Record


class CompareOptions(Record):
    """The options of `btq compare`.

    Attributes:
        store, before, after: as on the command line; without `after`, the other two are the sides.
        by: what the sides are, `label` or `robot`.
        label: of robots, only the runs with this label.
        at_least: the least difference that counts, as a percentage.
    """

    store: str
    before: str
    after: str | None
    by: str
    label: str | None
    at_least: str
    format: str | None
    output: str | None


def run(options: CompareOptions, messages: CommandOutput) -> int:
    """Compare, and print the differences; returns the exit code."""
    store, sides = _store_and_sides(options)
    refuse(_problem(options, sides) or form_problem(options.format, options.output, FORMATS))
    at_least = _fraction(options.at_least)
    if store is not None:
        return _compare(options, store, sides, at_least, messages)
    if options.by != "label" or not all(map(os.path.isdir, sides)):
        one = f"one {options.by} given; compare two, as in btq compare {sides[0]} A B"
        raise Refused(one if os.path.isdir(sides[0]) else NO_STORE)
    with _store_of_folders(sides, messages) as store_of_folders:
        return _compare(options, store_of_folders, sides, at_least, messages)


def _compare(
    options: CompareOptions, store: str, sides: tuple[str, str], at_least: float, messages: CommandOutput
) -> int:
    from btq_lang.evidence.compare.comparison import UnknownSide, compare
    from btq_lang.evidence.store.engine import NoEngine, asked

    try:
        comparisons = compare(asked(store, options.label), options.by, sides, at_least)
    except (NoEngine, UnknownSide) as error:
        is_of_label = options.label is not None and isinstance(error, UnknownSide)
        raise Refused(f"{error} with the label {options.label}" if is_of_label else error) from error
    form = form_of(options.format, options.output, FORMATS)
    write_output(messages, options.output, write(comparisons, options.by, sides, form), form)
    return int(any(comparison.is_worse for comparison in comparisons))


@contextmanager
def _store_of_folders(folders: tuple[str, str], messages: CommandOutput) -> Iterator[str]:
    """A temporary store of the logs in two folders, which are the labels."""
    from tempfile import TemporaryDirectory

    from btq_lang.commands.verify import run as verify
    from btq_lang.commands.verify_options import VerifyOptions

    with TemporaryDirectory(prefix="btq-") as temporary:
        store, verdicts = (os.path.join(temporary, name) for name in ("store", "verdicts.json"))
        notes = CommandOutput()
        for folder in folders:
            verify(VerifyOptions((folder,), store=store, label=folder, output=verdicts, exit_zero=True), notes)
        for note in dict.fromkeys(notes.text().splitlines()):  # those of both folders once
            messages.remark(note.replace("btq verify:", "btq compare:", 1))
        yield store


def _problem(options: CompareOptions, sides: tuple[str, str]) -> str | None:
    if options.label is not None and options.by != "robot":
        return "--label goes with --by robot"
    return f"both sides are {sides[0]}" if sides[0] == sides[1] else None


def _store_and_sides(options: CompareOptions) -> tuple[str | None, tuple[str, str]]:
    """The store and the two sides; argparse has two names alone as `store` and `before`."""
    if options.after is None:
        return store_of_project(), (options.store, options.before)
    return options.store, (options.before, options.after)


def _fraction(text: str) -> float:
    """A percentage, such as `5 %`, as a fraction of one."""
    number = re.fullmatch(r"\s*(\d+\.?\d*|\.\d+)\s*%?\s*", text, re.ASCII)
    if number is None:
        raise Refused(f"--at-least {text}: expected a percentage, such as 5 %")
    return float(number[1]) / 100

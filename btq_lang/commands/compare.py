"""`btq compare`: what got slower, less reliable or newly violated, from one label or robot of a store to another."""

from __future__ import annotations

import os
from argparse import Namespace

from btq_lang.commands.options import Refused
from btq_lang.commands.output import form_of, form_problem, write_output
from btq_lang.commands.stored import NO_STORE, store_of_project
from btq_lang.evidence.compare import FORMATS, write


def run(options: Namespace) -> int:
    """Compare, and print what was found; returns the exit code."""
    store, sides = _named(options)
    problem = form_problem(options, FORMATS)
    if sides[0] == sides[1]:
        problem = f"both sides are {sides[0]}"
    if options.label is not None and options.by != "robot":
        problem = "--label goes with --by robot"
    if problem or store is None:
        one = f"one {options.by} given; compare two, as in btq compare {sides[0]} A B"
        raise Refused(problem or (one if os.path.isdir(sides[0]) else NO_STORE))
    from btq_lang.evidence.compare.comparison import Unknown, compare
    from btq_lang.evidence.store.engine import NoEngine, asked

    try:
        found = compare(asked(store, options.label), options.by, sides)
    except (NoEngine, Unknown) as error:
        of = f" with the label {options.label}" if options.label is not None and isinstance(error, Unknown) else ""
        raise Refused(f"{error}{of}") from error
    write_output(options.output, write(found, options.by, sides, form_of(options, FORMATS)))
    return int(any(each.is_worse for each in found))


def _named(options: Namespace) -> tuple[str | None, tuple[str, str]]:
    """The store and the two sides; argparse has two names alone as `store` and `before`."""
    if options.after is None:
        return store_of_project(), (options.store, options.before)
    return options.store, (options.before, options.after)

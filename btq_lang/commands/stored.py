"""The store of `btq verify`: verdicts are kept there, and those of all runs in it are printed."""

from __future__ import annotations

import sys
from argparse import Namespace
from typing import TYPE_CHECKING, Final

from btq_lang.commands.output import form_of, form_problem
from btq_lang.commands.verdict_formats import FORMATS
from btq_lang.commands.verdict_report import print_report
from btq_lang.workspace.loader import shown

if TYPE_CHECKING:
    from btq_lang.evidence.store.sets import Keeping


def store_problem(options: Namespace) -> str | None:
    """What is wrong with a command line about a store."""
    given = vars(options)
    named = [each for each in (*_OF_LOGS, *_OF_KEEPING, *_OF_SUMMARY) if given[each.strip("-").replace("-", "_")]]
    if options.store is None:
        wrong = [each for each in named if each not in _OF_LOGS]
        return f"{wrong[0]} goes with --store DIR" if wrong else None
    if options.logs:
        wrong = [each for each in named if each in _OF_SUMMARY]
        return f"{wrong[0]} goes with --store DIR and no log" if wrong else None
    if wrong := [each for each in named if each not in _OF_SUMMARY]:
        return f"{wrong[0]} goes with logs; without any, --store DIR prints what is kept there"
    if form_of(options, FORMATS) == "html":
        return "a page is made of logs; choose another format for a store"
    return form_problem(options, FORMATS)


def opened(options: Namespace, problems: list[str]) -> Keeping | None:
    """The store to keep verdicts in, without what killed writers left; errors are appended to the problems."""
    if options.store is None:
        return None
    from btq_lang.evidence.store.engine import NoEngine, imported
    from btq_lang.evidence.store.sets import Keeping, tidy

    try:
        imported()
        tidy(options.store)
    except NoEngine as error:
        problems.append(str(error))
    except NotADirectoryError:
        problems.append(f"{shown(options.store)}: expected a folder, found a file")
    except OSError as error:
        problems.append(f"{shown(options.store)}: cannot be read: {error.strerror or error}")
    return Keeping(options.store, options.label, options.label_by, options.robot, options.robot_by)


def summarise(options: Namespace) -> int:
    """Print the verdicts of all runs in a store; returns the exit code."""
    from btq_lang.evidence.store.engine import NoEngine, asked
    from btq_lang.evidence.store.summary import summary

    try:
        if options.engine is None:
            ask = asked(options.store)
        else:
            from btq_lang.evidence.store.fleet import asked_by

            ask = asked_by(options.engine, options.store)
        report = summary(ask, options.store, tuple(dict.fromkeys(options.by)))
    except NoEngine as error:
        print(f"btq verify: {error}", file=sys.stderr)
        return 2
    return print_report(options, report, ())


_OF_LOGS: Final = ("--mission", "--signals", "--events")
_OF_SUMMARY: Final = ("--by", "--engine")
_OF_KEEPING: Final = ("--label", "--label-by", "--robot", "--robot-by")

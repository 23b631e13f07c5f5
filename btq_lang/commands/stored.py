"""The store of `btq verify`: verdicts are kept there, and those of all runs in it are printed."""

from __future__ import annotations

import os
from argparse import Namespace
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.commands.output import form_of, form_problem
from btq_lang.commands.verdict_formats import FORMATS
from btq_lang.commands.verdict_report import print_report
from btq_lang.projects.options import Refused
from btq_lang.workspace.loader import find_project, shown

if TYPE_CHECKING:
    from btq_lang.evidence.store.sets import Keeping
    from btq_lang.workspace.config import Project


def store_of_project() -> str | None:
    """As of `store_of`, for this folder's project."""
    return store_of(find_project(".").project)


def store_of(project: Project) -> str | None:
    """The folder that a project names as its store, or what an engine knows, such as `s3://fleet/evidence`."""
    store = project.evidence.store if project.evidence is not None else None
    return store if store is None or "://" in store else shown(os.path.join(project.root, store))


def reads_store(options: Namespace) -> bool:
    """Whether the verdicts of a store are printed, and no log is read.

    Where the command line names no store, that of the project is filled in.
    """
    is_named = options.store is not None or any(_given(options, _OF_SUMMARY))
    if options.store is None and not options.no_store:
        options.store = store_of_project()
    if options.logs or options.store is None:
        return False
    evidence = find_project(".").project.evidence
    return is_named or evidence is None or not evidence.logs


def store_problem(options: Namespace, is_summary: bool) -> str | None:
    """What is wrong with a command line about a store.

    Args:
        is_summary: as `reads_store` says.
    """
    if problem := name_problem(options):
        return problem
    named = _given(options, (*_OF_LOGS, *_OF_KEEPING, *_OF_SUMMARY))
    if options.store is None:
        wrong = [each for each in named if each not in _OF_LOGS]
        where = "a store; leave out --no-store" if options.no_store else "--store DIR"
        return f"{wrong[0]} goes with {where}" if wrong else None
    if not is_summary:
        wrong = [each for each in named if each in _OF_SUMMARY]
        return f"{wrong[0]} goes with --store DIR and no log" if wrong else None
    if wrong := [each for each in named if each not in _OF_SUMMARY]:
        return f"{wrong[0]} goes with logs; without any, --store DIR prints what is kept there"
    if form_of(options, FORMATS) == "html":
        return "a page is made of logs; choose another format for a store"
    return form_problem(options, FORMATS)


def name_problem(options: Namespace) -> str | None:
    """The error of a label or robot without a name, which a script with an unset variable gives."""
    for option, name in (("--label", options.label), ("--robot", options.robot)):
        if name is not None and not name.strip():
            return f"{option} is empty; give a name, or leave it out to keep what the store has"
    return None


def opened(options: Namespace, problems: list[str]) -> Keeping | None:
    """The store to keep verdicts in, without what killed writers left; errors are appended to the problems."""
    if options.store is None or problems:
        return None
    if "://" in options.store:
        problems.append(f"{options.store}: expected a folder; keep verdicts in one and upload it, or give --no-store")
        return None
    from btq_lang.evidence.store.engine import NoEngine, imported
    from btq_lang.evidence.store.sets import Keeping, prepare

    try:
        imported()
        prepare(options.store)
    except NoEngine as error:
        problems.append(str(error))
    except (FileExistsError, NotADirectoryError):
        problems.append(f"{shown(options.store)}: expected a folder, found a file")
    except OSError as error:
        problems.append(f"{shown(options.store)}: cannot be written: {error.strerror or error}")
    return Keeping(options.store, options.label, options.label_by, options.robot, options.robot_by)


def summarise(options: Namespace) -> int:
    """Print the verdicts of all runs in a store; returns the exit code."""
    from btq_lang.evidence.store.engine import NoEngine, asked
    from btq_lang.evidence.store.summary import summary

    try:
        if options.engine is None:
            ask = asked(options.store)
        else:
            from btq_lang.evidence.store.engine import asked_by

            ask = asked_by(options.engine, options.store)
        report = summary(ask, options.store, tuple(dict.fromkeys(options.by)))
    except NoEngine as error:
        raise Refused(error) from error
    return print_report(options, report, ())


def _given(options: Namespace, names: Sequence[str]) -> list[str]:
    """Those of some options that the command line has."""
    return [each for each in names if getattr(options, each.strip("-").replace("-", "_"))]


NO_STORE: Final = (
    "no store given; name one, which btq verify LOG … --store DIR makes, or set `store` in [evidence] of btq.toml"
)
_OF_LOGS: Final = ("--mission", "--signals", "--events")
_OF_SUMMARY: Final = ("--by", "--engine")
_OF_KEEPING: Final = ("--label", "--label-by", "--robot", "--robot-by")

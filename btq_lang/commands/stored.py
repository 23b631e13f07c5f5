"""The store of `btq verify`: verdicts are kept there, and those of all runs in it are printed."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Final

from btq_lang.commands.output import form_of, form_problem
from btq_lang.commands.verdict_report import print_report
from btq_lang.commands.verify_options import FORMATS, VerifyOptions, given_options
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import Refused
from btq_lang.util.record import replace
from btq_lang.workspace.loader import find_project, shown

if TYPE_CHECKING:
    from btq_lang.evidence.meanings import Meanings
    from btq_lang.evidence.store.sets import Keeping
    from btq_lang.workspace.config import Project


def store_of_project() -> str | None:
    """As of `store_of`, for this folder's project."""
    return store_of(find_project(".").project)


def store_of(project: Project) -> str | None:
    """The folder that a project names as its store, or what an engine knows, such as `s3://fleet/evidence`."""
    store = project.evidence.store if project.evidence is not None else None
    return store if store is None or "://" in store else shown(os.path.join(project.root, store))


def with_store(options: VerifyOptions) -> VerifyOptions:
    """The options with the project's store, if the command line names none."""
    if options.store is not None or options.no_store:
        return options
    return replace(options, store=store_of_project())


def reads_store(options: VerifyOptions) -> bool:
    """Whether the verdicts of a store are printed, and no log is read.

    Args:
        options: those of the command line, without the project's store.
    """
    if options.logs:
        return False
    if options.store is not None or given_options(options, _OF_SUMMARY):
        return with_store(options).store is not None
    evidence = find_project(".").project.evidence
    return evidence is not None and evidence.store is not None and not (options.no_store or evidence.logs)


def store_problem(options: VerifyOptions, is_summary: bool) -> str | None:
    """The usage error of a command line about a store.

    Args:
        is_summary: the result of `reads_store`.
    """
    if problem := name_problem(options):
        return problem
    given_names = given_options(options, (*_OF_LOGS, *_OF_KEEPING, *_OF_SUMMARY))
    if options.store is None:
        misplaced = [name for name in given_names if name not in _OF_LOGS]
        where = "a store; leave out --no-store" if options.no_store else "--store DIR"
        return f"{misplaced[0]} goes with {where}" if misplaced else None
    if not is_summary:
        misplaced = [name for name in given_names if name in _OF_SUMMARY]
        return f"{misplaced[0]} goes with --store DIR and no log" if misplaced else None
    if misplaced := [name for name in given_names if name not in _OF_SUMMARY]:
        return f"{misplaced[0]} goes with logs; without any, --store DIR prints what is kept there"
    if form_of(options.format, options.output, FORMATS) == "html":
        return "a page is made of logs; choose another format for a store"
    return form_problem(options.format, options.output, FORMATS)


def name_problem(options: VerifyOptions) -> str | None:
    """The error of a label or robot without a name, which a script with an unset variable gives."""
    for option, name in (("--label", options.label), ("--robot", options.robot)):
        if name is not None and not name.strip():
            return f"{option} is empty; give a name, or leave it out to keep what the store has"
    return None


def opened(options: VerifyOptions, problems: list[str]) -> Keeping | None:
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


def summarise(options: VerifyOptions, store: str, messages: CommandOutput) -> int:
    """Print the verdicts of all runs in a store; returns the exit code."""
    from btq_lang.evidence.store.engine import NoEngine, asked
    from btq_lang.evidence.store.summary import summary

    try:
        if options.engine is None:
            ask = asked(store)
        else:
            from btq_lang.evidence.store.engine import asked_by

            ask = asked_by(options.engine, store)
        report = summary(ask, store, tuple(dict.fromkeys(options.by)), meanings=meanings_here())
    except NoEngine as error:
        raise Refused(error) from error
    return print_report(options, report, (), messages)


def meanings_here() -> Meanings:
    """What the requirements of this folder's project mean; a mission that cannot be read is left out."""
    from btq_lang.commands.candidates import candidates
    from btq_lang.evidence.meanings import meanings_of

    return meanings_of((mission.name, mission.fingerprints) for mission in candidates((), (), []))


NO_STORE: Final = (
    "no store given; name one, which btq verify LOG … --store DIR makes, or set `store` in [evidence] of btq.toml"
)
_OF_LOGS: Final = ("--mission", "--signals", "--events")
_OF_SUMMARY: Final = ("--by", "--engine")
_OF_KEEPING: Final = ("--label", "--label-by", "--robot", "--robot-by")

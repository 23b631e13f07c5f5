"""`btq check`: find mistakes in files, fix those with safe fixes, report."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from btq_lang.checks import check, check_each
from btq_lang.checks.includes import is_reported_beside
from btq_lang.commands.files import STDIN, Files, Group, no_mission_below, usage_problem, write_stdout
from btq_lang.commands.reporting import FOR_PEOPLE, form_of, report_problem, write_report
from btq_lang.diagnostics.rules import UNREADABLE, Severity
from btq_lang.render import Finding, Report, Trouble
from btq_lang.util.record import replace
from btq_lang.workspace.config import Project, unknown_rule
from btq_lang.workspace.file import SUFFIXES
from btq_lang.workspace.loader import LoadProblem, write_whole
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.commands.options import CheckOptions
    from btq_lang.diagnostics.model import Diagnostic

_ORDER = tuple(Severity)
_FAILS = (Severity.ERROR, Severity.WARNING)
_ROUNDS = 10  # of fixing: a fix may enable another


def run(options: CheckOptions) -> int:
    """Check once, or again and again with `--watch`."""
    if problem := _usage_problem(options):
        print(f"btq check: {problem}", file=sys.stderr)
        return 2
    files = Files()
    code, watched = _check(options, files)
    if options.watch:
        from btq_lang.commands.watch_mode import run_on_changes

        suffixes = (*SUFFIXES, ".xml")
        run_on_changes(lambda: _check(options, files)[1], options.paths, watched, suffixes)
    return code


def _usage_problem(options: CheckOptions) -> str | None:
    if options.watch and STDIN in options.paths:
        return "--watch cannot watch standard input"
    if options.jobs < 0:
        return f"--jobs {options.jobs}: expected a number of processes, or 0 to let btq choose"
    rules = _rules(options.select) + _rules(options.ignore)
    unknown = next(filter(None, map(unknown_rule, rules)), None)
    return usage_problem(options.paths) or unknown or report_problem(options)


def _check(options: CheckOptions, files: Files) -> tuple[int, tuple[str, ...]]:
    """Check once; returns the exit code and the files that another run depends on."""
    groups, problems = files.groups(options.paths, options.stdin_filename, with_xml=True, with_pools=True)
    groups = tuple(replace(group, workspace=_configured(group.workspace, options)) for group in groups)
    mended = 0
    if options.fix:
        groups, mended, trouble = _fix(groups, options, files)
        problems += trouble
        mended = 0 if trouble else mended  # fixes that could not be written do not count
    for problem in problems:
        print(f"btq: {problem}", file=sys.stderr)
    checked = tuple(path for group in groups for path in group.given)
    is_checked = frozenset(checked)
    findings: list[Finding] = []
    for group in groups:
        for path, found in _found(group, options.jobs):
            text = group.workspace.files[path].source
            found = tuple(each for each in found if not is_reported_beside(each, is_checked))
            if path in group.damaged:  # the bytes that cannot be decoded are already reported
                found = tuple(diagnostic for diagnostic in found if diagnostic.rule not in UNREADABLE)
            findings += [Finding(path, text, diagnostic) for diagnostic in found if _is_wanted(diagnostic, options)]
    texts = {path: file.source for group in groups for path, file in group.workspace.files.items()}
    empty = no_mission_below(options.paths, groups, "no .btq file and no BehaviorTree.CPP XML")
    report = Report(tuple(findings), texts, checked, tuple(map(_trouble, problems)), empty)
    is_written = write_report(report, options, mended)
    if empty and form_of(options, os.environ) not in FOR_PEOPLE:  # those have it in their summary
        print(f"btq check: {empty}", file=sys.stderr)
    watched = tuple(
        path for group in groups for path in (*group.workspace.files, *group.absent, group.project_file) if path
    )
    if problems or empty or not is_written:
        return 2, watched
    fails = any(finding.diagnostic.effective_severity in _FAILS for finding in findings)
    return int(fails and not options.exit_zero), watched


def _trouble(problem: LoadProblem) -> Trouble:
    at = problem.position
    return Trouble(problem.path, problem.message, at.line + 1 if at else None, at.column + 1 if at else None)


def _found(group: Group, jobs: int) -> Iterator[tuple[str, tuple[Diagnostic, ...]]]:
    """The diagnostics of each requested file, in order; many files are checked in parallel."""
    if len(group.given) == 1:  # the usual case needs no progress
        yield group.given[0], check(group.workspace, group.given[0])
        return
    from btq_lang.commands.progress import Progress

    with Progress(len(group.given), "checked") as progress:
        workers = jobs or (min(os.cpu_count() or 1, len(group.given) // 100) if len(group.given) >= 200 else 1)
        if workers > 1:
            from btq_lang.commands.parallel import check_all

            results = check_all(group.workspace, group.given, workers)
        else:
            results = check_each(group.workspace, group.given)
        for path, found in zip(group.given, results, strict=True):
            progress.step()
            yield path, found


def _fix(
    groups: tuple[Group, ...], options: CheckOptions, files: Files
) -> tuple[tuple[Group, ...], int, tuple[LoadProblem, ...]]:
    """Apply the safe fixes to the requested files; returns the groups with the new texts, and how many fixes."""
    from btq_lang.workspace.fixes import fixed

    done: list[Group] = []
    trouble: list[LoadProblem] = []
    mended = 0
    for group in groups:
        workspace = group.workspace
        writable = tuple(
            path for path in group.given if path not in group.damaged and group.workspace.files[path].origin is None
        )
        for _ in range(_ROUNDS):
            each = zip(writable, check_each(workspace, writable), strict=True)
            found = {path: tuple(d for d in of_file if _is_wanted(d, options)) for path, of_file in each}
            texts, count = fixed(workspace, found)
            if not count:
                break
            mended += count
            for path, text in texts.items():
                workspace = workspace.with_file(path, text)
        for path in writable:
            text = workspace.files[path].text
            if path == files.stdin:
                write_stdout(text)
            elif text != group.workspace.files[path].text:
                try:
                    write_whole(path, text)
                except OSError as error:
                    trouble.append(LoadProblem(path, f"cannot be written: {error.strerror}"))
                    unchanged = group.workspace.files[path]  # the file on the disk still has its findings
                    workspace = Workspace({**workspace.files, path: unchanged}, workspace.project)
        done.append(replace(group, workspace=workspace))
    return tuple(done), mended, tuple(trouble)


def _configured(workspace: Workspace, options: CheckOptions) -> Workspace:
    """The workspace with the command line's selection of rules on top of the project file's."""
    project: Project = workspace.project
    select, ignore = _rules(options.select), _rules(options.ignore)
    if not select and not ignore:
        return workspace
    return workspace.with_project(replace(project, select=select or project.select, ignore=project.ignore + ignore))


def _rules(given: Iterable[str]) -> tuple[str, ...]:
    return tuple(rule.strip() for words in given for rule in words.split(",") if rule.strip())


def _is_wanted(diagnostic: Diagnostic, options: CheckOptions) -> bool:
    return _ORDER.index(diagnostic.effective_severity) <= _ORDER.index(Severity(options.severity))

"""`btq check`: find mistakes in files, fix those with safe fixes, report."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from btq_lang.checks import check, check_each
from btq_lang.checks.includes import is_reported_beside
from btq_lang.commands.output import FOR_PEOPLE, is_coloured
from btq_lang.commands.reporting import form_of, report_problem, write_report
from btq_lang.diagnostics.rules import UNREADABLE, Severity
from btq_lang.projects.files import STDIN, FileGroup, Files, no_mission_below, usage_problem
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import CheckOptions, Refused, refuse
from btq_lang.render import Finding, Report
from btq_lang.util.record import Record, replace
from btq_lang.util.text import counted
from btq_lang.workspace.config import Project, unknown_rule
from btq_lang.workspace.factories import Factory, merged
from btq_lang.workspace.file import SUFFIXES, XML_SUFFIXES, YAML_SUFFIXES
from btq_lang.workspace.loader import LoadProblem, absolute, shown
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.diagnostics.model import Diagnostic
    from btq_lang.projects.nav2_factory import ParameterFile

_ORDER = tuple(Severity)
_FAILS = (Severity.ERROR, Severity.WARNING)


def run(options: CheckOptions, messages: CommandOutput) -> int:
    """Check once, or again and again with `--watch`."""
    refuse(_usage_problem(options))
    if options.show_settings:
        from btq_lang.commands.show_settings import show_settings

        settings = {
            "select": _rule_names(options.select),
            "ignore": _rule_names(options.ignore),
            "baseline": options.baseline,
        }
        return show_settings(options.paths, settings, messages)
    files = Files()
    code, watched = _check(options, files, messages)
    if options.watch:
        from btq_lang.commands.watch_mode import run_on_changes

        suffixes = (*SUFFIXES, *XML_SUFFIXES)
        run_on_changes(lambda: _check(options, files, messages)[1], options.paths, watched, suffixes)
    return code


def _usage_problem(options: CheckOptions) -> str | None:
    if options.jobs < 0:
        return f"--jobs {options.jobs}: expected a number of processes, or 0 to let btq choose"
    rules = _rule_names(options.select) + _rule_names(options.ignore)
    unknown = next(filter(None, map(unknown_rule, rules)), None)
    return (
        usage_problem(options.paths, options.watch) or unknown or report_problem(options) or _writing_problem(options)
    )


def _writing_problem(options: CheckOptions) -> str | None:
    if options.since and STDIN in options.paths:
        return "--since cannot be used for standard input"
    if options.update_baseline:
        from btq_lang.commands.baseline import update_problem

        return update_problem(options)
    if options.add_ignore is not None:
        from btq_lang.commands.ignoring import ignore_problem

        return ignore_problem(options)
    return None


def _check(options: CheckOptions, files: Files, messages: CommandOutput) -> tuple[int, tuple[str, ...]]:
    """Check once; returns the exit code and the files that another run depends on."""
    others = tuple(path for path in options.paths if _is_other(path))
    refused: tuple[LoadProblem, ...] = ()
    if others:
        from btq_lang.commands.project_files import named_project_files

        files.project_files, refused = named_project_files(others)
    no_trees = {*files.project_files, *(problem.path for problem in refused)}
    trees = [path for path in options.paths if not path.endswith(YAML_SUFFIXES) and absolute(path) not in no_trees]
    named = (*options.nav2_params, *(path for path in options.paths if path.endswith(YAML_SUFFIXES)))
    files.nav2_params = tuple(dict.fromkeys(map(absolute, named)))
    groups, problems = files.groups(trees, options.stdin_filename, with_xml=True, for_checks=True)
    problems += refused
    groups = tuple(replace(group, workspace=_configured(group.workspace, options)) for group in groups)
    empty = no_mission_below(trees, groups, "no .btq file and no BehaviorTree.CPP XML")
    try:
        if options.update_baseline and not _has_baseline((*groups, *files.parameter_files), options):
            raise Refused("no baseline to update; name it with --baseline, or in btq.toml")
        parameter_files = _parameter_files(files, options)
        groups = _groups_to_check(groups, parameter_files, options)
        if options.show_files:
            messages.problems(problems)
            _show_files(groups, parameter_files, files, messages)
            return 2 if problems or (empty and not parameter_files) else 0, ()
        if options.diff:
            messages.problems(problems)
            code = _show_fixes(groups, options, bool(problems), messages)
        else:
            mended = 0
            if options.fix:
                from btq_lang.commands.fixing import fix, write_fixes

                after, mended = fix(groups, lambda diagnostic: _is_wanted(diagnostic, options))
                groups, write_problems = write_fixes(groups, after, files.stdin, messages)
                problems += write_problems
                mended = 0 if write_problems else mended  # fixes that could not be written do not count
            messages.problems(problems)
            why_empty = None if parameter_files else empty
            code = _report(groups, parameter_files, options, files, problems, mended, why_empty, messages)
    except Refused as reason:
        messages.remark(f"btq check: {reason}")
        code = 2
    return code, (*_watched(groups), *files.project_files, *(file.path for file in files.parameter_files))


def _show_files(
    groups: Iterable[FileGroup], parameter_files: Iterable[ParameterFile], files: Files, messages: CommandOutput
) -> None:
    """`--show-files`: print the files that a check would read."""
    missions = (path for group in groups for path in (*group.given, *group.cpp))
    for path in sorted({*missions, *files.project_files, *(file.path for file in parameter_files)}):
        messages.result(shown(path))


def _is_other(path: str) -> bool:
    """Whether a path names a file of another kind; one without a suffix is a mission, such as a stream of a shell."""
    kinds = (*SUFFIXES, *XML_SUFFIXES, *YAML_SUFFIXES)
    return bool(os.path.splitext(path)[1]) and not path.endswith(kinds) and not os.path.isdir(path)


class _Checked(Record):
    """The result of a check.

    Attributes:
        findings: in the order of files and places.
        texts: of the files that findings name, and others.
        paths: the checked files.
    """

    findings: list[Finding]
    texts: Mapping[str, str]
    paths: tuple[str, ...]


def _report(
    groups: tuple[FileGroup, ...],
    parameter_files: tuple[ParameterFile, ...],
    options: CheckOptions,
    files: Files,
    problems: tuple[LoadProblem, ...],
    mended: int,
    empty: str | None,
    messages: CommandOutput,
) -> int:
    """Check, leave out what is in the baseline, and write the report; returns the exit code.

    Args:
        problems: of reading and writing files.
        mended: the number of fixes that were applied.
        empty: why there is nothing to check.
    """
    checked = _checked(groups, parameter_files, options, files)
    findings = checked.findings
    hidden = 0
    if _has_baseline((*groups, *parameter_files), options):
        from btq_lang.commands.baseline import compared

        all_groups = (*groups, *_as_groups(parameter_files))
        findings, hidden, baseline_problems = compared(findings, all_groups, options, messages, is_whole=not problems)
        messages.problems(baseline_problems)
        problems += baseline_problems
    if options.add_ignore is not None:
        return _add_ignores(groups, findings, options, files, messages)
    if options.target is not None:
        from btq_lang.commands.target import together

        findings = together(findings)
    why_empty = empty or (f"nothing has changed since {options.since}" if options.since else None)
    paths = (*checked.paths, *files.project_files)
    report = Report(tuple(findings), checked.texts, paths, problems, why_empty, hidden, options.quiet)
    write_report(report, options, mended, messages)
    if empty and form_of(options, os.environ) not in FOR_PEOPLE:  # those have it in their summary
        messages.remark(f"btq check: {empty}")
    mistakes = [problem for problem in problems if problem.path in files.project_files]
    if len(mistakes) < len(problems) or empty:
        return 2
    fails = mistakes or any(finding.diagnostic.effective_severity in _FAILS for finding in findings)
    return int(bool(fails) and not options.exit_zero)


def _checked(
    groups: tuple[FileGroup, ...], parameter_files: tuple[ParameterFile, ...], options: CheckOptions, files: Files
) -> _Checked:
    """Check missions, project files and parameter files of Nav2."""
    texts = {path: file.source for group in groups for path, file in group.workspace.files.items()}
    findings, paths = _findings(groups, texts, options)
    is_whole = not options.since and options.add_ignore is None
    if is_whole and any(group.project.external for group in groups):
        from btq_lang.commands.project_files import unused_external  # few projects have any

        hints = [hint for hint in unused_external(groups, options.paths) if _is_wanted(hint.diagnostic, options)]
        findings = sorted([*findings, *hints], key=lambda finding: (finding.path, finding.diagnostic.span))
        texts.update((hint.path, hint.text) for hint in hints)
    if parameter_files:
        from btq_lang.projects.nav2_check import nav2_findings

        of_parameters, more_texts = nav2_findings(
            parameter_files, files, paths, lambda project: _selecting(project, options), options.target
        )
        findings += [finding for finding in of_parameters if _is_wanted(finding.diagnostic, options)]
        findings.sort(key=lambda finding: (finding.path, finding.diagnostic.span))
        texts = {**more_texts, **texts}
        paths += tuple(file.path for file in parameter_files)
    return _Checked(findings, texts, paths)


def _as_groups(parameter_files: tuple[ParameterFile, ...]) -> tuple[FileGroup, ...]:
    """Parameter files as groups without any tree: a baseline looks at the paths of groups."""
    return tuple(
        FileGroup(Workspace({}, file.project), (file.path,), (), (), file.project_file) for file in parameter_files
    )


def _parameter_files(files: Files, options: CheckOptions) -> tuple[ParameterFile, ...]:
    """The parameter files of Nav2 to check.

    Raises:
        Refused: it is not known what has changed.
    """
    if not files.parameter_files:
        return ()
    from btq_lang.projects.git import GitTrouble
    from btq_lang.projects.nav2_check import requested

    try:
        return requested(files, options)
    except GitTrouble as reason:
        raise Refused(f"--since: {reason}") from reason


def _groups_to_check(
    groups: tuple[FileGroup, ...], parameter_files: tuple[ParameterFile, ...], options: CheckOptions
) -> tuple[FileGroup, ...]:
    """The groups for the target, with only what has changed.

    Raises:
        Refused: there is nothing to compare with.
    """
    if options.target is not None:
        from btq_lang.commands.target import is_comparable, moving

        if parameter_files and not groups and not options.target.startswith("nav2-"):
            why = "the version of the engine changes no parameter of Nav2; name a distribution, such as nav2-lyrical"
            raise Refused(f"--target {options.target}: {why}")
        groups = moving(groups, options.target)
        if not (is_comparable(groups, options.target) or any(file.distribution for file in parameter_files)):
            what = 'write `nodes = ["nav2-jazzy"]` into btq.toml'
            raise Refused(f"--target needs to know what the trees are for: {what}")
    if options.since:
        from btq_lang.projects.git import GitTrouble
        from btq_lang.projects.since import affected

        try:
            groups = affected(groups, options.since)
        except GitTrouble as reason:
            raise Refused(f"--since: {reason}") from reason
    return groups


def _has_baseline(checked: Iterable[FileGroup | ParameterFile], options: CheckOptions) -> bool:
    return options.baseline is not None or any(each.project.baseline for each in checked)


def _add_ignores(
    groups: tuple[FileGroup, ...],
    findings: list[Finding],
    options: CheckOptions,
    files: Files,
    messages: CommandOutput,
) -> int:
    """`--add-ignore`: write the comments and check again."""
    from btq_lang.commands.ignoring import add_ignores  # as all here only where it is needed

    count, write_problems = add_ignores(groups, findings, options.add_ignore or "")
    messages.problems(write_problems)
    messages.remark(f"Added {counted(count, 'comment')}")
    code, _ = _check(replace(options, add_ignore=None), files, messages)  # --add-ignore watches nothing
    return 2 if write_problems else code


def _findings(
    groups: Iterable[FileGroup], texts: Mapping[str, str], options: CheckOptions
) -> tuple[list[Finding], tuple[str, ...]]:
    """The findings in the requested files, and these files; a file of several factories is checked in each."""
    of_file: dict[str, list[tuple[Factory | None, tuple[Diagnostic, ...]]]] = {}
    groups = tuple(groups)
    for group in groups:
        for path, diagnostics in _diagnostics_of(group, options.jobs):
            if path in group.damaged:  # the bytes that cannot be decoded are already reported
                diagnostics = tuple(diagnostic for diagnostic in diagnostics if diagnostic.rule not in UNREADABLE)
            of_file.setdefault(path, []).append((group.workspace.factory, diagnostics))
    for group in groups:
        for path in group.cpp:  # the same in every factory
            of_file[path] = [(None, check(group.workspace, path))]
    if len(groups) > 1:  # projects and factories
        of_file = {path: of_file[path] for path in sorted(of_file)}
    findings = [
        Finding(path, texts[path], diagnostic)
        for path, by_factory in of_file.items()
        for diagnostic in merged(by_factory)
        if _is_wanted(diagnostic, options) and not is_reported_beside(diagnostic, of_file)
    ]
    return findings, tuple(of_file)


def _watched(groups: Iterable[FileGroup]) -> tuple[str, ...]:
    """The files that another run depends on."""
    return tuple(path for group in groups for path in group.watched)


def _show_fixes(
    groups: tuple[FileGroup, ...], options: CheckOptions, has_problems: bool, messages: CommandOutput
) -> int:
    """`--diff`: print what `--fix` would change; returns the exit code."""
    from btq_lang.commands.fixing import fix, show_fixes

    after, mended = fix(groups, lambda diagnostic: _is_wanted(diagnostic, options))
    is_changed = show_fixes(groups, after, is_coloured(options.color, sys.stdout.isatty()), messages)
    if mended:
        messages.remark(f"Would fix {counted(mended, 'problem')}")
    return 2 if has_problems else int(is_changed and not options.exit_zero)


def _diagnostics_of(group: FileGroup, jobs: int) -> Iterator[tuple[str, tuple[Diagnostic, ...]]]:
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
        for path, diagnostics in zip(group.given, results, strict=True):
            progress.step()
            yield path, diagnostics


def _configured(workspace: Workspace, options: CheckOptions) -> Workspace:
    """The workspace with the command line's selection of rules on top of the project file's."""
    if not options.select and not options.ignore:
        return workspace
    return workspace.with_project(_selecting(workspace.project, options))


def _selecting(project: Project, options: CheckOptions) -> Project:
    select, ignore = _rule_names(options.select), _rule_names(options.ignore)
    return replace(project, select=select or project.select, ignore=project.ignore + ignore)


def _rule_names(options: Iterable[str]) -> tuple[str, ...]:
    return tuple(rule.strip() for words in options for rule in words.split(",") if rule.strip())


def _is_wanted(diagnostic: Diagnostic, options: CheckOptions) -> bool:
    return _ORDER.index(diagnostic.effective_severity) <= _ORDER.index(Severity(options.severity))

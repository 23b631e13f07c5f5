"""`btq check --baseline`: a file of findings that a team knows already, and the new findings.

    {"format": 1, "tool": "btq",
     "findings": [{"path": "missions/lab.btq", "rule": "unknown-node", "fingerprint": "5783b43235c1b533", "count": 2}]}

Invariants: the same findings give the same bytes; paths are relative to the folder of the file.  A finding is known by
its file, its rule and its text (render/fingerprint.py), as often as counted, wherever its line is; if the file is gone,
wherever its text is now.  What cannot be silenced is never known.
"""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, TypeAlias, TypeVar

from btq_lang.diagnostics.rules import UNREADABLE
from btq_lang.render.fingerprint import fingerprint
from btq_lang.workspace.loader import LoadProblem, absolute, read, shown, write_whole

if TYPE_CHECKING:
    from btq_lang.projects.files import FileGroup
    from btq_lang.projects.messages import CommandOutput
    from btq_lang.projects.options import CheckOptions
    from btq_lang.render import Finding

    Known: TypeAlias = Counter[tuple[str, str, str]]  # path, rule, fingerprint
    Key = TypeVar("Key", bound=tuple[str, ...])


def compared(
    findings: Sequence[Finding],
    groups: Iterable[FileGroup],
    options: CheckOptions,
    messages: CommandOutput,
    is_whole: bool,
) -> tuple[list[Finding], int, tuple[LoadProblem, ...]]:
    """The findings that are not in the baseline, which the command line or else the project of their file names; the
    number of the others; and problems with baselines.  With `--update-baseline`, the findings are written first if
    `is_whole`: all files could be read."""
    checked: dict[str, set[str]] = {}
    for group in groups:
        path = absolute(options.baseline) if options.baseline else group.project.baseline
        if path is not None:
            checked.setdefault(path, set()).update((*group.given, *group.cpp))
    problems: list[LoadProblem] = []
    new = [*findings]
    for path, files in checked.items():
        baseline, problem = _read_baseline(path, options.update_baseline)
        if problem is None and options.update_baseline and is_whole:
            mine = Counter(_identity(finding) for finding in findings if _may_be_known(finding, files))
            baseline, problem = _updated_baseline(path, baseline, mine, files, messages)
        if problem is not None:
            problems.append(problem)
        else:
            new = _new_findings(baseline, new, files)
    return new, len(findings) - len(new), tuple(problems)


def update_problem(options: CheckOptions) -> str | None:
    """The usage error of options together with `--update-baseline`."""
    others = {
        "--select": options.select,
        "--ignore": options.ignore,
        "--severity": options.severity != "hint",
        "--since": options.since,
        "--diff": options.diff,
        "--add-ignore": options.add_ignore is not None,
    }
    some = [option for option, is_given in others.items() if is_given]
    return f"--update-baseline needs all findings; leave out {some[0]}" if some else None


def _read_baseline(path: str, may_be_absent: bool) -> tuple[Known, LoadProblem | None]:
    baseline: Known = Counter()
    if not os.path.exists(path):
        message = "does not exist; `btq check --update-baseline` creates it"
        return baseline, None if may_be_absent else LoadProblem(path, message)
    text, problem = read(path)
    try:
        document = json.loads(text or "")
        if document["format"] != 1 or document["tool"] != "btq":
            raise ValueError
        for entry in document["findings"]:
            full_path = absolute(os.path.join(os.path.dirname(path), entry["path"]))
            baseline[full_path, str(entry["rule"]), str(entry["fingerprint"])] += int(entry["count"])
    except (ValueError, TypeError, KeyError, RecursionError):
        return baseline, problem or LoadProblem(path, "this is not a baseline that `btq check --update-baseline` wrote")
    return baseline, None


def _updated_baseline(
    path: str, before: Known, checked: Known, files: set[str], messages: CommandOutput
) -> tuple[Known, LoadProblem | None]:
    """The baseline after an update; files that were not checked keep their findings as long as they exist."""
    others = {key: count for key, count in before.items() if key[0] not in files and os.path.exists(key[0])}
    after = Counter(others) + checked
    added, removed = (after - before).total(), (before - after).total()
    try:
        if added or removed or not os.path.exists(path):
            write_whole(path, _text(after, os.path.dirname(path)))
    except OSError as error:
        return before, LoadProblem(path, f"cannot be written: {error.strerror}")
    messages.remark(f"{shown(path)}: {added} added, {removed} removed, {after.total() - added} kept")
    return after, None


def _text(baseline: Known, folder: str) -> str:
    """The file, with a line for each finding, so that changes of several people can be merged."""
    lines = []
    for (path, rule, text), count in baseline.items():
        relative_path = os.path.relpath(path, folder).replace(os.sep, "/")
        lines.append(json.dumps({"path": relative_path, "rule": rule, "fingerprint": text, "count": count}))
    findings = ",".join(f"\n    {line}" for line in sorted(lines)) + ("\n  " if lines else "")
    return f'{{\n  "format": 1,\n  "tool": "btq",\n  "findings": [{findings}]\n}}\n'


def _new_findings(baseline: Known, findings: Iterable[Finding], files: set[str]) -> list[Finding]:
    """The findings that are not in the baseline, in order; of equal findings the first ones are in it."""
    remaining = baseline.copy()
    new = [
        finding for finding in findings if not (_may_be_known(finding, files) and _take(remaining, _identity(finding)))
    ]
    moved: Counter[tuple[str, str]] = Counter()
    for (path, rule, text), count in remaining.items():
        moved[rule, text] += 0 if os.path.exists(path) else count
    return [finding for finding in new if not (_may_be_known(finding, files) and _take(moved, _identity(finding)[1:]))]


def _take(left: Counter[Key], key: Key) -> bool:
    is_there = left[key] > 0
    left[key] -= is_there
    return is_there


def _identity(finding: Finding) -> tuple[str, str, str]:
    return finding.path, finding.diagnostic.rule, fingerprint(finding)


def _may_be_known(finding: Finding, files: set[str]) -> bool:
    return finding.path in files and finding.diagnostic.rule not in UNREADABLE

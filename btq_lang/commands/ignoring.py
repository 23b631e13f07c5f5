"""`btq check --add-ignore`: a comment for each line with findings, so that a check reports only new ones.

One invariant: a file is written only if a check of it then finds nothing but what no comment can silence.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from itertools import islice
from typing import TypeAlias

from btq_lang.btcpp.marks import is_generated
from btq_lang.btcpp.opening import with_source
from btq_lang.checks import check
from btq_lang.checks.silencing import above_line, at_line_end, before_element, before_tag, line_to_silence
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.projects.files import FileGroup
from btq_lang.projects.options import CheckOptions
from btq_lang.render import Finding
from btq_lang.util.grouping import grouped
from btq_lang.util.text import Edit, apply_edits
from btq_lang.workspace.file import File
from btq_lang.workspace.loader import LoadProblem, write_whole
from btq_lang.workspace.workspace import Workspace

Added: TypeAlias = tuple[Edit, list[Diagnostic]]  # a comment, and what it silences


def add_ignores(
    groups: Iterable[FileGroup], findings: Sequence[Finding], reason: str
) -> tuple[int, tuple[LoadProblem, ...]]:
    """Write comments for the findings into their files; returns their number, and problems of writing."""
    of_file = grouped((finding.path, finding.diagnostic) for finding in findings)
    count = 0
    trouble: list[LoadProblem] = []
    seen: set[str] = set()
    for group in groups:
        for path in group.given:
            diagnostics = of_file.get(path, ())
            if path in seen or not diagnostics or path in group.damaged:
                continue
            seen.add(path)
            file = group.workspace.files[path]
            added = _comments_for(file, diagnostics, reason)
            if not _is_silent(group.workspace, file, added):
                added = [comment for comment in added if _is_silent(group.workspace, file, [comment])]
                if not _is_silent(group.workspace, file, added):
                    continue
            text = apply_edits(file.source, (edit for edit, _ in added))
            try:
                write_whole(path, text)
                count += len(added)
            except OSError as error:
                trouble.append(LoadProblem(path, f"cannot be written: {error.strerror}"))
    return count, tuple(trouble)


def ignore_problem(options: CheckOptions) -> str | None:
    """The usage error of options together with `--add-ignore`."""
    reason = options.add_ignore or ""
    if "\n" in reason or "\r" in reason or "--" in reason or reason.endswith("-"):
        return "the reason of --add-ignore must be one line without `--`, and not end with `-`"
    others = {"--fix": options.fix, "--diff": options.diff, "--watch": options.watch, "-": "-" in options.paths}
    some = [option for option, is_given in others.items() if is_given]
    return f"--add-ignore cannot be used together with {some[0]}" if some else None


def _comments_for(file: File, diagnostics: Iterable[Diagnostic], reason: str) -> list[Added]:
    of_line: dict[int, list[Diagnostic]] = {}
    added: list[Added] = []
    for diagnostic in diagnostics:
        if (line := line_to_silence(file, diagnostic)) is not None:
            of_line.setdefault(line, []).append(diagnostic)
        elif (edit := before_tag(file, diagnostic, reason)) is not None:
            same = [silenced for other, silenced in added if other == edit]
            added += [] if same else [(edit, [diagnostic])]
            for silenced in same:
                silenced.append(diagnostic)
    places = (at_line_end, above_line) if not file.is_foreign else (before_element,)
    for line, silenced_here in of_line.items():
        rules = tuple(dict.fromkeys(diagnostic.rule for diagnostic in silenced_here))
        edits = (edit for place in places if (edit := place(file, line, rules, reason)) is not None)
        added += [(edit, silenced_here) for edit in islice(edits, 1)]
    return added


def _is_silent(workspace: Workspace, file: File, added: Sequence[Added]) -> bool:
    """Whether a check of a file with comments has the same findings, except those that the comments silence."""
    if not added or is_generated(file.source):
        return False
    text = apply_edits(file.source, (edit for edit, _ in added))
    before = Counter(diagnostic.rule for diagnostic in check(workspace, file.path))
    after = Counter(diagnostic.rule for diagnostic in check(with_source(workspace, file.path, text), file.path))
    return after == before - Counter(diagnostic.rule for _, silenced in added for diagnostic in silenced)

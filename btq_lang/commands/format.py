"""`btq format`: lay out files in the standard style."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from btq_lang.commands.output import is_coloured
from btq_lang.formatter import format_text
from btq_lang.projects.files import Files, usage_problem
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import refuse
from btq_lang.render.colour import painter
from btq_lang.util.record import Record
from btq_lang.util.text import LineIndex, counted
from btq_lang.workspace.loader import LoadProblem, shown, write_whole


class FormatCommandOptions(Record):
    """The options of `btq format`."""

    paths: Sequence[str]
    stdin_filename: str | None
    check: bool
    diff: bool
    color: str


def run(options: FormatCommandOptions, messages: CommandOutput) -> int:
    """Format, or with `--check` and `--diff` only report what would change."""
    refuse(usage_problem(options.paths))
    files = Files()
    groups, load_problems = files.groups(options.paths, options.stdin_filename)
    problems = list(load_problems)
    is_dry_run = options.check or options.diff
    changed = count = refused = 0
    for group in groups:
        for path in group.given:
            if group.workspace.files[path].is_foreign:
                why = "this is XML, which `btq format` does not change; `btq import` converts it to .btq"
                problems.append(LoadProblem(path, why))
                continue
            text = group.workspace.files[path].text
            formatted = format_text(text)
            from_stdin = path == files.stdin
            count += 1
            if formatted.refused is not None:
                refused += 1
                line, column = LineIndex(text).position(formatted.refused.span.start)
                place = f"{shown(path)}:{line + 1}:{column + 1}"
                messages.remark(f"{place}: not formatted: {formatted.refused.message}")
            elif path in group.damaged:
                refused += 1  # already reported as a problem; writing it back would lose bytes
            elif formatted.text != text:
                changed += 1
                if options.diff:
                    _show_diff(shown(path), text, formatted.text, options.color, messages)
                elif options.check:
                    messages.result(f"would format {shown(path)}")
                elif not from_stdin:
                    try:
                        write_whole(path, formatted.text)
                    except OSError as error:
                        problems.append(LoadProblem(path, f"cannot be written: {error.strerror}"))
                        changed -= 1
                        refused += 1
            if from_stdin and not is_dry_run and path not in group.damaged:
                messages.add(formatted.text, "document")
    messages.problems(problems)
    messages.remark(_summary(count, changed, refused, is_dry_run))
    if problems:
        return 2
    return int(refused > 0 or (is_dry_run and changed > 0))


def _show_diff(path: str, old: str, new: str, color: str, messages: CommandOutput) -> None:
    from difflib import unified_diff

    paint = painter(is_coloured(color, sys.stdout.isatty()))
    for line in unified_diff(old.splitlines(), new.splitlines(), path, f"{path} (formatted)", lineterm=""):
        messages.result(paint(line[:1], line) if line[:1] in "+-" else line)


def _summary(count: int, changed: int, refused: int, is_dry_run: bool) -> str:
    verb = "would be formatted" if is_dry_run else "formatted"
    parts = [f"{counted(changed, 'file')} {verb}"] if changed else []
    if refused:
        parts.append(f"{counted(refused, 'file')} not formatted")
    if count - changed - refused or not parts:
        parts.append(f"{counted(count - changed - refused, 'file')} unchanged")
    return ", ".join(parts)

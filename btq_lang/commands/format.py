"""`btq format`: lay out files in the standard style."""

from __future__ import annotations

import sys
from argparse import Namespace

from btq_lang.commands.output import is_coloured, tell
from btq_lang.formatter import format_text
from btq_lang.projects.files import Files, usage_problem, write_stdout
from btq_lang.projects.options import refuse
from btq_lang.render.colour import painter
from btq_lang.util.text import LineIndex, counted
from btq_lang.workspace.loader import LoadProblem, shown, write_whole


def run(options: Namespace) -> int:
    """Format, or with `--check` and `--diff` only report what would change."""
    refuse(usage_problem(options.paths))
    files = Files()
    groups, problems = files.groups(options.paths, options.stdin_filename)
    trouble = list(problems)
    is_dry_run = options.check or options.diff
    changed = count = refused = 0
    for group in groups:
        for path in group.given:
            if group.workspace.files[path].is_foreign:
                why = "this is XML, which `btq format` does not change; `btq import` converts it to .btq"
                trouble.append(LoadProblem(path, why))
                continue
            text = group.workspace.files[path].text
            done = format_text(text)
            from_stdin = path == files.stdin
            count += 1
            if done.refused is not None:
                refused += 1
                line, column = LineIndex(text).position(done.refused.span.start)
                place = f"{shown(path)}:{line + 1}:{column + 1}"
                print(f"{place}: not formatted: {done.refused.message}", file=sys.stderr)
            elif path in group.damaged:
                refused += 1  # already reported as trouble; writing it back would lose bytes
            elif done.text != text:
                changed += 1
                if options.diff:
                    _show_diff(shown(path), text, done.text, options)
                elif options.check:
                    print(f"would format {shown(path)}")
                elif not from_stdin:
                    try:
                        write_whole(path, done.text)
                    except OSError as error:
                        trouble.append(LoadProblem(path, f"cannot be written: {error.strerror}"))
                        changed -= 1
                        refused += 1
            if from_stdin and not is_dry_run and path not in group.damaged:
                write_stdout(done.text)
    tell(trouble)
    _sum_up(count, changed, refused, is_dry_run)
    if trouble:
        return 2
    return int(refused > 0 or (is_dry_run and changed > 0))


def _show_diff(path: str, old: str, new: str, options: Namespace) -> None:
    from difflib import unified_diff

    colour = is_coloured(options, sys.stdout.isatty())
    paint = painter(colour)
    for line in unified_diff(old.splitlines(), new.splitlines(), path, f"{path} (formatted)", lineterm=""):
        print(paint(line[:1], line) if line[:1] in "+-" else line)


def _sum_up(count: int, changed: int, refused: int, is_dry_run: bool) -> None:
    verb = "would be formatted" if is_dry_run else "formatted"
    parts = [f"{counted(changed, 'file')} {verb}"] if changed else []
    if refused:
        parts.append(f"{counted(refused, 'file')} not formatted")
    if count - changed - refused or not parts:
        parts.append(f"{counted(count - changed - refused, 'file')} unchanged")
    print(", ".join(parts), file=sys.stderr)

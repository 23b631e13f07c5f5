"""Diagnostics as text: for people at a terminal, for programs, for code hosts and for CI servers.

One invariant: a renderer accepts every report, whatever characters its texts and messages contain and wherever its
spans point; its output is safe for a terminal and well formed for a program.  Lines and columns count from 1, columns
in code points.  Unknown here: which findings to show, where the output goes and what the exit code is.

    report.py       the findings of a run: what each format is given
    full.py, concise.py, json_format.py, junit.py, sarif.py, github.py, gitlab.py   the formats
    frame.py        lines of a file around a span; `colour`, `cells`: styles and columns of a terminal
    fingerprint.py  what identifies a finding in later runs
    summary.py      the findings as counts; `rule_counts`: of each rule
    pages.py        pages from templates; `chart`, a drawing of values; `gfm`, `spreadsheet`: tables in Markdown and CSV
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib import import_module

from btq_lang.diagnostics.model import Place, relocated
from btq_lang.render.report import Finding as Finding
from btq_lang.render.report import Report as Report
from btq_lang.util.record import replace

FORMATS = ("full", "concise", "json", "sarif", "github", "gitlab", "junit")
_MODULES = {"json": "json_format"}  # named otherwise


def render(form: str, report: Report, *, colour: bool = False, width: int = 120) -> Iterator[str]:
    """The report in one of FORMATS, in pieces, the last one ending with a newline.

    Args:
        colour: ANSI colours, for `full` and `concise`; other formats have none.
        width: the columns of the terminal, for `full`; longer source lines are cut around the span.

    Raises:
        ValueError: there is no such format.
    """
    # A run imports only the renderer that it uses: importing `json` takes longer than all of `full`.
    if form in ("full", "concise") and not report.findings:
        from btq_lang.render.summary import last_line

        return iter((last_line(report),))
    if form not in FORMATS:
        raise ValueError(f"unknown format {form!r}; expected one of {', '.join(FORMATS)}")
    options: dict[str, dict[str, object]] = {"full": {"colour": colour, "width": width}, "concise": {"colour": colour}}
    pieces: Iterator[str] = import_module(f"{__name__}.{_MODULES.get(form, form)}").render(
        report, **options.get(form, {})
    )
    return pieces


def with_paths(report: Report, shown: Callable[[str], str]) -> Report:
    """The report with every path as `shown` writes it: people read relative paths."""

    def place(old: Place) -> Place:
        return old if old.path is None else replace(old, path=shown(old.path))

    return Report(
        tuple(
            Finding(shown(old.path), old.text, relocated(old.diagnostic, old.diagnostic.span, place))
            for old in report.findings
        ),
        {shown(path): text for path, text in report.texts.items()},
        tuple(map(shown, report.checked)),
        tuple(replace(trouble, path=shown(trouble.path)) for trouble in report.troubles),
        report.why_empty,
        report.known,
        report.is_quiet,
    )

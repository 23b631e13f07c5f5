"""What holds for every renderer, every text and every span."""

from __future__ import annotations

import json
import subprocess
import sys
import unicodedata
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, Related, Tag
from btq_lang.diagnostics.rules import RULES
from btq_lang.render import FORMATS, Finding, Report, render, sarif
from btq_lang.render.cells import cut, laid_out, printable
from btq_lang.render.colour import wants_colour
from btq_lang.util.text import Span

# Every code point, also those that no file holds (surrogates, controls); often those that renderers trip over.
TEXTS = st.text(st.characters(codec=None) | st.sampled_from('\n\r\t"&<%:,\x1b\u202e\u0301日🤖'), max_size=60)
SPANS = st.builds(Span, st.integers(-3, 70), st.integers(-3, 70))
PATHS = st.sampled_from(["a.btq", "b.btq", "lost.btq"]) | TEXTS
PLACES = st.builds(Place, SPANS, st.none() | PATHS)
DIAGNOSTICS = st.builds(
    Diagnostic,
    st.sampled_from(sorted(RULES)),
    SPANS,
    TEXTS,
    st.lists(st.builds(Related, PLACES, TEXTS), max_size=2).map(tuple),
    st.lists(TEXTS, max_size=2).map(tuple),
    st.lists(
        st.builds(Fix, TEXTS, st.lists(st.builds(FixEdit, PLACES, TEXTS), max_size=3).map(tuple), st.booleans()),
        max_size=2,
    ).map(tuple),
    st.lists(st.sampled_from(tuple(Tag)), max_size=1).map(tuple),
)
REPORTS = st.builds(
    Report,
    st.lists(st.builds(Finding, PATHS, TEXTS, DIAGNOSTICS), max_size=3).map(tuple),
    st.dictionaries(PATHS, TEXTS, max_size=2),
    st.lists(PATHS, max_size=2).map(tuple),
)


def rendered(form: str, report: Report, **options: int) -> str:
    if form == "sarif":
        return "".join(sarif.render(report, page=str))
    return "".join(render(form, report, **options))  # type: ignore[arg-type]  # colour and width


@given(REPORTS, st.integers(1, 60), st.booleans())
def test_terminals_get_lines_that_command_nothing(report: Report, width: int, colour: bool) -> None:
    for form in ("full", "concise", "github"):
        shown = rendered(form, report, width=width, colour=colour)
        for style in range(10):  # our own colours
            shown = shown.replace(f"\x1b[1;3{style}m", "").replace(f"\x1b[3{style}m", "")
        shown = shown.replace("\x1b[1m", "").replace("\x1b[0m", "")
        categories = {unicodedata.category(character) for character in shown.replace("\n", "")}
        assert not categories & {"Cc", "Cs", "Zl", "Zp"}
        assert shown.endswith("\n") or (form == "github" and not report.findings)
        shown.encode("utf-8")


@given(REPORTS)
def test_one_line_a_finding(report: Report) -> None:
    assert rendered("concise", report).count("\n") == len(report.findings) + 1
    assert rendered("github", report).count("\n") == len(report.findings)


@given(REPORTS)
def test_junit_is_well_formed_and_counts_right(report: Report) -> None:
    document = ElementTree.fromstring(rendered("junit", report).encode("utf-8"))
    cases = document.findall("testsuite/testcase")
    assert len(cases) == len({*report.checked, *(finding.path for finding in report.findings)})
    assert document.get("tests") == str(len(cases))
    assert document.get("failures") == str(len(document.findall("testsuite/testcase/failure")))


@given(REPORTS)
def test_json_and_sarif_are_json_with_every_finding(report: Report) -> None:
    assert len(json.loads(rendered("json", report))["diagnostics"]) == len(report.findings)
    run = json.loads(rendered("sarif", report))["runs"][0]
    assert [result["ruleId"] for result in run["results"]] == [finding.diagnostic.rule for finding in report.findings]
    for result in run["results"]:
        assert run["tool"]["driver"]["rules"][result["ruleIndex"]]["id"] == result["ruleId"]


@given(st.text(max_size=30), SPANS)
def test_marks_are_as_wide_as_what_they_mark(text: str, at: Span) -> None:
    """On one line, marks begin and end where the marked cells do; an empty span has one mark."""
    line = "".join(character for character in text if character not in "\r\n")
    start, end = sorted(max(0, min(offset, len(line))) for offset in at)
    shown = rendered("full", Report((Finding("a", line, Diagnostic("unused-tree", Span(start, end), "m")),), {}))
    marks = shown.splitlines()[4].removeprefix("  |")[1:]
    columns = laid_out(line)[1]
    first, last = columns[start], columns[end]
    if first == last and start < end and first:
        first -= 1
    assert marks == " " * first + "^" * max(1, last - first)


@given(TEXTS.map(lambda text: text.replace("\n", "").replace("\r", "")), st.integers(0, 80), st.integers(1, 80))
def test_a_cut_line_takes_no_more_than_its_room(line: str, left: int, room: int) -> None:
    shown = cut(line, left, room)
    assert laid_out(shown)[1][-1] <= room + 2
    if left == 0 and laid_out(line)[1][-1] <= room:
        assert "\t" in line or shown == printable(line)


def test_what_python_prints_stays_as_it_is() -> None:
    assert printable("Grüße, 日本語 👩\u200d🚀 e\u0301 \xa0|") == "Grüße, 日本語 👩\u200d🚀 e\u0301 \xa0|"


@pytest.mark.parametrize(
    ("isatty", "environ", "expected"),
    [
        (True, {}, True),
        (False, {}, False),
        (True, {"NO_COLOR": "1"}, False),
        (True, {"NO_COLOR": ""}, True),
        (False, {"FORCE_COLOR": "1"}, True),
        (False, {"FORCE_COLOR": ""}, False),
        (True, {"FORCE_COLOR": "1", "NO_COLOR": "1"}, False),
        (True, {"TERM": "dumb"}, False),
        (False, {"TERM": "dumb", "FORCE_COLOR": "1"}, True),
    ],
)
def test_when_colour_is_wanted(isatty: bool, environ: dict[str, str], expected: bool) -> None:
    assert wants_colour(isatty, environ) is expected


@pytest.mark.parametrize("form", FORMATS)
def test_a_format_loads_only_what_it_needs(form: str) -> None:
    """Imports dominate the start-up time: a renderer must not import the others, or heavy standard modules."""
    program = (
        "import sys; from btq_lang.render import Report, render\n"
        f"list(render({form!r}, Report((), {{}})))\n"
        "print(*sys.modules)"
    )
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    loaded = set(result.stdout.split())
    module = "json_format" if form == "json" else form
    ours = {"full", "concise", "json_format", "sarif", "github", "gitlab", "junit"}
    # Where nothing was found, the forms for people are one line of summary and need no renderer.
    needed = set() if form in ("full", "concise") else {module}
    assert {name for name in ours if f"btq_lang.render.{name}" in loaded} == needed
    assert ("json" in loaded) == (form in ("json", "sarif", "gitlab"))
    assert not loaded & {"dataclasses", "inspect", "pathlib", "difflib", "unicodedata", "xml", "lxml", "tomllib"}

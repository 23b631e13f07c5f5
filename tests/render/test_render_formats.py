"""The formats that programs read, to the letter or by their structure."""

from __future__ import annotations

import json
from xml.etree import ElementTree

import pytest

from btq_lang import __version__
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, Related, Tag, replace_fix
from btq_lang.diagnostics.rules import RULES, Severity
from btq_lang.render import Finding, Report, render, sarif
from btq_lang.util.text import Position, Span
from btq_lang.workspace.loader import LoadProblem

TEXT = "BehaviorTree main\n    🤖 Rety\n"
RETY = Span(24, 28)
REPORT = Report(
    (
        Finding(
            "my lab.btq",
            TEXT,
            Diagnostic(
                "unknown-node",
                RETY,
                "50% <unknown>",
                related=(Related(Place(Span(0, 3), "skills,1:2.btq"), "models are here"),),
                notes=("a note\nof two lines",),
                fixes=(
                    replace_fix("replace `Rety` by `Retry`", RETY, "Retry", safe=True),
                    Fix("declare it", (FixEdit(Place(Span(7, 7), "skills,1:2.btq"), "Action Rety\n"),)),
                ),
            ),
        ),
        Finding("my lab.btq", TEXT, Diagnostic("unused-tree", Span(0, len(TEXT)), "unused", tags=(Tag.UNNECESSARY,))),
        Finding("/abs/é.btq", "x", Diagnostic("syntax-error", Span(0, 0), "empty")),
        Finding("my lab.btq", TEXT, Diagnostic("classic-placeholder", Span(0, 1), "a & b")),
    ),
    {"skills,1:2.btq": "Action\n"},
    ("my lab.btq", "clean.btq"),
)
EMPTY = Report((), {}, ("clean.btq",))
TROUBLED = Report(
    (Finding("latin.btq", "x", Diagnostic("syntax-error", Span(0, 0), "empty")),),
    {},
    ("latin.btq",),
    (LoadProblem("latin.btq", "this is no UTF-8", Position(1, 17)), LoadProblem("a&b,c.btq", "cannot be read")),
)


def rendered(form: str, report: Report = REPORT) -> str:
    return "".join(render(form, report))


def test_concise() -> None:
    assert (
        rendered("concise")
        == """\
my lab.btq:2:7: warning[unknown-node] 50% <unknown>
my lab.btq:1:1: warning[unused-tree] unused
/abs/é.btq:1:1: error[syntax-error] empty
my lab.btq:1:1: hint[classic-placeholder] a & b
Found 1 error, 2 warnings, 1 hint (1 fixable with --fix)
"""
    )
    assert rendered("concise", EMPTY) == "No problems found in 1 file\n"
    coloured = "".join(render("concise", REPORT, colour=True))
    assert coloured.startswith("my lab.btq:2:7: \x1b[1;33mwarning[unknown-node]\x1b[0m 50%")


def test_github() -> None:
    assert rendered("github").splitlines() == [
        "::warning file=my lab.btq,line=2,endLine=2,col=7,endColumn=11,title=unknown-node::my lab.btq:2:7: "
        "50%25 <unknown>%0Anote: a note%0Aof two lines%0Ahelp: replace `Rety` by `Retry`%0Ahelp: declare it",
        "::warning file=my lab.btq,line=1,endLine=3,title=unused-tree::my lab.btq:1:1: unused",
        "::error file=/abs/é.btq,line=1,endLine=1,col=1,endColumn=1,title=syntax-error::/abs/é.btq:1:1: empty",
        "::notice file=my lab.btq,line=1,endLine=1,col=1,endColumn=2,title=classic-placeholder::my lab.btq:1:1: a & b",
    ]
    assert rendered("github", EMPTY) == ""
    path = Report((Finding("a%,b:c\nd.btq", "", Diagnostic("unused-tree", Span(0, 0), "m\r\n::error::x")),), {})
    assert rendered("github", path) == (
        "::warning file=a%25%2Cb%3Ac␊d.btq,line=1,endLine=1,col=1,endColumn=1,title=unused-tree"
        "::a%25,b:c%0Ad.btq:1:1: m␍%0A::error::x\n"
    )


def test_json() -> None:
    document = json.loads(rendered("json"))
    assert {key: value for key, value in document.items() if key != "diagnostics"} == {
        "format": 1,
        "tool": "btq",
        "version": __version__,
        "summary": {"error": 1, "warning": 2, "info": 0, "hint": 1, "fixable": 1, "files": 2},
    }
    assert document["diagnostics"][0] == {
        "rule": "unknown-node",
        "severity": "warning",
        "message": "50% <unknown>",
        "path": "my lab.btq",
        "range": {"start": {"line": 2, "column": 7}, "end": {"line": 2, "column": 11}},
        "related": [
            {
                "message": "models are here",
                "path": "skills,1:2.btq",
                "range": {"start": {"line": 1, "column": 1}, "end": {"line": 1, "column": 4}},
            }
        ],
        "notes": ["a note\nof two lines"],
        "tags": [],
        "fixes": [
            {
                "title": "replace `Rety` by `Retry`",
                "safe": True,
                "edits": [
                    {
                        "path": "my lab.btq",
                        "range": {"start": {"line": 2, "column": 7}, "end": {"line": 2, "column": 11}},
                        "text": "Retry",
                    }
                ],
            },
            {
                "title": "declare it",
                "safe": False,
                "edits": [
                    {
                        "path": "skills,1:2.btq",
                        "range": {"start": {"line": 2, "column": 1}, "end": {"line": 2, "column": 1}},
                        "text": "Action Rety\n",
                    }
                ],
            },
        ],
    }
    assert document["diagnostics"][1]["tags"] == ["unnecessary"]
    assert [diagnostic["rule"] for diagnostic in document["diagnostics"]] == [
        finding.diagnostic.rule for finding in REPORT.findings
    ]
    assert rendered("json").isascii()
    assert json.loads(rendered("json", EMPTY))["diagnostics"] == []


def test_sarif() -> None:
    """The whole log: rules with their pages, places, related places and fixes."""
    log = json.loads("".join(sarif.render(REPORT, page=lambda rule: f"# {rule}\n")))
    lab = {"uri": "my%20lab.btq", "uriBaseId": "%SRCROOT%"}
    skills = {"uri": "skills%2C1%3A2.btq", "uriBaseId": "%SRCROOT%"}

    def rule(name: str, level: str) -> dict[str, object]:
        return {
            "id": name,
            "shortDescription": {"text": RULES[name].summary},
            "help": {"text": f"# {name}\n", "markdown": f"# {name}\n"},
            "defaultConfiguration": {"level": level},
        }

    def region(*numbers: int) -> dict[str, int]:
        return dict(zip(("startLine", "startColumn", "endLine", "endColumn"), numbers, strict=True))

    assert log == {
        "$schema": "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json",
        "version": "2.1.0",
        "runs": [
            {
                "tool": {
                    "driver": {
                        "name": "btq",
                        "version": __version__,
                        "rules": [
                            rule("syntax-error", "error"),
                            rule("unknown-node", "warning"),
                            rule("classic-placeholder", "note"),
                            rule("unused-tree", "warning"),
                        ],
                    }
                },
                "columnKind": "unicodeCodePoints",
                "results": [
                    {
                        "ruleId": "unknown-node",
                        "ruleIndex": 1,
                        "level": "warning",
                        "message": {"text": "50% <unknown>\nnote: a note\nof two lines"},
                        "locations": [{"physicalLocation": {"artifactLocation": lab, "region": region(2, 7, 2, 11)}}],
                        "relatedLocations": [
                            {
                                "id": 1,
                                "message": {"text": "models are here"},
                                "physicalLocation": {"artifactLocation": skills, "region": region(1, 1, 1, 4)},
                            }
                        ],
                        "fixes": [
                            {
                                "description": {"text": "replace `Rety` by `Retry`"},
                                "artifactChanges": [
                                    {
                                        "artifactLocation": lab,
                                        "replacements": [
                                            {
                                                "deletedRegion": region(2, 7, 2, 11),
                                                "insertedContent": {"text": "Retry"},
                                            }
                                        ],
                                    }
                                ],
                            },
                            {
                                "description": {"text": "declare it"},
                                "artifactChanges": [
                                    {
                                        "artifactLocation": skills,
                                        "replacements": [
                                            {
                                                "deletedRegion": region(2, 1, 2, 1),
                                                "insertedContent": {"text": "Action Rety\n"},
                                            }
                                        ],
                                    }
                                ],
                            },
                        ],
                    },
                    {
                        "ruleId": "unused-tree",
                        "ruleIndex": 3,
                        "level": "warning",
                        "message": {"text": "unused"},
                        "locations": [{"physicalLocation": {"artifactLocation": lab, "region": region(1, 1, 3, 1)}}],
                    },
                    {
                        "ruleId": "syntax-error",
                        "ruleIndex": 0,
                        "level": "error",
                        "message": {"text": "empty"},
                        "locations": [
                            {
                                "physicalLocation": {
                                    "artifactLocation": {"uri": "file:///abs/%C3%A9.btq"},
                                    "region": region(1, 1, 1, 1),
                                }
                            }
                        ],
                    },
                    {
                        "ruleId": "classic-placeholder",
                        "ruleIndex": 2,
                        "level": "note",
                        "message": {"text": "a & b"},
                        "locations": [{"physicalLocation": {"artifactLocation": lab, "region": region(1, 1, 1, 2)}}],
                    },
                ],
            }
        ],
    }


@pytest.mark.parametrize(
    ("path", "uri"),
    [("C:/lab/a b.btq", "file:///C:/lab/a%20b.btq"), ("/p/\udcff.btq", "file:///p/%FF.btq"), ("../x.btq", "../x.btq")],
)
def test_sarif_writes_paths_as_uris(path: str, uri: str) -> None:
    report = Report((Finding(path, "", Diagnostic("unused-tree", Span(0, 0), "m")),), {})
    log = json.loads("".join(sarif.render(report, page=str)))
    assert log["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"] == uri


def test_sarif_of_nothing() -> None:
    run = json.loads(rendered("sarif", EMPTY))["runs"][0]
    assert (run["results"], run["tool"]["driver"]["rules"]) == ([], [])


def test_junit() -> None:
    assert (
        rendered("junit")
        == """\
<?xml version="1.0" encoding="UTF-8"?>
<testsuites name="btq check" tests="3" failures="2" errors="0">
  <testsuite name="btq check" tests="3" failures="2" errors="0">
    <testcase classname="btq" name="my lab.btq" file="my lab.btq" time="0">
      <failure type="warning" message="2 warnings">my lab.btq:2:7: warning[unknown-node] 50% &lt;unknown&gt;
  a note
  of two lines
my lab.btq:1:1: warning[unused-tree] unused</failure>
      <system-out>my lab.btq:1:1: hint[classic-placeholder] a &amp; b</system-out>
    </testcase>
    <testcase classname="btq" name="clean.btq" file="clean.btq" time="0"/>
    <testcase classname="btq" name="/abs/é.btq" file="/abs/é.btq" time="0">
      <failure type="error" message="1 error">/abs/é.btq:1:1: error[syntax-error] empty</failure>
    </testcase>
  </testsuite>
</testsuites>
"""
    )
    assert ElementTree.fromstring(rendered("junit", EMPTY)).attrib == {
        "name": "btq check",
        "tests": "1",
        "failures": "0",
        "errors": "0",
    }


def test_json_of_a_file_that_could_not_be_read() -> None:
    document = json.loads(rendered("json", TROUBLED))
    assert [(each["rule"], each["path"], each["range"]["start"]) for each in document["diagnostics"]] == [
        ("io-error", "latin.btq", {"line": 2, "column": 18}),
        ("io-error", "a&b,c.btq", {"line": 1, "column": 1}),
        ("syntax-error", "latin.btq", {"line": 1, "column": 1}),
    ]
    assert (document["summary"]["error"], document["diagnostics"][0]["severity"]) == (3, "error")
    assert document["diagnostics"][0].keys() == document["diagnostics"][2].keys()


def test_sarif_of_a_file_that_could_not_be_read() -> None:
    run = json.loads(rendered("sarif", TROUBLED))["runs"][0]
    assert run["invocations"] == [
        {
            "executionSuccessful": False,
            "toolExecutionNotifications": [
                {
                    "level": "error",
                    "message": {"text": "this is no UTF-8"},
                    "locations": [
                        {
                            "physicalLocation": {
                                "artifactLocation": {"uri": "latin.btq", "uriBaseId": "%SRCROOT%"},
                                "region": {"startLine": 2, "startColumn": 18},
                            }
                        }
                    ],
                },
                {
                    "level": "error",
                    "message": {"text": "cannot be read"},
                    "locations": [
                        {
                            "physicalLocation": {
                                "artifactLocation": {"uri": "a%26b%2Cc.btq", "uriBaseId": "%SRCROOT%"},
                            }
                        }
                    ],
                },
            ],
        }
    ]
    assert len(run["results"]) == 1


def test_github_of_a_file_that_could_not_be_read() -> None:
    assert rendered("github", TROUBLED).splitlines()[:2] == [
        "::error file=latin.btq,line=2,col=18,title=io-error::latin.btq:2:18: this is no UTF-8",
        "::error file=a&b%2Cc.btq,title=io-error::a&b,c.btq: cannot be read",
    ]


def test_junit_of_a_file_that_could_not_be_read() -> None:
    assert (
        rendered("junit", TROUBLED)
        == """\
<?xml version="1.0" encoding="UTF-8"?>
<testsuites name="btq check" tests="2" failures="0" errors="2">
  <testsuite name="btq check" tests="2" failures="0" errors="2">
    <testcase classname="btq" name="latin.btq" file="latin.btq" time="0">
      <error type="io-error" message="this is no UTF-8">latin.btq:2:18: this is no UTF-8</error>
      <system-out>latin.btq:1:1: error[syntax-error] empty</system-out>
    </testcase>
    <testcase classname="btq" name="a&amp;b,c.btq" file="a&amp;b,c.btq" time="0">
      <error type="io-error" message="cannot be read">a&amp;b,c.btq: cannot be read</error>
    </testcase>
  </testsuite>
</testsuites>
"""
    )


def test_where_not_all_could_be_read_nothing_is_called_clean() -> None:
    report = Report((), {}, ("latin.btq",), TROUBLED.troubles)
    assert rendered("concise", report) == "Found nothing; incomplete because of latin.btq:2:18: this is no UTF-8\n"
    assert rendered("full", Report((), {}, (), TROUBLED.troubles)) == "No files were checked\n"


def test_a_severity_of_the_project_counts() -> None:
    quiet = Report((Finding("a", "", Diagnostic("syntax-error", Span(0, 0), "m", severity=Severity.INFO)),), {}, ("a",))
    assert rendered("concise", quiet).splitlines() == ["a:1:1: info[syntax-error] m", "Found 1 info message"]
    assert rendered("github", quiet).startswith("::notice ")
    assert '<testsuites name="btq check" tests="1" failures="0" errors="0">' in rendered("junit", quiet)
    assert json.loads(rendered("json", quiet))["diagnostics"][0]["severity"] == "info"

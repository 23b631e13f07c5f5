"""The overview: what is in it, and its formats."""

from __future__ import annotations

import csv
import io
import json
import re
import shutil
from html.parser import HTMLParser
from pathlib import Path

import pytest
from worked_mission import WORKED

from btq_lang.cli import main
from btq_lang.graph.svg import _COLOURS
from btq_lang.projects.opening import open_workspace
from btq_lang.render.cells import laid_out
from btq_lang.trace import FORMATS, write
from btq_lang.trace.collect import collect
from btq_lang.trace.meanings import Meanings
from btq_lang.trace.overview import Clause, Overview
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

ROOT = Path(__file__).resolve().parents[2]

MISSION = """\
quality gentle : safety "Nobody is pushed"
signal speed : m/s from {speed} initially 0 m/s

QualityReq rq1 : performance-efficiency.time-behaviour "In time"
    takes at most 30 s
    on violation fail
    goal 20 s

QualityReq slow(limit : m/s = 1 m/s) : gentle
    keeps speed <= limit

QualityReq trip : reliability
    from Drive succeeds to Dock succeeds takes at most 60 s
    in at least 98 % of runs

QualityReq tidy "Nothing is left behind"
    verified by review

QualityReq forgotten : security
    takes at most 1 s

apply slow(limit = 0.5 m/s) to Dock

Action Drive
Action Dock
Action Wait
Root Main
BehaviorTree Main
    ->
        Drive satisfies rq1, trip
        Dock
        -> Rest
            satisfices usability, performance
            SubTree Pause
        Wait
BehaviorTree Pause
    ->
        Wait
BehaviorTree Bare
    Wait
"""


def overview_of(*texts: str, **more: str) -> Overview:
    files = {f"{number}.btq": text for number, text in enumerate(texts)} | {f"{k}.btq": v for k, v in more.items()}
    return collect([(Workspace.of(files), tuple(files))])


# ---- what is in it --------------------------------------------------------------------------------------------------


def test_requirements_and_what_they_hold_for() -> None:
    overview = overview_of(MISSION)
    names = {node.key: node.name for node in overview.nodes}
    assert [
        (
            each.name,
            each.way,
            each.clauses,
            [(use.subject, [names[key] for key in use.nodes], use.how, use.arguments) for use in each.uses],
        )
        for each in overview.requirements
    ] == [
        (
            "rq1",
            "monitored",
            ("takes at most 30 s", "on violation fail", "goal 20 s"),
            [("Drive", ["Drive"], "satisfies", "")],
        ),
        ("slow", "monitored", ("keeps speed <= limit",), [("Dock", ["Dock"], "apply", "(limit = 0.5 m/s)")]),
        (
            "trip",
            "monitored",
            ("from Drive succeeds to Dock succeeds takes at most 60 s", "in at least 98 % of runs"),
            [
                ("from Drive succeeds to Dock succeeds", ["Drive", "Dock"], "subject", ""),
                ("Drive", ["Drive"], "link", ""),
            ],
        ),
        ("tidy", "not attached", ("verified by review",), []),
        ("forgotten", "not attached", ("takes at most 1 s",), []),
    ]
    assert [str(use.at) for each in overview.requirements for use in each.uses] == [
        *("0.btq:30", "0.btq:22", "0.btq:13", "0.btq:30"),
    ]


def test_qualities_and_what_measures_them() -> None:
    overview = overview_of(MISSION)
    names = {each.key: each.name for each in overview.requirements}
    nodes = {node.key: node.name for node in overview.nodes}
    assert [
        (
            each.name,
            each.characteristic,
            [nodes[key] for key in each.concerns],
            [names[key] for key in each.requirements],
        )
        for each in overview.qualities
    ] == [
        ("gentle", "safety", [], ["slow"]),
        ("usability", "interaction-capability", ["-> Rest"], []),
        ("performance", "performance-efficiency", ["-> Rest"], ["rq1"]),
        ("performance-efficiency.time-behaviour", "performance-efficiency", [], ["rq1"]),
        ("reliability", "reliability", [], ["trip"]),
        ("security", "security", [], ["forgotten"]),
    ]
    assert [each.name for each in overview.unmeasured] == ["usability"]


def test_gaps() -> None:
    overview = overview_of(MISSION)
    assert [each.name for each in overview.unenforced] == ["rq1"]
    assert [each.name for each in overview.unattached] == ["tidy", "forgotten"]
    assert [tree.name for tree in overview.bare_trees] == ["Pause", "Bare"]
    assert [(node.tree, node.name) for node in overview.bare_nodes] == [("Main", "Wait"), ("Bare", "Wait")]
    assert overview.coverage() == {"own": 2, "above": 1, "none": 2}


def test_totals() -> None:
    totals = {each.id: each for each in overview_of(MISSION).totals}
    assert {
        id_: (each.concerns, each.requirements, each.monitored)
        for id_, each in totals.items()
        if any((each.concerns, each.requirements))
    } == {
        "performance-efficiency": (1, 1, 1),
        "interaction-capability": (1, 0, 0),
        "reliability": (0, 1, 1),
        "security": (0, 1, 0),
        "safety": (0, 1, 1),
        "": (0, 1, 0),
    }
    assert len(totals) == 10


def test_the_edition_of_the_project_or_the_file_counts() -> None:
    old = Project(qualities="iso25010-2011")
    workspace = Workspace.of({"a.btq": MISSION}, old)
    assert "portability" in {each.id for each in collect([(workspace, ("a.btq",))]).totals}
    workspace = Workspace.of({"a.btq": f"qualities iso25010-2023\n{MISSION}"}, old)
    overview = collect([(workspace, ("a.btq",))])
    assert overview.edition == "2023"
    assert "flexibility" in {each.id for each in overview.totals}


def test_a_quality_that_is_its_own_part_ends() -> None:
    workspace = Workspace.of({"a.btq": "quality a : b\nquality b : a\nquality c : fuzziness\n"})
    meanings = Meanings(workspace, "a.btq")
    assert [(meanings.of(name).id, meanings.of(name).characteristic) for name in ("a", "c", "d")] == [
        ("a", None),
        ("c", None),
        (None, None),
    ]


def test_what_two_missions_share_is_one_row() -> None:
    shared = "QualityReq rq1 : safety\n    takes at most 1 s\nAction A\nBehaviorTree Shared\n    A satisfies rq1\n"
    one = (
        'include "shared.btq"\nBehaviorTree One\n    ->\n        satisfices safety\n        SubTree Shared\n        A\n'
    )
    two = 'include "shared.btq"\nBehaviorTree Two\n    ->\n        SubTree Shared\n        A\n'
    overview = overview_of(one=one, two=two, shared=shared)
    assert overview.files == ("one.btq", "two.btq")
    assert [each.name for each in overview.requirements] == ["rq1"]
    assert len(overview.requirements[0].uses) == 1
    assert [tree.name for tree in overview.trees] == ["One", "Two", "Shared"]
    assert [(node.tree, node.carries) for node in overview.nodes if node.is_skill] == [
        ("Shared", "own"),
        ("One", "above"),
        ("Two", "none"),
    ]


def test_whoever_knows_more_says_how_clauses_are_held() -> None:
    workspace = Workspace.of({"a.btq": MISSION})
    overview = collect(
        [(workspace, ("a.btq",))],
        lambda _, __, found: [
            [
                Clause(claim.text, "enforced" if each.requirement.action else "monitored")
                for claim in each.requirement.claims
            ]
            for each in found.applied
        ],
    )
    assert [each.way for each in overview.requirements] == [
        *("enforced", "monitored", "monitored", "not attached", "not attached"),
    ]
    notes = [note for box in overview.trees[0].figure.boxes for note in box.notes if note.kind == "requirement"]
    assert [(note.title, note.state) for note in notes] == [
        ("rq1", "enforced"),
        ("trip", "monitored"),
        ("slow(limit = 0.5 m/s)", "monitored"),
        ("trip", "monitored"),
    ]


# ---- formats --------------------------------------------------------------------------------------------------------


def test_csv() -> None:
    text = write(overview_of(MISSION), "csv")
    rows = list(csv.DictReader(io.StringIO(text, newline="")))
    assert text.count("\r\n") == text.count("\n") == len(rows) + 1
    assert [(row["kind"], row["requirement"] or row["quality"], row["holds_for"], row["how"]) for row in rows] == [
        ("requirement", "rq1", "Drive", "monitored"),
        ("requirement", "slow", "Dock(limit = 0.5 m/s)", "monitored"),
        ("requirement", "trip", "from Drive succeeds to Dock succeeds", "monitored"),
        ("requirement", "trip", "Drive", ""),
        ("requirement without node", "tidy", "", ""),
        ("requirement without node", "forgotten", "", ""),
        ("hard requirement not enforced", "rq1", "", ""),
        ("concern", "interaction-capability", "'-> Rest", ""),
        ("quality without requirement", "interaction-capability", "", ""),
        ("concern", "performance-efficiency", "'-> Rest", ""),
        ("node without quality", "", "Wait", ""),
        ("node without quality", "", "Wait", ""),
        ("tree without quality", "", "Pause", ""),
        ("tree without quality", "", "Bare", ""),
    ]
    assert rows[0] == {
        "kind": "requirement",
        "requirement": "rq1",
        "title": "In time",
        "quality": "performance-efficiency.time-behaviour",
        "characteristic": "performance-efficiency",
        "holds_for": "Drive",
        "tree": "Main",
        "clause": "takes at most 30 s",
        "how": "monitored",
        "why": "nothing enforces `on violation fail`",
        "attached_by": "satisfies",
        "source": "0.btq",
        "line": "30",
        "defined": "0.btq",
        "defined_line": "4",
        "verdict": "",
        "result": "",
        "build": "",
        **dict.fromkeys(("hazard", "severity", "external", "refines", "mitigates"), ""),
        **{"origin": "", "priority": "", "verified_by": "", "approval": "open", "suspect": "", "approved_by": ""},
        "scenario": "",
    }


def test_a_spreadsheet_finds_no_formula() -> None:
    text = 'QualityReq r "=1+1"\n    takes at most 1 s\nBehaviorTree A\n    Action "@x" satisfies r\n'
    (row,) = csv.DictReader(io.StringIO(write(overview_of(text), "csv"), newline=""))
    assert (row["title"], row["holds_for"]) == ("'=1+1", "'@x")


def test_json() -> None:
    document = json.loads(write(overview_of(MISSION), "json"))
    assert (document["format"], document["quality_model"], document["files"]) == (1, "iso25010-2023", ["0.btq"])
    assert document["requirements"][1]["holds_for"] == [
        {
            "subject": "Dock",
            "nodes": ["n3"],
            "arguments": "(limit = 0.5 m/s)",
            "at": {"path": "0.btq", "line": 22, "column": 7},
            "attached_by": "apply",
            "clauses": [{"text": "keeps speed <= limit", "how": "monitored", "why": ""}],
        }
    ]
    assert document["gaps"] == {
        "hard_requirements_not_enforced": ["r1"],
        "qualities_without_requirements": ["q2"],
        "requirements_without_nodes": ["r4", "r5"],
        "clauses_without_nodes": [],
        "nodes_without_qualities": ["n6", "n9"],
        "trees_without_qualities": ["Pause", "Bare"],
        "hazards_without_requirements": [],
        "requirements_without_verdicts": [],
        "requirements_without_sources": [],
        "scenarios_not_passed": [],
    }
    assert document["skills"] == {"own": 2, "above": 1, "none": 2}
    keys = {row["key"] for part in ("requirements", "qualities", "nodes") for row in document[part]}
    named = {key for row in document["requirements"] for use in row["holds_for"] for key in use["nodes"]}
    named |= {key for row in document["qualities"] for key in (*row["concerns"], *row["requirements"])}
    named |= {key for row in document["trees"] for key in row["nodes"]}
    assert named <= keys


def test_markdown() -> None:
    text = write(overview_of(MISSION.replace("In time", "a|b <i>*c*")), "markdown")
    lines = text.splitlines()
    assert lines[:6] == [
        "## Requirements and qualities",
        "",
        "5 requirements (3 clauses: 3 monitored), 1 of them hard (on violation fail or halt)"
        " and not enforced everywhere, 6 qualities;"
        " of 5 custom leaf nodes, 2 carry a quality or a requirement, 1 only through a node above, 2 not at all.",
        "",
        "| Requirement | Quality | Holds for | How | Defined |",
        "|---|---|---|---|---|",
    ]
    assert lines[6] == (
        "| **rq1**<br>a\\|b &lt;i>\\*c\\*<br>`takes at most 30 s`<br>`on violation fail`<br>`goal 20 s`"
        " | performance-efficiency.time-behaviour | `Drive` (0.btq:30)"
        " | monitored<br>nothing enforces `on violation fail` | 0.btq:4 |"
    )
    assert "* Trees without any quality: `Pause` (0.btq:36), `Bare` (0.btq:39)" in lines
    assert "| Performance efficiency | 1 | 1 | 0 | 1 | 0 |" in lines


@pytest.mark.parametrize("width", [60, 79, 120, 200])
def test_the_table_is_as_wide_as_the_terminal(width: int) -> None:
    text = write(collect([(open_workspace(str(ROOT / "examples")), ())]), "table", width=width)
    assert "Totals" not in text
    for example in ("hospital", "classic", "navigation"):
        workspace = open_workspace(str(ROOT / "examples" / example))
        lines = write(collect([(workspace, tuple(workspace.files))]), "table", width=width).splitlines()
        assert max(laid_out(line)[1][-1] for line in lines) <= width


def test_the_table() -> None:
    text = 'QualityReq rq1 : safety "Slow"\n    takes at most 30 s\nBehaviorTree Main\n    Action Drive satisfies rq1\n'
    assert write(overview_of(text), "table").splitlines()[:7] == [
        "Requirement           Holds for       How",
        "--------------------  --------------  ---------",
        "rq1, 0.btq:1          Drive, 0.btq:4  monitored",
        "  Slow",
        "  takes at most 30 s",
        "  for safety",
        "",
    ]
    coloured = write(overview_of(text), "table", colour=True)
    assert "\x1b[1;36mmonitored\x1b[0m" in coloured
    assert re.sub("\x1b\\[[0-9;]*m", "", coloured) == write(overview_of(text), "table")


def test_nothing_that_is_printed_steers_the_terminal() -> None:
    text = 'QualityReq "r\x1b[31m" "\x07"\n    takes at most 1 s\n'
    text += 'BehaviorTree "\u202e"\n    Action "A\x9b" satisfies "r\x1b[31m"\n'
    assert not re.search("[\x00-\x09\x0b-\x1f\x7f-\x9f\u202e]", write(overview_of(text), "table"))


class Page(HTMLParser):
    """What a page holds: its elements open and close in order; ids and links; what it would fetch."""

    VOID = frozenset({"meta", "input"})

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.ids: list[str] = []
        self.links: list[str] = []
        self.fetched: list[str] = []
        self.text: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = dict(attrs)
        self.ids += [value for key, value in attrs if key == "id" and value]
        self.links += [value for key, value in attrs if key == "href" and value]
        self.fetched += [tag] if "src" in values or tag in ("link", "img", "iframe", "object") else []
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.handle_starttag(tag, attrs)
        if tag not in self.VOID:
            self.handle_endtag(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text.append(data)


@pytest.mark.parametrize("example", sorted(path.name for path in (ROOT / "examples").iterdir() if path.is_dir()))
def test_a_page_is_whole(example: str) -> None:
    workspace = open_workspace(str(ROOT / "examples" / example))
    overview = collect([(workspace, tuple(workspace.files))])
    text = write(overview, "html")
    page = Page(text)
    assert page.open == []
    assert page.fetched == []
    assert not re.search(r"https?://|@import|url\(", text)
    assert len(page.ids) == len(set(page.ids))
    assert {link for link in page.links if link[1:] not in page.ids or not link.startswith("#")} == set()
    assert text == write(collect([(workspace, tuple(workspace.files))]), "html")
    assert text.count("<table") == text.count("<caption")


def test_texts_in_a_page_are_escaped() -> None:
    text = 'QualityReq "<b>&" : "<q>" "</script><i>"\n    takes at most 1 s\n'
    text += 'BehaviorTree "<t>"\n    Action "\'\\"<a>" satisfies "<b>&"\n'
    page = Page(write(overview_of(text), "html"))
    assert page.open == []
    assert "</script><i>" in page.text
    assert not {"b", "i", "q", "t"} & set(re.findall(r"<(\w+)", write(overview_of(text), "html")))


def luminance(colour: str) -> float:
    """Relative luminance, WCAG 2.2."""
    parts = [int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    light, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("column", [2, 3], ids=["light", "dark"])
def test_texts_of_a_picture_can_be_read(column: int) -> None:
    """4.5 for texts, 3 for outlines and lines against the ground (WCAG 2.2, 1.4.3 and 1.4.11)."""
    colours = [(row[0], row[1], row[column]) for row in _COLOURS]
    ground = next(colour for part, _, colour in colours if part == ".ground")
    ink = next(colour for part, _, colour in colours if part == "text")
    assert all(contrast(ink, colour) >= 4.5 for part, what, colour in colours if what == "fill" and "text" not in part)
    assert all(contrast(ground, colour) >= 3 for _, what, colour in colours if what == "stroke")


@pytest.mark.parametrize("at", [0, 1], ids=["light", "dark"])
def test_texts_of_the_page_can_be_read(at: int) -> None:
    style = (ROOT / "btq_lang/render/page.css").read_text(encoding="utf-8")
    colours = dict(re.findall(r"--(\w+): (#\w{6})", style.split("@media screen")[at].split("* {")[0]))
    assert len(colours) == 11
    for name in ("ink", "soft", "accent", "enforced", "monitored", "reviewed", "missing"):
        for ground in ("ground", "raised"):
            assert contrast(colours[name], colours[ground]) >= 4.5, (name, ground)
    assert contrast(colours["ink"], colours["chosen"]) >= 4.5


@pytest.mark.parametrize("form", FORMATS)
def test_deep_trees(form: str) -> None:
    """Of thousands of levels, the innermost with a requirement."""
    depth = 3_000
    lines = [f"{' ' * level}{'Inverter' if level < depth else 'Drive satisfies safe'}" for level in range(1, depth + 1)]
    text = "\n".join(["QualityReq safe : safety", " takes at most 1 s", "BehaviorTree Main", *lines, ""])
    assert "safe" in write(overview_of(text), form)


@pytest.mark.parametrize("form", FORMATS)
@pytest.mark.parametrize("text", ["", "BehaviorTree\n", MISSION[:600], MISSION.replace("takes", "tooks")])
def test_every_file_has_an_overview(text: str, form: str) -> None:
    assert write(overview_of(text), form).endswith("\n")


def test_there_is_no_other_format() -> None:
    with pytest.raises(ValueError, match="expected one of table, csv, json, markdown, html"):
        write(overview_of(MISSION), "pdf")


# ---- the command ----------------------------------------------------------------------------------------------------


def test_the_command(tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "0.btq").write_text(MISSION, encoding="utf-8")
    assert main(["trace", "--format", "json"]) == 0
    out, err = capfd.readouterr()
    assert err == ""
    assert [row["how"] for row in json.loads(out)["requirements"]] == [
        *("enforced", "monitored", "monitored", "not attached", "not attached"),
    ]
    requirements = json.loads(write(overview_of(MISSION), "json"))["requirements"]
    assert [row["holds_for"][0]["nodes"] for row in requirements[:3]] == [
        row["holds_for"][0]["nodes"] for row in json.loads(out)["requirements"][:3]
    ]
    assert main(["trace", "0.btq", "-o", "docs/trace.html"]) == 0
    assert (tmp_path / "docs" / "trace.html").read_text(encoding="utf-8").startswith("<!DOCTYPE html>\n")
    capfd.readouterr()
    assert main(["trace", "0.btq", "-o", "trace.pdf"]) == 2
    assert capfd.readouterr().err.startswith(
        "btq trace: cannot write .pdf; choose one of table, csv, json, markdown, html"
    )
    assert main(["trace", "0.btq"]) == 0
    assert capfd.readouterr().out.startswith("Requirement ")


SHARED = """\
Action Drive
BehaviorTree Shared
    Drive
"""
INCLUDING = """\
include "shared.btq"
QualityReq rq1 : safety
    takes at most 30 s
    on violation fail
apply rq1 to every Drive
Root Main
BehaviorTree Main
    ->
        SubTree Shared
        Drive
"""


def held(folder: Path, capfd: pytest.CaptureFixture[str], *more: str) -> list[tuple[str, str]]:
    assert main(["trace", str(folder), "--format", "json", *more]) in (0, 1)
    (requirement,) = json.loads(capfd.readouterr().out)["requirements"]
    return [(use["clauses"][0]["how"], use["clauses"][0]["why"]) for use in requirement["holds_for"]]


def test_what_the_build_enforces(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """With --bundle an included file is one mission's alone, so more can be guarded; with errors nothing is built."""
    (tmp_path / "shared.btq").write_text(SHARED)
    (tmp_path / "main.btq").write_text(INCLUDING)
    (shared, shared_why), own = held(tmp_path, capfd)
    assert (shared, own) == ("monitored", ("enforced", ""))
    assert "--bundle" in shared_why
    assert held(tmp_path, capfd, "--bundle") == [("enforced", ""), ("enforced", "")]
    (tmp_path / "main.btq").write_text(INCLUDING + "        Drive satisfies rq9\n")
    assert set(held(tmp_path, capfd)) == {("monitored", "btq build writes nothing for a mission with errors")}


def test_a_hard_requirement_that_is_not_enforced_everywhere_is_a_gap(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "shared.btq").write_text(SHARED)
    (tmp_path / "main.btq").write_text(INCLUDING)
    for more, gap in (((), ["r1"]), (("--bundle",), [])):
        assert main(["trace", str(tmp_path), "--format", "json", *more]) == 0
        assert json.loads(capfd.readouterr().out)["gaps"]["hard_requirements_not_enforced"] == gap
    heading = "Hard requirements that are not enforced everywhere"
    for form in ("table", "markdown", "html"):
        for more, count in (((), 1), (("--bundle",), 0)):
            assert main(["trace", str(tmp_path), "--format", form, *more]) == 0
            assert capfd.readouterr().out.count(heading) == count


def test_it_says_of_each_node_where_they_are_not_held_alike(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "shared.btq").write_text(SHARED)
    (tmp_path / "main.btq").write_text(INCLUDING)
    for form, monitored, enforced in (
        ("markdown", "main.btq:5), by apply, monitored", "main.btq:5), by apply, enforced"),
        ("html", "<small>by apply, monitored</small>", "<small>by apply, enforced</small>"),
    ):
        assert main(["trace", str(tmp_path), "--format", form]) == 0
        out = capfd.readouterr().out
        assert (out.count(monitored), out.count(enforced)) == (1, 1)


CASES = [
    *(f"examples/{name}" for name in ("laboratory", "hospital", "inspection", "navigation", "pick-and-place")),
    "worked",
]


@pytest.mark.parametrize("case", CASES)
def test_the_overview_the_side_file_and_the_xml_say_the_same(
    case: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    source = tmp_path / "source"
    if case == "worked":
        source.mkdir()
        text = WORKED.replace("from {energy_used} counter", "from {energy_used} counter initially 0 Wh")
        text = text.replace("from {base_speed}\n", "from {base_speed} initially 0 m/s\n")
        text = text.replace("from {people_count}\n", "from {people_count} initially 0 person\n")
        (source / "mission.btq").write_text(text, encoding="utf-8")
    else:
        shutil.copytree(ROOT / case, source)
    assert main(["trace", str(source), "--format", "json"]) == 0
    overview = json.loads(capfd.readouterr().out)
    assert main(["build", str(source), "-o", str(tmp_path / "built")]) == 0
    sides = [json.loads(path.read_text(encoding="utf-8")) for path in sorted((tmp_path / "built").rglob("*.qreq.json"))]
    missions = {Path(path).stem for path in overview["files"]}
    said = {
        (each["id"], clause["text"], clause["how"], clause["why"])
        for each in overview["requirements"]
        for use in each["holds_for"]
        for clause in use["clauses"]
        if each["clauses"] not in ([], ["verified by review"])  # what cannot be measured is in the overview alone
    }
    built = {
        (applied["requirement"], clause["clause"], clause["held"], clause.get("why", ""))
        for side in sides
        if Path(side["mission"]["file"]).stem in missions
        for applied in side["applied"]
        for clause in applied.get("clauses", ())
    }
    assert said == built
    xml = "".join(path.read_text(encoding="utf-8") for path in (tmp_path / "built").rglob("*.xml"))
    enforced = {name for name, _, how, _ in said if how == "enforced"}
    assert enforced == set(re.findall(r' _btq="([^"*]+)"', xml))  # `*`: what the mission begins with
    assert enforced


def test_of_missions_with_errors_it_shows_what_it_understands(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    mission = tmp_path / "a.btq"
    mission.write_text("BehaviorTree Main\n    Sequnce\n        Action A satisfies rq9\n", encoding="utf-8")
    assert main(["trace", str(mission), "--format", "markdown"]) == 1
    out, err = capfd.readouterr()
    assert "Custom leaf nodes without any quality: `A`" in out
    assert err == "btq trace: the missions have an error, so the overview may be incomplete; run btq check\n"
    assert main(["trace", str(mission), "--format", "html"]) == 1
    banner = "The missions have an error, so the overview may be incomplete; run btq check."
    assert f'<p class="incomplete" role="alert">{banner}</p>' in capfd.readouterr().out
    mission.write_text("BehaviorTree Main\n    Dock\n", encoding="utf-8")
    assert main(["trace", str(mission), "--format", "html"]) == 0
    assert 'class="incomplete"' not in capfd.readouterr().out
    assert main(["trace", str(tmp_path / "none.btq")]) == 2
    assert main(["trace", ""]) == 2


def test_xml_is_shown_on_its_own_lines(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    mission = tmp_path / "a.xml"
    mission.write_text(
        '<root BTCPP_format="4">\n <BehaviorTree ID="A">\n  <Sequence>\n   <Drive/>\n'
        "  </Sequence>\n </BehaviorTree>\n</root>\n"
    )
    assert main(["trace", str(mission), "--format", "json"]) == 0
    assert [node["at"]["line"] for node in json.loads(capfd.readouterr().out)["nodes"]] == [3, 4]


def test_of_the_published_example_the_overview_the_side_file_and_the_xml_say_the_same(
    shared: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    mission = tmp_path / "mission.qualitybtcpp"
    mission.write_bytes((shared / "original" / "paper_example.qualitybtcpp").read_bytes())
    assert main(["trace", str(mission), "--format", "json"]) == 0
    overview = json.loads(capfd.readouterr().out)
    nodes = {node["key"]: node["at"]["line"] for node in overview["nodes"]}
    assert main(["build", str(mission), "-o", str(tmp_path)]) == 0
    side = json.loads((tmp_path / "mission.qreq.json").read_text(encoding="utf-8"))
    places = {node["uid"]: node["line"] for node in side["nodes"]}
    said = {
        (each["id"], each["title"], tuple(nodes[key] for use in each["holds_for"] for key in use["nodes"]))
        for each in overview["requirements"]
    }
    titles = {each["id"]: " ".join(each["title"].split()) for each in side["requirements"]}
    assert said == {
        (each["requirement"], titles[each["requirement"]], tuple(places[uid] for uid in each["nodes"]))
        for each in side["applied"]
    }
    assert {name for name, _, _ in said} == {"rq1", "rq2", "rq3"}
    xml = (tmp_path / "mission.xml").read_text(encoding="utf-8")
    described = re.findall(r"&#10;(rq\d)[^:]*: ([^\"]*?)\"", xml)
    assert sorted(described) == sorted((name, title) for name, title, _ in said)


LOOSE = """\
signal force : N from {force} initially 0 N
QualityReq r5 : safety "Heat safely"
    Heat takes at most 40 s
    never force >= 50 N
    on violation halt
Action Heat
BehaviorTree Main
    Heat
"""


@pytest.mark.parametrize(
    ("form", "told"),
    [
        (
            "table",
            (
                "  Heat safely                                       not attached\n",
                "`never force >= 50 N` applies to no node\n",
                "Hard requirements that are not enforced everywhere\n  r5, m.btq:2\n",
                "Clauses without a node\n  r5, m.btq:2: never force >= 50 N\n",
                "1 requirement (2 clauses: 1 enforced, 1 without a node), "
                "1 of them hard (on violation fail or halt) and not enforced\neverywhere",
            ),
        ),
        (
            "markdown",
            (
                " | enforced, not attached<br>`never force >= 50 N` applies to no node | ",
                "* Hard requirements that are not enforced everywhere: r5 (m.btq:2)\n",
                "* Clauses without a node: r5 (m.btq:2): `never force >= 50 N`\n",
                "1 requirement (2 clauses: 1 enforced, 1 without a node), "
                "1 of them hard (on violation fail or halt) and not enforced everywhere",
            ),
        ),
        (
            "csv",
            (
                "requirement,r5,Heat safely,safety,safety,Heat,Main,Heat takes at most 40 s,enforced,,subject,",
                "clause without node,r5,Heat safely,safety,safety,,,never force >= 50 N,,,,,,m.btq,2"
                + "," * 12
                + "open,",
                "hard requirement not enforced,r5,",
            ),
        ),
        (
            "html",
            (
                'data-way="enforced, not attached"',
                '<span class="way none">not attached</span> <small><code>never force &gt;= 50 N</code> applies to no',
                "<h3>Clauses without a node (1)</h3>",
                "</small> <code>never force &gt;= 50 N</code></li>",
                "<h3>Hard requirements that are not enforced everywhere (1)</h3>",
                "(2 clauses: 1 enforced, 1 without a node)",
            ),
        ),
    ],
)
def test_enforced_covers_no_clause_about_no_node(
    tmp_path: Path,
    form: str,
    told: tuple[str, ...],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    (tmp_path / "m.btq").write_text(LOOSE, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert main(["trace", "m.btq", "--format", form]) == 0
    text = capsys.readouterr().out.replace("\r\n", "\n")
    assert [part for part in told if part not in text] == []


def test_clauses_about_no_node_as_json(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "m.btq").write_text(LOOSE, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert main(["trace", "m.btq", "--format", "json"]) == 0
    document = json.loads(capsys.readouterr().out)
    (requirement,) = document["requirements"]
    assert requirement["how"] == "enforced, not attached"
    assert requirement["clauses_without_nodes"] == ["never force >= 50 N"]
    assert [use["clauses"] for use in requirement["holds_for"]] == [
        [{"text": "Heat takes at most 40 s", "how": "enforced", "why": ""}]
    ]
    assert document["gaps"]["clauses_without_nodes"] == [{"requirement": "r1", "clause": "never force >= 50 N"}]
    assert document["gaps"]["hard_requirements_not_enforced"] == ["r1"]


def test_what_one_mission_attaches_is_about_a_node() -> None:
    rules = "QualityReq quick\n    Move takes at most 5 s\n    succeeds\nBehaviorTree Go\n    Move\n"
    plain = 'include "rules.btq"\nRoot One\nBehaviorTree One\n    SubTree Go\n'
    attached = (
        'include "rules.btq"\nRoot Two\nBehaviorTree Two\n    ->\n        SubTree Go\n        Rest satisfies quick\n'
    )
    assert [text for _, text in overview_of(rules=rules, one=plain).loose] == ["succeeds"]
    assert overview_of(rules=rules, one=plain, two=attached).loose == ()
    # The engine need not enforce it, so it is not a hard one.
    assert overview_of(rules=rules, one=plain).unenforced == ()


def test_trees_and_the_mission_are_called_what_the_claim_calls_them() -> None:
    claims = "".join(f"    {subject} takes at most 5 s\n" for subject in ("SubTree/Go", "mission", "Go/Move"))
    trees = "BehaviorTree Main\n    ->\n        SubTree Go\n        Rest\nBehaviorTree Go\n    R->\n        Move\n"
    (row,) = overview_of(f"QualityReq quick\n{claims}Root Main\n{trees}").requirements
    assert [use.subject for use in row.uses] == ["Go", "mission", "Move"]

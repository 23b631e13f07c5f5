"""`btq explore -o answers.html`: a page with each answer and its run."""

from __future__ import annotations

import re
from html import unescape
from pathlib import Path

import pytest
from chromium import BROAD, CHROMIUM, keep_screenshots, seen_in
from exploring import Exploring

TREE = """\
<Sequence>
  <Fallback>
    <DetectCup cup="{cup}"/>
    <LookAround/>
  </Fallback>
  <Grasp cup="{cup}"/>
  <Script code="lost := cup &lt; 3"/>
</Sequence>
</BehaviorTree>
<TreeNodesModel>
  <Action ID="DetectCup"><output_port name="cup" type="int"/></Action>
  <Action ID="LookAround"/>
  <Action ID="Grasp"><input_port name="cup" type="int"/></Action>
</TreeNodesModel>
<BehaviorTree ID="Other">
<AlwaysSuccess/>"""
MISSION = """
Action Grasp
Action Wave

QualityReq calm : safety
    Grasp succeeds

QualityReq quick : safety
    mission takes at most 3 s

BehaviorTree Fetch
    ?
        Grasp
        ForceSuccess
            Wave
"""
BEFORE = "Grasp starts before DetectCup succeeds"
LOW = "{cup} < 3 and node Grasp"
ROW = re.compile(r"<tr>(.*?)</tr>", re.DOTALL)
CELL = re.compile(r"<t[hd][^>]*>(.*?)</t[hd]>", re.DOTALL)
HEADS = ["Tick", "Node", "What it does", "Where", "Entries"]


def cells(page: str) -> list[list[str]]:
    """The cells of each row."""
    return [[unescape(cell) for cell in CELL.findall(row)] for row in ROW.findall(page)]


def test_a_yes_has_its_run_and_a_no_its_states(explore: Exploring) -> None:
    explore.tree(TREE)
    questions = ("--tree", "Main", "--never", BEFORE, "--never", "LookAround starts after Grasp starts")
    assert explore(*questions, "-o", "page.html") == (1, "", "")
    page = (explore.folder / "page.html").read_text(encoding="utf-8")
    assert cells(page) == [
        ["Question", "Answer"],
        [f"never {BEFORE}", '<span class="verdict violated">yes, in 1 tick</span>'],
        [
            "never LookAround starts after Grasp starts",
            '<span class="verdict satisfied">no, in all 1 state</span>',
        ],
        HEADS,
        ["1", "DetectCup::3", "fails", "tree.xml:5", ""],
        ["LookAround::4", "succeeds", "tree.xml:6"],
        ["Grasp::5", "succeeds", "tree.xml:8"],
    ]
    assert "<h2>tree.xml: tree Main, BehaviorTree.CPP 4.10</h2>" in page
    shown = explore(*questions, "--show")[1].partition(f"\n\nnever {BEFORE}\n")[2]
    drawing = "\n".join(line[2:] for line in shown.splitlines())
    assert [unescape(text) for text in re.findall(r"<pre>(.*?)</pre>", page, re.DOTALL)] == [drawing]
    assert explore(*questions, "--format", "html") == (1, page, "")
    assert explore(*questions, "--format", "html", "--show") == (1, page, "")


def test_entries_are_shown_and_all_is_escaped(explore: Exploring) -> None:
    explore.tree(TREE, "a<b>&.xml")
    code, page, err = explore("--tree", "Main", "--can", LOW, "--format", "html")
    assert (code, err) == (0, "")
    assert '<th scope="row">can {cup} &lt; 3 and node Grasp</th>' in page
    assert "<code>{cup} &lt;= 2</code>" in page
    assert "<h2>a&lt;b&gt;&amp;.xml: tree Main, BehaviorTree.CPP 4.10</h2>" in page
    assert LOW not in page
    assert "<b>" not in page


def test_a_circle_has_a_table_of_its_own(explore: Exploring) -> None:
    explore.tree('<Repeat num_cycles="-1"><Act/></Repeat>')
    code, page, err = explore("--can", "mission does not end", "--format", "html")
    assert (code, err) == (0, "")
    assert re.findall(r"<caption>(.*?)</caption>", page) == ["Answers", "Tick by tick", "and from here again and again"]
    assert cells(page)[3:] == [
        ["1", "Act::2", "succeeds", "tree.xml:3", ""],
        HEADS,
        ["2", "Act::2", "succeeds", "tree.xml:3", ""],
    ]
    assert '<p class="empty">No scenario says what happens in this run, so it is not drawn.</p>' in page


def test_a_search_that_was_cut_off_is_open(explore: Exploring) -> None:
    explore.tree('<Repeat num_cycles="90"><Sequence><A/><A/></Sequence></Repeat>')
    code, page, err = explore("--never", "mission succeeds", "--states", "10", "--format", "html")
    assert (code, err) == (0, "")
    assert '<span class="verdict unknown">not found in 10 states</span>' in page


def test_clauses_and_standard_answers_are_on_the_page(explore: Exploring) -> None:
    explore.mission(MISSION)
    assert explore("-o", "page.html") == (1, "", "")
    page = (explore.folder / "page.html").read_text(encoding="utf-8")
    assert cells(page) == [
        ["Question", "Answer"],
        ["calm <code>Grasp succeeds</code> can be violated", '<span class="verdict violated">yes, in 1 tick</span>'],
        [
            "cannot-fail",
            '<span class="verdict violated">the mission cannot fail: ForceSuccess::3 never fails'
            "  (mission.btq:14)</span>",
        ],
        [
            "quick <code>mission takes at most 3 s</code>",
            '<span class="verdict open">not asked</span><br><small><code>takes</code> is not explored</small>',
        ],
        HEADS,
        ["1", "Grasp::2", "fails", "mission.btq:13", ""],
    ]
    assert "<p>all 1 state seen</p>" in page


def test_the_name_of_the_file_does_not_change_a_requested_format(explore: Exploring) -> None:
    explore.tree("<Act/>")
    _, out, _ = explore("--can", "mission fails")
    assert explore("--can", "mission fails", "--format", "text", "-o", "page.html") == (0, "", "")
    assert (explore.folder / "page.html").read_text(encoding="utf-8") == out


def test_the_page_needs_no_other_file(explore: Exploring) -> None:
    explore.tree("<Act/>")
    page = explore("--can", "mission fails", "--format", "html")[1]
    assert not re.search(r"<(?:link|img|iframe|script)\b|\bsrc=|https?://|url\(", page)


@pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium: only a browser can tell")
@pytest.mark.parametrize("width", [1400, 390])
def test_the_page_fits_a_screen(width: int, explore: Exploring, tmp_path: Path) -> None:
    explore.tree(TREE)
    page = explore("--tree", "Main", "--never", BEFORE, "--can", LOW, "--format", "html")[1]
    assert seen_in(tmp_path, page, BROAD, width) == 0
    keep_screenshots(tmp_path, "explored", page, width, 1000)

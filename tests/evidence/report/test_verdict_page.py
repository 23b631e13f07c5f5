"""The page of verdicts: one file, with histograms, the run that broke a clause worst, and what nodes did."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
from chromium import BROAD, CHROMIUM, keep_screenshots, seen_in
from evidence_logs import START, Verify, btlog, rows, samples

MISSION = """
Root Main
QualityReq swift : reliability "As <swift> as & can be"
    Drive takes at most 25 ms
    goal 20 ms
QualityReq works : reliability
    mission succeeds
BehaviorTree Main
    -> Errand
        Action Move Drive
        Action Pick Grip
        Action Pick Wave
Action Move
Action Pick
"""
RUNS = "0 1R 2R 30 2S 3R 40 3F 1F 1I 50 1R 2R 70 2S 3R 80 3S 4R 90 4S 1S 1I 100 1R 2R 110 2S 3R 112 3I 1I"


class Tags(HTMLParser):
    """The elements of a page, and the texts in them."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str]]] = []
        self.texts: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, {name: value or "" for name, value in attrs}))

    def handle_data(self, data: str) -> None:
        self.texts.append(data.strip())

    def of(self, tag: str, class_: str) -> list[dict[str, str]]:
        return [each for name, each in self.tags if name == tag and class_ in each.get("class", "").split()]


@pytest.fixture
def page(verify: Verify) -> str:
    """The page of a mission and a log of three runs."""
    (verify.folder / "main.btq").write_text(MISSION, encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(btlog(verify.build(MISSION), rows(RUNS)))
    assert verify.text("run.btlog", "--mission", "main.btq", "-o", "page.html") == ""
    assert (verify.code, verify.errors) == (1, "")
    return (verify.folder / "page.html").read_text(encoding="utf-8")


def test_the_page_needs_no_other_file_and_no_network(page: str) -> None:
    for name, attributes in Tags(page).tags:
        assert name not in ("link", "img", "iframe")
        assert "src" not in attributes
        assert attributes.get("href", "#").startswith("#")
    assert set(re.findall(r"https?://[^\"' ]+", page)) <= {"http://www.w3.org/2000/svg"}
    assert "url(" not in page


def test_the_verdicts_are_said(page: str) -> None:
    tags = Tags(page)
    assert [each["class"] for each in tags.of("span", "verdict")] == ["verdict violated", "verdict violated"]
    assert "1 of 3 activations, worst 30 ms in run 1" in tags.texts
    assert "As <swift> as & can be" in tags.texts
    assert (
        "Drive: took 30 ms, bound 25 ms; its median is 20 ms"
        " (run 1 of run.btlog, 30 ms after its start at 2026-11-20 21:22:20.000 UTC)" in tags.texts
    )


def test_the_histogram_has_bound_and_goal(page: str) -> None:
    tags = Tags(page)
    (histogram,) = tags.of("svg", "histogram")
    # The steps are 64th parts of the bound: from 10 ms on it takes 52 of them to 30 ms, so they were doubled.
    assert histogram["aria-label"] == "3 values from 9.38 ms to 30.5 ms; bound 25 ms, goal 20 ms"
    assert len(tags.of("rect", "bin")) == 3
    assert {"bound 25 ms", "goal 20 ms"} <= {*tags.texts}
    (bound,), (goal,) = tags.of("path", "bound"), tags.of("path", "goal")
    assert (bound["d"], goal["d"]) == ("M219.3 0V92", "M151.1 13V92")


@pytest.mark.parametrize(
    ("bound", "label"),
    [
        ("between 15 ms and 25 ms", "lower bound 15 ms, upper bound 25 ms, goal 20 ms"),
        ("at most 24 ms if hurried else 26 ms", "bound 26 ms, goal 20 ms"),
    ],
)
def test_the_histogram_has_all_bounds_that_do_not_vary(bound: str, label: str, verify: Verify) -> None:
    mission = f"signal hurried : bool from {{hurried}}\n{MISSION.replace('at most 25 ms', bound)}"
    (verify.folder / "main.btq").write_text(mission, encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(btlog(verify.build(mission), rows(RUNS)))
    (verify.folder / "samples.csv").write_text(samples("hurried", {-1: 0}), encoding="utf-8")
    page = verify.text("run.btlog", "--mission", "main.btq", "--signals", "samples.csv", "--format", "html")
    (histogram,) = Tags(page).of("svg", "histogram")
    assert histogram["aria-label"].partition("; ")[2] == label
    assert len(Tags(page).of("path", "bound")) == label.count("bound")


def test_the_run_that_was_worst_is_drawn(page: str) -> None:
    tags = Tags(page)
    assert [each["id"] for each in tags.of("figure", "run")] == ["run-1"]
    assert [(each["class"], each["style"], each["title"]) for each in tags.of("span", "bar")] == [
        ("bar F", "left: 0.000%; width: 100.000%", "failed after 40 ms, 40 ms after the start of the run"),
        ("bar S", "left: 0.000%; width: 75.000%", "succeeded after 30 ms, 30 ms after the start of the run"),
        ("bar F", "left: 75.000%; width: 25.000%", "failed after 10 ms, 40 ms after the start of the run"),
    ]


def axis(page: str) -> list[tuple[str, str, str]]:
    """The numbers of the axis of the first run, each with its class and place."""
    (row,) = re.findall(r"<tfoot>.*?</tfoot>", page)[:1]
    return re.findall(r'<span(?: class="([^"]*)")? style="left: ([^"]*)">([^<]*)', row)


def test_the_axis_has_round_numbers(page: str) -> None:
    assert axis(page) == [
        ("", "0.000%", "0"),
        ("minor", "12.500%", "5 ms"),
        ("", "25.000%", "10 ms"),
        ("minor", "37.500%", "15 ms"),
        ("", "50.000%", "20 ms"),
        ("minor", "62.500%", "25 ms"),
        ("", "75.000%", "30 ms"),
        ("minor", "87.500%", "35 ms"),
        ("end", "100.000%", "40 ms"),
    ]
    assert '<table class="timeline" style="--grid: 12.500%">' in page


def breaches(page: str) -> list[tuple[str, str, str]]:
    """The rows of violations in drawings of runs: requirement, place of the line, and text."""
    rows_ = re.findall(r'<tr class="breach">(.*?)</tr>', page, re.DOTALL)
    parts = (
        re.search(r'">([^<]*)</a>.*class="at" style="left: ([^"]*)".*<p [^>]*>(.*)</p>', row, re.DOTALL)
        for row in rows_
    )
    return [part.groups() for part in parts if part is not None]  # type: ignore[misc]


def test_what_broke_clauses_is_marked_where_it_did(page: str) -> None:
    """Of a duration where it passed its bound."""
    assert breaches(page) == [
        ("works", "100.000%", "failed (40 ms after the start)"),
        ("swift", "62.500%", "bound 25 ms passed (25 ms after the start)"),
    ]
    assert [each["style"] for each in Tags(page).of("span", "at")] == [
        *["left: 100.000%"] * 2,  # in the row of the node and in the row below it
        *["left: 62.500%"] * 2,
    ]


@pytest.mark.parametrize(
    ("claim", "place", "text"),
    [
        ("Drive succeeds within 10 ms", "25.000%", "bound 10 ms passed (10 ms after the start)"),
        ("Drive takes between 35 ms and 50 ms", "75.000%", "took 30 ms, bound 35 ms (30 ms after the start)"),
        (
            "from Drive starts to Grip succeeds takes at most 20 ms",
            *("50.000%", "bound 20 ms passed (20 ms after the start)"),
        ),
        ("Grip starts within 8 ms after Drive starts", "20.000%", "bound 8 ms passed (8 ms after the start)"),
        (
            "sum of Drive, Grip takes at most 20 ms",
            *("100.000%", "took 40 ms together, bound 20 ms (40 ms after the start)"),
        ),
    ],
)
def test_where_other_clauses_are_marked(claim: str, place: str, text: str, verify: Verify) -> None:
    mission = f"QualityReq rq : reliability\n    {claim}\n{MISSION[MISSION.index('BehaviorTree Main') :]}"
    (verify.folder / "main.btq").write_text(mission, encoding="utf-8")
    log = btlog(verify.build(mission), rows("0 1R 2R 30 2S 3R 40 3S 1S"))
    (verify.folder / "run.btlog").write_bytes(log)
    page = verify.text("run.btlog", "--mission", "main.btq", "--format", "html")
    assert (verify.errors, verify.code) == ("", 1)
    assert breaches(page) == [("rq", place, text)]


SIGNALS = """
Root Main
signal battery : % from {level} fresh within 60 ms
signal mode : text from {mode}
signal docked : bool from {docked}
signal unread : m from {unread}
context low : battery < 20 %
QualityReq charged : reliability
    Drive leaves battery >= 15 %
QualityReq driving : safety
    Drive keeps not docked and mode != "<off>"
"""


def test_signals_are_drawn_below_the_run(verify: Verify) -> None:
    mission = SIGNALS + MISSION[MISSION.index("BehaviorTree Main") :]
    (verify.folder / "main.btq").write_text(mission, encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(btlog(verify.build(mission), rows("0 1R 2R 80 2S 3R 100 3S 1S")))
    lines = ["t,battery,mode,docked,unread"]
    for ms, battery, mode, docked in ((-5, 30, "<off>", 0), (20, 10, "<off>", 0), (50, 10, "go", 1), (90, 30, "go", 0)):
        lines.append(f"{(START + ms * 1000) / 1e6:.6f},{battery},{mode},{docked},1")
    (verify.folder / "samples.csv").write_text("\n".join(lines), encoding="utf-8")
    page = verify.text("run.btlog", "--mission", "main.btq", "--signals", "samples.csv", "--format", "html")
    assert (verify.errors, verify.code) == ("", 1)
    tags = Tags(page)
    assert [(each["style"], each["title"]) for each in tags.of("span", "band")] == [
        ("left: 0.000%; width: 50.000%", "false from 0 ms to 50 ms after the start of the run"),
        ("left: 50.000%; width: 40.000%", "true from 50 ms to 90 ms after the start of the run"),
        ("left: 90.000%; width: 10.000%", "false from 90 ms to 100 ms after the start of the run"),
        ("left: 0.000%; width: 50.000%", "<off> from 0 ms to 50 ms after the start of the run"),
        ("left: 50.000%; width: 50.000%", "go from 50 ms to 100 ms after the start of the run"),
    ]
    assert {"false", "true", "<off>", "go", "10 % to 30 %; bound 15 % of charged; bound 20 % of low"} <= {*tags.texts}
    # Its values hold until the next one, 30 % is at 6 of 100 below the top, 10 % at 94.
    assert [each["d"] for each in tags.of("path", "line")] == ["M0 6H200V94H900V6H1000"]
    assert [each["d"] for each in tags.of("path", "bound") if each["d"].startswith("M0")] == [
        "M0 72H1000",
        "M0 50H1000",
    ]
    assert "battery from 30 % to 30 %, between 10 % and 30 %" in [each.get("aria-label") for _, each in tags.tags]
    assert "unread" not in page[page.index('<tbody class="signals">') : page.index("<tfoot>")]


def test_a_signal_has_a_gap_where_its_value_is_unknown(verify: Verify) -> None:
    mission = SIGNALS + MISSION[MISSION.index("BehaviorTree Main") :]
    (verify.folder / "main.btq").write_text(mission, encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(btlog(verify.build(mission), rows("0 1R 2R 180 2S 3R 200 3S 1S")))
    (verify.folder / "samples.csv").write_text(samples("battery", {20: 30, 150: 10}), encoding="utf-8")
    page = verify.text("run.btlog", "--mission", "main.btq", "--signals", "samples.csv", "--format", "html")
    # Fresh until 60 ms after a sample.
    assert [each["d"] for each in Tags(page).of("path", "line")] == ["M100 6H400M750 94H1000"]


def test_many_samples_are_thinned(verify: Verify) -> None:
    """Of each 200th part of the run at most its first, lowest, highest and last sample is left."""
    demands = SIGNALS.replace(" fresh within 60 ms", "").replace("15 %", "60 %")
    mission = demands + MISSION[MISSION.index("BehaviorTree Main") :]
    (verify.folder / "main.btq").write_text(mission, encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(btlog(verify.build(mission), rows("0 1R 2R 180 2S 3R 200 3S 1S")))
    levels = {ms / 100: 50 + ms % 7 - 45 * (ms == 12_345) for ms in range(20_000)}
    (verify.folder / "samples.csv").write_text(samples("battery", levels), encoding="utf-8")
    page = verify.text("run.btlog", "--mission", "main.btq", "--signals", "samples.csv", "--format", "html")
    (line,) = Tags(page).of("path", "line")
    assert len(re.findall(r"[MV]", line["d"])) <= 4 * 200
    assert "V94H" in line["d"]  # the sample of 9 % among thousands
    assert "9 % to 56 %" in "".join(Tags(page).texts)


RUN = "1R 2R {} 2S 3R {} 3F 1F 1I"


@pytest.mark.parametrize(("number", "shown", "folded"), [(3, 3, 0), (10, 10, 0), (25, 10, 15)])
def test_all_runs_that_violate_a_clause_are_listed(number: int, shown: int, folded: int, verify: Verify) -> None:
    (verify.folder / "main.btq").write_text(MISSION, encoding="utf-8")
    runs = " ".join(f"{at} {RUN.format(at + 26 + at // 100, at + 80)}" for at in range(0, number * 100, 100))
    (verify.folder / "run.btlog").write_bytes(btlog(verify.build(MISSION), rows(runs)))
    page = verify.text("run.btlog", "--mission", "main.btq", "--format", "html")
    tables = [each for each in re.findall(r'<table class="violating">.*?</table>', page, re.DOTALL) if "swift" in each]
    rows_ = [
        re.findall(r"<t[hd] (?:scope=\"row\" )?data-of=\"\w+\">(.*?)</t[hd]>", row)
        for table in tables
        for row in re.findall(r"<tr>.*?</tr>", table[table.index("<tbody>") :])
    ]
    assert [table.count("<tr>") - 1 for table in tables] == [shown, *([folded] if folded else [])]
    assert rows_[0] == [
        "1 of run.btlog",
        "26 ms after the start at 2026-11-20 21:22:20.000 UTC",
        "26 ms",
        f"Drive: took 26 ms, bound 25 ms; its median is {26 + (number - 1) // 2} ms",
    ]
    assert rows_[-1][0] == f'<a href="#run-{number}">{number} of run.btlog</a>'  # the worst is drawn
    assert page.count("<summary>15 more violations of swift</summary>") == (folded == 15)


def test_violations_that_odds_allow_are_folded(verify: Verify) -> None:
    mission = MISSION.replace("mission succeeds", "mission succeeds in at least 30 % of runs")
    (verify.folder / "main.btq").write_text(mission, encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(btlog(verify.build(MISSION), rows(RUNS)))
    page = verify.text("run.btlog", "--mission", "main.btq", "--format", "html")
    folded = page[page.index("<details><summary>1 violation of works</summary>") :]
    assert re.findall(r'<th scope="row" data-of="Run">(.*?)</th>', folded) == ["1 of run.btlog"]


def test_the_tree_shows_what_nodes_did(page: str) -> None:
    tags = Tags(page[page.index('<section class="trees"') :])
    assert [each["class"] for each in tags.of("g", "box")] == [
        "box control mixed",
        "box action good",
        "box action mixed",
        "box action good",
    ]
    assert {"3 starts, 1 failed", "p50 40 ms, p95 40 ms", "3 starts", "p50 20 ms, p95 30 ms", "1 start"} <= {
        *tags.texts
    }


def test_a_node_that_did_not_run(verify: Verify) -> None:
    (verify.folder / "main.btq").write_text(MISSION, encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(btlog(verify.build(MISSION), rows("0 1R 2R 30 2F 1F 1I")))
    page = verify.text("run.btlog", "--mission", "main.btq", "--format", "html")
    tags = Tags(page[page.index('<section class="trees"') :])
    assert [each["class"].split()[-1] for each in tags.of("g", "box")] == ["bad", "bad", "idle", "idle"]
    assert tags.texts.count("did not run") == 2


def test_a_long_run_is_drawn_in_part(verify: Verify) -> None:
    mission = MISSION.replace("    -> Errand\n", "    KeepRunningUntilFailure\n     -> Errand\n")
    (verify.folder / "main.btq").write_text(mission, encoding="utf-8")
    times = (f"{at} 2R 3S 4S 5S 2S 2I" for at in range(1, 400))
    (verify.folder / "run.btlog").write_bytes(
        btlog(verify.build(mission), rows(f"0 1R {' '.join(times)} 500 2R 3S 4F 2F 1F"))
    )
    tags = Tags(verify.text("run.btlog", "--mission", "main.btq", "--format", "html"))
    assert len(tags.of("span", "bar")) == 1000
    assert "600 activations more are not drawn." in tags.texts


@pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium: only a browser can tell")
@pytest.mark.parametrize("width", [1400, 390])
def test_the_page_fits_a_screen(width: int, page: str, tmp_path: Path) -> None:
    assert seen_in(tmp_path, page, BROAD, width) == 0
    keep_screenshots(tmp_path, "verdicts", page, width, 2000)


@pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium: only a browser can tell")
def test_bars_and_numbers_are_on_one_axis(page: str, tmp_path: Path) -> None:
    """On a phone every second number is left out, and names are above their bars."""
    script = """
    const box = (selector) => document.querySelector(`#run-1 ${selector}`).getBoundingClientRect();
    const numbers = [...document.querySelectorAll("#run-1 tfoot span")].filter((each) => each.offsetParent);
    const first = box("tbody td"), drive = [...document.querySelectorAll("#run-1 .bar")][1].getBoundingClientRect();
    const passed = [...document.querySelectorAll("#run-1 .at")].at(-1).getBoundingClientRect();
    return {
      numbers: numbers.map((each) => each.textContent),
      share: Math.round((drive.right - drive.left) / first.width * 100),
      passed: Math.round((passed.left + passed.width / 2 - first.left) / first.width * 1000),
      stacked: box("tbody th").bottom <= first.top + 1,
    };"""
    every = [f"{ms} ms" if ms else "0" for ms in range(0, 45, 5)]
    assert seen_in(tmp_path, page, script, 1400) == {"numbers": every, "share": 75, "passed": 625, "stacked": False}
    phone = seen_in(tmp_path, page, script, 390)
    assert (phone["numbers"], phone["share"], phone["stacked"]) == (every[::2], 75, True)


SORT = """
const table = document.querySelector("table.sortable");
const head = (name) => [...table.tHead.rows[0].cells].find((each) => each.textContent === name);
const order = () => [...table.tBodies[0].rows].map((row) => row.cells[0].textContent);
const click = (name) => {
  const button = head(name).querySelector("button");
  button.focus();
  button.click();
  return [document.activeElement === button, head(name).getAttribute("aria-sort"), ...order()];
};
"""


@pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium: only a browser can tell")
def test_the_table_of_nodes_is_sorted_by_the_head_that_is_chosen(page: str, tmp_path: Path) -> None:
    """By a button, so with a keyboard as well; durations by their lengths, nodes without one last."""
    names = ["Errand", "Drive", "Grip", "Wave"]
    folded = page[page.index("<details><summary>What each of 4 nodes did</summary>") :]
    assert re.findall(r'<th scope="row">(\w+)</th>', folded)[:4] == names
    steps = """document.querySelector("table.sortable").closest("details").open = true;
    return { before: head("p95").getAttribute("aria-sort"), down: click("p95"), up: click("p95"), off: click("p95"),
      name: click("node"), other: head("p95").getAttribute("aria-sort") };"""
    assert seen_in(tmp_path, page, SORT + steps, 1400) == {
        "before": "none",
        "down": [True, "descending", "Errand", "Drive", "Grip", "Wave"],
        "up": [True, "ascending", "Grip", "Wave", "Drive", "Errand"],
        "off": [True, "none", *names],
        "name": [True, "ascending", "Drive", "Errand", "Grip", "Wave"],
        "other": "none",
    }

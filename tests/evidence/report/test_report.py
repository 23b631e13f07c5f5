"""`btq report`: the page about a store."""

from __future__ import annotations

import re
import shutil
from html.parser import HTMLParser
from pathlib import Path

import fleet
import pytest
from chromium import BROAD, CHROMIUM, keep_screenshots, seen_in
from evidence_logs import MAIN, MAIN_XML, START, btlog, rows
from in_process import run_btq

from btq_lang.evidence.report.trends import steps_of
from btq_lang.evidence.store import engine
from btq_lang.evidence.store.engine import asked_by
from btq_lang.evidence.store.queries import OVERVIEW

MISSION = 'QualityReq quick : safety "Be <quick>"\n    Move takes at most 15 ms\n' + MAIN
SLOW, QUICK = "1R 2R 20 2S 3R 25 3S 1S 26 2I 3I 1I", "1R 2R 12 2S 3R 25 3S 1S 26 2I 3I 1I"
FAILED = "1R 2R 12 2S 3R 25 3F 1F 26 2I 3I 1I"
HERE = Path(__file__).parent
DOTTED = "a dotted line is where the first run of a label begins"
DAY = 86_400_000_000  # µs


class Page(HTMLParser):
    """What a page says.

    Attributes:
        tables: the texts of the cells of each table, by its caption; the first row has the heads.
        texts: of headings, tiles, paragraphs and summaries outside of tables.
        labels: what drawings are called.
        attributes: of all elements: their tag, name and value.
    """

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tables: dict[str, list[list[str]]] = {}
        self.texts: list[str] = []
        self.labels: list[str] = []
        self.attributes: list[tuple[str, str, str]] = []
        self._caption: str | None = None  # None after a table
        self._is_drawing = False
        self.feed(text.partition("<body>")[2])

    @property
    def text(self) -> str:
        """The texts, a line each, then the tables, a line each row."""
        tables = [[caption, *map(" · ".join, rows)] for caption, rows in self.tables.items()]
        return "\n\n".join(map("\n".join, [self.texts, *tables])) + "\n"

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.attributes += [(tag, name, value or "") for name, value in attrs]
        self.labels += [value or "" for name, value in attrs if name == "aria-label"]
        if tag == "table":
            self._caption = ""
        elif self._caption is None:
            self.texts += [""] if tag in ("h1", "h2", "h3", "p", "li", "summary") else []
        elif tag == "tr":
            self.tables.setdefault(self._caption, []).append([])
        elif tag in ("td", "th"):
            self.tables[self._caption][-1].append("")
        elif tag in ("p", "small", "li") and (row := self.tables[self._caption][-1])[-1]:
            row[-1] = f"{row[-1].rstrip()} | "
        self._is_drawing = self._is_drawing or tag == "svg"

    def handle_endtag(self, tag: str) -> None:
        self._caption = None if tag == "table" else self._caption
        self._is_drawing = self._is_drawing and tag != "svg"

    def handle_data(self, data: str) -> None:
        if self._is_drawing or not data.strip():
            return
        if self._caption is None:
            self.texts[-1] += data
        elif self._caption in self.tables:
            self.tables[self._caption][-1][-1] += data
        else:
            self._caption += data


@pytest.fixture(scope="module")
def robots(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the page about three robots, each with two versions on two days, and its store."""
    folder = tmp_path_factory.mktemp("fleet")
    fleet.write_logs(folder, 3, ["v1.3", "v1.4"], 2, 25)
    for version in ("v1.3", "v1.4"):
        asked = ("--mission", "fetch.btq", "--store", "evidence", "--label", version, "--robot-by", "folder")
        assert run_btq("verify", f"logs/{version}", *asked, cwd=folder)[0] in (0, 1)
    assert run_btq("report", "evidence", "-o", "report.html", cwd=folder) == (1, "", "")
    return folder


def page_of(folder: Path) -> str:
    return (folder / "report.html").read_text(encoding="utf-8")


def test_what_the_page_of_a_fleet_says(robots: Path) -> None:
    """The text beside this file has been counted by hand where a person can, and by SQL below."""
    assert Page(page_of(robots)).text == (HERE / "report_of_three_robots.txt").read_text(encoding="utf-8")


def test_the_page_counts_as_sql_by_hand_does(robots: Path) -> None:
    def asked(question: str) -> list[tuple[str, ...]]:
        import duckdb

        files = re.sub(r"FROM (\w+)", rf"FROM read_parquet('{robots}/evidence/*/\1.parquet')", question)
        return [tuple(map(str, row)) for row in duckdb.execute(files).fetchall()]

    tables = Page(page_of(robots)).tables
    ((runs, failed, retries),) = asked(
        "SELECT COUNT(*), COUNT(*) FILTER (outcome = 'failed'), round(SUM(retries) / COUNT(*), 2) FROM runs"
        " WHERE label = 'v1.4'"
    )
    found = {row[0]: row[2] for row in tables[f"What happened in runs; {DOTTED}"]}
    assert (found["Runs"], found["Failed"].split()[0], found["Retries per run"]) == (runs, failed, retries)
    began = asked("SELECT failure, COUNT(*) FROM runs WHERE label = 'v1.4' AND failure IS NOT NULL GROUP BY ALL")
    caption = "Nodes where failures began, with their share of the failed runs"
    assert {(row[0], row[2].split()[0]) for row in tables[caption][1:]} == {*began}
    violated = asked(
        "SELECT robot, COUNT(*) FILTER (verdict = 'violated'), COUNT(*) FROM verdicts"
        " WHERE label = 'v1.4' AND requirement = 'quick' GROUP BY ALL"
    )
    rows_ = tables["Robots, those with the most violated requirements first"][1:]
    assert {(row[0], *re.findall(r"quick \| (\d+) of (\d+)", row[1])[0]) for row in rows_} == {*violated}


def test_what_is_drawn_of_a_measure_is_what_sql_by_hand_gives(robots: Path) -> None:
    """Of each day the median, the smallest value that half do not exceed, and the largest, for it is bounded above."""
    import duckdb

    asked = (
        f"SELECT strftime(make_timestamp(start_us), '%Y-%m-%d') AS day, quantile_disc(measured_si, 0.5), "
        f"max(measured_si) FROM '{robots}/evidence/*/verdicts.parquet' WHERE requirement = 'quick' AND most_si IS NULL"
        " AND measured_si IS NOT NULL GROUP BY day ORDER BY day"
    )
    days = duckdb.execute(asked).fetchall()
    figure = page_of(robots).partition('<figure><svg class="chart measure"')[2].partition("</figure>")[0]
    assert re.findall("<title>([^<]*: worst [^<]*)</title>", figure) == [
        f"{day}: worst {w:.3g} s" for day, _, w in days
    ]
    middle = [median for _, median, _ in days]
    assert f"<p>the median from {middle[0]:.3g} s to {middle[-1]:.3g} s, between {min(middle):.3g} s" in figure


def test_the_page_needs_nothing_but_itself(robots: Path) -> None:
    text = page_of(robots)
    assert not re.search(r"https?:|<script|<link|<img|@import|url\(", text)
    page = Page(text)
    ids = [value for _, name, value in page.attributes if name == "id"]
    assert len(ids) == len({*ids})
    links = {value for _, name, value in page.attributes if name == "href"}
    assert links == {f"#r1-{number}" for number in range(1, 6)}
    assert links <= {f"#{each}" for each in ids}


def test_the_page_can_be_read_aloud(robots: Path) -> None:
    """Every table has a caption and heads for its columns and rows, every drawing a text."""
    text = page_of(robots)
    assert text.count("<table") == text.count("<caption>") == text.count("<thead>")
    assert text.count("<tr") - text.count("<thead>") == text.count('<th scope="row"')
    assert len(re.findall(r"<th(?! scope=)", text)) == text.count("<thead")
    began = "; v1.3 begins 2026-11-20; v1.4 begins 2026-11-22"
    assert Page(text).labels == [
        f"by day: 0 % from 2026-11-20, 21.9 % from 2026-11-23, at most 21.9 %{began}",
        f"by day: 0 % from 2026-11-20, 1.33 % from 2026-11-23, at most 1.33 %{began}",
        f"by day: 4 % from 2026-11-20, 22.7 % from 2026-11-23, at most 34.7 %{began}",
        f"by day: 2.59 % from 2026-11-20, 2.45 % from 2026-11-23, at most 2.87 %{began}",
        *(f"{change}{began}" for change in re.findall("<p>(the median from [^<]*)", text)),
        f"by day: 75 from 2026-11-20, 75 from 2026-11-23, at most 75{began}",
        f"by day: 4 % from 2026-11-20, 22.7 % from 2026-11-23, at most 34.7 %{began}",
        f"by day: 7.24 from 2026-11-20, 8.83 from 2026-11-23, at most 8.83{began}",
    ]
    assert text.count('<svg class="chart ') == len(Page(text).labels)


@pytest.mark.scheduled
def test_the_same_store_gives_the_same_page(robots: Path) -> None:
    assert run_btq("report", "evidence", cwd=robots) == (1, page_of(robots), "")


@pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium: only a browser can tell")
@pytest.mark.parametrize("width", [1400, 390])
def test_the_page_is_no_wider_than_the_window(width: int, robots: Path, tmp_path: Path) -> None:
    assert seen_in(tmp_path, page_of(robots), BROAD, width) == 0
    keep_screenshots(tmp_path, "report", page_of(robots), width, 4000)


@pytest.mark.scheduled
def test_twins_have_what_their_robot_has(robots: Path, tmp_path: Path) -> None:
    shutil.copytree(robots / "evidence", tmp_path / "evidence")
    fleet.add_twins(tmp_path / "evidence", 2)
    code, text, errors = run_btq("report", "evidence", cwd=tmp_path)
    assert (code, errors) == (1, "")
    table = Page(text).tables["Robots, those with the most violated requirements first"]
    assert [row[0] for row in table[1:]] == ["r003", "r003-2", "r001", "r001-2", "r002", "r002-2"]
    assert [row[1:] for row in table[1::2]] == [row[1:] for row in table[2::2]]


# ---- stores made by hand ----


def keep(folder: Path, number: int, log: str, *options: str, mission: str = "main.btq") -> None:
    """Judge a log of one run, made on a day of its own, and keep its verdicts."""
    path = folder / f"{number}.btlog"
    path.write_bytes(btlog(MAIN_XML, rows(log), START + number * DAY))
    asked = ("--mission", mission, "--store", "kept", *options)
    assert run_btq("verify", path.name, *asked, cwd=folder)[0] == (log == SLOW)


PACED = """\
QualityReq in_time : performance-efficiency "Reach the charger in time"
    Move takes at most 30 s
    goal 20 s
QualityReq paced : reliability
    Pick takes between 2 s and 6 s
"""


def drive(folder: Path, label: str, first: int, number: int) -> None:
    """Keep runs of a label, one a minute, the first of all with this number: each drive takes 4/39 s longer."""
    rows_ = []
    for run in range(first, first + number):
        begin = (run - first) * 60_000_000
        arrived = begin + 21_000_000 + round(run * 4_000_000 / 39)
        end = arrived + 4_000_000 + run % 2 * 1_000_000
        rows_ += [(begin, 1, 1), (begin, 2, 1), (arrived, 2, 2), (arrived, 3, 1), (end, 3, 2), (end, 1, 2)]
        rows_ += [(end + 1000, uid, 0) for uid in (2, 3, 1)]
    log = btlog(MAIN_XML, rows_, START + first * 60_000_000)
    (folder / f"{label}.btlog").write_bytes(log)
    asked = ("verify", f"{label}.btlog", "--mission", "main.btq", "--store", "kept", "--label", label)
    assert run_btq(*asked, cwd=folder)[::2] == (0, "")


def test_a_drift_is_drawn_before_it_violates(tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(PACED + MAIN, encoding="utf-8")
    for label, first, number in (("v1", 0, 20), ("v<2>", 20, 5), ("v3", 25, 15)):
        drive(tmp_path, label, first, number)
    code, text, errors = run_btq("report", "kept", cwd=tmp_path)
    assert (code, errors) == (0, "")
    in_time, paced = re.findall(r"<figure>(.*?)</figure>", text)
    dots = re.findall(r'<circle cx="([\d.]*)" cy="([\d.]*)" r="2.5"><title>(.*?)</title>', in_time)
    levels = re.findall(r'class="(bound|goal)" d="M[\d.]* ([\d.]*)H', in_time)
    assert [title for *_, title in dots] == [
        f"2026-11-20 {21 + (22 + run) // 60}:{(22 + run) % 60:02}: worst {float(f'{21 + run * 4 / 39:.3g}'):g} s"
        for run in range(40)
    ]
    # The axis goes from the goal, 20 s, to the bound, 30 s: 21 s is a tenth above the one, 25 s in the middle.
    (_, top), (_, ground) = levels
    assert [round((float(ground) - float(y)) / (float(ground) - float(top)), 3) for _, y, _ in (dots[0], dots[-1])] == [
        pytest.approx(0.1, abs=1e-3),
        pytest.approx(0.5, abs=1e-3),
    ]
    assert [float(x) for x, *_ in dots] == sorted(float(x) for x, *_ in dots)
    assert re.findall(r'class="tick"[^>]*>(.*?)<', in_time) == ["20 s", "25 s", "30 s"]
    assert re.findall(r"<title>(\S*) begins</title></path><text[^>]*>(.*?)<", in_time) == [
        ("v1", "v1"),
        ("v&lt;2&gt;", "v&lt;2&gt;"),
        ("v3", "v3"),
    ]
    said = Page(text).texts
    assert "the worst of each run from 21 s to 25 s; bound 30 s, goal 20 s" in said
    assert "the worst of each run from 4 s to 5 s; lower bound 2 s, upper bound 6 s" in said
    assert len(re.findall(r'<path class="bound"', paced)) == 2


def test_many_runs_are_drawn_by_step(tmp_path: Path) -> None:
    """More than sixty, of which the worst of a lower bound is the smallest."""
    demands = "QualityReq slow : safety\n    Move takes at least 20 s\n"
    (tmp_path / "main.btq").write_text(demands + MAIN, encoding="utf-8")
    drive(tmp_path, "v1", 0, 70)
    _, page = reported(tmp_path)
    assert "the median from 22.8 s to 26.4 s; the worst of each hour from 21 s to 24.9 s; bound 20 s" in page.texts


@pytest.fixture
def kept(tmp_path: Path) -> Path:
    """A folder with a mission, and a store with a run of it that kept its bound."""
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    keep(tmp_path, 0, QUICK, "--label", "v<1>", "--robot", "red")
    return tmp_path


def reported(folder: Path, *options: str) -> tuple[int, Page]:
    code, text, errors = run_btq("report", "kept", *options, cwd=folder)
    assert errors == ""
    return code, Page(text)


def test_one_label_has_nothing_to_compare_with(kept: Path) -> None:
    code, page = reported(kept)
    assert code == 0
    assert page.texts[:5] == [
        "What robots did: kept",
        "1 run, 2026-11-20 21:22 UTC, 1 label: v<1>",
        "What got worse",
        "0 violated now of 1 requirement",
        "All runs have the same label, so there is nothing to compare.",
    ]
    assert page.tables[f"Verdicts, and the share of violations; {DOTTED}"] == [
        ["Requirement", "v<1>", "Violations by minute"],
        [
            "quick Be <quick> | Move takes at most 15 ms",
            "satisfied | held so far in 1 activation, worst 12 ms",
            "always 0 %",
        ],
    ]


def test_what_is_newly_violated_is_on_top(kept: Path) -> None:
    for number in range(1, 6):
        keep(kept, number, QUICK, "--label", "v<1>", "--robot", "red")
        keep(kept, number + 5, SLOW, "--label", "v<2>", "--robot", "red")
    code, page = reported(kept, "--by", "label")
    assert code == 1
    assert page.tables["What got worse in main"] == [
        ["Finding", "Of", "Change"],
        ["newly violated", "quick Be <quick>", "was satisfied; violated in 0 of 6 → 5 of 5, p = 0.0087"],
        [
            "slower",
            "Move",
            "mean 12 ms → 20 ms (+8 ms, +66.7 %; 95 % interval +8 ms to +8 ms) over 6 and 5 runs, p = 0.0087 | and"
            " in requirement quick",
        ],
    ]
    assert page.texts[2:8] == [
        "What got worse from v<1> to v<2>",
        "1 newly violated",
        "0 less reliable",
        "1 slower",
        "1 violated now of 1 requirement",
        "main: 6 runs of v<1> (2026-11-20 21:22–2026-11-25 21:22 UTC),"
        " 5 runs of v<2> (2026-11-26 21:22–2026-11-30 21:22 UTC), durations compared by runs",
    ]
    assert "Robots with v<2>" not in page.texts


def test_what_chance_may_explain_is_no_loss(kept: Path) -> None:
    keep(kept, 1, SLOW, "--label", "v<2>", "--robot", "red")
    code, page = reported(kept, "--by", "label")
    assert code == 0
    assert "What got worse in main" not in page.tables
    assert page.tables["What differs most where chance may explain it in main"] == [
        ["Finding", "Of", "Change"],
        ["newly violated", "quick Be <quick>", "was satisfied; violated in 0 of 1 → 1 of 1, p = 1"],
    ]
    assert page.texts[2:8] == [
        "What got worse from v<1> to v<2>",
        "0 newly violated",
        "0 less reliable",
        "– slower: not testable with 1 run",
        "1 violated now of 1 requirement",
        "main: 1 run of v<1> (2026-11-20 21:22 UTC), 1 run of v<2> (2026-11-21 21:22 UTC), durations compared by runs",
    ]


def test_all_runs_by_robot(kept: Path) -> None:
    keep(kept, 1, FAILED, "--label", "v<2>", "--robot", "blue")
    code, page = reported(kept, "--by", "robot")
    assert code == 0
    assert page.tables["Robots, those with the most violated requirements first"] == [
        ["Robot", "Violated", "Runs", "Failed", "Retries per run", "Recoveries per run"],
        ["blue", "nothing", "1", "1 of 1, 100 %", "0", "0"],
        ["red", "nothing", "1", "0 of 1, 0 %", "0", "0"],
    ]
    assert page.tables["Nodes where failures began, with their share of the failed runs"] == [
        ["Node", "All runs"],
        ["Pick", "1 of 1, 100 %"],
    ]
    assert page.tables["What was exercised"][1] == ["Nodes", "3 of 3"]


def test_labels_of_different_missions(kept: Path) -> None:
    (kept / "other.btq").write_text(MISSION, encoding="utf-8")
    keep(kept, 1, SLOW, mission="other.btq")
    code, page = reported(kept)
    assert code == 0
    assert page.texts[1:5] == [
        "2 runs, 2026-11-20 21:22–2026-11-21 21:22 UTC, 2 labels: v<1>, (none)",
        "What got worse from v<1> to (none)",
        "1 violated now of 2 requirements",
        "No mission was run with both v<1> and (none).",
    ]
    assert [text for text in page.texts if text.startswith("Mission")] == ["Mission main", "Mission other"]


def test_earlier_labels_have_no_column(kept: Path) -> None:
    for number in range(1, 6):
        keep(kept, number, QUICK, "--label", f"w{number}")
    _, page = reported(kept)
    assert page.texts[1].endswith("6 labels: 2 others, w2, w3, w4, w5")
    assert page.tables["What was exercised"] == [
        ["What", "w2", "w3", "w4", "w5"],
        ["Nodes", *["3 of 3"] * 4],
        ["Requirements", *["1 of 1"] * 4],
    ]
    assert "2 earlier labels not shown here; btq verify --store DIR --by label shows all." in page.texts


def test_the_store_of_the_project(kept: Path) -> None:
    (kept / "btq.toml").write_text('[evidence]\nstore = "kept"\n', encoding="utf-8")
    code, output, errors = run_btq("report", cwd=kept)
    assert (code, errors, Page(output).texts[0]) == (0, "", "What robots did: kept")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            (),
            "no store given; name one, which btq verify LOG … --store DIR makes,"
            " or set `store` in [evidence] of btq.toml",
        ),
        (("gone",), "gone: no verdicts are kept there; keep some with btq verify LOG --store gone"),
        (("kept", "-o", "x.md"), "x.md is not the name of a page; choose one that ends in .html"),
    ],
)
def test_what_cannot_be_reported(arguments: tuple[str, ...], message: str, kept: Path) -> None:
    assert run_btq("report", *arguments, cwd=kept) == (2, "", f"btq report: {message}\n")
    assert not (kept / "x.md").exists()


@pytest.mark.parametrize(
    ("length", "name", "number"),
    [
        (0, "minute", 1),
        (39 * 60, "minute", 40),
        (41 * 60, "hour", 2),
        (6 * 86_400, "day", 7),
        (41 * 86_400, "week", 7),
        (400 * 86_400, "2 weeks", 30),
    ],
)
def test_steps_are_as_short_as_their_number_allows(length: int, name: str, number: int) -> None:
    steps = steps_of(START, START + length * 1_000_000)
    assert (steps.name, steps.number) == (name, number)
    assert steps.begin(0) <= START < steps.begin(1)
    assert steps.begin(number - 1) <= START + length * 1_000_000 < steps.begin(number)


@pytest.mark.scheduled
def test_a_second_engine_says_the_same(robots: Path, polars: str) -> None:
    store = str(robots / "evidence")
    words = {"by": "mission, label", "origin": START, "step": DAY, "runs": 60}
    for name, question in OVERVIEW.items():
        one, other = (ask(question.format(**words)) for ask in (engine.asked(store), asked_by(polars, store)))
        assert sorted(map(repr, one)) == sorted(map(repr, other)), name


def test_the_sides_are_named_where_labels_began_at_once(kept: Path) -> None:
    """By their first runs, neither is the earlier one."""
    keep(kept, 1, SLOW, "--label", "after")
    keep(kept, 1, QUICK, "--label", "before")
    _, page = reported(kept)
    assert "Both labels began at the same time; --sides A B sets their order." in page.texts
    for sides in (("before", "after"), ("after", "before")):
        _, output, _ = run_btq("report", "kept", "--sides", *sides, cwd=kept)
        assert f"What got worse from {sides[0]} to {sides[1]}" in Page(output).texts
    gone = "btq report: no run has the label gone; there are after, before, v<1>\n"
    assert run_btq("report", "kept", "--sides", "gone", "after", cwd=kept) == (2, "", gone)

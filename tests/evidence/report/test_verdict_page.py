"""The page of verdicts: one file, with histograms, the run that broke a clause worst, and what nodes did."""

from __future__ import annotations

import re
import subprocess
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from chromium import ARTIFACTS, CHROMIUM, FLAGS
from evidence_logs import Verify, btlog, rows

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


def test_the_run_that_was_worst_is_drawn(page: str) -> None:
    tags = Tags(page)
    assert [each["id"] for each in tags.of("figure", "run")] == ["run-1"]
    assert [(each["class"], each["style"], each["title"]) for each in tags.of("span", "bar")] == [
        ("bar F", "left: 0.000%; width: 100.000%", "failed after 40 ms, 40 ms after the start of the run"),
        ("bar S", "left: 0.000%; width: 75.000%", "succeeded after 30 ms, 30 ms after the start of the run"),
        ("bar F", "left: 75.000%; width: 25.000%", "failed after 10 ms, 40 ms after the start of the run"),
    ]


def test_the_tree_shows_what_nodes_did(page: str) -> None:
    tags = Tags(page)
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
    tags = Tags(verify.text("run.btlog", "--mission", "main.btq", "--format", "html"))
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
@pytest.mark.parametrize(("scheme", "size"), [("light", "1500,1600"), ("dark", "1200,1600"), ("light", "500,1600")])
def test_the_page_fits_a_screen(scheme: str, size: str, page: str, tmp_path: Path) -> None:
    width = size.partition(",")[0]
    measure = "document.body.dataset.broad = document.documentElement.scrollWidth - innerWidth"
    source = tmp_path / "seen.html"
    source.write_text(page.replace("</body>", f"<script>{measure}</script></body>"), encoding="utf-8")
    ARTIFACTS.mkdir(exist_ok=True)
    target = ARTIFACTS / f"verdicts-{scheme}-{width}.png"
    shown = ("--blink-settings=preferredColorScheme=0",) if scheme == "dark" else ()

    def run(*more: str) -> Any:
        command = (CHROMIUM, *FLAGS, f"--user-data-dir={tmp_path / 'profile'}", f"--window-size={size}", *shown, *more)
        return subprocess.run(
            [str(each) for each in (*command, source.as_uri())], capture_output=True, text=True, check=True, timeout=120
        ).stdout

    assert 'data-broad="0"' in run("--dump-dom")
    run(f"--screenshot={target}")
    assert target.read_bytes().startswith(b"\x89PNG")

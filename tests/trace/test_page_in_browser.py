"""The page and the pictures in a real browser: what fits, what overlaps, and what a click highlights.

Chromium alone, without a driver: a script that is put into a copy of the page acts as a person does, measures, and
writes what it saw into the page, which `--dump-dom` prints.  Screenshots are kept in tests/artifacts.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable
from html import unescape
from pathlib import Path
from typing import Any

import pytest
from chromium import ARTIFACTS, BROAD, CHROMIUM, chromium, keep_screenshots, seen_in
from missions import mission

from btq_lang.graph import DIRECTIONS, draw
from btq_lang.graph.missions import figures
from btq_lang.projects.opening import open_workspace
from btq_lang.trace import write
from btq_lang.trace.collect import collect
from btq_lang.trace.missions import built_ways
from btq_lang.trace.overview import Overview
from btq_lang.workspace.workspace import Workspace

ROOT = Path(__file__).resolve().parents[2]

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium: only a browser can tell")

# Every text inside its outline, and no two outlines over each other.
MEASURE = """
const over = [], outside = [];
for (const svg of document.querySelectorAll("svg")) {
  const groups = [...svg.querySelectorAll("g.box, g.note")];
  const frames = groups.map((group) => group.querySelector(".outline").getBoundingClientRect());
  groups.forEach((group, at) => {
    const frame = frames[at];
    for (const text of group.querySelectorAll("text")) {
      const box = text.getBoundingClientRect();
      if (box.x < frame.x || box.y < frame.y || box.x + box.width > frame.x + frame.width
          || box.y + box.height > frame.y + frame.height + 1) outside.push(text.textContent);
    }
    frames.slice(0, at).forEach((other) => {
      if (frame.x < other.x + other.width && other.x < frame.x + frame.width
          && frame.y < other.y + other.height && other.y < frame.y + frame.height) over.push(group.textContent);
    });
  });
}
"""


def overview_of(example: str) -> Overview:
    if example == "200 nodes":
        return collect([(Workspace.of({"big.btq": mission(200, 3, "short")}), ("big.btq",))])
    workspace = open_workspace(str(ROOT / "examples" / example))
    missions = tuple(path for path, file in workspace.files.items() if not file.has_only_scenarios)
    return collect([(workspace, missions)], built_ways, lambda path: os.path.relpath(path, ROOT))


@pytest.fixture
def seen(tmp_path: Path) -> Callable[..., dict[str, Any]]:
    """What a script sees in a page: the object that its last expression gives."""

    def look(page: str, script: str, size: str = "1500,1200") -> dict[str, Any]:
        acting = (
            f"<script>{{ {MEASURE}\n document.body.dataset.seen = JSON.stringify((() => {{ {script} }})()); }}</script>"
        )
        path = tmp_path / "page.html"
        path.write_text(page.replace("</body>", f"{acting}</body>"), encoding="utf-8")
        dom = chromium(tmp_path, f"--window-size={size}", "--dump-dom", path.as_uri())
        found = re.search(r'data-seen="([^"]*)"', dom)
        assert found is not None, dom[-2000:]
        result: dict[str, Any] = json.loads(unescape(found[1]))
        return result

    return look


def keep_screenshot(folder: Path, name: str, page: str, size: str, *more: str) -> None:
    ARTIFACTS.mkdir(exist_ok=True)
    source = folder / f"{name}{'.svg' if page.startswith('<svg') else '.html'}"
    source.write_text(page, encoding="utf-8")
    target = ARTIFACTS / f"{name}.png"
    target.unlink(missing_ok=True)
    chromium(folder, f"--window-size={size}", f"--screenshot={target}", *more, source.as_uri())
    assert target.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    "example",
    [
        "laboratory",
        *(
            pytest.param(each, marks=pytest.mark.scheduled)
            for each in ("hospital", "inspection", "navigation", "classic", "200 nodes")
        ),
    ],
)
def test_in_the_page_nothing_overlaps_and_every_text_fits(
    example: str, seen: Callable[..., dict[str, Any]], tmp_path: Path
) -> None:
    page = write(overview_of(example), "html")
    script = "return { over, outside, boxes: document.querySelectorAll('.trees g.box').length,"
    script += " broad: document.documentElement.scrollWidth - innerWidth };"
    found = seen(page, script)
    assert found == {"over": [], "outside": [], "boxes": len(overview_of(example).nodes), "broad": 0}
    assert seen(page, script, "600,900")["broad"] == 0
    keep_screenshot(tmp_path, f"trace-{example.replace(' ', '-')}", page, "1500,1200")


SCROLLS = """
return [...document.querySelectorAll(".scroll")].map((part) =>
  [part.getAttribute("aria-label"), part.scrollWidth > part.clientWidth]).filter(([, scrolls]) => scrolls);
"""


@pytest.mark.parametrize(("example", "place"), [("pick-and-place", "beside"), ("navigation", "below")])
def test_every_tree_can_be_seen_as_a_whole(example: str, place: str, tmp_path: Path) -> None:
    """One that is too broad for the column beside the tables puts all below them."""
    page = write(overview_of(example), "html")
    assert f'<div class="{place}">' in page
    assert seen_in(tmp_path, page, SCROLLS, 1400) == []


def test_on_a_phone_what_is_broad_scrolls_and_the_page_does_not(tmp_path: Path) -> None:
    page = write(overview_of("navigation"), "html")
    assert seen_in(tmp_path, page, BROAD, 390) == 0
    assert ["Tree NavigateToPose", True] in seen_in(tmp_path, page, SCROLLS, 390)
    keep_screenshots(tmp_path, "trace-navigation", page, 390, 4000)


@pytest.mark.scheduled
@pytest.mark.parametrize("direction", DIRECTIONS)
def test_in_pictures_nothing_overlaps_and_every_text_fits(
    direction: str, seen: Callable[..., dict[str, Any]], tmp_path: Path
) -> None:
    texts = {"big.btq": mission(200, 1, "classic"), "other.btq": '''
QualityReq "充電の要求" : "エネルギー" "時間内に"
    takes at most 30 s
BehaviorTree "木の名前"
    R-> "WWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWW"
        Condition MMMMMMMMMMMMMMMMMMMMMMMMMMMMMMMM @@@@
        Action "ﬁne%%%%%%%%%%%%%%%%%%%%%%%%" satisfies "充電の要求"
        ForceSuccess
            Action "電池を充電する"
'''.replace(" @@@@", ' "@@@@@@@@@@@@@@@@"')}  # fmt: skip
    workspace = Workspace.of(texts)
    for path in texts:
        picture = draw(figures(workspace, path, with_qualities=True), "svg", direction)
        page = f"<!DOCTYPE html><meta charset='utf-8'><body>{picture}</body>"
        assert seen(page, "return { over, outside };") == {"over": [], "outside": []}
        keep_screenshot(tmp_path, f"graph-{path[:-4]}-{direction}", picture, "1700,1300")


CLICK = """
const chosen = () => [...document.querySelectorAll(".chosen")].map((part) =>
  part.matches(".note") ? `note ${part.dataset.note}` : part.id).sort();
const press = (key) => document.dispatchEvent(new KeyboardEvent("keydown", { key }));
const click = (selector) => document.querySelector(selector).dispatchEvent(new MouseEvent("click", { bubbles: true }));
const boxes = [...document.querySelectorAll(".trees g.box")];
const faint = () => boxes.filter((box) => getComputedStyle(box).opacity < 1).length;
"""


def test_a_click_highlights_what_belongs_together(seen: Callable[..., dict[str, Any]], tmp_path: Path) -> None:
    overview = overview_of("laboratory")
    page = write(overview, "html")
    steps = """
    const found = { before: chosen() };
    click("tr#r1"); found.row = chosen(); found.faint = faint();
    found.status = document.querySelector(".live").textContent;
    found.stroke = getComputedStyle(document.querySelector("g.box.chosen .outline")).strokeWidth;
    click("tr#r1"); found.again = chosen();
    click(".trees g.note[data-note=r2]"); found.note = chosen();
    press("Escape"); found.escaped = chosen(); found.clear = faint();
    click("g.box#n3 .outline"); found.node = chosen();
    press("Escape");
    document.querySelector("g.box#n20").dispatchEvent(new KeyboardEvent("keydown", { key: "Enter" }));
    found.entered = chosen(); press("Escape");
    document.querySelector("tr#r3").dispatchEvent(new MouseEvent("mouseenter"));
    found.near = [...document.querySelectorAll("g.box.near")].map((part) => part.id);
    document.querySelector("tr#r3").dispatchEvent(new MouseEvent("mouseleave"));
    found.left = document.querySelectorAll(".near").length;
    return found;"""
    assert seen(page, CLICK + steps) == {
        "before": [],
        "row": ["n14", "note r1", "r1"],
        "faint": len(overview.nodes) - 1,
        "status": "1 node highlighted",
        "stroke": "3.5px",
        "again": [],
        "note": ["n6", "note r2", "r2"],
        "escaped": [],
        "clear": 0,
        "node": ["n3", "note q1", "note q2", "q1", "q2"],
        "entered": ["n20", "note r3", "r3"],
        "near": ["n20"],
        "left": 0,
    }
    clicked = page.replace("</body>", f"<script>{{ {CLICK} click('tr#r2'); }}</script></body>")
    keep_screenshot(tmp_path, "trace-clicked", clicked, "1500,1200")


def test_rows_can_be_filtered(seen: Callable[..., dict[str, Any]]) -> None:
    page = write(overview_of("hospital"), "html")
    steps = """
    const form = document.querySelector(".filter");
    const left = () => [...document.querySelectorAll("tr.row")].filter((row) => row.offsetParent).map((row) => row.id);
    const set = (name, value) => {
      form.elements[name].value = value;
      form.dispatchEvent(new Event("input"));
      return left();
    };
    const all = left().length;
    const found = { all, text: set("text", "DRAWER"), none: set("text", "no such thing") };
    const gaps = () => [...document.querySelectorAll(".gaps li")].filter((gap) => gap.offsetParent).length;
    found.gaps = [gaps()]; set("text", ""); found.gaps.push(gaps());
    found.way = set("way", "reviewed"); set("way", "");
    found.of = set("of", "reliability"); set("of", "");
    found.shown = left().length === all;
    return found;"""
    overview = overview_of("hospital")
    names = {each.name: each.key for each in overview.requirements}
    found = seen(page, steps)
    assert found["all"] == len(overview.requirements) + len(overview.qualities)
    assert found["text"] == [names["locked"]]
    assert found["none"] == []
    gaps = (overview.unenforced, overview.unmeasured, overview.unattached, overview.bare_nodes, overview.bare_trees)
    assert found["gaps"] == [0, sum(map(len, gaps))]
    assert found["way"] == [names["wiped"]]
    assert found["of"][0] == names["dependable"]
    assert found["shown"] is True


def test_without_a_script_links_lead_to_nodes_and_back(tmp_path: Path, seen: Callable[..., dict[str, Any]]) -> None:
    page = re.sub(r"<script>.*?</script>", "", write(overview_of("laboratory"), "html"), flags=re.DOTALL)
    steps = """
    const node = document.querySelector("#requirements td a").getAttribute("href");
    location.hash = node;
    const stroke = getComputedStyle(document.querySelector("g.box:target .outline")).strokeWidth;
    location.hash = document.querySelector(".trees g.note.requirement a").getAttribute("href");
    const row = document.querySelector("tr:target").id;
    return { node, stroke, row, form: document.querySelector(".filter").offsetParent === null };"""
    assert seen(page, steps) == {"node": "#n14", "stroke": "3.5px", "row": "r4", "form": True}


@pytest.mark.scheduled
def test_it_prints_and_is_dark_where_the_reader_wants_it(seen: Callable[..., object], tmp_path: Path) -> None:
    page = write(overview_of("laboratory"), "html")
    target = ARTIFACTS / "trace-laboratory.pdf"
    ARTIFACTS.mkdir(exist_ok=True)
    source = tmp_path / "page.html"
    source.write_text(page, encoding="utf-8")
    chromium(tmp_path, f"--print-to-pdf={target}", "--no-pdf-header-footer", source.as_uri())
    assert target.read_bytes().startswith(b"%PDF")
    dark = page.replace("screen and (prefers-color-scheme: dark)", "screen")
    script = """
    const colour = (selector, what) => getComputedStyle(document.querySelector(selector))[what];
    const box = colour(".trees .box.action .outline", "fill");
    return [colour("body", "backgroundColor"), colour("svg text", "fill"), box];"""
    assert seen(dark, script) == ["rgb(22, 25, 29)", "rgb(238, 241, 244)", "rgb(32, 37, 43)"]
    assert seen(page, script) == ["rgb(255, 255, 255)", "rgb(20, 24, 28)", "rgb(255, 255, 255)"]
    keep_screenshot(tmp_path, "trace-dark", dark, "1500,1200")

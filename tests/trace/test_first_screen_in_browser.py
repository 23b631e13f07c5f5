"""The first screen in a real browser: what fits, what a filter leaves strong, and what is printed.

Screenshots, and the printed pages, are kept in tests/artifacts: look at them.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from chromium import ARTIFACTS, CHROMIUM, DARK, chromium, keep_screenshots, seen_in
from in_process import run_btq
from judged_examples import judged_example

ROOT = Path(__file__).resolve().parents[2]

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium: only a browser can tell")

HELPERS = """
const all = (selector) => [...document.querySelectorAll(selector)];
const strong = () => all("#overview .box").filter((box) => getComputedStyle(box).opacity === "1").map((box) => box.id);
const button = (name) => all(".by-quality button").find((each) => each.textContent === name);
"""


def page_of(folder: Path, *arguments: str) -> str:
    code, out, err = run_btq("trace", "--format", "html", *arguments, cwd=folder)
    assert (code, err) == (0, "")
    return out


@pytest.fixture(scope="module")
def inspection(tmp_path_factory: pytest.TempPathFactory) -> str:
    return page_of(judged_example(tmp_path_factory.mktemp("inspection"), "inspection"))


FITS = f"""
{HELPERS}
const texts = all("#overview svg text").map((text) => text.getBoundingClientRect().height);
const scale = all("#overview svg").map((svg) => svg.getBoundingClientRect().width / svg.viewBox.baseVal.width);
const inside = all("#overview .matters *").every((each) => each.getBoundingClientRect().right <= innerWidth);
return {{
  broad: document.documentElement.scrollWidth - innerWidth,
  scrolls: all("#overview .scroll").filter((part) => part.scrollWidth > part.clientWidth).length,
  small: scale.filter((each) => each < 0.8).length, inside,
}};
"""
EXAMPLES = [
    "inspection",
    *(
        pytest.param(each, marks=pytest.mark.scheduled)
        for each in ("hospital", "laboratory", "published", "navigation")
    ),
]


@pytest.mark.parametrize("example", EXAMPLES)
def test_all_of_it_fits_a_desk_and_a_phone(example: str, tmp_path: Path) -> None:
    page = page_of(ROOT / "examples" / example)
    assert seen_in(tmp_path, page, FITS, 1400) == {"broad": 0, "scrolls": 0, "small": 0, "inside": True}
    on_phone = seen_in(tmp_path, page, FITS, 390)
    assert (on_phone["broad"], on_phone["small"], on_phone["inside"]) == (0, 0, True)
    keep_screenshots(tmp_path, f"first-{example}", page, 1400, 1000)
    keep_screenshots(tmp_path, f"first-{example}", page, 390, 2600)


def test_a_filter_leaves_the_nodes_of_a_quality_strong(inspection: str, tmp_path: Path) -> None:
    steps = f"""
    {HELPERS}
    const found = {{ before: strong(), hidden: document.querySelector(".by-quality").hidden }};
    button("Time behaviour").click();
    found.time = strong();
    found.notes = all("#overview .note.strong").map((note) => note.dataset.note);
    found.rows = all("#overview tr.strong th a").map((each) => each.textContent);
    found.pressed = all('.by-quality [aria-pressed="true"]').map((each) => each.textContent);
    found.status = document.querySelector(".live").textContent;
    button("Reliability").click(); found.reliability = strong();
    found.plural = document.querySelector(".live").textContent;
    button("all").click(); found.after = strong().length;
    found.said = document.querySelector(".live").textContent;
    found.whole = all(".trees .box").filter((box) => getComputedStyle(box).opacity !== "1").length;
    return found;"""
    assert seen_in(tmp_path, inspection, steps, 1400) == {
        "before": ["at-n1", "at-n2", "at-n3", "at-n4", "at-n5", "at-n6"],
        "hidden": False,
        "time": ["at-n1"],
        "notes": ["r4"],
        "rows": ["Time behaviour"],
        "pressed": ["Time behaviour"],
        "status": "Time behaviour: 1 node",
        "reliability": ["at-n4", "at-n6"],
        "plural": "Reliability: 2 nodes",
        "after": 6,
        "said": "all nodes",
        "whole": 0,
    }


def test_on_a_phone_a_filter_shows_the_first_of_its_nodes(tmp_path: Path) -> None:
    page = page_of(ROOT / "examples/laboratory")
    steps = f"""
    {HELPERS}
    const shown = () => {{
      const box = document.querySelector("#at-n6").getBoundingClientRect();
      const frame = document.querySelector("#at-n6").closest(".scroll").getBoundingClientRect();
      return box.left >= frame.left && box.right <= frame.right;
    }};
    const found = [shown()];
    button("Resource utilization").click();
    return [...found, shown(), scrollY];"""
    assert seen_in(tmp_path, page, steps, 390) == [False, True, 0]


def test_keys_and_screen_readers_reach_the_requirement_of_a_box(inspection: str, tmp_path: Path) -> None:
    steps = f"""
    {HELPERS}
    const links = all("#overview .box a");
    const found = links.map((link) => {{
      link.focus();
      const row = document.querySelector(link.getAttribute("href"));
      return [document.activeElement === link, link.querySelector("title").textContent, row.tagName, row.id];
    }});
    const named = all("#overview [role=group], #overview [role=region]").every((part) => part.ariaLabel);
    return [found, named];"""
    links, are_named = seen_in(tmp_path, inspection, steps, 1400)
    assert links == [
        [True, "R->; in_time: violated", "TR", "r4"],
        [
            *(True, "DriveTo ToRoom (place = room 7); enough_power: suspect; keep_away: unknown; slow: satisfied"),
            *("TR", "r3"),
        ],
        [True, "DriveTo ToExit (place = exit); keep_away: unknown; slow: satisfied", "TR", "r1"],
    ]
    assert are_named


def test_states_differ_without_colour(inspection: str, tmp_path: Path) -> None:
    steps = f"""
    {HELPERS}
    return ["at-n1", "at-n4", "at-n6", "at-n2"].map((id) => {{
      const style = getComputedStyle(document.querySelector(`#${{id}} .outline`));
      return [style.strokeWidth, style.strokeDasharray];
    }});"""
    assert seen_in(tmp_path, inspection, steps, 1400) == [
        ["4px", "none"],
        ["2.6px", "10px, 4px"],
        ["2.6px", "3px, 3px"],
        ["1px", "none"],
    ]


def test_without_a_script_all_is_shown(inspection: str, tmp_path: Path) -> None:
    page = re.sub(r"<script>.*?</script>", "", inspection, flags=re.DOTALL)
    steps = f"""
    {HELPERS}
    return [document.querySelector(".by-quality").offsetParent, strong().length, all("tr.row[hidden]").length];"""
    assert seen_in(tmp_path, page, steps, 1400) == [None, 6, 0]


def test_filters_cover_hazards(inspection: str, tmp_path: Path) -> None:
    steps = f"""
    {HELPERS}
    const form = document.querySelector(".filter");
    const shown = (name, value) => {{
      form.elements[name].value = value;
      form.dispatchEvent(new Event("input"));
      const names = all("#chain tr.row").filter((row) => !row.hidden).map((row) => row.querySelector("a").textContent);
      form.elements[name].value = "";
      return names;
    }};
    return [
      shown("text", "dust"), shown("way", "enforced"), shown("of", "reliability"),
      shown("of", "performance-efficiency"), shown("text", "no such thing"), shown("text", "").length,
    ];"""
    assert seen_in(tmp_path, inspection, steps, 1400) == [
        ["blind"],
        ["HAZ_1", "HAZ_2", "PLANT_1", "PLANT_2"],
        ["HAZ_1", "HAZ_2", "PLANT_1", "PLANT_2"],
        ["PLANT_3"],
        [],
        6,
    ]


A4 = 688  # pixels between the margins
PRINTED = f"""
{HELPERS}
button("Reliability").click();
const form = document.querySelector(".filter");
form.elements.text.value = "no such thing";
form.dispatchEvent(new Event("input"));
dispatchEvent(new Event("beforeprint"));
const isShown = (part) => part.getBoundingClientRect().height > 0;
const cut = all("table, svg").filter((part) => part.getBoundingClientRect().right > innerWidth + 1);
return {{
  broad: document.documentElement.scrollWidth - innerWidth,
  cut: cut.map((part) => part.getAttribute("aria-label") ?? part.caption.textContent),
  filters: all(".filter, .by-quality, nav").filter(isShown).length,
  rows: all("tr.row").length - all("tr.row").filter(isShown).length,
  faint: all("#overview .box").length - strong().length,
  folded: all("details:not([open])").length,
}};
"""


@pytest.mark.parametrize("example", ["verdicts", "inspection", pytest.param("hospital", marks=pytest.mark.scheduled)])
def test_print_is_whole(example: str, inspection: str, tmp_path: Path) -> None:
    page = inspection if example == "inspection" else page_of(ROOT / "examples/hospital")
    if example == "verdicts":  # with tables of runs and nodes, folded on a screen
        folder = ROOT / "examples/laboratory"
        run_btq("verify", "--exit-zero", "-o", str(tmp_path / "verdicts.html"), cwd=folder)
        page = (tmp_path / "verdicts.html").read_text(encoding="utf-8")
    as_printed = page.replace("@media print", "@media all").replace("@media screen", "@media not all")
    assert seen_in(tmp_path, as_printed, PRINTED, A4) == {
        "broad": 0,
        "cut": [],
        "filters": 0,
        "rows": 0,
        "faint": 0,
        "folded": 0,
    }
    ARTIFACTS.mkdir(exist_ok=True)
    target, source = ARTIFACTS / f"first-{example}.pdf", tmp_path / "printed.html"
    source.write_text(page, encoding="utf-8")
    chromium(tmp_path, DARK, f"--print-to-pdf={target}", "--no-pdf-header-footer", source.as_uri())
    boxes = re.findall(rb"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", target.read_bytes())
    assert {(round(float(width)), round(float(height))) for width, height in boxes} == {(595, 842)}  # points of A4

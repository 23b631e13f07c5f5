"""The page of `btq preview` in a real browser, used as people use it: mouse, keys, and what a screen reader is told."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

MISSION = """\
QualityReq soon "In time"
    takes at most 30 s
BehaviorTree Main
    ->
        Condition Ready
        ? Way
            Dock satisfies soon
            SubTree Rest
BehaviorTree Rest
    Charge satisfices safety
"""


@pytest.fixture
def page(browser: Browser, tmp_path: Path, artifacts: Path, request: pytest.FixtureRequest) -> Iterator[Page]:
    """The page of `main.btq`; how it looks at the end of the test is kept."""
    (tmp_path / "main.btq").write_text(MISSION)
    command = [sys.executable, "-m", "btq_lang", "preview", "main.btq"]
    process = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout is not None
    found = re.search(r"http://\S+", process.stdout.readline())
    assert found is not None
    page = browser.new_page(viewport={"width": 900, "height": 600})
    complaints: list[str] = []
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.goto(found[0])
    page.locator(".box", has_text="Dock").wait_for(state="attached")
    yield page
    page.screenshot(path=str(artifacts / f"preview-{request.node.name}.png"))
    page.close()
    process.terminate()
    process.communicate(timeout=30)
    assert complaints == []


def keys(page: Page, *names: str) -> None:
    for name in names:
        page.keyboard.press(name)


def boxes(page: Page) -> list[str]:
    """What is written in each box."""
    return page.locator(".box").evaluate_all(
        "boxes => boxes.map(box => [...box.querySelectorAll('text')].map(text => text.textContent).join(' '))"
    )  # type: ignore[no-any-return]  # whatever a page's script gives


def focused(page: Page) -> str:
    return str(page.evaluate("document.activeElement.querySelector('text.title')?.textContent ?? ''"))


def see_boxes(page: Page, *texts: str) -> None:
    """Wait until these are drawn and no others."""
    page.wait_for_function("count => document.querySelectorAll('.box').length === count", arg=len(texts))
    assert boxes(page) == list(texts)


ALL = ("->", "Ready", "? Way", "Dock", "Rest", "Charge")


def test_it_follows_the_file(page: Page, tmp_path: Path) -> None:
    see_boxes(page, *ALL)
    (tmp_path / "main.btq").write_text(MISSION.replace("Condition Ready", "Condition Ready\n        Undock"))
    see_boxes(page, "->", "Ready", "Undock", "? Way", "Dock", "Rest", "Charge")
    assert page.title() == "main.btq"
    (tmp_path / "main.btq").unlink()
    page.locator("#said.trouble", has_text="No such file").wait_for()
    (tmp_path / "main.btq").write_text("BehaviorTree Main\n    Dock\n")
    see_boxes(page, "Dock")
    assert page.locator("#said").text_content() == ""
    (tmp_path / "main.btq").write_text("QualityReq soon\n    takes at most 30 s\n")
    see_boxes(page)
    assert page.locator("#said").text_content() == "There is no tree in main.btq"
    (tmp_path / "main.btq").write_text("BehaviorTree Main\n    Dock\n")
    see_boxes(page, "Dock")
    assert page.locator("#said").text_content() == ""


def test_a_subtree_is_folded_by_its_handle_and_stays_folded(page: Page, tmp_path: Path) -> None:
    page.locator(".box", has_text="Way").locator(".fold").click()
    see_boxes(page, "->", "Ready", "? Way … 2 nodes", "Charge")
    (tmp_path / "main.btq").write_text(MISSION.replace("Condition Ready", "Undock"))
    page.locator(".box", has_text="Undock").wait_for(state="attached")
    see_boxes(page, "->", "Undock", "? Way … 2 nodes", "Charge")
    page.locator(".box", has_text="Way").locator(".fold").click()
    see_boxes(page, "->", "Undock", "? Way", "Dock", "Rest", "Charge")


def test_all_are_folded_and_unfolded(page: Page) -> None:
    page.get_by_role("button", name="Fold all", exact=True).click()
    see_boxes(page, "->", "Ready", "? Way … 2 nodes", "Charge")
    page.get_by_role("button", name="Unfold all").click()
    see_boxes(page, *ALL)


def test_the_keys_of_a_tree_view(page: Page) -> None:
    page.locator("#save").focus()
    keys(page, "Tab")
    assert focused(page) == "->"
    for key, node in (
        ("ArrowDown", "Ready"),
        ("ArrowDown", "?"),
        ("ArrowRight", "Dock"),
        ("ArrowLeft", "?"),
        ("End", "Charge"),
        ("Home", "->"),
        ("ArrowRight", "Ready"),
        ("ArrowRight", "Ready"),  # a leaf has nothing to open
        ("ArrowDown", "?"),
    ):
        keys(page, key)
        assert focused(page) == node
    keys(page, "ArrowLeft")
    see_boxes(page, "->", "Ready", "? Way … 2 nodes", "Charge")
    assert focused(page) == "?"
    keys(page, "ArrowRight")
    see_boxes(page, *ALL)
    keys(page, "Space")
    see_boxes(page, "->", "Ready", "? Way … 2 nodes", "Charge")
    keys(page, "Enter")
    page.locator("#said", has_text="main.btq:6:9").wait_for()
    keys(page, "ArrowLeft")
    assert focused(page) == "->"


def test_what_a_screen_reader_is_told(page: Page) -> None:
    page.locator(".box", has_text="Way").locator(".fold").click()
    see_boxes(page, "->", "Ready", "? Way … 2 nodes", "Charge")
    told = page.locator("body").aria_snapshot()
    assert told.splitlines() == [
        "- banner:",
        '  - searchbox "Find a node"',
        '  - group "Zoom":',
        '    - button "Smaller": −',
        '    - button "Actual size": 100 %',
        '    - button "Larger": +',
        '  - button "Fold all"',
        '  - button "Unfold all"',
        '  - button "Save SVG"',
        "  - status",
        "- main:",
        '  - tree "Behavior trees of main.btq":',
        '    - treeitem "->" [expanded] [level=1]',
        '    - treeitem "Ready" [level=2]',
        '    - \'treeitem "? Way; folded: Dock, Rest" [level=2]\': "? Way … 2 nodes"',
        '    - treeitem "Charge; satisfices safety" [level=1]: Charge',
    ]


def test_searching(page: Page) -> None:
    keys(page, "/")
    page.keyboard.type("ta")  # no name: the clause of a requirement
    assert page.locator("#said").text_content() == "1 found"
    assert page.locator(".box:not(.other)").get_attribute("aria-label") == "Dock; soon; takes at most 30 s"
    keys(page, "Enter")
    assert focused(page) == "Dock"
    keys(page, "/", "Escape")
    assert (page.locator("#said").text_content(), page.locator(".box.other").count()) == ("", 0)


def test_searching_finds_what_is_folded_away(page: Page) -> None:
    page.get_by_role("button", name="Fold all", exact=True).click()
    see_boxes(page, "->", "Ready", "? Way … 2 nodes", "Charge")
    page.locator("#search").fill("dock")
    assert page.locator(".box:not(.other)").get_attribute("data-name") == "Main/->/? Way"


def test_zoom(page: Page) -> None:
    def width() -> float:
        return float(page.evaluate("document.querySelector('#tree svg').getBoundingClientRect().width"))

    before = width()
    page.get_by_role("button", name="Larger").click()
    assert width() == pytest.approx(before * 1.1, abs=0.1)
    page.locator(".box").first.focus()
    keys(page, "0", "-", "-")
    assert width() == pytest.approx(before / 1.21, abs=0.1)
    page.keyboard.down("Control")
    page.mouse.wheel(0, -100)
    page.keyboard.up("Control")
    page.wait_for_function("document.getElementById('whole').textContent === '91 %'")


def test_the_picture_is_saved_as_it_is_shown(page: Page, tmp_path: Path) -> None:
    page.get_by_role("button", name="Fold all", exact=True).click()
    see_boxes(page, "->", "Ready", "? Way … 2 nodes", "Charge")
    with page.expect_download() as download:
        page.get_by_role("button", name="Save SVG").click()
    assert download.value.suggested_filename == "main.svg"
    download.value.save_as(tmp_path / "saved.svg")
    svg = (tmp_path / "saved.svg").read_text(encoding="utf-8")
    assert svg.startswith("<svg xmlns=")
    assert "… 2 nodes" in svg
    assert 'class="fold"' not in svg


def test_it_is_dark_where_the_reader_wants_it(page: Page) -> None:
    def colours() -> list[str]:
        return [
            str(page.evaluate(f"getComputedStyle(document.querySelector({selector!r})).{what}"))
            for selector, what in (("body", "backgroundColor"), (".box .outline", "fill"), (".box text", "fill"))
        ]

    light = colours()
    page.emulate_media(color_scheme="dark")
    assert (light, colours()) == (
        ["rgb(255, 255, 255)", "rgb(230, 235, 242)", "rgb(20, 24, 28)"],
        ["rgb(18, 18, 18)", "rgb(46, 55, 66)", "rgb(238, 241, 244)"],
    )

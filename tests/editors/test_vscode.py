"""VS Code with the package of this checkout: one window, in which a person works through these tests in turn."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from chromium import CHROMIUM
from evidence_logs import MAIN, MAIN_XML, btlog, rows
from installed import ROOT, STORE, has_failed, there
from workbench import Windows, Workbench, workbench

# A workbench loses a click or a change of its settings now and then, on a busy machine: what fails is tried once more,
# in a window of its own, and the run says so.
pytestmark = pytest.mark.flaky(reruns=1)

WRONG = "BehaviorTree Main\n    ->\n        Sequnce\n            Dock\n"
ENVIRONMENT = {
    "btq.interpreter": sys.executable,
    "files.autoSave": "off",
    "security.workspace.trust.enabled": False,
    "workbench.startupEditor": "none",
    "workbench.colorTheme": "Default Dark Modern",
    "workbench.tips.enabled": False,
    "workbench.secondarySideBar.defaultVisibility": "hidden",
    "chat.disableAIFeatures": True,
    # What these draw takes a tenth of the processor.
    "editor.cursorBlinking": "solid",
    "editor.minimap.enabled": False,
    "terminal.integrated.gpuAcceleration": "off",
    # What is proposed without being asked for comes when it comes, and would take an Enter of these tests for its own.
    "[btq]": {"editor.formatOnSave": True, "editor.quickSuggestions": {"other": "off"}},
}


@pytest.fixture(scope="module")
def windows(
    vsix: Path, node: Path, driver: None, artifacts: Path, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Windows]:
    there(CHROMIUM, "Chromium", "from_apt")
    there(STORE / "vscode/node_modules/code-server/out/node/entry.js", "VS Code", "vscode")

    @contextmanager
    def window() -> Iterator[Workbench]:
        scratch = tmp_path_factory.mktemp("vscode")
        files = ROOT / "examples" / "hospital"
        programs = scratch / "programs"
        programs.mkdir()
        program(programs / "btq-lsp")
        with workbench(
            store=STORE, node=node, vsix=vsix, scratch=scratch, files=files, settings=ENVIRONMENT, programs=programs
        ) as window:
            window.open("missions/deliver.btq")
            window.see(".codelens-decoration")  # the server answers: whichever test is the first finds it running
            window.close_all()
            yield window

    with Windows(window) as windows:
        yield windows


def program(path: Path) -> None:
    """This checkout's `btq-lsp`, as an installation puts it on the PATH."""
    path.write_text(f'#!/bin/sh\nPYTHONPATH="{ROOT}" exec "{sys.executable}" -m btq_lang.server "$@"\n')
    path.chmod(0o755)


@pytest.fixture
def code(windows: Windows, request: pytest.FixtureRequest, artifacts: Path) -> Iterator[Workbench]:
    """The window with no editor open.  A test that failed leaves none, but a picture of what stood in it."""
    code = windows.current()
    yield code
    if has_failed(request.node):
        code.shot(artifacts / f"vscode-{request.node.name}.png")
        print(code.seen())
        windows.close()
        return
    code.close_all()
    code.clean()


def test_an_example_is_clean_and_a_mistake_is_underlined(code: Workbench) -> None:
    code.open("missions/deliver.btq")
    code.write("wrong.btq", WRONG)
    code.open("wrong.btq")
    code.see(".squiggly-warning, .squiggly-error")
    assert code.problems("unknown node `Sequnce`")[0].endswith("btq unknown-node [Ln 3, Col 9]")


def test_mending_it_empties_the_problems(code: Workbench) -> None:
    code.write("wrong.btq", WRONG)
    code.open("wrong.btq")
    code.problems("unknown node `Sequnce`")
    code.focus()
    code.cursor(3, 9)
    code.keys("Control+Shift+ArrowRight")
    code.type("Sequence")
    code.problems()
    code.focus()
    code.save()


def test_saving_formats(code: Workbench) -> None:
    code.write("untidy.btq", "BehaviorTree   Main\n  ->\n     Action   Dock( x=1 )\n")
    code.open("untidy.btq")
    code.focus()
    code.keys("End")
    code.type(" ")
    code.save()
    code.on_disk("untidy.btq", "BehaviorTree Main\n    ->\n        Action Dock (x = 1)\n")


REQUIREMENTS = """\
QualityReq soon_there : performance-efficiency.time-behaviour "In time"
    takes at most 30 s
"""
MISSION = """\
include "demands.btq"

BehaviorTree Visit
    Dock satisfies soon_there
"""


def test_f12_leads_to_the_definition_in_another_file(code: Workbench) -> None:
    code.write("demands.btq", REQUIREMENTS)
    code.write("visit.btq", MISSION)
    code.open("visit.btq")
    code.cursor(4, 22)
    code.keys("F12")
    code.see(".tab.active:has-text('demands.btq')")
    code.at(1, 12)


def test_renaming_changes_both_files(code: Workbench) -> None:
    code.write("demands.btq", REQUIREMENTS)
    code.write("visit.btq", MISSION)
    code.open("demands.btq")
    code.open("visit.btq")
    code.cursor(4, 22)
    code.keys("F2")
    code.see(".rename-box input.rename-input")
    code.page.wait_for_function("document.activeElement.classList.contains('rename-input')")
    code.keys("Control+a")
    code.type("punctual")
    code.keys("Enter")
    code.see(".view-line:has-text('punctual')")
    code.command("File: Save All")
    code.on_disk("visit.btq", MISSION.replace("soon_there", "punctual"))
    code.on_disk("demands.btq", REQUIREMENTS.replace("soon_there", "punctual"))
    code.no_more(".tab.dirty")  # a file is on the disk before its tab says so


def test_completion_offers_qualities_and_hover_explains_them(code: Workbench, artifacts: Path) -> None:
    code.write("concerns.btq", "BehaviorTree Main\n    Dock\n        satisfices reliab\n")
    code.open("concerns.btq")
    code.cursor(3, 26)
    assert "reliability" in code.suggestions()
    code.shot(artifacts / "vscode-completion.png")
    code.keys("Enter")
    code.see(".view-line:has-text('satisfices reliability')")
    code.keys("Escape", "Control+k", "Control+i")
    code.see(".monaco-hover:not(.hidden):has-text('reliability')")
    code.shot(artifacts / "vscode-hover.png")
    code.keys("Escape", "Escape")
    code.save()


@pytest.mark.scheduled
def test_a_quality_is_found_by_either_name_and_after_its_dot(code: Workbench) -> None:
    code.write("concerns.btq", "BehaviorTree Main\n    Dock\n        satisfices \n")
    code.open("concerns.btq")
    code.see(".codelens-decoration")  # the server answers
    code.cursor(3, 20)
    whole = "performance-efficiency"
    parts = ["time-behaviour", "resource-utilization", "capacity"]
    expected = {"time": [f"{whole}.time-behaviour"], "performance": [whole, *(f"{whole}.{part}" for part in parts)]}
    for typed, first in {**expected, f"{whole}.": parts}.items():
        code.type(typed)
        assert [row for row in code.suggestions() if row.startswith(whole) or typed.endswith(".")] == first
        code.keys("Escape", "Escape", *["Backspace"] * len(typed), "Escape")
    code.save()


@pytest.mark.scheduled
def test_the_light_bulb_mends(code: Workbench) -> None:
    code.write("wrong.btq", WRONG)
    code.open("wrong.btq")
    code.see(".squiggly-warning")
    code.cursor(3, 10)
    code.fixes()
    code.see(".action-widget .monaco-list-row:has-text('Sequence')")
    code.keys("Enter")
    code.see(".view-line:has-text('Sequence')")
    code.save()
    code.on_disk("wrong.btq", WRONG.replace("Sequnce", "Sequence"))


@pytest.mark.scheduled
def test_auto_fix_takes_the_only_near_name(code: Workbench) -> None:
    """Without a list to choose from: the fix is preferred."""
    code.write("wrong.btq", WRONG)
    code.open("wrong.btq")
    code.see(".squiggly-warning")
    code.cursor(3, 10)
    code.command("Auto Fix...")
    code.see(".view-line:has-text('Sequence')")
    code.save()
    code.on_disk("wrong.btq", WRONG.replace("Sequnce", "Sequence"))


@pytest.mark.scheduled
def test_a_save_applies_the_source_actions_that_are_asked_for(code: Workbench) -> None:
    actions = {"source.fixAll": "explicit", "source.organizeImports": "explicit"}
    code.settings(**{**ENVIRONMENT, "editor.codeActionsOnSave": actions})
    code.write("demands.btq", REQUIREMENTS)
    text = 'include "demands.btq"  # all\ninclude "demands.btq"  # again\n\nBehaviorTree Visit\n    Dock{}\n'
    code.write("saved.btq", text.format(" satisfies soon_there"))
    code.open("saved.btq")
    code.see(".codelens-decoration")
    code.cursor(5, 30)
    code.type(" satisfices speed")
    code.keys("Escape")
    code.save()
    quality = "performance-efficiency.time-behaviour"
    fixed = text.format(f" satisfies soon_there satisfices {quality}").replace(
        'include "demands.btq"  # again', "# again"
    )
    code.on_disk("saved.btq", fixed)
    code.settings(**ENVIRONMENT)


@pytest.mark.scheduled
def test_a_code_lens_shows_the_uses(code: Workbench) -> None:
    code.write("demands.btq", REQUIREMENTS)
    code.write("visit.btq", MISSION)
    code.open("visit.btq")
    code.see(".codelens-decoration:has-text('main tree'):not(:has(a))")  # there is nothing to open
    code.open("demands.btq")
    code.see(".codelens-decoration a:text-is('1 use')").click()
    code.see(".peekview-widget .ref-tree .monaco-list-row:has-text('satisfies soon_there')")
    code.keys("Escape")


SCENARIOS = """\
BehaviorTree Deliver
    ?
        MoveTo (location = "E")
        MoveTo (location = "B")

scenario "E is closed"
    given MoveTo (location = "E") fails
    expect MoveTo runs "E", "B"

scenario "E is open"
    expect MoveTo runs "E", "B"
"""


def test_the_test_explorer_lists_and_runs_scenarios(code: Workbench, artifacts: Path) -> None:
    def see(title: str, state: str) -> None:
        code.see(f".test-explorer .monaco-list-row:has-text('{title}') .codicon-testing-{state}-icon")

    code.write("cases.btq", SCENARIOS)
    code.open("cases.btq")
    code.see(".codelens-decoration a:text-is('run')").click()
    code.problems()
    code.command("Testing: Focus on Test Explorer View")
    code.see(".test-explorer .monaco-list-row:has-text('cases.btq') .monaco-tl-twistie").click()
    see("E is closed", "passed")
    see("E is open", "unset")
    code.command("Test: Run All Tests")
    see("E is open", "failed")
    see("E is closed", "passed")
    expected = 'the mission succeeds, and the node has not run with it; expected "B"'
    assert code.problems(expected)[0].endswith("btq test [Ln 11, Col 5]")
    code.shot(artifacts / "vscode-scenarios.png")
    code.focus()
    code.cursor(2, 6)
    code.keys("Backspace")
    code.type("->")
    code.problems()
    code.command("Test: Run All Tests")
    see("E is open", "passed")
    see("E is closed", "failed")
    assert code.problems("the mission fails, and the node has not run with it")[0].endswith("[Ln 8, Col 5]")


TWICE = """\
include "fetch.btq"

scenario "E is closed" of Deliver
    given MoveTo (location = "E") fails
    expect mission succeeds

scenario "E is closed" of Deliver
    given MoveTo fails
    expect mission fails
"""
ONCE = """\
include "fetch.btq"

scenario "it leaves" of Leave
    expect mission succeeds
"""
FETCHED = """\
BehaviorTree Deliver
    ?
        MoveTo (location = "E")
        MoveTo (location = "B")
        Charge

BehaviorTree Leave
    Charge

BehaviorTree Never
    Charge
"""


def test_what_scenarios_meet_is_in_the_gutter_and_two_may_have_one_title(code: Workbench, artifacts: Path) -> None:
    code.write("fetch.btq", FETCHED)
    code.write("once.btq", ONCE)
    code.write("twice.btq", TWICE)
    code.open("twice.btq")
    code.see(".codelens-decoration a:text-is('run')")
    code.command("Testing: Focus on Test Explorer View")
    code.see(".test-explorer .monaco-list-row:has-text('twice.btq') .monaco-tl-twistie").click()
    rows = code.page.locator(".test-explorer .monaco-list-row:has-text('E is closed')")
    code.until(lambda: rows.count() == 2, lambda: str(rows.all_inner_texts()))
    code.command("Test: Run All Tests with Coverage")
    for state in ("passed", "failed"):
        code.see(f".test-explorer .monaco-list-row:has-text('E is closed') .codicon-testing-{state}-icon")
    code.open("fetch.btq")
    lines = code.page.locator(".line-numbers.coverage-deco-gutter")

    def met() -> dict[str, str]:
        classes = ((each.inner_text(), str(each.get_attribute("class"))) for each in lines.all())
        return {line: " ".join(word for word in ("hit", "miss") if f"-{word}" in of) for line, of in classes}

    expected = {"2": "hit miss", "3": "hit miss", "4": "hit", "5": "hit miss", "8": "hit miss", "10": "miss"}
    code.until(lambda: met() == expected, lambda: str(met()))
    code.shot(artifacts / "vscode-coverage.png")
    code.keys("Control+;", "Control+Shift+i")  # Toggle Inline Coverage
    code.cursor(3, 9)
    code.keys("Control+k", "Control+i")
    code.see(".monaco-hover:not(.hidden):has-text('Branch MoveTo succeeds in')")
    code.shot(artifacts / "vscode-coverage-hover.png")
    code.keys("Escape")
    code.keys("Control+;", "Control+Shift+i")


EXPLORED = """\
QualityReq most : reliability "It looks twice"
    Look tries at most 2

BehaviorTree Main
    Retry (num_attempts = 3)
        Look
"""
EXPLORE = ".codelens-decoration a:text-is('how can this be violated?')"


def test_a_run_that_violates_a_requirement_is_opened_and_run(code: Workbench, artifacts: Path) -> None:
    code.write("look.btq", EXPLORED)
    code.open("look.btq")
    code.see(EXPLORE).click()
    answer = "most `Look tries at most 2` can be violated: "
    code.see(f".notification-toast:has-text('{answer}yes, in 3 ticks')")
    code.command("Notifications: Clear All Notifications")
    code.see(".tab.active.dirty:has-text('most_violated.btq')")
    code.until(lambda: code.text()[3:4] == ["    given Look fails 2 times, then succeeds"], lambda: str(code.text()))
    code.see(".editor-group-container.active .codelens-decoration a:text-is('run')").click()
    (row,) = code.problems("started 3 times; expected most satisfied, bound 2")
    code.shot(artifacts / "vscode-explored.png")
    assert row.endswith("btq test [Ln 5, Col 5]")
    code.see(".tab:has-text('most_violated.btq')").click()
    code.save()
    (code.folder / "most_violated.btq").unlink()  # it was saved there, beside the mission
    code.open("look.btq")
    code.cursor(5, 28)
    code.keys("Backspace")
    code.type("2")
    code.cursor(1, 13)
    code.fixes()
    code.see(".action-widget .monaco-list-row:has-text('Explore how `most` can be violated')").click()
    code.see(f".notification-toast:has-text('{answer}no, in all 2 states')")
    code.command("Notifications: Clear All Notifications")


def test_the_next_key_ends_a_long_search(code: Workbench) -> None:
    branches = (f"        ->\n            A{number}\n            B{number}\n" for number in range(12))
    code.write("long.btq", EXPLORED.replace("Retry (num_attempts = 3)", "ParallelAll") + "".join(branches))
    code.open("long.btq")
    code.see(EXPLORE).click()
    code.see(".statusbar-item:has-text('exploring most')")
    code.focus()
    code.type(" ")
    code.see(".statusbar-item:has-text('a text was edited: ask again whether `most` can be violated')")


@pytest.mark.scheduled
def test_enter_indents_below_what_has_a_block_and_leaves_it_at_the_second(code: Workbench) -> None:
    code.write("typed.btq", "")
    code.open("typed.btq")
    for line, text, column in (
        (2, "BehaviorTree Main", 5),
        (3, "->", 9),
        (4, "? Way", 13),
        (5, "Dock", 13),
        (6, "", 9),
    ):
        code.type(text)
        code.keys("Enter")
        code.at(line, column)
    code.type("Charge")
    code.keys("Enter")
    code.at(7, 9)
    code.type('Say (text = "a')  # the bracket and the quote are closed by themselves
    code.save()
    code.on_disk(
        "typed.btq",
        'BehaviorTree Main\n    ->\n        ? Way\n            Dock\n\n        Charge\n        Say (text = "a")\n',
    )


@pytest.mark.scheduled
def test_a_snippet_writes_a_requirement(code: Workbench) -> None:
    code.write("snippet.btq", "")
    code.open("snippet.btq")
    code.type("req-time")
    code.keys("Control+Space")
    code.see(".suggest-widget.visible .monaco-list-row.focused:has-text('req-time')")
    code.keys("Enter")
    code.type("soon")
    code.keys("Escape", "Escape")
    code.save()
    code.on_disk(
        "snippet.btq",
        'QualityReq soon : performance-efficiency.time-behaviour "Done in time"\n'
        "    takes at most 30 s\n    on violation warn\n",
    )


@pytest.mark.scheduled
@pytest.mark.parametrize("served", [True, False])
def test_checking_all_missions_finds_what_is_wrong_in_files_that_are_not_open(code: Workbench, served: bool) -> None:
    """Each mistake stands there once: what the server tells, the task does not tell again."""
    if not served:
        code.settings(**{**ENVIRONMENT, "btq.checkClosedFiles": False})
    code.write("unopened.btq", WRONG)
    code.run_task("btq: Check All Missions")
    assert "btq unknown-node" in " ".join(code.problems_of("unopened.btq", 1))
    code.settings(**ENVIRONMENT)


@pytest.mark.scheduled
def test_a_task_takes_nothing_from_the_problems_and_knows_which_rules_are_off(code: Workbench) -> None:
    code.write("seen.btq", WRONG)
    code.open("seen.btq")
    code.problems_of("seen.btq", 1)
    code.run_task("btq: Check All Missions")
    code.problems_of("seen.btq", 1)
    code.settings(**{**ENVIRONMENT, "btq.rules": {"unknown-node": "off"}})
    code.no_problems_of("seen.btq")
    code.run_task("btq: Check All Missions")
    code.see(".single-terminal-tab .codicon-check")
    code.no_problems_of("seen.btq")
    code.settings(**ENVIRONMENT)


@pytest.mark.scheduled
@pytest.mark.parametrize("gone", ["robot", "robot/mission.btq"])
def test_problems_go_with_the_file_or_its_folder(code: Workbench, gone: str) -> None:
    code.write("robot/mission.btq", WRONG)
    code.write("robot/closed.btq", WRONG)
    code.open("robot/mission.btq")
    code.problems_of("mission.btq", 1)
    code.problems_of("closed.btq", 1)
    if gone == "robot":
        shutil.rmtree(code.folder / gone)
    else:
        (code.folder / gone).unlink()
    code.focus()
    code.close_all()
    code.no_problems_of("mission.btq")
    if gone == "robot":
        code.no_problems_of("closed.btq")


def test_the_xml_beside_follows_what_is_typed(code: Workbench) -> None:
    code.write("main.btq", "BehaviorTree Main\n    Dock\n")
    code.open("main.btq")
    code.command("btq: Show XML Beside")
    code.see(".view-line:has-text('<Action ID=\"Dock\"/>'), .view-line:has-text('<Dock/>')")
    code.cursor(2, 9)
    code.type("Station")
    code.see(".view-line:has-text('<DockStation/>')")
    code.keys("Control+z")


def test_the_tree_beside_follows_the_text_and_the_cursor_and_leads_back(code: Workbench) -> None:
    code.write("tree.btq", "BehaviorTree Main\n    ->\n        Dock satisfices safety\n        Charge\n")
    code.open("tree.btq")
    code.cursor(2, 5)
    code.command("btq: Show Tree Beside")
    frame = code.page.frame_locator("iframe.webview.ready").frame_locator("#active-frame")
    box = frame.locator(".box", has_text="Dock")
    box.wait_for(state="attached")
    assert frame.locator(".note.quality", has_text="safety").count() == 1
    frame.locator(".box.here", has_text="->").wait_for(state="attached")
    frame.locator(".box", has_text="Charge").click()
    code.at(4, 9)
    frame.locator(".box.here", has_text="Charge").wait_for(state="attached")
    code.keys("End")
    code.type("Fully")
    frame.locator(".box.here", has_text="ChargeFully").wait_for(state="attached")
    code.type("Now")  # the page that was drawn anew has not taken the keys
    frame.locator(".box.here", has_text="ChargeFullyNow").wait_for(state="attached")
    code.save()
    # What the server says of words is laid over the grammar's colours, and leaves a symbol the colour of a keyword.
    keyword, symbol = (code.see(f".view-line span span:text-is('{word}')") for word in ("satisfices", "->"))
    assert symbol.evaluate("e => getComputedStyle(e).color") == keyword.evaluate("e => getComputedStyle(e).color")


@pytest.mark.scheduled
def test_the_tree_beside_is_fitted_and_zoomed_at_the_pointer(code: Workbench) -> None:
    leaves = "".join(f"        Act{number} satisfices safety\n" for number in range(70))
    code.write("tree.btq", f"BehaviorTree Main\n    -> Root\n{leaves}")
    code.open("tree.btq")
    code.command("btq: Show Tree Beside")
    frame = code.page.frame_locator("iframe.webview.ready").frame_locator("#active-frame")
    frame.locator(".box", has_text="Act69").wait_for(state="attached")

    def rectangle(selector: str) -> tuple[float, float, float, float]:
        box = frame.locator(selector).first.bounding_box()
        assert box is not None
        return box["x"], box["y"], box["width"], box["height"]

    def middle(selector: str) -> float:
        x, _, width, _ = rectangle(selector)
        return x + width / 2

    (x, _, width, _), view = rectangle("#tree svg"), rectangle("#view")
    assert width == pytest.approx(view[2] - 16, abs=2)
    assert middle("#tree svg") == pytest.approx(middle("#view"), abs=1)
    assert middle(".box .outline") == pytest.approx(middle("#view"), abs=1)
    assert frame.locator(".note.folded").count() == 70
    at = frame.locator(".box", has_text="Act9").first.bounding_box()
    assert at is not None
    place = at["x"] + at["width"] / 2, at["y"] + at["height"] / 2
    code.page.mouse.move(*place)
    code.page.mouse.wheel(0, -125)
    code.until(lambda: rectangle("#tree svg")[2] > 1.3 * width, lambda: str(rectangle("#tree svg")))
    assert rectangle("#tree svg")[2] == pytest.approx(width * 2**0.5, abs=2)
    at = frame.locator(".box", has_text="Act9").first.bounding_box()
    assert at is not None
    assert (at["x"] + at["width"] / 2, at["y"] + at["height"] / 2) == pytest.approx(place, abs=2)
    frame.locator("#search").click()
    code.keys("Tab", "f")
    assert rectangle("#tree svg")[:3:2] == pytest.approx((x, width), abs=1)


@pytest.mark.scheduled
def test_the_tree_beside_is_folded_and_saved_as_it_is_shown(code: Workbench) -> None:
    code.write("tree.btq", "BehaviorTree Main\n    ->\n        ? Way\n            Dock\n        Charge\n")
    code.open("tree.btq")
    code.command("btq: Show Tree Beside")
    frame = code.page.frame_locator("iframe.webview.ready").frame_locator("#active-frame")
    frame.locator(".box", has_text="Way").locator(".fold").click()
    frame.locator(".box", has_text="… 1 node").wait_for(state="attached")
    assert frame.locator(".box").count() == 3
    code.focus()
    code.cursor(4, 13)  # in what is folded away
    frame.locator(".box.here", has_text="Way").wait_for(state="attached")
    frame.get_by_role("button", name="Save SVG").click()
    code.answer_path(code.folder / "tree.svg")
    code.until((code.folder / "tree.svg").exists, lambda: "no tree.svg")
    saved = (code.folder / "tree.svg").read_text(encoding="utf-8")
    assert (saved.count('class="box'), "… 1 node" in saved) == (3, True)
    (code.folder / "tree.svg").unlink()


def test_logs_are_judged_as_a_bound_is_typed_and_a_run_is_stepped_through_in_the_tree(code: Workbench) -> None:
    code.write("robot/btq.toml", '[evidence]\nlogs = ["run.btlog"]\n')
    log = code.write("robot/run.btlog", "")
    log.write_bytes(btlog(MAIN_XML, rows("0 1R 2R 20 2S 3R 60 3S 1S 1I 100 1R 2R 140 2S 3R 150 3S 1S")))
    code.write("robot/judged.btq", "QualityReq quick : safety\n    Move takes at most 30 ms\n" + MAIN)
    code.open("robot/judged.btq")
    code.see(".codelens-decoration:has-text('violated in 1 of 2 activations · worst 40 ms')")
    (problem,) = [row for row in code.problems_of("judged.btq", 1) if "`quick` is violated" in row]
    assert "1 of 2 activations, worst 40 ms in run 2 btq requirement-violated [Ln 6, Col 16] Move::2:" in problem
    assert "took 40 ms, bound 30 ms" in problem
    code.focus()
    code.cursor(2, 24)
    code.keys("Delete")
    code.type("4")
    code.see(".codelens-decoration:has-text('held in 2 of 2 activations · worst 40 ms')")
    code.no_problems_of("judged.btq")
    code.focus()
    code.cursor(2, 25)
    code.keys("Backspace")
    code.type("1")
    code.see(".codelens-decoration:has-text('violated in 2 of 2 activations · worst 40 ms')")
    code.command("btq: Show Run")
    code.see(".quick-input-list .monaco-list-row:has-text('Run 2'):has-text('the last one')")
    code.keys("Enter")
    frame = code.page.frame_locator("iframe.webview.ready").frame_locator("#active-frame")

    def sees(step: int, sentence: str, *marks: str) -> None:
        said = f"Run 2 of run.btlog: succeeded, step {step} of 6: {sentence}"
        frame.locator(f"#step:text-is('{said}')").wait_for(state="attached")
        assert frame.locator(".mark").all_text_contents() == [*marks]

    sees(6, "50 ms: Sequence::1 succeeded, 50 ms", "✔ 50 ms", "✔ 40 ms", "✔ 10 ms")
    frame.locator(".note.violated", has_text="last run: 40 ms, violated").wait_for(state="attached")
    assert frame.locator(".note .broken").count() == 2
    frame.locator("#step").click()  # in this browser the page has the keys only then
    code.keys("p")
    sees(5, "50 ms: Pick::3 succeeded, 10 ms", "…", "✔ 40 ms", "✔ 10 ms")
    code.keys("p", "p")
    sees(3, "40 ms: Move::2 succeeded, 40 ms", "…", "✔ 40 ms")
    code.keys("n")
    sees(4, "40 ms: Pick::3 starts", "…", "✔ 40 ms", "…")
    code.focus()
    code.save()
    log.write_bytes(btlog(MAIN_XML, rows("0 1R 2R 10 2S 3R 60 3S 1S")))
    frame.locator(".note.satisfied", has_text="last run: 10 ms, satisfied").wait_for(state="attached")


COLUMNS = """[...document.querySelectorAll(".editor-group-container")].map(column =>
  [column.clientWidth, ...[...column.querySelectorAll(".tab")].map(tab => tab.innerText.replaceAll("\\n", ""))])"""


@pytest.mark.scheduled
def test_the_overview_takes_at_most_half_of_the_pane_and_no_text_away(code: Workbench) -> None:
    def columns(count: int) -> list[list[Any]]:
        code.page.wait_for_function(f"count => {COLUMNS}.length === count", arg=count)
        return code.page.evaluate(COLUMNS)  # type: ignore[no-any-return]  # whatever a page's script gives

    def see_halves() -> None:
        code.page.wait_for_function(f"(columns => columns.length === 2 && columns[1][0] <= columns[0][0])({COLUMNS})")
        assert [names for _, *names in columns(2)] == [["visit.btq"], ["Overview of visit.btq"]]

    code.write("demands.btq", REQUIREMENTS)
    code.write("visit.btq", MISSION)
    code.open("visit.btq")
    code.command("btq: Open Requirements Overview Beside")
    see_halves()
    sash = code.see(".split-view-container > .monaco-sash.vertical, .grid-view-container .monaco-sash.vertical")
    column = code.page.locator(".editor-group-container").nth(1).bounding_box()
    assert sash
    assert column is not None
    code.page.mouse.move(column["x"], 400)
    code.page.mouse.down()
    code.page.mouse.move(column["x"] - 200, 400, steps=5)
    code.page.mouse.up()
    (text, *_), (overview, *_) = columns(2)
    assert overview > text
    code.focus()
    code.command("btq: Open Requirements Overview Beside")
    see_halves()
    code.focus()
    code.command("View: Join All Editor Groups")
    assert [sorted(names) for _, *names in columns(1)] == [["Overview of visit.btq", "visit.btq"]]
    code.open("visit.btq")
    code.command("btq: Open Requirements Overview Beside")
    see_halves()


def test_the_overview_beside_follows_what_is_saved_and_leads_to_the_text(code: Workbench) -> None:
    code.write("demands.btq", REQUIREMENTS)
    code.write("visit.btq", MISSION)
    code.open("visit.btq")
    code.command("btq: Open Requirements Overview Beside")
    code.see(".tab:has-text('Overview of visit.btq')")
    frame = code.page.frame_locator("iframe.webview.ready").frame_locator("#active-frame")
    row = frame.locator("#requirements tr.row", has_text="soon_there")
    row.wait_for(state="attached")
    assert "takes at most 30 s" in row.inner_text()
    assert frame.locator(".trees svg .box", has_text="Dock").count() == 1
    frame.get_by_label("Show", exact=True).fill("soon")
    row.locator(".at", has_text="demands.btq:1").click()
    code.see(".tab.active:has-text('demands.btq')")
    code.at(1, 12)
    code.cursor(2, 20)
    code.keys("Delete")
    code.type("4")
    code.save()
    frame.locator("#requirements tr.row", has_text="takes at most 34 s").wait_for(state="attached")
    assert (
        frame.get_by_label("Show", exact=True).input_value() == "soon"
    )  # the page is another, and looks like the last
    assert code.see(".tab:has-text('Overview')").inner_text() == "Overview of visit.btq"

    def ground() -> str:
        frame.locator("tr.row").first.wait_for(state="attached")
        return str(frame.locator("body").evaluate("body => getComputedStyle(body).backgroundColor"))

    assert ground() == "rgb(31, 31, 31)"
    code.settings(**{**ENVIRONMENT, "workbench.colorTheme": "Default Light Modern"})
    code.until(lambda: ground() == "rgb(255, 255, 255)", ground)
    code.settings(**ENVIRONMENT)
    code.see(".monaco-workbench.vs-dark")


@pytest.mark.scheduled
def test_saving_writes_the_xml_where_that_is_asked_for(code: Workbench) -> None:
    code.settings(**{**ENVIRONMENT, "btq.buildOnSave": True})
    code.write("built.btq", "BehaviorTree Main\n    Dock\n")
    code.open("built.btq")
    code.cursor(2, 9)
    code.type("ToBench")
    code.save()
    code.until(lambda: (code.folder / "built.xml").exists(), lambda: "no built.xml")
    assert "<DockToBench/>" in (code.folder / "built.xml").read_text()
    code.settings(**ENVIRONMENT)


@pytest.mark.scheduled
def test_the_settings_of_the_server_hold_at_once(code: Workbench) -> None:
    code.write("demands.btq", REQUIREMENTS)
    code.write("visit.btq", MISSION)
    code.write("closed.btq", WRONG)
    code.open("visit.btq")
    code.see(".codelens-decoration")
    hints = ".view-line:has-text('soon_there: time-behaviour')"
    code.see(hints)
    code.problems_of("closed.btq", 1)
    for setting, value, gone in (
        ("btq.codeLens", False, ".codelens-decoration"),
        ("btq.inlayHints", False, hints),
        ("btq.checkClosedFiles", False, ".markers-panel .monaco-list-row:has-text('closed.btq')"),
        ("btq.rules", {"unknown-node": "off"}, ".markers-panel .monaco-list-row:has-text('closed.btq')"),
    ):
        code.settings(**{**ENVIRONMENT, setting: value})
        code.no_more(gone)
        code.settings(**ENVIRONMENT)
        code.see(gone)


@pytest.mark.scheduled
def test_the_server_is_told_what_to_trace(code: Workbench, tmp_path: Path) -> None:
    """This build of VS Code writes no logs: what is said is kept by a program before the server."""
    recorder = tmp_path / "recorder"
    recorder.write_text(f'#!/bin/sh\ntee "{tmp_path}/said" | "{code.programs}/btq-lsp" "$@"\n')
    recorder.chmod(0o755)
    command = {"btq.server.command": [str(recorder)]}

    def said() -> list[str]:
        return re.findall(r'"method":"\$/setTrace","params":{"value":"(\w+)"}', (tmp_path / "said").read_text())

    code.settings(**ENVIRONMENT, **command)
    serves(code, "the setting btq.server.command")
    code.log_level("btq", "Trace")
    code.until(lambda: said() == ["messages"], lambda: str(said()))
    code.settings(**ENVIRONMENT, **command, **{"btq.trace.server": "verbose"})
    code.until(lambda: said()[-1] == "verbose", lambda: str(said()))
    code.log_level("btq", "Info")
    code.until(lambda: said()[-1] == "off", lambda: str(said()))
    code.settings(**ENVIRONMENT)


def test_building_all_missions_writes_their_xml(code: Workbench) -> None:
    code.command("btq: Build XML of All Missions")
    made = [
        code.folder / "missions" / f"{name}.{end}" for name in ("deliver", "disinfect") for end in ("xml", "qreq.json")
    ]
    code.until(lambda: all(path.exists() for path in made), lambda: str(sorted(code.folder.rglob("*"))))
    for path in [*code.folder.rglob("*.xml"), *code.folder.rglob("*.qreq.json")]:
        path.unlink()


@pytest.mark.scheduled
def test_the_path_of_a_node_is_copied(code: Workbench) -> None:
    code.write("path.btq", "BehaviorTree Main\n    -> Way\n        Dock\n        Charge\n")
    code.open("path.btq")
    code.cursor(3, 9)
    code.command("btq: Copy Path of Node")
    code.see(".statusbar-item:has-text('Main/Way/Dock')")


@pytest.mark.scheduled
def test_the_tree_of_the_active_editor_can_be_saved(code: Workbench) -> None:
    code.write("saved.btq", "BehaviorTree Main\n    Dock\n")
    code.open("saved.btq")
    code.command("btq: Save Tree as SVG…")
    box = code.page.locator(".quick-input-widget input:visible").first
    code.until(lambda: box.input_value().endswith("/saved.svg"), lambda: box.input_value())
    code.keys("Escape")
    code.gone(".quick-input-widget")


@pytest.mark.scheduled
def test_a_python_is_chosen_in_a_dialog(code: Workbench) -> None:
    code.command("btq: Choose Python Interpreter…")
    code.see(".quick-input-titlebar:has-text('The Python, 3.10 or newer, that runs btq')")
    code.keys("Escape")
    code.gone(".quick-input-widget")


@pytest.mark.scheduled
def test_the_server_starts_again(code: Workbench) -> None:
    """A server that was ended for good, as by an error, serves again."""
    code.write("wrong.btq", WRONG)
    code.open("wrong.btq")
    code.see(".squiggly-warning")
    code.command("btq: Restart Server")
    serves(code, f"btq of {sys.executable}")


def serves(code: Workbench, origin: str) -> None:
    """Wait until the status item says which server runs, and that one finds a mistake."""
    code.write("wrong.btq", WRONG)
    code.open("wrong.btq")
    code.see(".squiggly-warning, .squiggly-error")
    code.see(".statusbar-item[id='status.languageStatus'] a").hover()
    code.see(f".hover-language-status:has-text('{origin}')")
    code.focus()


def environment_of_the_python_extension(code: Workbench, tmp_path: Path) -> None:
    """The extension is one of ours with the same API; which environment is active is a setting of it."""
    settings = {name: value for name, value in ENVIRONMENT.items() if name != "btq.interpreter"}
    for name in ("one", "other"):
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", tmp_path / name], check=True)
        (packages,) = (tmp_path / name).glob("lib/python*/site-packages")
        (packages / "all.pth").write_text(
            "\n".join([str(ROOT), *(path for path in sys.path if "site-packages" in path)])
        )
        python = tmp_path / name / "bin" / "python"
        code.settings(**settings, **{"python.activeEnvironment": str(python)})
        serves(code, f"btq of {python}")
        assert code.page.locator(".notification-toast").all_inner_texts() == []
    code.settings(**ENVIRONMENT)


def path_where_the_environment_has_none(code: Workbench, tmp_path: Path) -> None:
    settings = {name: value for name, value in ENVIRONMENT.items() if name != "btq.interpreter"}
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", tmp_path / "bare"], check=True)
    for active in ({}, {"python.activeEnvironment": str(tmp_path / "bare" / "bin" / "python")}):
        code.settings(**settings, **active)
        serves(code, f"{code.programs}/btq-lsp")
    code.settings(**ENVIRONMENT)


def command_that_is_set_before_all_others(code: Workbench, tmp_path: Path) -> None:
    code.settings(**{**ENVIRONMENT, "btq.server.command": [str(code.programs / "btq-lsp"), "--log", "warning"]})
    serves(code, "the setting btq.server.command")
    code.settings(**ENVIRONMENT)


def copy_in_the_package(code: Workbench, tmp_path: Path) -> None:
    code.settings(**{**ENVIRONMENT, "btq.importStrategy": "useBundled"})
    serves(code, "the copy in the extension, Python 3.")
    code.settings(**ENVIRONMENT)


ORIGINS = [
    environment_of_the_python_extension,
    path_where_the_environment_has_none,
    command_that_is_set_before_all_others,
    copy_in_the_package,
]


@pytest.mark.scheduled
@pytest.mark.parametrize("origin", ORIGINS)
def test_the_server_is_of(code: Workbench, origin: Callable[[Workbench, Path], None], tmp_path: Path) -> None:
    origin(code, tmp_path)


def test_without_a_python_it_says_so_and_offers_help(code: Workbench) -> None:
    code.settings(**{**ENVIRONMENT, "btq.interpreter": "/no/such/python"})
    toast = code.see(".notification-toast:has-text('/no/such/python, which is not Python 3.10 or newer')")
    assert toast.locator(".notification-list-item-buttons-container a").all_inner_texts() == [
        "Choose Python…",
        "Get Python",
    ]
    code.write("main.btq", "BehaviorTree Main\n    Dock\n")
    code.open("main.btq")
    code.command("btq: Open Requirements Overview Beside")
    refusal = code.see(".notification-toast:has-text('The btq server is not running.')")
    assert refusal.locator(".notification-list-item-buttons-container a").all_inner_texts() == [
        "Restart Server",
        "Show Log",
    ]
    code.command("Notifications: Clear All Notifications")
    code.settings(**ENVIRONMENT)


def walkthrough(code: Workbench, tmp_path: Path) -> None:
    (code.folder / "new").mkdir()
    code.command("Welcome: Open Walkthrough...")
    code.choose("A checked mission in five minutes")
    code.see(".getting-started-step:has-text('Create a project')").click()
    code.see(".getting-started-step .monaco-button:has-text('New Project')").click()
    code.choose_empty(code.folder / "new")
    code.see(".tab.active:has-text('mission.btq')")
    assert {path.name for path in (code.folder / "new").iterdir()} == {"btq.toml", "mission.btq", "skills.btq"}
    code.focus()
    code.command("Welcome: Open Walkthrough...")
    code.choose("A checked mission in five minutes")
    code.see(".getting-started-step:has-text('Check the whole project')").click()
    code.see(".getting-started-step .monaco-button:has-text('Check All Missions')").click()
    # VS Code ticks the step in a new session; in this one, where the command was run before, not always.
    code.task_ends()
    code.focus_nothing()


def folder_that_is_not_open(code: Workbench, tmp_path: Path) -> None:
    """It gets a window of its own."""
    (tmp_path / "robot").mkdir()
    with code.empty_window() as window:
        window.command("btq: New Project")
        window.choose_empty(tmp_path / "robot")
        window.see(".tab.active:has-text('mission.btq')")
        window.see(".explorer-folders-view .monaco-list-row:has-text('skills.btq')")
    assert {path.name for path in (tmp_path / "robot").iterdir()} == {"btq.toml", "mission.btq", "skills.btq"}


@pytest.mark.scheduled
@pytest.mark.parametrize("begin", [walkthrough, folder_that_is_not_open])
def test_a_project_begins_in(code: Workbench, begin: Callable[[Workbench, Path], None], tmp_path: Path) -> None:
    begin(code, tmp_path)


@pytest.mark.scheduled
@pytest.mark.parametrize("theme", ["dark", "light"])
def test_how_a_mission_looks(code: Workbench, theme: str, artifacts: Path) -> None:
    # Every word of the file on one screen, and nothing between them but the colours.
    alone = {
        **{f"editor.{name}": False for name in ("codeLens", "minimap.enabled", "stickyScroll.enabled")},
        **{"editor.wordWrap": "on", "editor.inlayHints.enabled": "off", "problems.visibility": False},
    }
    code.settings(**{**ENVIRONMENT, **alone, "workbench.colorTheme": f"Default {theme.title()} Modern"})
    code.see(".monaco-workbench.vs-dark" if theme == "dark" else ".monaco-workbench.vs:not(.vs-dark)")
    code.write("every_form.btq", (ROOT / "tests" / "every_form.btq").read_text(encoding="utf-8"))
    code.page.set_viewport_size({"width": 1500, "height": 2500})
    code.open("every_form.btq")
    code.keys("Control+End")  # the window may still have its old size
    code.see(".view-line:has-text('Größe!')")
    code.see(".view-line:has-text('Every construct')")
    code.see(".view-line span span:text-is('gentleness')")
    code.gone(".squiggly-error, .squiggly-warning")
    # Comment, keyword, string, number, name of a node: five colours at least, or nothing is coloured.
    colours = code.page.evaluate(
        "new Set([...document.querySelectorAll('.view-line span span')].map(e => getComputedStyle(e).color)).size"
    )
    assert colours >= 6
    code.shot(artifacts / f"vscode-{theme}.png")
    code.page.set_viewport_size({"width": 1400, "height": 900})

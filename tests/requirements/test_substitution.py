"""What is named in many places is computed once, however often it is named: trees that run each other twice, contexts
that name each other twice.  Calls are counted, in missions where following every name would take 2³⁰ of them."""

from __future__ import annotations

import sys
from collections.abc import Callable
from itertools import islice
from pathlib import Path

import pytest
from kept_checks import Kept

from btq_lang.btcpp.document import write
from btq_lang.btcpp.enforcement import enforced
from btq_lang.btcpp.export import export
from btq_lang.btcpp.importing import import_xml
from btq_lang.btcpp.instances import instances
from btq_lang.btcpp.side_file import BuiltFile, side_file
from btq_lang.checks import check
from btq_lang.cli import main
from btq_lang.diff import compare
from btq_lang.graph import draw
from btq_lang.graph.missions import figures
from btq_lang.graph.picture import picture
from btq_lang.ide.completion import complete
from btq_lang.ide.hover import hover
from btq_lang.requirements.budgets import Budgets
from btq_lang.requirements.resolve import requirements
from btq_lang.trace import write as write_overview
from btq_lang.trace.collect import collect
from btq_lang.workspace.workspace import Workspace

MAIN = "main.btq"


def trees(count: int) -> str:
    """Each tree runs the next one twice, and gives it an entry."""
    calls = (f"SubTree T{{0}}{label} (x = {{{{x}}}})" for label in ("", " again"))
    twice = "BehaviorTree T{1}\n    input x\n    ->\n" + "".join(f"        {call}\n" for call in calls)
    return (
        "Root T0\nsignal battery : % from {battery} level initially 100 %\n"
        "QualityReq soon : time-behaviour\n    T0 takes at most 5 s\n    on violation warn\n"
        "QualityReq sure : reliability\n    T0 succeeds within 1 s\n    in at least 99 % of activations\n"
        "QualityReq likely : reliability\n    every Go succeeds within 1 s\n    in at least 99.9 % of activations\n"
        "QualityReq awake : safety\n    every Go keeps battery > 3 %\n    on violation halt\n"
        + "".join(twice.format(number + 1, number) for number in range(count))
        + f"BehaviorTree T{count}\n    input x\n    ->\n        Action Go\n"
        "        SetBlackboard (value = 3 output_key = {x})\n"
    )


def contexts(count: int) -> str:
    """Each context names the one before it twice."""
    return (
        "Root Main\nsignal battery : % from {battery} level initially 100 %\n"
        "signal speed : m/s from {speed} initially 0 m/s\ncontext c0 : battery > 3 %\n"
        + "".join(f"context c{number + 1} : c{number} and not c{number}\n" for number in range(count))
        + f"QualityReq kept : safety\n    every Go keeps c{count}\n    while c{count}\n    on violation fail\n"
        f"QualityReq timed : safety\n    every Go takes at most 1 s if c{count} else 2 s\n    on violation halt\n"
        f"QualityReq slow(limit : m/s) : safety\n    keeps speed < limit\n    needs c{count}\n    on violation fail\n"
        f"apply slow(limit = 1 m/s if c{count} else 2 m/s) to every Go\n"
        f"QualityReq after : safety\n    from when c{count} to Go starts takes at most 5 s\n"
        f"    Go starts within 5 s after when c{count}\n"
        "BehaviorTree Main\n    Action Go\n"
    )


def checked(workspace: Workspace) -> object:
    return check(workspace, MAIN)


def checked_again(workspace: Workspace) -> object:
    """As an editor checks, which keeps answers from one edit to the next."""
    answers = Kept()
    answers.check(workspace, MAIN)
    text = workspace.files[MAIN].text
    for edited in (text.replace("2 s", "3 s").replace("5 s", "6 s"), text.replace("> 3 %", "> 4 %")):
        answers.check(workspace.with_file(MAIN, edited), MAIN)
    return answers


def traced(workspace: Workspace) -> object:
    return write_overview(collect([(workspace, (MAIN,))]), "html")


def drawn(workspace: Workspace) -> object:
    return draw(figures(workspace, MAIN, True))


def previewed(workspace: Workspace) -> object:
    return picture(workspace, MAIN)


def compared(workspace: Workspace) -> object:
    other = workspace.with_file(MAIN, workspace.files[MAIN].text.replace("3 %", "4 %").replace("Go", "Drive"))
    return compare(workspace, (MAIN,), other, (MAIN,))


def budgeted(workspace: Workspace) -> object:
    found = requirements(workspace, MAIN)
    budgets = Budgets(found.store, found.viewpoint)
    first = budgets.of(found.nodes.all[0])
    return first, [(budgets.composed_of_known(each), budgets.success_of_known(each)) for each in found.nodes.all]


def exported(workspace: Workspace) -> str:
    done = export(workspace, MAIN)
    assert done.problems == ()
    return write(enforced(workspace, MAIN, done).export.document)


def asked(workspace: Workspace) -> object:
    text = workspace.files[MAIN].text
    return [
        ask(workspace, MAIN, text.rindex(word))
        for word in ("Go", "T1", "c1")
        if word in text
        for ask in (hover, complete)
    ]


ALL = (checked, checked_again, traced, drawn, previewed, compared, budgeted, exported, asked)


def calls(work: Callable[[Workspace], object], text: str) -> int:
    """How many functions are called."""
    count = 0

    def note(_frame: object, event: str, _argument: object) -> None:
        nonlocal count
        count += event == "call"

    workspace = Workspace.of({MAIN: text})
    sys.setprofile(note)
    try:
        work(workspace)
    finally:
        sys.setprofile(None)
    return count


@pytest.mark.parametrize("work", ALL)
@pytest.mark.parametrize("mission", [trees, contexts])
def test_to_name_it_twice_is_no_more_work(mission: Callable[[int], str], work: Callable[[Workspace], object]) -> None:
    work(Workspace.of({MAIN: mission(2)}))  # what is made once for all
    few, many = calls(work, mission(15)), calls(work, mission(30))
    assert many < 3 * few  # some answers name all trees above


def test_the_engine_numbers_no_more_nodes_than_a_side_file_lists() -> None:
    workspace = Workspace.of({MAIN: trees(30)})
    found = list(islice(instances([export(workspace, MAIN).document], "T0"), 70_000))
    assert [each.uid for each in found[:65_535]] == list(range(1, 65_536))
    assert all(each.uid is None for each in found[65_535:])
    assert len(found) < 65_535 + 100


def test_forty_contexts_are_built_and_imported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = contexts(40)
    (tmp_path / MAIN).write_text(text, encoding="utf-8")
    assert main(["build", str(tmp_path / MAIN)]) == 0
    said = capsys.readouterr().err
    assert said.count("its script would be longer than 10000 characters; compute it in a node") == 4
    side = tmp_path / "main.qreq.json"
    assert len(side.read_text("utf-8")) < 20_000
    (tmp_path / MAIN).unlink()
    assert main(["import", str(tmp_path / "main.xml")]) == 0
    assert (tmp_path / MAIN).read_text("utf-8") == text


def test_what_forty_contexts_need_is_counted() -> None:
    def built(workspace: Workspace) -> object:
        done = export(workspace, MAIN)
        made = enforced(workspace, MAIN, done)
        xml = write(made.export.document)
        document = (made.export.document,)
        return side_file(
            workspace, BuiltFile(MAIN, "main.xml", xml, document, made.export.elements, made.clauses)
        ), import_xml(xml)

    built(Workspace.of({MAIN: contexts(2)}))
    assert calls(built, contexts(40)) < 3 * calls(built, contexts(15))

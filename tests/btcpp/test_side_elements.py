"""What a side file says of the elements of its XML."""

from __future__ import annotations

import json
import re
from pathlib import Path

from btq_lang import build, open_workspace
from btq_lang.btcpp.marks import described
from btq_lang.btcpp.side_elements import descriptions_from

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").rglob("*.btq"))
PART = """\
QualityReq slow(limit : m/s = 0.25 m/s) : safety.operational-constraint "Slowly,
  on the ward"
    keeps speed <= limit
signal speed : m/s from {speed}
QualityReq quick : time-behaviour
    takes at most 0.5 min
    on violation fail
apply slow(limit = 36 m/h) to First/Move
Action Move
Root Main
BehaviorTree Main
    ->
        SubTree Part First
        SubTree Part Second
            satisfies quick
BehaviorTree Part
    Move satisfices ergonomics
"""


def built(folder: Path, text: str, **others: str) -> tuple[str, str]:
    """The XML and the side file of a mission."""
    for name, each in {"main": text, **others}.items():
        (folder / f"{name}.btq").write_text(each, encoding="utf-8")
    workspace = open_workspace(str(folder / "main.btq"))
    files = build(workspace, str(folder / "main.btq")).files
    of = {Path(path).name: text for path, text in files.items()}
    return of["main.xml"], of["main.qreq.json"]


def test_lines_of_elements(tmp_path: Path) -> None:
    """What holds for one of the nodes that the engine makes of an element holds for the element."""
    xml, side = built(tmp_path, PART)
    found = descriptions_from(side, xml, ())
    assert found.problem == ""
    assert {xml[at:].split()[0]: lines for at, lines in found.lines.items()} == {
        "Move": (
            "satisfices ergonomics",
            "slow(limit = 36 m/h) (operational-constraint): Slowly, on the ward; keeps speed <= limit (monitored)",
        ),
        "SubTree": ("quick (time-behaviour): takes at most 0.5 min (enforced); on violation fail",),
    }


ORDER = """\
QualityReq a
    mission takes at most 30 s
QualityReq ab(limit : s = 20 s)
    takes at most limit
QualityReq c
    every Move succeeds
QualityReq "d e" : safety "D"
    takes at most 10 s
apply ab to Move
Root Main
BehaviorTree Main
    -> satisfies "d e", ab satisfices comfort
        Move satisfices safety satisfies "d e"
"""


def test_requirements_are_in_the_order_in_which_the_build_has_described_them(tmp_path: Path) -> None:
    """What a node satisfies, as it is written, then what is applied to it, or is about it or the mission."""
    xml, side = built(tmp_path, ORDER)
    heads = {
        at: [re.split(r": | \(|\(", line)[0] for line in lines]
        for at, lines in descriptions_from(side, xml, ()).lines.items()
    }
    assert [*heads.values()] == [
        ["d e", "ab", "satisfices comfort", "a"],
        ["satisfices safety", "d e", "ab", "c"],
    ]
    shown = {at: [re.split(r": | \(|\(", line)[0] for line in lines] for at, lines in described(xml)}
    assert shown == heads


def test_nodes_after_an_include_that_has_changed(tmp_path: Path) -> None:
    """Their numbers are others now, and nothing is said of them."""
    part = "BehaviorTree Part\n    Move\n"
    text = (
        'include "part.btq"\nRoot Main\nBehaviorTree Main\n    ->\n        SubTree Part\n        Go satisfices safety\n'
    )
    xml, side = built(tmp_path, text, part=part)
    included = '<root BTCPP_format="4"><BehaviorTree ID="Part"><Move/></BehaviorTree></root>'
    longer = included.replace("<Move/>", "<Inverter><Move/></Inverter>")
    at = xml.index("Go")
    assert descriptions_from(side, xml, (included,)).lines == {at: ("satisfices safety",)}
    assert descriptions_from(side, xml, (longer,)).lines == {}
    assert descriptions_from(side, xml, ()).lines == {}


def test_side_files_that_say_nothing(tmp_path: Path) -> None:
    xml, side = built(tmp_path, PART)
    assert descriptions_from(side, f"{xml}\n", ()).problem == "belongs to other XML than this"
    newer = json.dumps({**json.loads(side), "version": 99})
    assert descriptions_from(newer, xml, ()).problem == "cannot be read by this version of btq"
    damaged = ["", "{", "[]", "{}", "[" * 100_000, side[:-40], side.replace('"uid": 2', '"uid": []')]
    damaged += [side.replace('"nodes": [3]', '"nodes": 3'), side.replace('"arguments": {', '"arguments": [], "x": {')]
    for each in damaged:
        assert each != side
        assert descriptions_from(each, xml, ()).problem == "cannot be read", each[:80]
        assert descriptions_from(each, xml, ()).lines == {}


def test_it_says_what_the_build_has_described() -> None:
    """The same requirements and qualities, in order, at each node of a main tree that has a description."""
    compared = 0
    for example in EXAMPLES:
        files = build(open_workspace(str(example)), str(example)).files
        if not files:
            continue  # scenarios, of which nothing is built
        xml = files[str(example.with_suffix(".xml"))]
        side = files.get(str(example.with_suffix(".qreq.json")))
        said = descriptions_from(side, xml, ()).lines if side is not None else {}
        for at, lines in described(xml):
            if at in said:
                assert list(map(_name, lines)) == list(map(_name, said[at]))
                compared += 1
    assert compared == 59


def _name(line: str) -> str:
    """A quality, or the name of a requirement, whose arguments are described only where they are given."""
    return line if line.startswith("satisfices") else re.split("[ (:]", line)[0]

"""`btq test --engine`: scenarios run in the engine, too, and what it does otherwise than the model is a failure."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from engine_loader import Engine
from in_process import run_btq

from btq_lang.scenarios import installed_engine
from btq_lang.simulator import kinds
from btq_lang.util.record import replace

EXAMPLES = Path(__file__).parents[2] / "examples"
SCHEMA = EXAMPLES.parent / "btq_lang" / "scenarios" / "scenarios.schema.json"
SCENARIOS = {
    "classic": 2,
    "hospital": 7,
    "inspection": 4,
    "laboratory": 4,
    "navigation": 4,
    "paper": 3,
    "pick-and-place": 5,
    "published": 11,
}
NO_NAV2 = "BehaviorTree.CPP does not have RecoveryNode"


def ran(engine: Engine, folder: Path, *arguments: str) -> tuple[int, str]:
    code, out, err = run_btq("test", *arguments, f"--engine={engine.prefix or ''}", cwd=folder)
    assert err == ""
    return code, out


@pytest.mark.parametrize("name", SCENARIOS)
@pytest.mark.usefixtures("installed")
def test_examples_run_in_the_engine_as_in_the_model(engine: Engine, name: str) -> None:
    code, out = ran(engine, EXAMPLES / name)
    reason = NO_NAV2 if name == "navigation" else ""
    if name == "hospital" and engine.version == "4.6.2":
        reason = "it is 4.6.2, and the tree is built for 4.10; use --target 4.6"
    reasons = re.findall(r"not run in the engine: (.*)", out)
    number = SCENARIOS[name]
    outcome = "unknown" if reason else "passed"
    assert reasons == [reason] * (number if reason else 0)
    assert out.splitlines()[-1] == f"{number} scenarios in BehaviorTree.CPP {engine.version}: {number} {outcome}"
    assert code == int(bool(reason))


TREE = """\
<root BTCPP_format="4" main_tree_to_execute="Main">
  <include path="other.xml"/>
  <BehaviorTree ID="Main">
    <Sequence>
      <Fallback>
        <Timeout msec="300">
          <SubTree ID="Go" place="{shelf}" found="{seen}"/>
        </Timeout>
        <AlwaysSuccess/>
      </Fallback>
      <ReactiveSequence>
        <Free distance="{distance}"/>
        <ScriptCondition code="near == false"/>
        <Delay delay_msec="50">
          <Look at="{seen}" _skipIf="seen == 'B'"/>
        </Delay>
      </ReactiveSequence>
    </Sequence>
  </BehaviorTree>
</root>
"""
OTHER = """\
<root BTCPP_format="4">
  <BehaviorTree ID="Go">
    <Sequence>
      <MoveTo place="{place}"/>
      <Find found="{found}"/>
    </Sequence>
  </BehaviorTree>
</root>
"""
CASES = """\
include "tree.xml"

Condition Free
signal distance : m from {distance}
signal near : bool from {near}

given {shelf} = "A"
given near = false
given Free answers true

scenario "in time"
    given MoveTo takes 250 ms
    given Find succeeds after 40 ms and writes found = "C"
    given Look takes 1 s
    expect mission succeeds within 1345 ms
    expect mission takes at least 1335 ms
    expect MoveTo runs "A"
    expect Look runs "C"

scenario "too late"
    given MoveTo takes 1 min
    given {seen} = "B"
    expect never node Find

scenario "once, then again"
    given {seen} = "B"
    given MoveTo fails once, then succeeds after 3 s
    given Find fails
    expect never node Look

scenario "the world changes"
    given MoveTo takes 100 ms
    given Find succeeds and writes found = "C"
    given Free answers true and writes distance = 2
    given Look takes 1 h
    when MoveTo starts : {shelf} = "Y"
    when Look starts : Free answers true, true, true and writes distance = 4
    when distance > 3 m : {shelf} = "Z"
    when 10 min have passed : near = true
    expect mission fails
    expect mission takes at least 10 min
    expect finally distance == 4 m
    expect MoveTo runs "A"
    expect finally {shelf} == "Z"

scenario "it does not end"
    given {seen} = "A"
    given MoveTo does not end
    given Look does not end
    expect mission does not end

scenario "the program halts the tree"
    given MoveTo takes 100 ms
    given Find succeeds and writes found = "C"
    given Look does not end
    when 20 s have passed : mission halts
    expect mission halts

scenario "an entry is empty"
    given MoveTo fails
    expect mission succeeds

scenario "nobody says what is found"
    given Look takes 20 ms
    expect mission succeeds
"""


OUTCOMES = [
    "passed  in time",
    "passed  too late",
    "passed  once, then again",
    "passed  the world changes",
    "passed  it does not end",
    "passed  the program halts the tree",
    "failed  an entry is empty",
    "unknown nobody says what is found",
]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "tree.xml").write_text(TREE, encoding="utf-8")
    (tmp_path / "other.xml").write_text(OTHER, encoding="utf-8")
    (tmp_path / "cases.btq").write_text(CASES, encoding="utf-8")
    return tmp_path


@pytest.mark.usefixtures("installed")
def test_all_that_scenarios_give_happens_in_the_engine(engine: Engine, folder: Path) -> None:
    """The verdicts are those of the model, so there is no difference in any of them."""
    line = ".".join(engine.version.split(".")[:2])
    _, in_model, _ = run_btq("test", "cases.btq", "--target", line, cwd=folder)
    _, out = ran(engine, folder, "cases.btq")
    assert [line.partition(" (")[0] for line in out.splitlines() if "(cases.btq" in line and line[0] != " "] == OUTCOMES
    assert out == in_model.replace(" scenarios:", f" scenarios in BehaviorTree.CPP {engine.version}:")


@pytest.mark.usefixtures("installed")
def test_what_the_engine_does_otherwise_is_a_failure(
    engine: Engine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The model is made to take an Inverter for a ForceSuccess."""

    rules = kinds._RULES
    monkeypatch.setitem(rules, "Inverter", replace(rules["Inverter"], flow=rules["ForceSuccess"].flow))
    (tmp_path / "tree.xml").write_text(
        '<root BTCPP_format="4"><BehaviorTree ID="Main"><Inverter><Go/></Inverter></BehaviorTree></root>',
        encoding="utf-8",
    )
    text = 'include "tree.xml"\n\nscenario "there"\n    given Go takes 2 s\n    expect mission succeeds\n'
    (tmp_path / "cases.btq").write_text(text, encoding="utf-8")
    assert run_btq("test", "cases.btq", cwd=tmp_path)[0] == 0
    code, out = ran(engine, tmp_path, "cases.btq")
    assert code == 1
    assert out.splitlines()[:2] == [
        "failed  there (cases.btq:3)",
        "        the engine does not do what the model does: after 2 s Inverter::1 becomes FAILURE; "
        "in the model after 2 s Inverter::1 becomes SUCCESS",
    ]


@pytest.mark.usefixtures("installed")
def test_the_engine_is_in_documents(engine: Engine, folder: Path) -> None:
    _, out = ran(engine, folder, "cases.btq", "-k", "in time", "--format", "json")
    document = json.loads(out)
    assert (document["engine"], document["scenarios"][0]["outcome"]) == (engine.version, "passed")
    assert {*document} <= {*json.loads(SCHEMA.read_text(encoding="utf-8"))["properties"]}


CRASH = """\
<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    <Timeout msec="20">
      <Go _onHalted="nothing_there + 1"/>
    </Timeout>
  </BehaviorTree>
</root>
"""


@pytest.mark.usefixtures("installed")
def test_an_exception_in_the_thread_of_a_timer_ends_the_process(engine: Engine, tmp_path: Path) -> None:
    (tmp_path / "tree.xml").write_text(CRASH, encoding="utf-8")
    text = 'include "tree.xml"\n\nscenario "there"\n    given Go does not end\n    expect mission fails\n'
    (tmp_path / "cases.btq").write_text(text, encoding="utf-8")
    code, out = ran(engine, tmp_path, "cases.btq")
    assert code == 1
    assert out.splitlines()[1].startswith("        the engine does not do what the model does: it ends its process: ")


@pytest.mark.usefixtures("installed")
def test_a_run_that_takes_long_is_not_run(engine: Engine, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(installed_engine, "_SECONDS", 1)
    text = (folder / "cases.btq").read_text(encoding="utf-8").replace("Look takes 1 h", "Look takes 900 h")
    (folder / "cases.btq").write_text(text.replace("10 min have", "900 h have"), encoding="utf-8")
    code, out = ran(engine, folder, "cases.btq", "-k", "world")
    assert (code, out.splitlines()[1]) == (
        1,
        "        not run in the engine: it takes longer than 1 s, if it ever ends",
    )

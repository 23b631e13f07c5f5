"""What `btq test --rules` writes: with it the engine does what the model of the engine does in the scenario."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest
from engine_loader import Engine
from in_process import run_btq

from btq_lang.catalog.versions import at_least
from btq_lang.projects.opening import open_workspace
from btq_lang.scenarios.installed_engine import InstalledEngine
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.scenarios.plan import Plan
from btq_lang.scenarios.replay import Job, moments_of
from btq_lang.scenarios.results import ScenarioResult
from btq_lang.scenarios.rules import NoRules, substitution_rules
from btq_lang.scenarios.running import run
from btq_lang.scenarios.suite import Suite
from btq_lang.scenarios.tape import Event, Moment, Tape
from btq_lang.simulator.nodes import RUNNING, STATUS_NAMES

ROOT = Path(__file__).parents[2]

TREE = """\
<root BTCPP_format="4" main_tree_to_execute="Deliver">
  <BehaviorTree ID="Deliver">
    <Sequence>
      <SubTree ID="Visit" station="A" name="first"/>
      <Fallback>
        <SubTree ID="Visit" station="E" name="second"/>
        <MoveTo location="B"/>
      </Fallback>
      <ScriptCondition code="place == 3 &amp;&amp; floor == 2"/>
      <Fallback>
        <Inverter>
          <Condition ID="BatteryLow"/>
        </Inverter>
        <RetryUntilSuccessful num_attempts="4">
          <Dock place="{place}"/>
        </RetryUntilSuccessful>
      </Fallback>
      <Wait _skipIf="place == 3"/>
    </Sequence>
  </BehaviorTree>
  <BehaviorTree ID="Visit">
    <Sequence>
      <MoveTo location="X"/>
      <Look place="{@place}"/>
    </Sequence>
  </BehaviorTree>
</root>
"""
CASES = """\
include "tree.xml"

Condition BatteryLow
Action MoveTo
Action Dock
Action Look
Action Wait

given {@floor} = 2
given Look succeeds and writes place = 3

scenario "all at once"
    given BatteryLow answers false
    expect mission succeeds

scenario "it takes time"
    given BatteryLow answers true
    given every MoveTo takes 20 ms
    given second/MoveTo fails after 30 ms
    expect mission succeeds

scenario "nobody gets anywhere"
    given every MoveTo fails
    expect mission fails at least 1 per run

scenario "docking is difficult"
    given BatteryLow answers true
    given Dock fails twice, then succeeds
    expect mission succeeds
"""


@pytest.mark.parametrize("title", re.findall('scenario "(.*)"', CASES))
def test_the_engine_does_what_the_model_does(engine: Engine, title: str, tmp_path: Path) -> None:
    (tmp_path / "tree.xml").write_text(TREE, encoding="utf-8")
    (tmp_path / "cases.btq").write_text(CASES, encoding="utf-8")
    if title == "docking is difficult" and not at_least(engine.version, "4.10"):
        pytest.skip("this version has no return_status_script")
    assert _changes_in_engine(engine, tmp_path, title, TREE) == _changes_in_model(tmp_path, title)


# Of each example, the scenarios that rules say, and those that they do not.
EXAMPLES = {
    "classic": (2, 0),
    "hospital": (4, 3),
    "inspection": (2, 2),
    "laboratory": (2, 2),
    "paper": (3, 0),
    "pick-and-place": (2, 3),
    "published": (6, 5),
}


@pytest.mark.parametrize("name", EXAMPLES)
def test_examples_do_what_the_model_does(engine: Engine, installed: InstalledEngine, name: str) -> None:
    """Under virtual time, all nodes that ever run; others are asked again at every tick."""
    if not at_least(engine.version, "4.10"):
        pytest.skip("this version has no return_status_script")
    reasons = []
    compared = 0
    for mission, plan in _planned(ROOT / "examples" / name):
        try:
            rules = substitution_rules(mission, plan)
        except NoRules as reason:
            reasons.append(str(reason))
            continue
        tape = Tape()
        job = Job(mission, plan, tape)
        data = job.data(run(mission, plan, tape=tape))
        counters = [{"key": key, "value": 0.0} for key in re.findall(r"btq_\d+", "".join(rules.entries))]
        answer = installed.run({**data, "rules": rules.text, "given": [*_list(data["given"]), *counters]})
        ours = _lasting(tape.moments())
        assert _lasting(moments_of(answer["moments"], job.unsaid)) == ours
        compared += 1
    assert (compared, len(reasons)) == EXAMPLES[name]
    assert set(reasons) <= {"rules cannot say what a `when` changes"}


def _planned(folder: Path) -> Iterator[tuple[ScenarioMission, Plan]]:
    """What the scenarios below a folder say."""
    for path in sorted(folder.rglob("*.btq")):
        suite = Suite(open_workspace(str(path)))
        for place, _ in suite.places(str(path)):
            planned = suite.planned(place)
            assert not isinstance(planned, ScenarioResult)
            yield planned[1:]


def _list(value: object) -> list[object]:
    assert isinstance(value, list)
    return value


def _lasting(moments: Iterable[Moment]) -> list[tuple[int, Event]]:
    """The changes of the statuses of nodes that ever run, with their times."""
    changes = [(moment.first, each) for moment in moments for each in moment.events if isinstance(each[1], int)]
    lasting = {uid for _, (uid, status) in changes if status == RUNNING}
    return [change for change in changes if change[1][0] in lasting]


def _changes_in_engine(engine: Engine, folder: Path, title: str, xml: str) -> list[tuple[int, str]]:
    """Each change of a status, with the rules of a scenario."""
    if not at_least(engine.version, "4.7"):
        pytest.skip("no rules are written for this version")
    target = ".".join(engine.version.split(".")[:2])
    arguments = "test", "cases.btq", "-k", title, "--rules", "rules.json", "--target", target
    code, out, err = run_btq(*arguments, cwd=folder)
    assert (code, out) == (0, "wrote rules.json\n"), err
    answer = engine.run_one(
        xml,
        blackboard={key: float(value) for key, value in re.findall(r"set the entry (\w+) = (\S+) before", err)},
        rules=(folder / "rules.json").read_text(encoding="utf-8"),
        ticks=2000,
        tick_ms=5,
    )
    assert answer.error == ""
    return [(uid, after) for _, uid, _, after in answer.transitions]


def _changes_in_model(folder: Path, title: str) -> list[tuple[int, str]]:
    path = str(folder / "cases.btq")
    suite = Suite(open_workspace(path))
    ran = suite.ran(next(place for place, name in suite.places(path) if name == title), False)
    assert ran.result.outcome == "passed", ran.result
    assert ran.run is not None
    return [(uid, STATUS_NAMES[status]) for _, uid, status in ran.run.rows]

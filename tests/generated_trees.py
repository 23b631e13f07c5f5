"""Five tasks as scenarios over trees that language models wrote for them."""

from __future__ import annotations

import re
from functools import cache
from itertools import chain, combinations

from btq_lang.btcpp.opening import file_of
from btq_lang.projects.cpp_files import CppFiles
from btq_lang.scenarios.results import ScenarioResult
from btq_lang.scenarios.suite import Suite
from btq_lang.workspace.config import Project
from btq_lang.workspace.factories import Factory
from btq_lang.workspace.file import File
from btq_lang.workspace.workspace import Workspace

# Each station in its turn, with the one that stands in for it if it cannot be reached.
TASKS = {
    "1": ["A"],
    "2": ["A", "B", "C", "D"],
    "3": ["A", "EB", "C", "D"],
    "4": ["A", "EB", "FC", "D"],
    "5": ["AB", "EB", "FC", "DC"],
}
ROBOT = """
class MoveTo : public BT::StatefulActionNode
{
public:
  static BT::PortsList providedPorts() { return { BT::InputPort<std::string>("location") }; }
};
void registerNodes(BT::BehaviorTreeFactory& factory) { factory.registerNodeType<MoveTo>("MoveTo"); }
"""
PORT = re.compile(r'(\blocation\s*=\s*")([^"]*)"')


@cache
def robot_sources() -> dict[str, File]:
    """The program, which registers one action."""
    return CppFiles().files({"robot.cpp": ROBOT})[1]


def scenarios(task: str) -> list[str]:
    """The scenarios of a task, by which stations cannot be reached: none first."""
    replaceable = [stations[0] for stations in TASKS[task] if len(stations) > 1]
    subsets = chain.from_iterable(combinations(replaceable, number) for number in range(len(replaceable) + 1))
    return [scenario(TASKS[task], unreachable) for unreachable in subsets]


def scenario(turns: list[str], unreachable: tuple[str, ...]) -> str:
    visits = chain.from_iterable(turn if turn[0] in unreachable else turn[:1] for turn in turns)
    givens = "".join(f'    given MoveTo (location = "{station}") fails\n' for station in unreachable)
    wanted = ", ".join(f'"{station}"' for station in visits)
    return f'scenario "unreachable={{{",".join(unreachable)}}}"\n{givens}    expect MoveTo runs {wanted}\n'


def without_station(match: re.Match[str]) -> str:
    value = match[2].replace(" ", "").replace("_", "")
    return f'{match[1]}{value.removeprefix("Station")}"'


def suite_of(xml: str, task: str) -> Suite:
    """A tree with the scenarios of a task."""
    case = "\n".join(['include "tree.xml"', *scenarios(task)])
    files = {"tree.xml": file_of("tree.xml", PORT.sub(without_station, xml)), "case.btq": File("case.btq", case)}
    robot = Factory(
        "robot", nodes=("robot.cpp",), files=tuple(files), node_files=("robot.cpp",), cpp_files=("robot.cpp",)
    )
    return Suite(Workspace({**files, **robot_sources()}, Project(engines=("4.10",)), robot))


def results(xml: str, task: str) -> list[ScenarioResult]:
    """The results of the scenarios of a task, up to the first that is not passed."""
    suite = suite_of(xml, task)
    ran: list[ScenarioResult] = []
    for place, _ in suite.places("case.btq"):
        ran.append(suite.result(place, False))
        if ran[-1].outcome != "passed":
            break
    return ran

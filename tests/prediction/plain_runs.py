"""A drawn run by the simulator's own driver, which remembers nothing: what `LoadedRuns` must do too."""

from __future__ import annotations

from btq_lang.prediction.prepared import PreparedMission
from btq_lang.prediction.states import States
from btq_lang.scenarios.running import why_unknown
from btq_lang.simulator.blackboard import DOUBLE, type_of
from btq_lang.simulator.drivers import drive, halt_tree
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.loading import load
from btq_lang.simulator.nav2_answered import set_answered
from btq_lang.simulator.nodes import RUNNING, STATUS_NAMES, Machine, SimulatedNode

Row = tuple[int, int, int]


def plain_run(prepared: PreparedMission, seed: int, number: int) -> tuple[str, int, list[Row]]:
    """How a run ends, when, and each change of a status."""
    mission, robot = prepared.mission, prepared.loaded.robot
    loaded = robot.machine
    board = mission.program.board()
    for course in robot.courses:
        settings = course.settings
        if settings.entry and settings.is_constant:
            board.define(settings.entry, settings.start, type_of(settings.start))
        elif settings.entry:
            board.define(settings.entry, robot.live[settings.name], DOUBLE)
    rows: list[Row] = []

    def changed(node: SimulatedNode, before: int, after: int) -> None:
        rows.append((machine.now, node.uid, after))

    machine: Machine = load(mission.documents, mission.name, mission.dialect, robot, changed, board, mission.actions)
    robot.machine = machine
    for node in machine.nodes:
        set_answered(node, robot)
    states = States(machine, robot.asker)

    def look() -> bool:
        values = states.keep_values()
        numbers = [value.value() for _, value in values]
        for (own, _), number in zip(values, numbers, strict=True):
            own.kept = number
        running = {node.uid for node in machine.nodes if node.status == RUNNING}
        for course in robot.courses:
            course.turn(machine.now, course.settings.rate_with(running))
        return False

    robot.begin_run(seed, number)
    try:
        result = drive(machine, mission.program.driver, prepared.loaded.limit, look)
        look()
        end = STATUS_NAMES[result]
        if result == RUNNING:
            halt_tree(machine)
    except EngineError as error:
        end = str(error)
    except NotModelled as error:
        end = why_unknown(machine.nodes, error, has_givens=False)
    robot.machine = loaded
    return end, machine.now, rows

"""`btq explore -o case.btq` and `--show`: the runs that answer questions, as scenarios, logs and drawings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from btq_lang.commands.output import write_file, write_output
from btq_lang.exploration.report import Explored
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import Refused
from btq_lang.render.cells import printable
from btq_lang.scenarios.btlog import as_btlog
from btq_lang.scenarios.explored import drawn, scenario_file, witnessed
from btq_lang.scenarios.witnessed import WitnessedScenario
from btq_lang.util.text import counted
from btq_lang.workspace.loader import absolute


def write_runs(explored: Sequence[Explored], output: str, messages: CommandOutput) -> None:
    """Write the runs that were found as scenarios, or the only one as a log.

    Raises:
        Refused: several missions were explored, or several runs found for a log, or the file cannot be written.
    """
    if len(explored) > 1:
        raise Refused(f"-o {output} takes the runs of one mission; name one")
    scenarios = _scenarios(explored[0], absolute(output), messages)
    if not scenarios:
        messages.remark(f"btq explore: there is no run to write to {output}")
    elif output.endswith(_LOG):
        if len(scenarios) > 1:
            raise Refused(f"-o {output} takes one run, and there are {len(scenarios)}; ask one question")
        write_file(output, as_btlog(scenarios[0].mission.tree, scenarios[0].run))
    else:
        write_output(messages, output, scenario_file(explored[0], absolute(output), scenarios))
        messages.remark(f"{counted(len(scenarios), 'run')} in {output}: run with btq test {output}")


def drawn_runs(explored: Sequence[Explored], messages: CommandOutput) -> str:
    """The runs that were found, as `btq test --show` draws them."""
    lines = [line for each in explored for line in drawn(_scenarios(each, f"{each.mission.path}.runs.btq", messages))]
    return "".join(f"{printable(line)}\n" for line in lines)


def _scenarios(explored: Explored, path: str, messages: CommandOutput) -> list[WitnessedScenario]:
    """The runs as scenarios in a file."""
    scenarios: list[WitnessedScenario] = []
    for witness, scenario in witnessed(explored, path):
        if scenario is None:
            messages.remark(f"btq explore: no scenario says what happens in the run of `{witness.title}`")
        else:
            scenarios.append(scenario)
    return scenarios


_LOG: Final = ".btlog"
RUN_SUFFIXES: Final = (".btq", _LOG)

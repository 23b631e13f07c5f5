"""How long drawn runs take: 1,000 of the laboratory with verdicts, beside parsing and building its mission.

One invariant: both take turns in one process, and times are of the processor.  The skills are those of this file, so
that all of them are drawn.
"""

from __future__ import annotations

import statistics
import time

from report import Goal, machine, options, shown
from scenarios import MISSION, built, seconds

from btq_lang.prediction.predicting import BLOCK, Predictor, Recipe
from btq_lang.scenarios.mission import as_program, main_tree
from btq_lang.util.record import replace
from btq_lang.workspace.config import Project, parse_project
from btq_lang.workspace.workspace import Workspace

ROUNDS = 5
RUNS = 1_000
SKILLS = """
[simulate.skills]
ToSolidStation = { takes = ["9 s", "16 s"], succeeds = "99.7 %" }
ToCharger = { takes = ["14 s", "24 s"] }
Pick = { takes = ["4 s", "7 s"], succeeds = "99.7 %", writes = { "@tubes" = "@tubes - 1" } }
ReadLabel = { takes = ["1.5 s", "3 s"] }
Place = { takes = ["4 s", "6 s"] }
Charge = { takes = "1 h" }
BatteryFull = { is = "battery >= 95 %" }
MicroplateNotEmpty = { is = "{tubes} > 0" }
SensorsAlive = { fails = "1 per 8 h", for = "2 s" }

[simulate.world]
"{tubes}" = { start = 6 }
label_traffic = { start = "0 kB" }

[simulate.world.battery]
start = "60 %"
rate = "-0.1 %/s"
while = { MoveBase = "-0.5 %/s", Charge = "+1 %/s" }
between = ["0 %", "100 %"]
"""


def main() -> None:
    options(__doc__).parse_args()
    text = MISSION.read_text(encoding="utf-8")
    project = replace(Project(), simulation=parse_project(SKILLS)[0].simulation)
    workspace = Workspace.of({"mission.btq": text}, project)
    tree = main_tree(workspace, "mission.btq")
    recipe = Recipe(as_program(workspace, "mission.btq", tree), "mission.btq", tree, True, None, 1)
    quotients = []
    for _ in range(ROUNDS):
        reference = seconds(lambda: [built(text) for _ in range(100)]) / 100
        begin = time.process_time()
        predictor = Predictor(recipe)
        sums = predictor.evaluation()
        for number in range(RUNS // BLOCK):
            block = predictor.block(number, RUNS)
            sums.findings.add(block.findings, number * BLOCK)
        verdicts = sums.verdicts()
        took = time.process_time() - begin
        quotients.append(took / reference)
        print(f"{RUNS:,} runs, {len(verdicts)} verdicts: {took:.2f} s; the mission: {reference * 1e3:.2f} ms")
    print(machine())
    middle = statistics.median(quotients)
    print(*shown([Goal("1,000 runs over parsing and building their mission, at most 150", middle, middle <= 150)]))


if __name__ == "__main__":
    main()

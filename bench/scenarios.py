"""How long scenarios take: those of trees that language models wrote, beside parsing and building a mission.

One invariant: both take turns in one process, and times are of the processor.  The trees are those of
`shared/corpus/generated`, or of the folder that `BTQ_SHARED` names; a scenario is read, checked, run and judged.
"""

from __future__ import annotations

import csv
import os
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

from report import Goal, machine, options, shown

from btq_lang.btcpp.document import write
from btq_lang.btcpp.outputs import as_xml
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

ROOT = Path(__file__).resolve().parents[1]
SHARED = Path(os.environ.get("BTQ_SHARED") or ROOT.parent / "shared")
MISSION = ROOT / "examples" / "laboratory" / "mission.btq"
ROUNDS = 5


def main() -> None:
    sys.path.append(str(ROOT / "tests"))
    from generated_trees import results

    options(__doc__).parse_args()
    text = MISSION.read_text(encoding="utf-8")
    with open(SHARED / "corpus/generated/TRUTH.tsv", encoding="utf-8") as rows:
        trees = [(row["file"], row["task"]) for row in csv.DictReader(rows, delimiter="\t")]
    texts = [((SHARED / "corpus/generated" / name).read_text(encoding="utf-8"), task) for name, task in trees]
    quotients = []
    for _ in range(ROUNDS):
        reference = seconds(lambda: [built(text) for _ in range(100)]) / 100
        number = 0
        begin = time.process_time()
        for xml, task in texts:
            number += len(results(xml, task))
        each = (time.process_time() - begin) / number
        quotients.append(each / reference)
        print(f"{number} scenarios, {each * 1e3:.2f} ms each; the mission: {reference * 1e3:.2f} ms")
    print(machine())
    middle = statistics.median(quotients)
    print(*shown([Goal("a scenario over parsing and building a mission, at most 1", middle, middle <= 1)]))


def built(text: str) -> str:
    """The XML of a mission, from its text."""
    workspace = Workspace.of({"mission.btq": text}, Project())
    return write(as_xml(workspace, "mission.btq").export.document)


def seconds(work: Callable[[], object]) -> float:
    """The time of the processor that some work takes."""
    begin = time.process_time()
    work()
    return time.process_time() - begin


if __name__ == "__main__":
    main()

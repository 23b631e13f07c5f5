"""The pages of rules about logs: their examples, judged by the log on the page."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

from check_asserts import Announced, announced
from evidence_logs import as_logged, btlog, rows

from btq_lang.btcpp.document import write
from btq_lang.btcpp.outputs import as_xml
from btq_lang.checks import findings
from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.json_document import read_verdicts, render
from btq_lang.evidence.judging import Means
from btq_lang.evidence.verifying import verify
from btq_lang.ide.verdicts import ProjectVerdicts, verdict_findings
from btq_lang.util.text import LineIndex
from btq_lang.workspace.workspace import Workspace

RULES_OF_LOGS = ("requirement-violated", "never-exercised")
_LOG = re.compile(r"^```text\n(?P<rows>.*?)^```$", re.DOTALL | re.MULTILINE)


def assert_marked_by_log(page: str, text: str, folder: Path) -> None:
    """What the log on a page shows of an example is exactly what comments in that announce."""
    log = _LOG.search(page)
    assert log is not None
    workspace = Workspace.of({"main.btq": text})
    xml = as_logged(write(as_xml(workspace, "main.btq").export.document))
    (folder / "run.btlog").write_bytes(btlog(xml, rows(log["rows"])))
    mission = Candidate(workspace, "main.btq", "main", None)
    logs = [str(folder / "run.btlog")]
    report = verify(logs, Means([mission], with_measures=True))
    (found,) = read_verdicts(render(report))
    seen = verdict_findings(workspace, "main.btq", ProjectVerdicts(str(folder), {"main.btq": found}))
    shown: Announced = Counter(
        ("main.btq", LineIndex(text).position(each.span.start).line, each.effective_severity.value, each.rule)
        for each in findings(workspace.store, "main.btq", seen).diagnostics
    )
    assert shown == announced("main.btq", text)

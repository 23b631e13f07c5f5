"""The golden files: `golden/x.btq` is written as `golden/x.xml`, and the export's remarks are `golden/x.remarks`.

What its requirements add is in it, and the remarks tell how each clause is enforced.  A file whose name ends in
`_verbatim` is written verbatim.  `pytest --update` writes what is written today: read the difference before it is
committed.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree

from btq_lang.btcpp.document import write
from btq_lang.btcpp.enforcement import Enforcement, enforced
from btq_lang.btcpp.export import export
from btq_lang.util.text import LineIndex
from btq_lang.workspace.workspace import Workspace

GOLDEN = Path(__file__).parent / "golden"
SOURCES = sorted(GOLDEN.glob("*.btq"))


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.stem)
def test_a_file_is_written_as_its_golden_file(path: Path, update: bool) -> None:
    with path.open(encoding="utf-8", newline="") as file:
        text = file.read()
    # The files of the folder are one project: some include others.
    workspace = Workspace.of({other.name: other.read_text(encoding="utf-8") for other in SOURCES} | {path.name: text})
    is_verbatim = path.stem.endswith("_verbatim")
    done = export(workspace, path.name, verbatim=is_verbatim)
    enforcement = Enforcement(done, ()) if is_verbatim else enforced(workspace, path.name, done)
    done = enforcement.export
    lines = LineIndex(text)
    remarks = [
        f"{lines.position(remark.span.start).line + 1}: {kind}: {remark.message}"
        for kind, found in (("repair", done.repairs), ("problem", done.problems))
        for remark in found
    ]
    remarks += [
        f"{each.requirement}: {each.way}: {each.clause}{f': {each.why}' if each.why else ''}"
        for applied in enforcement.clauses
        for each in applied
        if each.asked
    ]
    xml = write(done.document)
    if not done.problems:
        etree.fromstring(xml.encode())
    assert_golden(path.with_suffix(".xml"), xml, update)
    assert_golden(path.with_suffix(".remarks"), "".join(f"{line}\n" for line in remarks), update)


def test_every_golden_file_is_used() -> None:
    used = {source.with_suffix(suffix) for source in SOURCES for suffix in (".btq", ".xml", ".remarks")}
    assert [path.name for path in sorted(GOLDEN.iterdir()) if path not in used] == []


def assert_golden(path: Path, text: str, update: bool) -> None:
    """Compare a file with a text; an empty text is no file."""
    if update:
        if text:
            path.write_text(text, encoding="utf-8", newline="")
        else:
            path.unlink(missing_ok=True)
    assert (path.read_bytes().decode() if path.exists() else "") == text

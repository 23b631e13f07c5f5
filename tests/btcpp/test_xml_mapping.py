"""docs/xml-mapping.md and docs/enforcement.md: each mission becomes the XML that is below it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from btq_lang.btcpp.document import write
from btq_lang.btcpp.enforcement import enforced
from btq_lang.btcpp.export import export
from btq_lang.workspace.workspace import Workspace

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGES = {name: (DOCS / name).read_text(encoding="utf-8") for name in ("xml-mapping.md", "enforcement.md")}
PAIR = re.compile(r"^```btq(?: classic)?\n(.*?)^```\n\n```xml\n(.*?)^```$", re.DOTALL | re.MULTILINE)
PAIRS = [pair for page in PAGES.values() for pair in PAIR.findall(page)]


@pytest.mark.parametrize("name", PAGES)
def test_every_example_has_both_sides(name: str) -> None:
    page = PAGES[name]
    assert (
        len(PAIR.findall(page))
        == len(re.findall(r"^```btq( classic)?$", page, re.MULTILINE))
        == len(re.findall(r"^```xml$", page, re.M))
    )


@pytest.mark.parametrize(("mission", "xml"), PAIRS, ids=[mission.split("\n")[0] for mission, _ in PAIRS])
def test_a_mission_becomes_its_xml(mission: str, xml: str) -> None:
    workspace = Workspace.of({"main.btq": mission})
    done = export(workspace, "main.btq")
    assert done.problems == ()
    xml_now = write(enforced(workspace, "main.btq", done).export.document)
    assert f"\n{stripped(xml)}" in f"\n{stripped(xml_now)}"


def stripped(xml: str) -> str:
    """Without what stands before a line: an example begins further left than the file."""
    return "".join(f"{line.strip()}\n" for line in xml.splitlines())

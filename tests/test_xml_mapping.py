"""docs/xml-mapping.md: each mission becomes the XML that stands below it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from btq_lang.btcpp.document import write
from btq_lang.btcpp.export import export
from btq_lang.workspace import Workspace

PAGE = (Path(__file__).resolve().parents[1] / "docs" / "xml-mapping.md").read_text(encoding="utf-8")
PAIRS = re.findall(r"^```btq(?: classic)?\n(.*?)^```\n\n```xml\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)


def test_every_example_has_both_sides() -> None:
    assert (
        len(PAIRS)
        == len(re.findall(r"^```btq( classic)?$", PAGE, re.MULTILINE))
        == len(re.findall(r"^```xml$", PAGE, re.M))
    )


@pytest.mark.parametrize(("mission", "xml"), PAIRS, ids=[mission.split("\n")[0] for mission, _ in PAIRS])
def test_a_mission_becomes_its_xml(mission: str, xml: str) -> None:
    done = export(Workspace.of({"main.btq": mission}), "main.btq")
    assert done.problems == ()
    assert f"\n{stripped(xml)}" in f"\n{stripped(write(done.document))}"


def stripped(xml: str) -> str:
    """Without what stands before a line: an example begins further left than the file."""
    return "".join(f"{line.strip()}\n" for line in xml.splitlines())

"""The first page of the documentation says that the engine loads the XML in which it shows findings."""

from __future__ import annotations

import re
from pathlib import Path

from engine_loader import Engine

PAGE = (Path(__file__).resolve().parents[2] / "docs/README.md").read_text(encoding="utf-8")


def test_the_xml_of_the_first_page_loads(engine: Engine) -> None:
    (xml,) = re.findall(r"^```xml\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)
    answer = engine.run_one(xml, every_tree=True)
    assert (answer.stage, answer.error) == ("done", "")
    assert {*answer.trees} == {"Deliver", "HandOver"}

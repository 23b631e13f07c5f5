"""Random trees do in an installed engine, under virtual time, what they do in the model: every change of a status."""

from __future__ import annotations

import re
from pathlib import Path
from random import Random

import pytest
from drawn_runs import compared, drawn_run, told
from seeds import seeds

from btq_lang.scenarios.installed_engine import InstalledEngine
from btq_lang.simulator import kinds
from btq_lang.util.record import replace


def test_random_trees_run_as_in_the_model(installed: InstalledEngine, tmp_path: Path) -> None:
    count = 0
    for seed in seeds(300):
        drawn = drawn_run(Random(seed), installed.line)
        differs = compared(drawn, installed, tmp_path)
        assert not differs, told(seed, drawn, installed, tmp_path)
        count += differs is not None
    assert count > 290


def test_a_mistake_of_the_model_is_found_and_made_small(
    installed: InstalledEngine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The model is made to take an Inverter for a ForceSuccess."""
    rules = kinds._RULES
    monkeypatch.setitem(rules, "Inverter", replace(rules["Inverter"], flow=rules["ForceSuccess"].flow))
    for seed in seeds(300):
        drawn = drawn_run(Random(seed), installed.line)
        if compared(drawn, installed, tmp_path):
            break
    seed_line, xml, *_ = told(seed, drawn, installed, tmp_path).splitlines()
    assert seed_line.startswith(f"seed {seed}: ")
    assert re.findall(r"<(\w+)", xml.partition("</BehaviorTree>")[0])[:-1] == ["root", "BehaviorTree", "Inverter"]

"""The table `[simulate]` of a project file: its settings, and what is reported about errors in it."""

from __future__ import annotations

import pytest
from test_config import problems

from btq_lang.catalog.units import parse_unit
from btq_lang.workspace.config import parse_project
from btq_lang.workspace.project_driver import Driver
from btq_lang.workspace.project_simulation import SaidValue, SkillSetting, Spread, WorldSetting

WHOLE = """\
[simulate]
driver = { tick_once = "0.1 s" }
[simulate.skills]
MoveBase = { takes = { median = "18 s", p95 = "27 s" }, succeeds = "99 %" }
"BatteryCheck/MoveBase" = { takes = ["12 s", "20 s"] }
Dock = { takes = { from = "500 ms", to = "1 min" } }
Pick = { takes = "6 s", succeeds = "97 %", writes = { tubes = "tubes - 1", is_held = true, pose = 3 } }
BatteryFull = { is = "battery  >= 95 %" }
SensorsAlive = { fails = "1 per 8 h", for = "2 s" }
CameraWorks = { is = "{light} > 3", fails = "0.5 per min", for = "1 s" }
[simulate.world]
battery = { start = "60 %", rate = "-0.05 %/s", while = { Charge = "+1 %/s" }, between = ["0 %", "100 %"] }
person_near = { start = false }
"{light}" = { start = 5, rate = "0.5 1/s" }
zone = { start = "hall" }
"""
PERCENT = parse_unit("%")
PERCENT_PER_SECOND = parse_unit("%/s")


def test_every_key() -> None:
    project, wrong = parse_project(WHOLE)
    assert wrong == ()
    assert project.simulation is not None
    assert project.simulation.driver == Driver("tick_once", 100)
    assert project.simulation.skills == (
        SkillSetting("MoveBase", Spread("lognormal", 18.0, 27.0), 0.99),
        SkillSetting("BatteryCheck/MoveBase", Spread("uniform", 12.0, 20.0)),
        SkillSetting("Dock", Spread("uniform", 0.5, 60.0)),
        SkillSetting(
            "Pick", Spread("fixed", 6.0, 6.0), 0.97, (("tubes", "tubes - 1"), ("is_held", "true"), ("pose", "3"))
        ),
        SkillSetting("BatteryFull", condition="battery >= 95 %"),
        SkillSetting("SensorsAlive", fails=1 / 28_800, lasts=2.0),
        SkillSetting("CameraWorks", condition="{light} > 3", fails=0.5 / 60, lasts=1.0),
    )
    assert project.simulation.world == (
        WorldSetting(
            "battery",
            SaidValue(60.0, PERCENT),
            SaidValue(-0.05, PERCENT_PER_SECOND),
            (("Charge", SaidValue(1.0, PERCENT_PER_SECOND)),),
            (SaidValue(0.0, PERCENT), SaidValue(100.0, PERCENT)),
        ),
        WorldSetting("person_near", SaidValue(False)),
        WorldSetting("{light}", SaidValue(5.0), SaidValue(0.5, parse_unit("1/s"))),
        WorldSetting("zone", SaidValue("hall")),
    )


def test_what_is_right_is_kept() -> None:
    project, _ = parse_project(WHOLE.replace('"97 %"', '"970 %"').replace('"60 %"', '"60 percents"'))
    assert project.simulation is not None
    assert "Pick" not in [each.name for each in project.simulation.skills]
    assert len(project.simulation.skills) == 6
    assert [each.signal for each in project.simulation.world] == ["person_near", "{light}", "zone"]


SKILLS = "[simulate.skills]\n"
WORLD = "[simulate.world]\n"
TABLE = 'a table with one function such as { tick_once = "10 ms" }'
TAKES = (
    '`simulate.skills.Pick.takes` must be a duration such as "6 s", two that it lies between such as ["12 s", "20 s"], '
    'or a table such as { median = "18 s", p95 = "27 s" }'
)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("simulate = 1", "1:1: `simulate` must be a table"),
        ("[simulate]\nskill = {}", "2:1: unknown key `simulate.skill`; did you mean `skills`?"),
        ("[simulate]\nskills = 1", "2:1: `simulate.skills` must be a table of skills"),
        *[
            (f"[simulate]\ndriver = {value}", f"2:1: `simulate.driver` must be {TABLE}")
            for value in ('"tick_once"', "{}", '{ tick_once = "1 s", tick_exactly_once = "1 s" }')
        ],
        (
            '[simulate]\ndriver = { tick_onc = "10 ms" }',
            "2:12: `simulate.driver` has an unknown function `tick_onc`; did you mean `tick_once`?",
        ),
        *[
            (
                f"[simulate]\ndriver = {{ tick_once = {time} }}",
                f'2:12: `simulate.driver` must give `tick_once` {what} such as "10 ms"',
            )
            for times, what in (
                (("10", '"10"'), "a duration"),
                (('"10 m"', '"0 ms"', '"1.5 ms"'), "whole milliseconds"),
            )
            for time in times
        ],
        ("[simulate]\nworld = []", "2:1: `simulate.world` must be a table of signals"),
        (
            f'{SKILLS}Pick = "6 s"',
            '2:1: `simulate.skills.Pick` must be a table such as { takes = "6 s", succeeds = "97 %" }',
        ),
        (
            f"{SKILLS}Pick = {{}}",
            '2:1: `simulate.skills.Pick` must be a table such as { takes = "6 s", succeeds = "97 %" }',
        ),
        (
            f'{SKILLS}Pick = {{ succeed = "9 %", takes = "6 s" }}',
            "2:10: unknown key `simulate.skills.Pick.succeed`; did you mean `succeeds`?",
        ),
        (f"{SKILLS}Pick = {{ takes = 6 }}", f"2:10: {TAKES}"),
        (f'{SKILLS}Pick = {{ takes = ["6 s"] }}', f"2:10: {TAKES}"),
        (f'{SKILLS}Pick = {{ takes = {{ median = "6 s" }} }}', f"2:10: {TAKES}"),
        (
            f'{SKILLS}Pick = {{ takes = "6" }}',
            '2:10: `simulate.skills.Pick.takes` must be a duration such as "6 s"',
        ),
        (
            f'{SKILLS}Pick = {{ takes = "6 %" }}',
            '2:10: `simulate.skills.Pick.takes` must be a duration such as "6 s"',
        ),
        (
            f'{SKILLS}Pick = {{ takes = "6 sek" }}',
            "2:10: `simulate.skills.Pick.takes` has an unknown unit `sek`; did you mean `s`?",
        ),
        (
            f'{SKILLS}Pick = {{ takes = "53 week" }}',
            "2:10: `simulate.skills.Pick.takes` must be from 0 s to a year",
        ),
        (
            f'{SKILLS}Pick = {{ takes = ["6 s", "500 ms"] }}',
            "2:10: `simulate.skills.Pick.takes` must begin with the shorter duration",
        ),
        (
            f'{SKILLS}Pick = {{ takes = {{ median = "6 s", p95 = "5 s" }} }}',
            "2:36: `simulate.skills.Pick.takes` must have a `p95` above its `median`, and both above 0",
        ),
        (
            f'{SKILLS}Pick = {{ takes = {{ from = "6 s", to = "7 sek" }} }}',
            "2:34: `simulate.skills.Pick.takes` has an unknown unit `sek`; did you mean `s`?",
        ),
        (
            f'{SKILLS}Pick = {{ succeeds = "101 %" }}',
            '2:10: `simulate.skills.Pick.succeeds` must be a percentage from 0 to 100 such as "97 %"',
        ),
        (
            f"{SKILLS}Pick = {{ succeeds = 0.97 }}",
            '2:10: `simulate.skills.Pick.succeeds` must be a percentage from 0 to 100 such as "97 %"',
        ),
        (
            f"{SKILLS}Pick = {{ writes = {{}} }}",
            "2:10: `simulate.skills.Pick.writes` must be a table of entries and scripts such as "
            '{ tubes = "tubes - 1" }',
        ),
        (
            f"{SKILLS}Pick = {{ writes = {{ tubes = [] }} }}",
            "2:21: `simulate.skills.Pick.writes` must give each entry a number, `true`, `false` or a script",
        ),
        (
            f'{SKILLS}Pick = {{ writes = {{ tubes = "tubes -" }} }}',
            "2:21: `simulate.skills.Pick.writes` has a mistake in the script of `tubes`: missing operand after `-`",
        ),
        (
            f'{SKILLS}Full = {{ is = "" }}',
            '2:10: `simulate.skills.Full.is` must be a condition such as "battery >= 95 %"',
        ),
        (  # its name ends in the key
            f'{SKILLS}This = {{ is = "" }}',
            '2:10: `simulate.skills.This.is` must be a condition such as "battery >= 95 %"',
        ),
        (
            f'{SKILLS}Full = {{ is = "battery > 9 %", succeeds = "9 %" }}',
            "2:32: `simulate.skills.Full.succeeds` does not go with `is`, which is for conditions",
        ),
        (
            f'{SKILLS}Full = {{ fails = "1 per h" }}',
            "2:1: `simulate.skills.Full` must have a `for` beside its `fails`",
        ),
        (f'{SKILLS}Full = {{ for = "1 h" }}', "2:1: `simulate.skills.Full` must have a `fails` beside its `for`"),
        (
            f'{SKILLS}Full = {{ fails = "1 %", for = "1 h" }}',
            '2:10: `simulate.skills.Full.fails` must be how often it happens such as "1 per 8 h"',
        ),
        (
            f'{SKILLS}Full = {{ fails = "1 per 8 hrz", for = "1 h" }}',
            "2:10: `simulate.skills.Full.fails` has an unknown unit `hrz`; did you mean `h` or `Hz`?",
        ),
        (
            f'{SKILLS}Full = {{ fails = "1 per 8 h", for = "0 s" }}',
            "2:31: `simulate.skills.Full.for` must be above 0 s",
        ),
        (
            f'{SKILLS}Full = {{ fails = "6 per min", for = "10 s" }}',
            "2:31: `simulate.skills.Full.for` must be shorter than the time from one failure to the next",
        ),
        (
            f"{WORLD}battery = {{}}",
            '2:1: `simulate.world.battery` must be a table with a `start` such as { start = "60 %" }',
        ),
        (
            f'{WORLD}battery = {{ start = "6 %", rat = "1 %/s" }}',
            "2:28: unknown key `simulate.world.battery.rat`; did you mean `rate`?",
        ),
        (
            f'{WORLD}battery = {{ start = "6 pct" }}',
            "2:13: `simulate.world.battery.start` has an unknown unit `pct`; did you mean `%`?",
        ),
        (
            f'{WORLD}battery = {{ start = "6 %", rate = "fast" }}',
            '2:28: `simulate.world.battery.rate` must be a number with its unit such as "-0.05 %/s"',
        ),
        (
            f'{WORLD}battery = {{ start = "6 %", while = "1 %/s" }}',
            '2:28: `simulate.world.battery.while` must be a table of nodes and rates such as { Charge = "+1 %/s" }',
        ),
        (
            f'{WORLD}battery = {{ start = "6 %", while = {{ Charge = true }} }}',
            '2:38: `simulate.world.battery.while` must be a number with its unit such as "-0.05 %/s"',
        ),
        (
            f'{WORLD}battery = {{ start = "6 %", between = ["0 %"] }}',
            '2:28: `simulate.world.battery.between` must be two values such as ["0 %", "100 %"]',
        ),
        (f"{WORLD}battery = {{ start = inf }}", "2:13: `simulate.world.battery.start` must be a finite number"),
        (f"{WORLD}battery = {{ start = [] }}", '2:13: `simulate.world.battery.start` must be a value such as "60 %"'),
    ],
)
def test_problems_and_their_places(text: str, expected: str) -> None:
    assert problems(text) == [expected]


def test_a_text_does_not_change_with_time() -> None:
    assert problems(f'{WORLD}zone = {{ start = "hall", rate = "1 1/s" }}') == [
        "2:10: `simulate.world.zone.start` must be a number if the signal changes with time"
    ]

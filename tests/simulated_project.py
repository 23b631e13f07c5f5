"""A project whose runs are predicted."""

from __future__ import annotations

import json
from pathlib import Path

import btq_lang.prediction

MISSION = """Root Deliver

signal battery : % from {battery}

QualityReq reliable : reliability "The parcel mostly arrives"
    mission succeeds
    in at least 90 % of runs

QualityReq in_time : performance-efficiency.time-behaviour "A drive is short"
    takes at most 30 s

QualityReq way_home : performance-efficiency.resource-utilization "It gets home"
    leaves battery >= 3 %

QualityReq charging : performance-efficiency.time-behaviour
    takes at most 2 h

Action Drive
Action Pick
Action Charge
Condition BatteryLow

BehaviorTree Deliver
    ->
        ?
            Inverter
                BatteryLow
            Charge satisfies charging
        Drive satisfies in_time, way_home
        Retry (num_attempts = 2)
            Pick
"""
ANSWER = 'BatteryLow = { is = "battery < 20 %" }\n'
SETTINGS = f"""[simulate.skills]
Drive = {{ takes = ["10 s", "20 s"], succeeds = "95 %" }}
Pick = {{ takes = "6 s", succeeds = "60 %" }}
{ANSWER}
[simulate.world]
battery = {{ start = "60 %", rate = "-0.5 %/s" }}
"""
SCHEMA = json.loads(Path(btq_lang.prediction.__file__).with_name("simulate.schema.json").read_text(encoding="utf-8"))

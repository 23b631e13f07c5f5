"""The table `[evidence]` of a project file: its settings, and what is reported about errors in it."""

from __future__ import annotations

import pytest
from test_config import problems

from btq_lang.catalog.units import parse_unit
from btq_lang.workspace.config import parse_project
from btq_lang.workspace.project_evidence import EvidenceSettings, SignalSource

WHOLE = """\
[evidence]
logs = ["logs/**/*.btlog", "bags/*"]
store = "evidence"
[evidence.signals]
battery = { topic = "/battery_state", field = "percentage", scale = 100, unit = "%" }
speed   = { topic = "/odom", field = "twist.twist.linear.x", offset = -0.5 }
energy  = { file = "power.csv", time = "t", column = "wh", unit = "Wh" }
"""


def test_every_key() -> None:
    project, wrong = parse_project(WHOLE)
    assert wrong == ()
    assert project.evidence == EvidenceSettings(
        logs=("logs/**/*.btlog", "bags/*"),
        store="evidence",
        signals=(
            SignalSource("battery", topic="/battery_state", field="percentage", scale=100, unit=parse_unit("%")),
            SignalSource("speed", topic="/odom", field="twist.twist.linear.x", offset=-0.5),
            SignalSource("energy", file="power.csv", time="t", column="wh", unit=parse_unit("Wh")),
        ),
    )


def test_what_is_right_is_kept() -> None:
    text = WHOLE.replace('"%"', '"percent of it"')
    project, _ = parse_project(text)
    assert project.evidence is not None
    assert [each.signal for each in project.evidence.signals] == ["speed", "energy"]


SIGNALS = "[evidence.signals]\n"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("evidence = 1", "1:1: `evidence` must be a table"),
        ("[evidence]\nlog = []", "2:1: unknown key `evidence.log`; did you mean `logs`?"),
        ('[evidence]\nlogs = "x"', "2:1: `evidence.logs` must be a list of paths"),
        ("[evidence]\nlogs = [1]", "2:1: `evidence.logs` must be a list of paths"),
        ("[evidence]\nstore = 1", "2:1: `evidence.store` must be the path of a folder"),
        ("[evidence]\nsignals = 1", "2:1: `evidence.signals` must be a table of signals"),
        (
            f'{SIGNALS}a = "/x"',
            '2:1: `evidence.signals.a` must be a table such as { topic = "/battery_state", field = "percentage" }',
        ),
        (
            f'{SIGNALS}a = {{ topc = "/x", field = "y", topic = "/x" }}',
            "2:7: unknown key `evidence.signals.a.topc`; did you mean `topic`?",
        ),
        (f'{SIGNALS}a = {{ topic = "/x" }}', "2:1: `evidence.signals.a` must have a `field` beside its `topic`"),
        (f'{SIGNALS}a = {{ file = "x.csv" }}', "2:1: `evidence.signals.a` must have a `column` beside its `file`"),
        (
            f'{SIGNALS}a = {{ unit = "m" }}',
            "2:1: `evidence.signals.a` must have either a `topic` and its `field`, or a `file` and its `column`",
        ),
        (
            f'{SIGNALS}a = {{ topic = "/x", field = "y", column = "z" }}',
            "2:34: `evidence.signals.a.column` does not go with a `topic`",
        ),
        (
            f'{SIGNALS}a = {{ topic = "/x", field = "y", unit = "sek" }}',
            "2:34: unknown unit `sek`; did you mean `s`?",
        ),
        (
            f'{SIGNALS}a = {{ topic = "/x", field = "y", scale = true }}',
            "2:34: `evidence.signals.a.scale` must be a number",
        ),
        (
            f'{SIGNALS}a = {{ topic = "/x", field = "y", offset = inf }}',
            "2:34: `evidence.signals.a.offset` must be a number",
        ),
        (  # as an integer it is finite, but no float
            f'{SIGNALS}a = {{ topic = "/x", field = "y", offset = 1{"0" * 400} }}',
            "2:34: `evidence.signals.a.offset` must be a number",
        ),
        (f'{SIGNALS}a = {{ topic = "", field = "y" }}', "2:7: `evidence.signals.a.topic` must be a string"),
    ],
)
def test_problems_and_their_places(text: str, expected: str) -> None:
    assert problems(text) == [expected]

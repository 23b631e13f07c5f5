"""The fingerprint of what a requirement means: what changes it, what does not, and which requirements are suspect."""

from __future__ import annotations

import pytest

from btq_lang.requirements.approval import ApprovalState, added_since_approval, approval_state
from btq_lang.workspace.workspace import Workspace

MISSION = """\
signal speed : m/s from {base_speed} fresh within 200 ms initially 0 m/s
signal noise : dB from {noise}
context near : speed > 0.1 m/s
hazard H1
QualityReq other "Other"
QualityReq slow(limit : m/s = 0.25 m/s) : safety and comfort "Slow near people"
    keeps speed <= limit
    while near
    in at least 98 % of runs
    on violation fail
    verified by test "TC-1"
    refines other
    mitigates H1
    because "they are not startled"
    goal 0.2 m/s
    source "ISO 13482"
    priority high
apply slow to every MoveBase except Dock/MoveBase
BehaviorTree Main
    ->
        MoveBase satisfies slow(limit = 0.1 m/s)
"""


def state(text: str, name: str = "slow", **files: str) -> ApprovalState:
    workspace = Workspace.of({"main.btq": text, **{f"{other}.btq": content for other, content in files.items()}})
    return workspace.store.ask(approval_state, "main.btq", name)


def test_it_is_short_and_does_not_change_between_versions() -> None:
    """A new field of the syntax must not outdate the approvals that are there."""
    assert state(MISSION) == ApprovalState("open", "1:7ab13bacda62")
    assert state(MISSION, "other").fingerprint == "1:f3b24ab67f40"
    assert state(MISSION, "unknown") == ApprovalState("open")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("0.25 m/s", "25 cm/s"),
        ("200 ms", "0.2 s"),
        ("    while near\n    in at least 98 % of runs\n", "    in at least 98 %  of runs\n    while near  # here\n"),
        ('"Slow near people"', '"Slow\n  near people"'),
        ('source "ISO 13482"', 'source "ISO 10218"'),
        ("priority high", "priority low"),
        ("goal 0.2 m/s", "goal 0.1 m/s"),
        ("they are not", "nobody is"),
        ("initially 0 m/s", "initially 1 m/s"),
        ("signal noise : dB", "signal noise : Pa"),
        ("satisfies slow(limit = 0.1 m/s)", "satisfies slow"),
        ("priority high\n", 'priority high\n    approved by "Kim" on "2026-11-29"\n'),
        ("refines other", 'refines "other"'),
    ],
)
def test_what_does_not_count(old: str, new: str) -> None:
    assert old in MISSION
    assert state(MISSION.replace(old, new)).fingerprint == state(MISSION).fingerprint


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("0.25 m/s", "0.3 m/s"),
        ("limit : m/s", "limit : km/h"),
        ("200 ms", "300 ms"),
        ("{base_speed}", "{speed}"),
        ("m/s from", "km/h from"),
        ("from {base_speed}", "from {base_speed} counter"),
        ("0.1 m/s\nhazard", "0.2 m/s\nhazard"),
        ("<= limit", "< limit"),
        ("keeps speed", "needs speed"),
        ("while near", "when near"),
        ("98 %", "99 %"),
        ("violation fail", "violation halt"),
        ("TC-1", "TC-2"),
        ("refines other", "refines others"),
        ("mitigates H1", "mitigates H2"),
        ("safety and comfort", "safety"),
        ("Slow near", "Slower near"),
        ("every MoveBase", "every Move"),
        ("Dock/MoveBase", "Dock"),
        ("apply slow to", "apply slow(limit = 0.1 m/s) to"),
        ("    while near\n", ""),
    ],
)
def test_what_counts(old: str, new: str) -> None:
    assert old in MISSION
    assert state(MISSION.replace(old, new)).fingerprint != state(MISSION).fingerprint


@pytest.mark.parametrize(
    ("short", "whole"),
    [
        ("A succeeds with probability >= 98 %", "A succeeds with probability >= 98 % of activations"),
        ("A succeeds with probability >= 98 %", "A succeeds in at least 98 % of activations"),
        ("A tries at most 3", "A tries at most 3 per run"),
    ],
)
def test_what_may_be_left_out_does_not_count(short: str, whole: str) -> None:
    one, other = (state(f"QualityReq r\n    {clause}\n", "r").fingerprint for clause in (short, whole))
    assert one == other


@pytest.mark.parametrize(
    ("short", "other"),
    [
        ("A succeeds with probability >= 98 %", "A succeeds with probability >= 98 % of runs"),
        ("A succeeds with probability >= 98 %", "A succeeds with probability > 98 % of activations"),
        ("A tries at most 3", 'A tries at most 3 per "run"'),
        ("A tries at most 3", "A tries at most 3 per B"),
    ],
)
def test_other_experiments_count(short: str, other: str) -> None:
    one, another = (state(f"QualityReq r\n    {clause}\n", "r").fingerprint for clause in (short, other))
    assert one != another


def test_definitions_in_included_files_count() -> None:
    text = 'include "lib.btq"\n' + MISSION.partition("\n")[2]
    signal = MISSION.partition("\n")[0]
    assert state(text, lib=signal).fingerprint == state(MISSION).fingerprint
    assert state(text, lib=signal.replace("200", "300")).fingerprint != state(MISSION).fingerprint


def test_of_each_person_the_last_approval_counts() -> None:
    text = 'QualityReq r "R"\n    mission takes at most 3 s\n'
    current = state(text, "r").fingerprint
    old, new = (
        '    approved by "Kim" on "2026-11-01" of "1:0"\n',
        f'    approved by "Kim" on "2026-11-29" of "{current}"\n',
    )
    lee = '    approved by "Lee" on "2026-11-30"\n'
    assert [state(text + lines, "r").state for lines in ("", old, old + new, new + old, lee, lee + old)] == [
        *("open", "suspect", "approved", "suspect", "approved without fingerprint", "suspect"),
    ]
    assert [each.by for each in state(text + lee + old, "r").outdated] == ["Kim"]


def test_what_refines_a_suspect_requirement_is_suspect_too() -> None:
    approved = '    approved by "Kim" on "2026-11-29"'
    text = f"""\
QualityReq a "A"
{approved} of "1:0"
QualityReq b "B"
    refines a
{approved}
QualityReq c "C"
    refines b, d
{approved}
QualityReq d "D"
    refines a
"""
    states = {name: state(text, name) for name in "abcd"}
    assert {name: (each.state, each.changed) for name, each in states.items()} == {
        "a": ("suspect", ()),
        "b": ("suspect", ("a",)),
        "c": ("suspect", ("b",)),
        "d": ("open", ()),
    }


def test_a_circle_is_answered() -> None:
    text = """\
QualityReq a "A"
    refines b
    approved by "K" on "2026-11-29" of "1:0"
QualityReq b "B"
    refines a
    approved by "K" on "2026-11-29"
"""
    assert [state(text, name).state for name in "ab"] == ["suspect", "suspect"]
    assert [state(text.replace(' of "1:0"', ""), name).state for name in "ab"] == ["approved without fingerprint"] * 2


@pytest.mark.parametrize(
    ("added", "said"),
    [
        ("    while near\n", "while near"),
        ("apply slow to every MoveBase except Dock/MoveBase\n", "apply slow to every"),
    ],
)
def test_what_was_added_is_known(added: str, said: str) -> None:
    before = MISSION.replace(added, "")
    line = f'    approved by "Kim" on "2026-11-29" of "{state(before).fingerprint}"\n'
    now = MISSION.replace("    priority high\n", line)
    known = Workspace.of({"main.btq": now}).store.ask(added_since_approval, "main.btq", "slow")
    assert known.startswith(said)
    changed = now.replace("98 %", "99 %")
    assert Workspace.of({"main.btq": changed}).store.ask(added_since_approval, "main.btq", "slow") == ""

"""`[requirements] import` in the project file: what is read, and what is said where that is not possible."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from in_process import run_btq

from btq_lang.projects.files import Files
from btq_lang.workspace.external_requirements import ExternalRequirement

MISSION = "BehaviorTree Main\n    ->\n        Drive\n        Dock\nAction Drive\nAction Dock\n"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    (tmp_path / "btq.toml").write_text('[requirements]\nimport = ["docs/needs.json", "reqs.csv"]\n')
    (tmp_path / "docs").mkdir()
    write_needs(tmp_path, REQ_1="Distance")
    (tmp_path / "reqs.csv").write_text("id,title\nREQ_2,Noise\nREQ_1,Not this one\n")
    (tmp_path / "m.btq").write_text(MISSION)
    return tmp_path


def write_needs(robot: Path, **titles: str) -> None:
    needs = {id_: {"id": id_, "title": title} for id_, title in titles.items()}
    text = json.dumps({"current_version": "", "versions": {"": {"needs": needs}}})
    (robot / "docs/needs.json").write_text(text)


def imported(files: Files, robot: Path) -> dict[str, ExternalRequirement]:
    """The external requirements that a workspace has, by their ids."""
    groups, problems = files.groups((str(robot),))
    assert problems == ()
    project = groups[0].workspace.project
    assert project.external_requirements is not None
    return project.external_requirements.by_id


def test_a_workspace_has_them(robot: Path) -> None:
    files = Files()
    assert [(each.id, each.title, each.line) for each in imported(files, robot).values()] == [
        ("REQ_1", "Distance", 1),
        ("REQ_2", "Noise", 2),
    ]
    assert imported(files, robot)["REQ_2"] is imported(files, robot)["REQ_2"]  # not read again
    write_needs(robot, REQ_1="Distance", REQ_3="Another")
    assert [*imported(files, robot)] == ["REQ_1", "REQ_3", "REQ_2"]


def test_changes_of_them_count(robot: Path) -> None:
    ((group,), _) = Files().groups((str(robot),))
    assert {f"{robot}/docs/needs.json", f"{robot}/reqs.csv"} <= {*group.watched}


def test_what_cannot_be_read_is_said_where_it_is_named(robot: Path) -> None:
    (robot / "docs/needs.json").write_text('{"versions":\n  {"1" 2}}')
    (robot / "reqs.csv").unlink()
    code, _, err = run_btq("check", cwd=robot)
    assert (code, err.splitlines()) == (
        2,
        [
            "btq: btq.toml:2:11: `docs/needs.json:2:8`: not JSON: expecting ':' delimiter",
            "btq: btq.toml:2:30: `reqs.csv`: cannot be read: No such file or directory",
        ],
    )


def test_the_settings_show_them(robot: Path) -> None:
    _, out, _ = run_btq("check", "--show-settings", ".", cwd=robot)
    line = 'requirements = {"import": ["docs/needs.json", "reqs.csv"]}'
    assert [each.split(" #")[0].rstrip() for each in out.splitlines() if each.startswith("requirements")] == [line]


def test_an_id_that_is_in_neither_is_a_finding(robot: Path) -> None:
    chain = "QualityReq calm\n    Drive takes at most 30 s\n    refines {}\n    mitigates {}\n"
    satisfies = MISSION.replace("        Drive", "        Drive satisfies {}")

    def found(refines: str, mitigates: str, satisfied: str = "calm") -> list[str]:
        text = chain.format(refines, mitigates) + satisfies.format(satisfied)
        (robot / "m.btq").write_text(text)
        return run_btq("check", "--output-format", "concise", cwd=robot)[1].splitlines()[:-1]

    assert found("REQ_1, REQ_2", "REQ_2") == []
    assert found("REQ_1, REQ_7, x", "REG_1, y") == [
        "m.btq:3:20: error[unknown-requirement] unknown requirement `REQ_7`; did you mean `REQ_1`?",
        "m.btq:3:27: error[unknown-requirement] unknown requirement `x`; neither this file nor its includes define it",
        "m.btq:4:15: error[unknown-hazard] unknown hazard `REG_1`; did you mean `REQ_1`?",
        "m.btq:4:22: error[unknown-hazard] unknown hazard `y`; neither this file nor its includes define it",
    ]
    assert found("REQ_1", "REQ_1", "REQ_2") == [
        "m.btq:7:25: error[unknown-requirement] `REQ_2` is a requirement of another tool, and has no clauses that a "
        "node could satisfy",
    ]
    (robot / "reqs.csv").unlink()  # which may have any id
    assert found("REQ_1, REQ_7, x", "REG_1, y") == []

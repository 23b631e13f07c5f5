"""The benchmark of the parser: what it runs is what it says, and what it makes of the times."""

from __future__ import annotations

import subprocess
from pathlib import Path

import forms
import pytest
from inputs import Input, three
from rates import Rates, as_text, compare
from report import Goal
from turns import ROOT, Worker, worker

FAST = Input("fast", Path("fast"), 1_000)
SLOW = Input("slow", Path("slow"), 1_000)


def test_a_worker_reads_all_files_of_a_folder_and_counts_their_nodes(tmp_path: Path) -> None:
    (tmp_path / "a.btq").write_text("BehaviorTree A\n  ->\n    X\n    Y\n")
    (tmp_path / "b.btq").write_bytes(b"BehaviorTree B\r\n  X\r\n")
    started = Worker(worker("with_btq"))
    assert len(started.time(tmp_path, nodes=4, repeat=2)) == 2
    with pytest.raises(SystemExit, match=r"found 4 nodes in .*, which has 5"):
        started.time(tmp_path, nodes=5)
    started.close()


def test_a_form_is_the_one_that_it_says(tmp_path: Path) -> None:
    started = forms.Form("interpreted", ROOT).start()
    started.close()
    assert started.hello["form"] == "interpreted"
    with pytest.raises(SystemExit, match="compiled: expected it compiled in"):
        forms.Form("compiled", ROOT).start()
    with pytest.raises(SystemExit, match="interpreted: expected it interpreted in"):
        forms.Form("interpreted", tmp_path).start()


def test_another_commit_is_checked_out_only_for_a_while(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    repository = tmp_path / "repository"
    repository.mkdir()
    monkeypatch.setattr(forms, "ROOT", repository)
    git = ("git", "-C", str(repository), "-c", "user.name=a", "-c", "user.email=a@example.org")
    subprocess.run((*git, "init", "--quiet"), check=True)
    (repository / "file").write_text("first")
    subprocess.run((*git, "add", "file"), check=True)
    subprocess.run((*git, "commit", "--quiet", "-m", "First"), check=True)
    (repository / "file").write_text("second")
    with forms.checkout_of("HEAD", tmp_path) as other:
        assert (other / "file").read_text() == "first"
    assert not (tmp_path / "checkout").exists()
    assert (repository / "file").read_text() == "second"
    unknown = forms.checkout_of("nowhere", tmp_path)
    with pytest.raises(SystemExit, match=r"`git worktree add .* nowhere` failed: "), unknown:
        pass


def test_without_public_files_two_inputs_remain(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("BTQ_SHARED", str(tmp_path / "nowhere"))
    names = [each.name for each in three(tmp_path, 7)]
    assert names == ["synthetic mission, classic", "synthetic mission, short", "drawn missions, seed 7"]
    assert capsys.readouterr().err.startswith("The public files are left out: there are none in ")


def test_public_files_are_imported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "shared" / "corpus" / "dev"
    folder.mkdir(parents=True)
    tree = '<BehaviorTree ID="{}"><Sequence><A/><B/></Sequence></BehaviorTree>'
    root = '<root BTCPP_format="4">' + tree.format("T") + tree.format("U") + "</root>"
    (folder / "two.xml").write_text(root)
    (folder / "broken.xml").write_text("<root")
    monkeypatch.setenv("BTQ_SHARED", str(tmp_path / "shared"))
    found = {each.name: each.nodes for each in three(tmp_path, 7)}
    assert found["1 imported public files"] == 6


def test_the_slowest_input_counts() -> None:
    measured = [
        Rates(SLOW, {"interpreted": [4.0, 2.0, 2.0], "old interpreted": [1.0, 1.0, 0.5], "compiled": [0.2, 0.2, 0.2]}),
        Rates(FAST, {"interpreted": [1.0, 1.0, 1.0], "old interpreted": [1.0, 1.0, 1.0], "compiled": [0.1, 0.1, 0.1]}),
    ]
    assert compare(measured, "old") == [
        Goal("interpreted, slow: times old interpreted >= 0.33", 0.25, False),
        Goal("interpreted: slow beside fast >= 0.5", 0.5, True),
        Goal("compiled, slow: times old interpreted >= 2.5", 5.0, True),
        Goal("compiled: slow beside fast >= 0.5", 0.5, True),
    ]
    assert as_text(measured, "old") == [
        "| input | nodes | interpreted, nodes/s | old interpreted, nodes/s | compiled, nodes/s "
        "| interpreted / old interpreted | compiled / old interpreted |",
        "|---|---|---|---|---|---|---|",
        "| slow | 1,000 | 500 | 1,000 | 5,000 | 0.25 | 5.00 |",
        "| fast | 1,000 | 1,000 | 1,000 | 10,000 | 1.00 | 10.00 |",
    ]

"""`btq explain` of nodes of Nav2."""

from __future__ import annotations

from pathlib import Path

from in_process import run_btq

WAIT = """\
# Wait (Action of Nav2)

Waits.

in: Humble, Iron, Jazzy, Kilted, Lyrical

                                                        H  I  J  K  L
input  server_name : std::string = ""                   x  x  x  x  x  the action server; empty: the usual one
input  server_timeout : std::chrono::milliseconds = ""  x  x  x  x  x  how long to wait for the server to answer; \
empty: as configured
input  wait_duration : int = 1                          x  x  -  -  -  seconds
input  wait_duration : double = 1.0                     -  -  x  x  x  seconds
output error_code_id : uint16_t                         -  -  -  x  x  the error code of the action, 0 for none
output error_msg : std::string                          -  -  -  x  x  the error of the action in words

An input without a default is one without which the node fails or has nothing to do.
"""


def test_a_node_in_all_distributions_side_by_side(tmp_path: Path) -> None:
    assert run_btq("explain", "Wait", cwd=tmp_path) == (0, WAIT, "")


def test_a_node_of_some_distributions_and_one_without_ports(tmp_path: Path) -> None:
    lines = run_btq("explain", "ClearCostmapAroundPose", cwd=tmp_path)[1].splitlines()
    assert (lines[4], lines[6].split()) == ("in: Jazzy, Lyrical", ["J", "L"])
    assert lines[11].endswith("  -  x  the layers of the costmap to clear; empty: all of them")
    assert run_btq("explain", "SingleTrigger", cwd=tmp_path)[1].endswith(
        "\n\nin: Humble, Iron, Jazzy, Kilted, Lyrical\n"
    )


def test_a_similar_name_is_suggested(tmp_path: Path) -> None:
    message = "btq explain: unknown name `RemovePasedGoals`; did you mean RemovePassedGoals?\n"
    assert run_btq("explain", "RemovePasedGoals", cwd=tmp_path) == (2, "", message)

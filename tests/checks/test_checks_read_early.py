"""unset-entry and uncreated-entry where the writer runs later: certain only where nothing skips what runs first."""

from __future__ import annotations

import pytest
from check_asserts import problems

MODELS = "Action Scan\n    output n : int\nAction Report\n    input n : int\nAction Show\n    input n : int = 0\n"
READ, WRITTEN = "Report (n = {n})", "Scan (n = {n})"
EARLY = ["nothing writes `n` before it is read here"]


def inspect(*lines: str, call: str = "SubTree Inspect", more: str = "") -> str:
    below = "".join(f"    {line}\n" for line in lines)
    return f"{MODELS}Root Main\nBehaviorTree Main\n    {call}\n{more}BehaviorTree Inspect\n{below}"


@pytest.mark.parametrize(
    "lines",
    [
        ("->", f"    {READ}", f"    {WRITTEN}"),
        ("M->", f"    {READ}", "    ?", f"        {WRITTEN}"),
        ("->", "    ->", "        AlwaysSuccess", f"        {READ}", f"    {WRITTEN}"),
        ("->", f"    {READ}", '    Script (code = "n := 1")', f"    {WRITTEN}"),
        ("R->", f"    {READ}", f"    {WRITTEN}"),
    ],
)
def test_an_entry_that_is_read_before_it_is_written(lines: tuple[str, ...]) -> None:
    for call in ("SubTree Inspect", "SubTree Inspect (m = 3)"):
        found = problems(inspect(*lines, call=call), "unset-entry")
        assert [(each.message, each.effective_severity.value) for each in found] == [(EARLY[0], "warning")]
        assert [related.message for related in found[0].related] == ["writes it, but runs later"]


@pytest.mark.parametrize(
    "lines",
    [
        ("->", f"    {WRITTEN}", f"    {READ}"),
        ("->", "    Show (n = {n})", f"    {WRITTEN}"),  # whose port has a default
        ("->", "    ?", "        Near", f"        {READ}", f"    {WRITTEN}"),
        ("->", "    ForceSuccess", "        ->", "            AlwaysFailure", f"            {READ}", f"    {WRITTEN}"),
        ("->", '    Report (n = {n} _skipIf = "@first")', f"    {WRITTEN}"),
        ("->", '    -> (_skipIf = "@first")', f"        {READ}", f"    {WRITTEN}"),
        ("?", f"    {READ}", f"    {WRITTEN}"),
        ("Repeat (num_cycles = 2)", "    ->", f"        {READ}", f"        {WRITTEN}"),
        ("Parallel", f"    {READ}", f"    {WRITTEN}"),
        ("->", f"    {READ}", f"    {WRITTEN}", "    Unknown"),
        ("->", f"    {READ}", f"    {WRITTEN}", "    SubTree Other (n = {n})"),
    ],
)
def test_an_entry_that_may_be_written_before(lines: tuple[str, ...]) -> None:
    other = "BehaviorTree Other\n    input n\n    Report (n = {n})\n"
    assert problems(inspect(*lines, more=other), "unset-entry") == []


@pytest.mark.parametrize("given", ["(n = 3)", "(n = {n})", "(_autoremap = true)"])
def test_an_entry_that_the_tree_is_given(given: str) -> None:
    text = inspect("->", f"    {READ}", f"    {WRITTEN}", call=f"SubTree Inspect {given}")
    assert [each.message for each in problems(text, "unset-entry") if "before it is read" in each.message] == []


@pytest.mark.parametrize(
    ("lines", "is_found"),
    [
        (('Script (code = "n = 0")', 'Script (code = "n := n + 1")'), True),
        (('Script (code = "n = 0")', 'AlwaysSuccess (_onSuccess = "n := 1")'), True),
        (('Script (code = "n := 0")', 'Script (code = "n = 1")'), False),
        (('Script (code = "n = 0")', WRITTEN), False),  # the port creates it with the tree
        (('Script (code = "n = 0" _skipIf = "@first")', 'Script (code = "n := 1")'), False),
        (('Script (code = "n = 0")', 'Script (code = "n := 1")', "SubTree Other (n = {n})"), False),
    ],
)
def test_an_assignment_before_the_entry_is_created(lines: tuple[str, ...], *, is_found: bool) -> None:
    below = "".join(f"        {line}\n" for line in lines)
    text = f"{MODELS}Root Main\nBehaviorTree Main\n    ->\n{below}BehaviorTree Other\n    input n\n    {READ}\n"
    found = problems(text, "uncreated-entry")
    message = "a script assigns to `n`, which nothing creates before"
    assert [each.message for each in found] == ([message] if is_found else [])
    assert [each.fixes[0].title for each in found] == ["Write `:=`"] * is_found

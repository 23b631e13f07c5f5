"""What the page opens with: a headline, where each quality matters, and the trees with a sign for each requirement."""

from __future__ import annotations

import re
from html import unescape
from pathlib import Path
from typing import Any

import pytest
from evidence_logs import MAIN, MAIN_XML, btlog, rows
from in_process import run_btq
from judged_examples import judged_example

from btq_lang.evidence.verdicts import WORST_FIRST
from btq_lang.trace.states import IN_SENTENCES, SIGNS

ROOT = Path(__file__).resolve().parents[2]


def first_screen(page: str) -> dict[str, Any]:
    """The words of each part; the notes of each node by its name, and the class of its box."""
    screen = page[page.index('<section id="overview"') : page.index('<form class="filter"')]
    (headline,) = re.findall('<p class="headline">(.*?)</p>', page)
    return {
        "headline": words(headline),
        "qualities": [
            [words(cell) for cell in re.findall("<t[hd][ >].*?</t[hd]>", row, re.DOTALL)]
            for row in re.findall("<tr data-keys.*?</tr>", screen, re.DOTALL)
        ],
        "legend": [words(each) for each in re.findall(LEGEND, legend_of(screen))],
        "buttons": [words(each) for each in re.findall("<button.*?</button>", screen)],
        "trees": re.findall('role="group" aria-label="(The tree .*?)"', screen),
        "nodes": {
            unescape(title).partition(";")[0]: [state, *re.findall("<title>(.*?)</title>", notes)]
            for state, title, notes in re.findall(BOX, screen, re.DOTALL)
            if notes
        },
    }


def words(piece: str) -> str:
    """What a reader sees of a piece of the page."""
    return re.sub(r" ([:,])", r"\1", " ".join(unescape(re.sub("<[^>]*>", " ", piece)).split()))


def legend_of(screen: str) -> str:
    return screen[screen.index('<p class="legend">') : screen.index('<span class="hint">')]


LEGEND = r'<span class="state [-\w]+">(?:<span.*?</span>)?[^<]*</span>'
BOX = r'<g class="box [-\w]+ ?([-\w]*)"[^>]*>.*?<title>([^<]*)</title>.*?</g>\n((?:<g class="note.*?</g>\n)*)'


def page_of(folder: Path, *arguments: str) -> str:
    code, out, err = run_btq("trace", "--format", "html", *arguments, cwd=folder)
    assert (code, err) == (0, "")
    return out


def test_a_mission_without_evidence() -> None:
    assert first_screen(page_of(ROOT / "examples/inspection")) == {
        "headline": "4 requirements: 4 not judged. No log has been judged: there is no evidence yet.",
        "qualities": [
            [
                "Operational constraint Safety",
                "Inspection: DriveTo ToRoom, DriveTo ToExit",
                "□ 2 not judged: keep_away, slow",
            ],
            ["Reliability", "Inspection: DriveTo ToRoom, DriveTo ToExit", "□ 2 not judged: keep_away, enough_power"],
            ["Time behaviour Performance efficiency", "Inspection: the whole mission", "□ 1 not judged: in_time"],
        ],
        "legend": ["□ not judged"],
        "buttons": ["all", "Operational constraint", "Reliability", "Time behaviour"],
        "trees": ["The tree Inspection: 6 nodes, 4 requirements"],
        "nodes": {
            "R->": ["is-not-judged", "in_time: not judged"],
            "DriveTo ToRoom (place = room 7)": [
                "is-not-judged",
                "keep_away: not judged",
                "slow: not judged",
                "enough_power: not judged",
            ],
            "DriveTo ToExit (place = exit)": ["is-not-judged", "keep_away: not judged", "slow: not judged"],
        },
    }


def test_a_mission_that_ran(tmp_path: Path) -> None:
    assert first_screen(page_of(judged_example(tmp_path, "inspection"))) == {
        "headline": "4 requirements: 1 satisfied, 1 violated, 1 unknown, 1 suspect. Verdicts of 2 runs, the last one "
        "on 2026-11-20.",
        "qualities": [
            [
                "Operational constraint Safety",
                "Inspection: DriveTo ToRoom, DriveTo ToExit",
                "2 requirements: ✔ 1 satisfied: slow ? 1 unknown: keep_away",
            ],
            [
                "Reliability",
                "Inspection: DriveTo ToRoom, DriveTo ToExit",
                "2 requirements: ? 1 unknown: keep_away ! 1 suspect: enough_power",
            ],
            ["Time behaviour Performance efficiency", "Inspection: the whole mission", "✖ 1 violated: in_time"],
        ],
        "legend": ["✔ satisfied", "✖ violated", "? unknown", "! suspect"],
        "buttons": ["all", "Operational constraint", "Reliability", "Time behaviour"],
        "trees": ["The tree Inspection: 6 nodes, 4 requirements"],
        "nodes": {
            "R->": ["is-violated", "in_time: violated"],
            "DriveTo ToRoom (place = room 7)": [
                "is-suspect",
                "enough_power: suspect",
                "keep_away: unknown",
                "slow: satisfied",
            ],
            "DriveTo ToExit (place = exit)": ["is-unknown", "keep_away: unknown", "slow: satisfied"],
        },
    }


# Of examples/hospital: each quality and where it matters, in the order of the screen.
HOSPITAL = (
    ("hygiene Safety", "DisinfectRoom: -> DeliverMedicine: -> Delivery"),
    ("discretion Security", "DeliverMedicine: -> Delivery, MoveBase ToWard"),
    (
        "quiet Interaction capability",
        "EnoughBattery: MoveBase ToCharger DeliverMedicine: MoveBase ToPharmacy, MoveBase ToWard "
        "DisinfectRoom: MoveBase ToRoom",
    ),
    (
        "Time behaviour Performance efficiency",
        "DeliverMedicine: MoveBase ToWard, OpenDrawer AtPharmacy, OpenDrawer AtWard DisinfectRoom: "
        "MoveBase ToRoom, R-> Radiate",
    ),
    (
        "Operational constraint Safety",
        "EnoughBattery: MoveBase ToCharger DeliverMedicine: MoveBase ToPharmacy, MoveBase ToWard "
        "DisinfectRoom: MoveBase ToRoom, R-> Radiate",
    ),
    ("energy autonomy Performance efficiency", "DeliverMedicine: MoveBase ToWard DisinfectRoom: MoveBase ToRoom"),
    ("Reliability", "DeliverMedicine: -> Delivery"),
)


def screen_of_hospital(
    headline: str, states: list[str], legend: list[str], nodes: dict[str, list[str]]
) -> dict[str, object]:
    """The first screen of examples/hospital; `states`: of the requirements of each quality."""
    return {
        "headline": headline,
        "qualities": [[*quality, state] for quality, state in zip(HOSPITAL, states, strict=True)],
        "legend": legend,
        "buttons": [
            *("all", "hygiene", "discretion", "quiet", "Time behaviour", "Operational constraint"),
            *("energy autonomy", "Reliability"),
        ],
        "trees": [
            "The tree DeliverMedicine: 10 nodes, 8 requirements",
            "The tree DisinfectRoom: 9 nodes, 6 requirements",
            "The tree EnoughBattery: 5 nodes, 2 requirements",
        ],
        "nodes": nodes,
    }


def test_two_missions_without_evidence() -> None:
    assert first_screen(page_of(ROOT / "examples/hospital")) == screen_of_hospital(
        "9 requirements: 9 not judged. No log has been judged: there is no evidence yet.",
        [
            "□ 1 not judged: wiped",
            "□ 1 not judged: locked",
            "□ 1 not judged: hush",
            "□ 2 not judged: on_time, round_trip",
            "□ 2 not judged: slow, dark",
            "□ 1 not judged: reserve",
            "□ 1 not judged: dependable",
        ],
        ["□ not judged", "concern"],
        {
            "-> Delivery": ["is-not-judged", "dependable: not judged", "wiped: not judged", "satisfices discretion"],
            "MoveBase ToPharmacy (place = pharmacy)": ["is-not-judged", "slow: not judged", "hush: not judged"],
            "OpenDrawer AtPharmacy (for = pharmacist)": ["is-not-judged", "round_trip: not judged"],
            "MoveBase ToWard (place = {ward})": [
                "is-not-judged",
                "on_time: not judged",
                "slow: not judged",
                "hush: not judged",
                "reserve: not judged",
                "locked: not judged",
            ],
            "OpenDrawer AtWard (for = nurse)": ["is-not-judged", "round_trip: not judged"],
            "->": ["is-not-judged", "wiped: not judged", "satisfices hygiene"],
            "MoveBase ToRoom (place = {room})": [
                "is-not-judged",
                "on_time: not judged",
                "slow: not judged",
                "hush: not judged",
                "reserve: not judged",
            ],
            "R-> Radiate": ["is-not-judged", "on_time: not judged", "dark: not judged"],
            "MoveBase ToCharger (place = charger)": ["is-not-judged", "slow: not judged", "hush: not judged"],
        },
    )


def test_two_missions_one_of_which_ran(tmp_path: Path) -> None:
    assert first_screen(page_of(judged_example(tmp_path, "hospital"))) == screen_of_hospital(
        "9 requirements: 1 satisfied, 6 unknown, 1 undecided, 1 open. Verdicts of 1 run on 2026-11-20.",
        [
            "○ 1 open: wiped",
            "? 1 unknown: locked",
            "? 1 unknown: hush",
            "2 requirements: ✔ 1 satisfied: round_trip ? 1 unknown: on_time",
            "? 2 unknown: slow, dark",
            "? 1 unknown: reserve",
            "~ 1 undecided: dependable",
        ],
        ["✔ satisfied", "? unknown", "~ undecided", "∅ never exercised", "○ open", "□ not judged", "concern"],
        {
            "-> Delivery": ["is-undecided", "dependable: undecided", "wiped: open", "satisfices discretion"],
            "MoveBase ToPharmacy (place = pharmacy)": ["is-unknown", "slow: unknown", "hush: unknown"],
            "OpenDrawer AtPharmacy (for = pharmacist)": ["is-satisfied", "round_trip: satisfied"],
            "MoveBase ToWard (place = {ward})": [
                "is-unknown",
                "on_time: unknown",
                "slow: unknown",
                "hush: unknown",
                "reserve: unknown",
                "locked: unknown",
            ],
            "OpenDrawer AtWard (for = nurse)": ["is-satisfied", "round_trip: satisfied"],
            "->": ["is-open", "wiped: open", "satisfices hygiene"],
            "MoveBase ToRoom (place = {room})": [
                "is-not-judged",
                "on_time: not judged",
                "slow: not judged",
                "hush: not judged",
                "reserve: not judged",
            ],
            "R-> Radiate": ["is-unknown", "dark: unknown", "on_time: not judged"],
            "MoveBase ToCharger (place = charger)": [
                "is-never-exercised",
                "slow: never exercised",
                "hush: never exercised",
            ],
        },
    )


def test_states_have_signs_of_their_own() -> None:
    assert len(set(SIGNS.values())) == len(SIGNS)
    assert set(SIGNS) == set(IN_SENTENCES) == {*WORST_FIRST, "suspect", "not judged"}


def test_signs_of_verdicts_are_the_same_in_tables() -> None:
    style = (ROOT / "btq_lang/render/page.css").read_text(encoding="utf-8")
    own = dict(re.findall(r'\.verdict\.([-\w]+)::before { content: "(.*?)\\00A0"', style))
    (otherwise,) = re.findall(r'\.verdict::before { content: "(.*?)\\00A0"', style)
    for verdict in WORST_FIRST:
        written = own.get(verdict.replace(" ", "-"), otherwise)
        assert (chr(int(written[1:], 16)) if written[0] == "\\" else written) == SIGNS[verdict]


RUNS = "Verdicts of 2 runs, the last one on 2026-11-20."
HEADLINES = {
    (): f"4 requirements: 1 satisfied, 1 violated, 1 unknown, 1 suspect. {RUNS}",
    ("--priority", "low"): f"1 selected requirement: 1 violated. {RUNS}",
}


@pytest.mark.parametrize("arguments", HEADLINES)
def test_a_file_of_verdicts_gives_the_same_headline(arguments: tuple[str, ...], tmp_path: Path) -> None:
    folder = judged_example(tmp_path, "inspection")
    run_btq("verify", "-o", "verdicts.json", cwd=folder)
    given = page_of(folder, "--evidence", "verdicts.json", *arguments)
    assert first_screen(given) == first_screen(page_of(folder, *arguments))
    assert first_screen(given)["headline"] == HEADLINES[arguments]


def test_a_store_gives_the_same_headline(tmp_path: Path) -> None:
    folder = judged_example(tmp_path, "inspection")
    run_btq("verify", "runs.btlog", "--store", "kept", cwd=folder)
    assert first_screen(page_of(folder, "--evidence", "kept"))["headline"] == HEADLINES[()]


def test_the_page_of_verdicts_opens_with_it(tmp_path: Path) -> None:
    folder = judged_example(tmp_path, "inspection")
    run_btq("verify", "-o", "verdicts.html", cwd=folder)
    screen = first_screen((folder / "verdicts.html").read_text(encoding="utf-8"))
    assert screen == first_screen(page_of(folder))


MANY = """\
Root Main
BehaviorTree Main
    ->
        satisfies r1, r2, r3, r4, r5, r6, r7
        Move satisfices safety
"""


def test_what_is_long_is_shortened(tmp_path: Path) -> None:
    requirements = "".join(f"QualityReq r{number} : safety\n    verified by review\n" for number in range(1, 8))
    (tmp_path / "main.btq").write_text(f"{requirements}QualityReq bare\n    verified by test\nAction Move\n{MANY}")
    screen = first_screen(page_of(tmp_path))
    assert screen["qualities"] == [
        ["Safety", "Main: Move, ->", "□ 7 not judged: r1, r2, r3, r4, r5, r6 and 1 more"],
        ["without a quality", "no node", "□ 1 not judged: bare"],
    ]
    assert screen["nodes"] == {
        "->": [
            "is-not-judged",
            *(f"r{number}: not judged" for number in range(1, 5)),
            "r5: not judged; r6: not judged; r7: not judged",
        ],
        "Move": ["", "satisfices safety"],
    }


def test_a_large_tree_is_folded_where_nothing_is_demanded(tmp_path: Path) -> None:
    leaves = "".join(f"            Move N{number}\n" for number in range(40))
    tree = f"BehaviorTree Main\n    ->\n        -> Plain\n{leaves}        -> Held\n            Move satisfies r1\n"
    text = f"QualityReq r1 : safety\n    takes at most 1 s\nAction Move\nRoot Main\n{tree}"
    (tmp_path / "main.btq").write_text(text, encoding="utf-8")
    page = page_of(tmp_path)
    boxes = dict(re.findall('id="at-(n[0-9]+)".*?\n(.*?)\n', page))
    assert boxes == {
        "n1": "<title>-&gt;</title>",
        "n2": '<a href="#n2">',
        "n43": "<title>-&gt; Held</title>",
        "n44": '<a href="#r1">',
    }
    assert "… 40 nodes" in page


def test_names_that_trees_share_have_their_files() -> None:
    screen = first_screen(page_of(ROOT / "examples/published"))
    assert [tree.partition(":")[0] for tree in screen["trees"]] == [
        "The tree Inspection in inspection.btq",
        "The tree Inspection in pipeline.btq",
        "The tree Round",
        "The tree Prepare",
        "The tree Examine",
    ]


def test_logs_of_another_mission_have_no_run(tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(f"QualityReq r1\n    Move takes at most 1 s\n{MAIN}", encoding="utf-8")
    other = MAIN_XML.replace("Move", "Fly").replace("Pick", "Land")
    (tmp_path / "run.btlog").write_bytes(btlog(other, rows("0 1R 2R 20 2S 3R 60 3S 1S")))
    screen = first_screen(page_of(tmp_path, "--evidence", "run.btlog"))
    assert screen["headline"] == "1 requirement: 1 not judged. The evidence has no run of these missions."

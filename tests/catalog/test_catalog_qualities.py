"""The quality catalog, compared with the collected facts, and what a name written in a file means."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from btq_lang.catalog.qualities import (
    DEFAULT_EDITION,
    EDITIONS,
    Edition,
    Quality,
    find,
    fold,
    get,
    parts,
    predecessors,
    qualities,
    siblings,
    successors,
)
from btq_lang.catalog.quality_words import ALIASES, AMBIGUOUS

BOTH: tuple[Edition, ...] = ("2011", "2023")


@pytest.fixture(scope="module")
def facts(shared: Path) -> Any:
    return json.loads((shared / "facts" / "iso25010.json").read_text(encoding="utf-8"))


# ---- the rows ----


@pytest.mark.parametrize("edition", BOTH)
def test_names_of_parts_are_unique(edition: Edition) -> None:
    names = [fold(each.name) for each in qualities(edition) if each.parent is not None and each.kind != "ai"]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("edition", BOTH)
def test_the_models_of_the_iso(edition: Edition, facts: Any) -> None:
    published = facts["editions"][edition]
    in_use_source = published.get("quality_in_use_standard", published["standard"])
    expected = [
        row
        for kind, group, source in (
            ("product", "product", published["standard"]),
            ("in-use", "quality_in_use", in_use_source),
        )
        for characteristic in published[group]
        for row in [
            (characteristic, None, kind, source),
            *((part, characteristic["id"], kind, source) for part in characteristic["subcharacteristics"]),
        ]
    ]
    ours = [quality for quality in qualities(edition) if quality.kind in ("product", "in-use")]
    assert [(quality.id, quality.name, quality.parent, quality.kind, quality.source) for quality in ours] == [
        (row["id"], row["name"], parent, kind, source) for row, parent, kind, source in expected
    ]
    definitions = {row["id"]: row["definition"] for row, *_ in expected}
    for id_ in ("effectiveness", "efficiency"):
        if id_ in definitions:
            assert definitions[f"{id_}.{id_}"] == "(same as the characteristic)"
            definitions[f"{id_}.{id_}"] = definitions[id_]
    assert {quality.id: quality.definition for quality in ours} == definitions


@pytest.mark.parametrize(
    ("edition", "kind", "expected"),
    [
        ("2011", "product", (8, 31)),
        ("2023", "product", (9, 40)),
        ("2011", "in-use", (5, 11)),
        ("2023", "in-use", (3, 10)),
    ],
)
def test_the_counts_of_the_standards(edition: Edition, kind: str, expected: tuple[int, int]) -> None:
    found = [quality for quality in qualities(edition) if quality.kind == kind]
    characteristics = sum(quality.parent is None for quality in found)
    assert (characteristics, len(found) - characteristics) == expected


def test_robotics_qualities(facts: Any) -> None:
    ours = [quality for quality in qualities() if quality.kind == "robotics"]
    assert [
        {
            "id": quality.id,
            "name": quality.name,
            "definition": quality.definition,
            "nearest": quality.nearest,
            "measures": [measure for measure in quality.measures.split(", ") if measure],
        }
        for quality in ours
    ] == facts["robotics"]
    assert all(get(quality.nearest or "") is not None for quality in ours)
    assert {quality.parent for quality in ours} == {None}


def test_additions_for_artificial_intelligence(facts: Any) -> None:
    expected = {
        (row["parent"].removesuffix(" (quality in use)"), row["name"])
        for row in facts["ai_extension"]["added"]
        if row["kind"] == "new"
    }
    ours = [quality for quality in qualities() if quality.kind == "ai"]
    assert {(quality.parent, quality.name) for quality in ours} == expected
    assert {quality.source for quality in ours} == {facts["ai_extension"]["id"]}
    assert all(get(quality.parent or "", "2011") is not None and quality.definition for quality in ours)


def test_every_row_of_the_mapping(facts: Any) -> None:
    mapping = facts["mapping_2011_to_2023"]
    for row in [*mapping["product"], *mapping["quality_in_use"]]:
        assert sorted(successors(row["from"])) == sorted(row["to"]), row
        for new in row["to"]:
            assert row["from"] in predecessors(new), row
    # Inclusivity is called new, and is one half of accessibility.
    assert [new for new in mapping["new_in_2023"] if predecessors(new)] == ["interaction-capability.inclusivity"]


def test_every_name_of_the_old_product_model_has_a_successor() -> None:
    lost = [quality.id for quality in qualities("2011") if not successors(quality.id) and quality.kind != "ai"]
    assert lost == [
        "satisfaction.comfort",
        "context-coverage",
        "context-coverage.context-completeness",
        "context-coverage.flexibility",
    ]


def test_editions_by_the_word_in_a_file() -> None:
    assert EDITIONS == {"iso25010-2023": "2023", "iso25010-2011": "2011"}
    assert DEFAULT_EDITION == "2023"


# ---- what a name means ----


@pytest.mark.parametrize("edition", BOTH)
def test_every_id_is_exact(edition: Edition) -> None:
    for quality in qualities(edition):
        match = find(tuple(quality.id.split(".")), edition)
        assert (match.kind, match.quality, match.candidates) == ("exact", quality, ())


@pytest.mark.parametrize("edition", BOTH)
def test_a_part_alone_is_exact_unless_the_word_means_more(edition: Edition) -> None:
    other = {quality.id for quality in qualities(edition) if quality.kind == "robotics"}
    exceptions = {}
    for quality in qualities(edition):
        if quality.parent is None:
            continue
        word = quality.id.partition(".")[2]
        match = find((word,), edition)
        if match.quality is not quality:
            exceptions[quality.id] = match.kind if word not in other else "robotics"
    assert (
        exceptions
        == {
            "2011": {
                "effectiveness.effectiveness": "exact",
                "efficiency.efficiency": "exact",
                "satisfaction.trust": "robotics",
                "satisfaction.comfort": "robotics",
                "usability.user-controllability": "alias",
                "usability.transparency": "robotics",
                "reliability.robustness": "ambiguous",
                "satisfaction.transparency": "robotics",
            },
            "2023": {
                "beneficialness.usability": "ambiguous",
                "beneficialness.accessibility": "ambiguous",
                "beneficialness.suitability": "ambiguous",
                "usability.user-controllability": "alias",
                "usability.transparency": "robotics",
                "reliability.robustness": "ambiguous",
                "satisfaction.transparency": "robotics",
            },
        }[edition]
    )


@pytest.mark.parametrize(
    "word", ["Time Behaviour", "time-behavior", "time_behaviour", "TIME  BEHAVIOR", "timebehaviour", "Time\nbehaviour"]
)
def test_names_are_compared_folded(word: str) -> None:
    match = find((word,))
    assert (match.kind, match.quality) == ("exact", get("performance-efficiency.time-behaviour"))
    assert find(("Performance Efficiency", word)) == match


@pytest.mark.parametrize(
    ("words", "id_"),
    [
        (("resource utilisation",), "performance-efficiency.resource-utilization"),
        (("analyzability",), "maintainability.analysability"),
        (("appropriateness recognisability",), "interaction-capability.appropriateness-recognizability"),
        (("coexistence",), "compatibility.co-existence"),
        (("failsafe",), "safety.fail-safe"),
        (("energy-autonomy",), "energy-autonomy"),
        (("Ergonomics",), "ergonomics"),
        (("safety",), "safety"),
        (("intervenability",), "security.intervenability"),
    ],
)
def test_exact(words: tuple[str, ...], id_: str) -> None:
    match = find(words)
    assert (match.kind, match.quality, match.candidates) == ("exact", get(id_), ())


def test_the_paper_s_names_are_exact(facts: Any) -> None:
    for written, id_ in facts["paper_names"].items():
        words = tuple(written.rstrip(">").split(" <"))
        for edition in BOTH:
            match = find(words, edition)
            assert (match.kind, match.quality) == ("exact", get(id_, edition))


def test_every_alias_of_the_facts(facts: Any) -> None:
    """Those that are names of robotics qualities are exact; those that mean several things put the target first."""
    robotics = {quality.id for quality in qualities() if quality.kind == "robotics"}
    kinds: dict[str, set[str]] = {}
    for word, id_ in facts["aliases"].items():
        match = find((word,))
        kinds.setdefault(match.kind, set()).add(word)
        if word in robotics:
            assert (match.kind, match.quality) == ("exact", get(word))
        elif word in facts["ambiguous"]:
            assert (match.kind, match.candidates[0].id) == ("ambiguous", id_)
        else:
            assert match.quality is get(id_), word
            assert match.safe == (match.kind != "exact"), word
    assert kinds["other-edition"] == {"maturity", "portability", "user interface aesthetics"}
    assert kinds["exact"] == {
        *("time behavior", "resource utilisation", "coexistence", "appropriateness recognisability", "failsafe"),
        *("operability", "learnability", "self descriptiveness", "recoverability", "nonrepudiation", "analyzability"),
        *("controllability", "resilience", "privacy", "configurability"),
    }
    assert "performance" in kinds["alias"]
    assert kinds.keys() == {"exact", "alias", "other-edition", "ambiguous"}


def test_our_aliases_are_those_of_the_facts_and_all_needed(facts: Any) -> None:
    ours = {fold(word): id_ for id_, words in ALIASES.items() for word in words.split()}
    theirs = {fold(word): id_ for word, id_ in facts["aliases"].items()}
    assert ours.items() <= theirs.items()
    for words in ALIASES.values():
        for word in words.split():
            assert fold(word) == word.replace("-", "")
            assert find((word,)).kind == "alias"


def test_every_word_that_means_several_things(facts: Any) -> None:
    assert AMBIGUOUS.keys() == facts["ambiguous"].keys()
    kinds = {word: tuple(find((word,), edition).kind for edition in BOTH) for word in AMBIGUOUS}
    assert kinds == {
        "usability": ("exact", "ambiguous"),
        "accessibility": ("exact", "ambiguous"),
        "flexibility": ("exact", "exact"),
        "efficiency": ("exact", "ambiguous"),
        "integrity": ("exact", "exact"),
        "availability": ("exact", "exact"),
        "safety": ("alias", "exact"),
        "robustness": ("ambiguous", "ambiguous"),
        "suitability": ("alias", "ambiguous"),
        "trust": ("exact", "exact"),
    }
    for word, (remark, ids) in AMBIGUOUS.items():
        assert all(find((word,), edition).explanation == remark for edition in BOTH)
        assert all(get(id_, "2011") or get(id_, "2023") for id_ in ids)


@pytest.mark.parametrize(
    ("edition", "written", "kind", "quality", "candidates", "safe"),
    [
        ("2023", "performance", "alias", "performance-efficiency", ["performance-efficiency"], True),
        ("2011", "hri", "alias", "usability", ["usability"], True),
        ("2011", "mtbf", "alias", "reliability.maturity", ["reliability.maturity"], True),
        ("2011", "safe state", "other-edition", "safety.fail-safe", [], False),
        (
            *("2023", "performance.throughput", "alias"),
            *("performance-efficiency.time-behaviour", ["performance-efficiency.time-behaviour"], True),
        ),
        (
            *("2023", "efficiency.time-behaviour", "alias"),
            *("performance-efficiency.time-behaviour", ["performance-efficiency.time-behaviour"], True),
        ),
        ("2023", "safety.human-separation", "alias", "human-separation", ["human-separation"], True),
        (
            "2023",
            "safety.operational-constraint.human-separation",
            "alias",
            "human-separation",
            ["human-separation"],
            True,
        ),
        (
            *("2023", "interaction-capability.accessibility", "ambiguous", None),
            *(["interaction-capability.user-assistance", "interaction-capability.inclusivity"], False),
        ),
        ("2023", "maturity", "other-edition", "reliability.faultlessness", ["reliability.faultlessness"], True),
        (
            "2023",
            "portability.adaptability",
            "other-edition",
            "flexibility.adaptability",
            ["flexibility.adaptability"],
            True,
        ),
        (
            "2011",
            "flexibility.adaptability",
            "other-edition",
            "portability.adaptability",
            ["portability.adaptability"],
            True,
        ),
        ("2011", "faultlessness", "other-edition", "reliability.maturity", ["reliability.maturity"], True),
        # Split, dropped, folded in, or only near: the other edition's name is what is meant.
        (
            *("2023", "usability.accessibility", "other-edition", "usability.accessibility"),
            *(["interaction-capability.inclusivity", "interaction-capability.user-assistance"], False),
        ),
        (
            "2011",
            "inclusivity",
            "other-edition",
            "interaction-capability.inclusivity",
            ["usability.accessibility"],
            False,
        ),
        ("2023", "context-coverage", "other-edition", "context-coverage", [], False),
        ("2023", "effectiveness", "other-edition", "effectiveness", ["beneficialness.usability"], False),
        ("2023", "usefulness", "other-edition", "satisfaction.usefulness", ["beneficialness.suitability"], False),
        ("2011", "trustworthiness", "other-edition", "acceptability.trustworthiness", ["satisfaction.trust"], False),
        ("2011", "resistance", "other-edition", "security.resistance", [], False),
    ],
)
def test_what_is_understood_and_not_exact(
    edition: Edition, written: str, kind: str, quality: str | None, candidates: list[str], safe: bool
) -> None:
    match = find(tuple(written.split(".")), edition)
    assert match.kind == kind
    assert (match.quality and match.quality.id) == quality
    assert [candidate.id for candidate in match.candidates] == candidates
    assert match.safe is safe


@pytest.mark.parametrize(
    ("edition", "written", "explanation"),
    [
        ("2023", "latency", "`latency` is another word for performance-efficiency.time-behaviour"),
        ("2023", "portability", "`portability` is a name of ISO/IEC 25010:2011; in 2023 it is flexibility"),
        (
            "2023",
            "context-coverage",
            "`context-coverage` is a name of ISO/IEC 25010:2011; 2023 has no counterpart",
        ),
        (
            *("2023", "pleasure"),
            "`satisfaction.pleasure` is a name of ISO/IEC 25010:2011; "
            "in 2023 it is nearest to acceptability.experience",
        ),
        (
            "2011",
            "compliance",
            "`acceptability.compliance` is new in ISO/IEC 25019:2023; 2011 has no counterpart",
        ),
        ("2011", "alarm", "`alarm` means safety.hazard-warning, which is new in ISO/IEC 25010:2023"),
    ],
)
def test_explanations(edition: Edition, written: str, explanation: str) -> None:
    assert find((written,), edition).explanation == explanation


@pytest.mark.parametrize(
    ("words", "near"),
    [
        (("perfomance",), ("performance-efficiency",)),
        (("relaibility",), ("reliability",)),
        (("time-behaviuor",), ("performance-efficiency.time-behaviour",)),
        (("performance-efficiency", "time-behavour"), ("performance-efficiency.time-behaviour",)),
        (("speedy", "time-behavour"), ("performance-efficiency.time-behaviour",)),
        (("reliability", "time-behaviour"), ("performance-efficiency.time-behaviour",)),
        (("security", "robustness"), ("reliability.fault-tolerance", "reliability.robustness")),
        (("latancy",), ("performance-efficiency.time-behaviour",)),
        (("xyzzy",), ()),
        (("",), ()),
        (("", ""), ()),
        ((), ()),
        (("a", "b", "c"), ()),
    ],
)
def test_unknown_names(words: tuple[str, ...], near: tuple[str, ...]) -> None:
    match = find(words)
    assert (match.kind, match.quality, match.candidates, match.near) == ("unknown", None, (), near)


WORDS = st.sampled_from(
    sorted({part for edition in BOTH for quality in qualities(edition) for part in quality.id.split(".")})
    + sorted({word for words in ALIASES.values() for word in words.split()})
    + sorted(AMBIGUOUS)
) | st.text(max_size=12)


@given(st.lists(WORDS, max_size=4).map(tuple), st.sampled_from(BOTH))
def test_whatever_is_proposed_is_exact(words: tuple[str, ...], edition: Edition) -> None:
    match = find(words, edition)
    for id_ in [*(candidate.id for candidate in match.candidates), *match.near]:
        proposed = find(tuple(id_.split(".")), edition)
        assert proposed.kind == "exact"
        assert proposed.quality is not None
        assert proposed.quality.id == id_
    if match.safe:
        assert match.candidates == (match.quality,)
    assert bool(match.near) <= (match.kind == "unknown")
    assert (match.kind in ("unknown", "ambiguous")) == (match.quality is None)


# ---- neighbours ----


def ids(found: tuple[Quality, ...]) -> list[str]:
    return [quality.id for quality in found]


def test_parts_and_siblings() -> None:
    expected = [f"performance-efficiency.{part}" for part in ("time-behaviour", "resource-utilization", "capacity")]
    assert ids(parts("performance-efficiency")) == expected
    time = get("performance-efficiency.time-behaviour")
    assert time is not None
    assert ids(siblings(time)) == expected[1:]


def test_siblings_of_a_characteristic_are_those_of_its_model() -> None:
    in_use = get("acceptability")
    assert in_use is not None
    assert ids(siblings(in_use)) == ["beneficialness", "freedom-from-risk"]
    wear = get("wear")
    assert wear is not None
    assert {quality.kind for quality in siblings(wear)} == {"robotics"}

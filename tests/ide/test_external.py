"""The requirements of other tools in an editor: completion, hover and links."""

from __future__ import annotations

from pathlib import Path

import pytest
from feature_asserts import Fixture

from btq_lang.ide.completion import complete
from btq_lang.ide.describe import documentation
from btq_lang.ide.hover import hover
from btq_lang.ide.structure import document_links
from btq_lang.workspace.config import Project
from btq_lang.workspace.external_requirements import ExternalRequirement, ExternalRequirements

IMPORTED = ExternalRequirements(
    [
        ExternalRequirement(
            "REQ-1",
            "Keep *the* distance",
            "At least\n0.4 m ```now```",
            "open",
            "https://x.org/a?b#REQ-1",
            "/r/n.json",
            7,
        ),
        ExternalRequirement("HAZ_1", "Collision [x](command:x)", "", "", "", "/r/h z.csv", 2),
        ExternalRequirement("slow", "Not ours", "", "", "", "/r/n.json", 9),
    ]
)
PROJECT = Project("/r", external_requirements=IMPORTED)
MISSION = """\
QualityReq slow
    Drive takes at most 30 s
QualityReq calm
    refines {refines}
    mitigates {mitigates}
Action Drive
"""


def shown(refines: str = "slow", mitigates: str = "HAZ_1") -> str | None:
    """The hover at the cursor."""
    fixture = Fixture(MISSION.format(refines=refines, mitigates=mitigates), project=PROJECT)
    result = hover(*fixture.at)
    return result.markdown if result is not None else None


def labels(refines: str = "slow", mitigates: str = "HAZ_1") -> list[tuple[str, str, str]]:
    fixture = Fixture(MISSION.format(refines=refines, mitigates=mitigates), project=PROJECT)
    return [(one.label, one.detail, one.insert) for one in complete(*fixture.at).proposals if one.kind == "external"]


def test_hover_shows_their_texts() -> None:
    assert shown(refines='"RE$0Q-1"') == (
        "**REQ-1** · open\n\n"
        "Keep \\*the\\* distance\n\n"
        "````text\nAt least\n0.4 m ```now```\n````\n\n"
        "[n.json:7](file:///r/n.json#L7) · <https://x.org/a?b#REQ-1>"
    )


def test_a_stranger_writes_no_links() -> None:
    assert shown(mitigates="HAZ$0_1") == (
        "**HAZ\\_1**\n\nCollision \\[x\\](command:x)\n\n[h z.csv:2](file:///r/h%20z.csv#L2)"
    )


def test_own_ones_come_first() -> None:
    markdown = shown(refines="sl$0ow")
    assert markdown is not None
    assert markdown.startswith("**slow**\n\n```btq\nDrive takes at most 30 s\n```")


@pytest.mark.parametrize("refines", ["$0", "slow, $0"])
def test_completion_offers_them(refines: str) -> None:
    assert labels(refines=refines) == [
        ("REQ-1", "Keep *the* distance", "REQ-1"),
        ("HAZ_1", "Collision [x](command:x)", "HAZ_1"),
    ]


def test_completion_offers_none_twice() -> None:
    assert [label for label, _, _ in labels(mitigates="HAZ_1, $0")] == ["REQ-1", "slow"]


def test_completion_documents_them() -> None:
    fixture = Fixture(MISSION.format(refines="$0slow", mitigates="HAZ_1"), project=PROJECT)
    workspace, path, _ = fixture.at
    assert documentation(workspace, path, "external", "HAZ_1") == shown(mitigates="HAZ$0_1")
    assert documentation(workspace, path, "external", "gone") is None


def test_links_lead_to_their_pages_or_files() -> None:
    text = MISSION.format(refines='slow, "REQ-1", nowhere', mitigates="HAZ_1")
    fixture = Fixture(text, cursor=False, project=PROJECT)
    path = next(iter(fixture.files))
    links = [(text[slice(*link.span)], link.target, link.line) for link in document_links(fixture.workspace, path)]
    assert links == [('"REQ-1"', "https://x.org/a?b#REQ-1", 0), ("HAZ_1", "/r/h z.csv", 2)]


def test_without_imports_nothing_is_offered(tmp_path: Path) -> None:
    fixture = Fixture(MISSION.format(refines="$0slow", mitigates="HAZ_1"))
    assert [one for one in complete(*fixture.at).proposals if one.kind == "external"] == []
    assert document_links(*fixture.at[:2]) == ()

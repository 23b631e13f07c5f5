"""A robot with parameters of Nav2: a package with trees, in whose folder a parameter file is checked."""

from __future__ import annotations

import re
from pathlib import Path

from btq_lang.catalog.nav2 import PACKAGED
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.projects.files import Files
from btq_lang.projects.nav2_factory import ParameterSources, findings_of, parameter_file
from btq_lang.util.text import LineIndex
from btq_lang.workspace.config import Project
from btq_lang.workspace.factories import Factory
from btq_lang.workspace.loader import FoundProject

NAVIGATE = '<ComputePathToPose goal="{goal}" path="{path}"/><FollowPath path="{path}"/>'
TREES = {
    "trees/navigate.xml": (f"<Sequence>{NAVIGATE}</Sequence>",),
    "trees/dock.xml": ('<DockRobot dock_id="1"/>',),
    "same/navigate.xml": ("<AlwaysSuccess/>",),
    "same/again.xml": ("<AlwaysSuccess/>", "<AlwaysFailure/>"),
    "several/two.xml": ("<AlwaysSuccess/>", "<AlwaysFailure/>"),
}
IDS = {
    "trees/navigate.xml": ("Navigate",),
    "trees/dock.xml": ("Dock",),
    "same/navigate.xml": ("Navigate",),
    "same/again.xml": ("Navigate", "Again"),
    "several/two.xml": ("One", "Two"),
}
_NODES = re.compile(r'^# nodes = \["([\w-]+)"\] in btq.toml$', re.MULTILINE)


def make_robot(folder: Path) -> None:
    """Write the package `my_robot`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "package.xml").write_text("<package><name>my_robot</name></package>\n")
    for path, roots in TREES.items():
        main = ' main_tree_to_execute="Navigate"' if path == "same/again.xml" else ""
        trees = "".join(
            f'  <BehaviorTree ID="{name}">{root}</BehaviorTree>\n' for name, root in zip(IDS[path], roots, strict=True)
        )
        (folder / path).parent.mkdir(exist_ok=True)
        (folder / path).write_text(f'<root BTCPP_format="4"{main}>\n{trees}</root>\n')


def findings_in(folder: Path, text: str, distribution: str | None = None) -> list[tuple[str, Diagnostic]]:
    """What is wrong with parameters and with what they load, each with its file; a comment in the text may name the
    distribution."""
    named = _NODES.search(text)
    nodes = f"nav2-{distribution}" if distribution is not None else named[1] if named else None
    project = Project(str(folder), node_files=(PACKAGED[nodes],) if nodes else ())
    path = str(folder / "nav2_params.yaml")
    files = Files()
    sources = ParameterSources(
        {path: text}.get, lambda _: None, lambda each: files.workspace_of(each, FoundProject(project, None))
    )
    file, problem = parameter_file(Factory("robot", nav2="nav2_params.yaml"), project, None, sources)
    assert file is not None, problem
    return list(findings_of(file, sources.workspace_of))


def shown(folder: Path, text: str, distribution: str | None = None) -> list[str]:
    """The same, a line each: `3:5 error unknown-library message`, with the file before it if it is another one."""
    lines = []
    for path, each in findings_in(folder, text, distribution):
        source = text if path.endswith(".yaml") else Path(path).read_text()
        at = LineIndex(source).position(each.span.start)
        name = "" if path.endswith(".yaml") else f"{Path(path).name}:"
        severity = each.effective_severity.value
        lines.append(f"{name}{at.line + 1}:{at.column + 1} {severity} {each.rule} {each.message}")
    return lines

"""The requirements of other tools in an editor: what a name means that no file of the mission defines.

One invariant: their texts are of strangers, so none of them is Markdown.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from urllib.parse import quote

from btq_lang.ide.meaning import Subject, definition
from btq_lang.render.gfm import escaped
from btq_lang.util.text import Span
from btq_lang.workspace.external_requirements import ExternalRequirement
from btq_lang.workspace.references import What
from btq_lang.workspace.workspace import Workspace


def external_requirement(workspace: Workspace, path: str, referent: Subject) -> ExternalRequirement | None:
    """The imported requirement that a subject is, if no file of the project defines a requirement or hazard so
    called."""
    imported = workspace.project.external_requirements
    if imported is None or referent.what not in (What.REQUIREMENT, What.HAZARD) or referent.name not in imported.by_id:
        return None
    subjects = (Subject(what, referent.name) for what in (What.REQUIREMENT, What.HAZARD))
    is_defined = any(definition(workspace, path, one) is not None for one in (referent, *subjects))
    return None if is_defined else imported.by_id[referent.name]


def external_links(workspace: Workspace, path: str) -> Iterator[tuple[Span, ExternalRequirement]]:
    """The names in a file that mean imported requirements."""
    if workspace.project.external_requirements is None:
        return
    file = workspace.files[path]
    for entry in file.parsed.entries:
        for mention in file.mentions_of(entry):
            if mention.what in (What.REQUIREMENT, What.HAZARD) and not mention.defines:
                meant = external_requirement(workspace, path, Subject(mention.what, mention.name))
                if meant is not None:
                    yield mention.span.shifted(entry.start), meant


def described(workspace: Workspace, requirement: ExternalRequirement) -> str:
    """An imported requirement in Markdown."""
    head = f"**{escaped(requirement.id)}**" + (f" · {escaped(requirement.status)}" if requirement.status else "")
    place = f"{workspace.project.shown(requirement.path)}:{requirement.line}"
    links = [f"[{place}](file://{quote(requirement.path)}#L{requirement.line})"]
    links += [f"<{requirement.url}>"] if requirement.url else []
    return "\n\n".join(filter(None, (head, escaped(requirement.title), _fenced(requirement.text), " · ".join(links))))


def _fenced(text: str) -> str:
    """A text as it is, between fences that are not in it."""
    ticks = max((len(run) for run in re.findall("`+", text)), default=0)
    fence = "`" * max(ticks + 1, 3)
    return f"{fence}text\n{text}\n{fence}" if text else ""

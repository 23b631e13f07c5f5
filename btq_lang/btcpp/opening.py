"""Files in this language or in XML.

It is apart from `importing`, which is large, and which most missions do not need.
"""

from __future__ import annotations

from btq_lang.workspace.file import File, Origin, is_xml
from btq_lang.workspace.workspace import Workspace


def with_source(workspace: Workspace, path: str, text: str) -> Workspace:
    """The workspace after a change of the text that a file has on the disk, whatever its language."""
    is_foreign = workspace.files[path].is_foreign
    return workspace.with_read(file_of(path, text)) if is_foreign else workspace.with_file(path, text)


def file_of(path: str, text: str) -> File:
    """The file for a path and its text; XML is imported without changing it, whatever its version."""
    if not is_xml(path, text):
        return File(path, text)
    from btq_lang.btcpp.importing import import_xml  # large, and most missions do without XML

    imported = import_xml(text, keep_v3=True, for_people=False)
    is_complete, defines = imported.is_complete, imported.defines
    origin = Origin(text, imported.places, imported.diagnostics, is_complete, defines, signs=imported.signs)
    return File(path, imported.text, origin)

"""Files in this language or in XML."""

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

    done = import_xml(text, keep_v3=True, for_people=False)
    origin = Origin(text, done.places, done.diagnostics, done.is_complete, done.defines, signs=done.signs)
    return File(path, done.text, origin)

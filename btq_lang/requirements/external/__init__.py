"""Reads requirements that other tools have written.

    needs_json.py   the needs.json of sphinx-needs
    csv_table.py    CSV with a heading, that of `btq trace` too
    reqif_file.py   the Requirements Interchange Format; the package `reqif`, only here
    fields.py       what the columns and attributes of these are called

One invariant: a text of a stranger gives requirements or an `ImportProblem`, and no other exception: nothing in it is
expanded or fetched, and its size and depth are bounded.
"""

from __future__ import annotations

from importlib import import_module
from typing import Final

from btq_lang.requirements.external.fields import ImportProblem
from btq_lang.workspace.external_requirements import ExternalRequirement


def read_external(path: str, text: str) -> list[ExternalRequirement]:
    """The requirements in a file of one of the IMPORTED_SUFFIXES, in order; an id may occur several times.

    Raises:
        ImportProblem: the file is not of the format of its suffix, larger than any list of requirements, or the package
            that reads the format is missing.
    """
    if len(text) > _MOST_CHARACTERS:
        raise ImportProblem(f"larger than {_MOST_CHARACTERS} characters", 1)
    reader = import_module(f"{__name__}.{_MODULES[path.rpartition('.')[2]]}")  # most projects import one format
    requirements: list[ExternalRequirement] = reader.read_requirements(path, text)
    return requirements


_MODULES: Final = {"json": "needs_json", "csv": "csv_table", "reqif": "reqif_file"}
_MOST_CHARACTERS: Final = 100_000_000

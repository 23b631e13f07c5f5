"""The requirements of other tools, which a project imports: `[requirements]` in the project file.

    [requirements]
    import = ["needs.json", "reqs.csv", "reqs.reqif"]
    approval = "required"

One invariant: what is wrong is left out and reported, and the rest is kept.  Not known here: how the files are read.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final, TypeAlias

from btq_lang.util.record import Record
from btq_lang.util.spelling import did_you_mean, near

# The message, the keys below `requirements` to its place, and the string that it is about.
Complaint: TypeAlias = tuple[str, tuple[str, ...], str | None]


class ExternalRequirement(Record):
    """A requirement or a hazard that another tool keeps.

    Attributes:
        text: what it demands, if that is more than its title.
        url: of a web page about it; empty if the file names none.
        path, line: of the imported file; the line counts from 1.
    """

    id: str
    title: str
    text: str
    status: str
    url: str
    path: str
    line: int


class ExternalRequirements:
    """All that a project imports; of several with one id the first counts.

    Attributes:
        by_id: in the order of the files.
        is_complete: whether all files could be read, so that an id that is not here does not exist.
    """

    def __init__(self, requirements: Iterable[ExternalRequirement] = (), is_complete: bool = True) -> None:
        self.is_complete = is_complete
        self.by_id: dict[str, ExternalRequirement] = {}
        for requirement in requirements:
            self.by_id.setdefault(requirement.id, requirement)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ExternalRequirements) and (self.is_complete, self.by_id) == (
            other.is_complete,
            other.by_id,
        )

    def __hash__(self) -> int:
        return hash(tuple(self.by_id))


class RequirementSettings(Record):
    """The settings of a project for requirements.

    Attributes:
        imports: the files of other tools' requirements, relative to the project file.
        requires_approval: whether a requirement without an approval is a finding.
        requires_source: whether one that has no source and refines none is a gap.
    """

    imports: tuple[str, ...] = ()
    requires_approval: bool = False
    requires_source: bool = False


def read_requirements(table: object) -> tuple[RequirementSettings, list[Complaint]]:
    """The contents of a table, and what is wrong with it."""
    if not isinstance(table, dict):
        return RequirementSettings(), [("`requirements` must be a table", (), None)]
    complaints: list[Complaint] = [
        (f"unknown key `requirements.{key}`{did_you_mean(near(key, KEYS, 1))}", (key,), None)
        for key in table
        if key not in KEYS
    ]
    imports = table.get("import", [])
    if not (isinstance(imports, list) and all(isinstance(each, str) for each in imports)):
        complaints.append(("`requirements.import` must be a list of files", ("import",), None))
        imports = []
    for name in imports:
        if not name.endswith(IMPORTED_SUFFIXES):
            message = f"`{name}` is of an unknown format; expected a file that ends in {', '.join(IMPORTED_SUFFIXES)}"
            complaints.append((message, ("import",), name))
    for key in ("approval", "source"):
        if table.get(key, "optional") not in DEMANDS:
            allowed = " or ".join(f'"{word}"' for word in DEMANDS)
            complaints.append((f"`requirements.{key}` must be {allowed}", (key,), None))
    imported = tuple(name for name in imports if name.endswith(IMPORTED_SUFFIXES))
    required = (table.get(key) == "required" for key in ("approval", "source"))
    return RequirementSettings(imported, *required), complaints


IMPORTED_SUFFIXES: Final = (".json", ".csv", ".reqif")  # of sphinx-needs, tables, the Requirements Interchange Format
# Each key with a line for editors.
KEYS: Final = {
    "import": "the files of requirements that other tools keep: a needs.json, CSV or ReqIF",
    "approval": "whether each requirement must be approved",
    "source": "whether btq trace lists requirements that have no source and refine none",
}
DEMANDS: Final = ("optional", "required")

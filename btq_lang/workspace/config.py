"""The project file: `btq.toml`, or the table `[tool.btq]` of a pyproject.toml, with the keys of `KEYS`.

One invariant: every text gives a project and never an exception; what is wrong in it is left out and reported.  Not
known here: the disk, and where the file was found.  A new key is a row of `KEYS`; `project_schema` describes its form.
"""

from __future__ import annotations

import os.path
import re
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from btq_lang.catalog.versions import PRODUCTS, VERSION_3, VERSIONS, at_least, numbers
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import RULES, UNREADABLE, Severity
from btq_lang.util.record import Record, replace
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.util.text import LineIndex, Position
from btq_lang.workspace.overrides import KEYS as OVERRIDE_KEYS
from btq_lang.workspace.overrides import Override, severities_at

if TYPE_CHECKING:
    from btq_lang.workspace.external_requirements import ExternalRequirements, RequirementSettings
    from btq_lang.workspace.factories import Factory
    from btq_lang.workspace.project_evidence import EvidenceSettings
    from btq_lang.workspace.project_simulation import SimulationSettings

Kind: TypeAlias = "Literal['btq.toml', 'pyproject.toml']"
PROJECT_FILES: tuple[Kind, ...] = ("btq.toml", "pyproject.toml")  # the first of those in a folder counts


class Project(Record):
    """The settings of all files of a project.

    Attributes:
        root: the folder of the project file.
        include_paths: folders, joined to `root` if they were relative.
        lost_paths: those that the loader did not find.
        engines: the versions of BehaviorTree.CPP that a file must hold for, oldest first.
        product: the program that runs the trees, if it provides trees of its own that nothing here defines.
        external: the trees that other packages provide, which no file of the project defines.
        qualities: the edition of the quality model for files that name none.
        severities: the rules set in `[rules]`; None is off.
        select: the only rules to apply; empty for all.
        ignore: rules not to apply.
        baseline: the file with the findings that a check does not report, joined to `root` if it was relative.
        exclude: patterns of paths that the check of a folder leaves out.
        overrides: of severities in some files; of several that name a rule the last one counts.
        folders: working folders: an editor's, or the current one.
        pools: folders in which an XML file finds the trees and models that it lacks; the loader finds them.
        created: the trees of XML that C++ in the pools names, and probably creates.
        served: the folders from whose XML a server in the pools creates any tree by its ID.
        evidence: its table about logs, if it has one.
        simulation: its table about simulated runs, if it has one.
        requirements: its table about requirements, if it has one.
        external_requirements: those that the files of this table have; None without any.
        factories: what each of its programs registers.
        node_files: files whose models count in all files: files of btq, and C++ sources that were read.
        cpp: patterns of C++ sources whose nodes count in all files.
        hides_nodes: whether there may be nodes in C++ sources that cannot be seen.
        moves_to: the distribution of Nav2, or the version of the engine, for which its trees are checked besides
            their own.
        original_engines: what `engines` was, if it now has the versions that take its files whatever they are written
            for.
        names_all: whether its file names all versions, instead of none.
    """

    root: str = "."
    include_paths: tuple[str, ...] = ()
    lost_paths: tuple[str, ...] = ()
    engines: tuple[str, ...] = VERSIONS
    product: str = ""
    external: tuple[str, ...] = ()
    qualities: str = "iso25010-2023"
    severities: tuple[tuple[str, Severity | None], ...] = ()
    select: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()
    baseline: str | None = None
    exclude: tuple[str, ...] = ()
    overrides: tuple[Override, ...] = ()
    folders: tuple[str, ...] = ()
    pools: tuple[str, ...] = ()
    created: frozenset[str] = frozenset()
    served: tuple[str, ...] = ()
    evidence: EvidenceSettings | None = None
    simulation: SimulationSettings | None = None
    requirements: RequirementSettings | None = None
    external_requirements: ExternalRequirements | None = None
    factories: tuple[Factory, ...] = ()
    node_files: tuple[str, ...] = ()
    cpp: tuple[str, ...] = ()
    hides_nodes: bool = False
    moves_to: str | None = None
    original_engines: tuple[str, ...] = ()
    names_all: bool = False

    def shown(self, path: str) -> str:
        """A path for display: relative to a working folder if it is inside one, else as it is."""
        for folder in self.folders or (self.root,):
            if path == folder:
                return "."
            if path.startswith(f"{folder.rstrip('/')}/"):
                return path[len(folder.rstrip("/")) + 1 :]
        return path

    def pool_of(self, path: str) -> str | None:
        """The innermost of the pools that contain a file, with a `/` at its end."""
        pools = (f"{pool.rstrip('/')}/" for pool in self.pools)
        return max((pool for pool in pools if path.startswith(pool)), key=len, default=None)

    @property
    def imports(self) -> tuple[str, ...]:
        """The paths of the files of external requirements."""
        return tuple(_joined(self.root, name) for name in self.requirements.imports) if self.requirements else ()

    @property
    def cpp_patterns(self) -> tuple[str, ...]:
        """The patterns of C++ sources, its own and those of its factories."""
        from btq_lang.workspace.file import CPP_SUFFIXES  # few projects have any

        of_factories = (pattern for factory in self.factories for pattern in factory.nodes)
        return (*self.cpp, *(pattern for pattern in of_factories if pattern.endswith(CPP_SUFFIXES)))

    @property
    def pinned(self) -> bool:
        """Whether the project names the versions it is for."""
        return self.names_all or self.engines != VERSIONS

    @property
    def target(self) -> str:
        """The version that files are written for: the newest they must hold for."""
        return self.engines[-1]


class ProjectProblem(Record):
    """A part of a project file that was left out, and its place if it could be found."""

    message: str
    position: Position | None = None


def parse_project(text: str, kind: Kind = "btq.toml", root: str = ".") -> tuple[Project, tuple[ProjectProblem, ...]]:
    """The project that a file describes, and what is wrong with the file.

    Args:
        kind: which of the two files it is; in a pyproject.toml only `[tool.btq]` counts.
        root: the folder of the file, which relative include paths are relative to.
    """
    above = keys_above(kind)
    try:
        table = table_of(text, above)
    except (ValueError, RecursionError) as error:  # not only TOMLDecodeError: int() refuses 5,000 digits
        return Project(root), (_syntax_problem(text, error),)
    if not isinstance(table, dict):
        return Project(root), (ProjectProblem(f"`{'.'.join(above)}` must be a table", _find(text, above)),)

    fields: dict[str, Any] = {"root": root}
    problems: list[ProjectProblem] = []
    for key, value in table.items():
        if key in KEYS:
            field, read, *_ = KEYS[key]
            fields[field], complaints = read(key, value)
        else:
            complaints = [_Complaint(f"unknown key `{key}`{_suggestion(key, KEYS)}")]
        for complaint in complaints:
            position = _find(text, (*above, key, *complaint.below), complaint.value)
            problems.append(ProjectProblem(complaint.message, position))
    settings = {field: value for field, value in fields.items() if value is not None}
    named_engines = settings.get("engines", ())
    settings["product"] = next((name for name in named_engines if name in PRODUCTS), "")
    if settings["product"]:
        settings["engines"] = tuple(dict.fromkeys(PRODUCTS.get(name, name) for name in named_engines))
    settings["names_all"] = settings.get("engines") == VERSIONS
    if "include_paths" in settings:
        settings["include_paths"] = tuple(_joined(root, path) for path in settings["include_paths"])
    if "baseline" in settings:
        settings["baseline"] = _joined(root, settings["baseline"])
    if "node_files" in settings:
        from btq_lang.catalog.nav2 import PACKAGED  # few projects have this key

        named = settings["node_files"]
        settings["node_files"] = tuple(PACKAGED[name] for name in named if name in PACKAGED)
        settings["cpp"] = tuple(name for name in named if name not in PACKAGED)
    return Project(**settings), tuple(problems)


def keys_above(path: str) -> tuple[str, ...]:
    """The keys above those of btq in a project file."""
    return ("tool", "btq") if path.rpartition("/")[2] == "pyproject.toml" else ()


def table_of(text: str, above: tuple[str, ...]) -> Any:
    """The value below some keys of a TOML file, which should be a table.

    Raises:
        ValueError, RecursionError: it is not TOML.
    """
    table: object = _toml(text)
    for key in above:
        table = table.get(key, {}) if isinstance(table, dict) else table
    return table


def has_btq_table(text: str) -> bool:
    """Whether a pyproject.toml has a table `[tool.btq]`, or one below it, without parsing it."""
    return _BTQ_TABLE.search(text) is not None


def configured(project: Project, path: str, diagnostics: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """The diagnostics of a file that a project wants, with the severities it gives them."""
    severities = severities_at(project.root, project.severities, project.overrides, path)
    for diagnostic in diagnostics:
        rule = diagnostic.rule
        if rule in UNREADABLE:
            yield diagnostic
        elif rule in project.ignore or (project.select and rule not in project.select):
            continue
        elif rule not in severities:
            yield diagnostic
        elif severity := severities[rule]:
            yield replace(diagnostic, severity=severity)


def unknown_rule(name: str) -> str | None:
    """The message about an unknown rule; None if the rule exists."""
    return None if name in RULES else f"unknown rule `{name}`{_suggestion(name, RULES)}"


def include_candidates(project: Project, path: str, include: str) -> tuple[str, ...]:
    """The paths at which an included file may be, best first: beside the file at `path`, then in the include paths."""
    folders = (os.path.dirname(path), *project.include_paths)
    return tuple(dict.fromkeys(_joined(folder, include) for folder in folders))


class _Complaint(Record):
    """A mistake in the value of a key: in the part `below` it, or in the string `value` in it."""

    message: str
    below: tuple[str, ...] = ()
    value: str | None = None


_Read: TypeAlias = "tuple[Any, list[_Complaint]]"  # None keeps the field as it is without the key


def _engines(key: str, value: object) -> _Read:
    wanted, complaints = _strings(key, [value] if isinstance(value, str) else value)
    if complaints:
        trap = ": TOML reads 4.10 as 4.1" if isinstance(value, float) else ""
        return None, [_Complaint(f'`{key}` must be a string such as "4.10", or a list of them{trap}')]
    valid = tuple(version for version in wanted or () if version in _NAMED or is_engine(version))
    complaints = [
        _Complaint(f"unknown engine version `{version}`{_engine_suggestion(version)} {_CHECKED}", value=version)
        for version in wanted
        if version not in valid
    ]
    if not wanted:
        complaints = [_Complaint(f"`{key}` must name at least one version; {_CHECKED}")]
    return tuple(sorted(set(valid), key=_as_numbers)) or None, complaints


def _as_numbers(named: str) -> tuple[int, ...]:
    return numbers(PRODUCTS.get(named) or named)


def _engine_suggestion(version: str) -> str:
    """A similar version with the same major number: `3.8` is not a misspelt 4.8."""
    if not version[:1].isdecimal():
        return _suggestion(version, PRODUCTS) or ";"
    return (_suggestion(version, VERSIONS) if version.startswith("4.") else "") or ";"


def is_engine(version: str) -> bool:
    """Whether it is a release line such as 4.9, also one between those that the catalog was tested with."""
    is_line = _RELEASE_LINE.fullmatch(version) is not None
    return is_line and at_least(version, VERSIONS[0]) and at_least(VERSIONS[-1], version)


def _qualities(key: str, value: object) -> _Read:
    from btq_lang.catalog.qualities import EDITIONS  # its tables are large, and few files have this key

    if value in (*EDITIONS,):
        return value, []
    meant = _suggestion(value, EDITIONS) if isinstance(value, str) else ""
    return None, [_Complaint(f"`{key}` must be {' or '.join(map(_quoted, EDITIONS))}{meant}")]


def _strings(key: str, value: object) -> _Read:
    if isinstance(value, list) and all(isinstance(item, str) for item in value):
        return tuple(value), []
    return None, [_Complaint(f"`{key}` must be a list of strings")]


def _file(key: str, value: object) -> _Read:
    if isinstance(value, str) and value:
        return value, []
    return None, [_Complaint(f"`{key}` must be the name of a file")]


def _rule_names(key: str, value: object) -> _Read:
    names, complaints = _strings(key, value)
    unknown = [_Complaint(message, value=name) for name in names or () if (message := unknown_rule(name))]
    return None if names is None else tuple(name for name in names if name in RULES), complaints + unknown


def _severities(key: str, value: object) -> _Read:
    if not isinstance(value, dict):
        return None, [_Complaint(f"`{key}` must be a table of rules and severities")]
    severities: list[tuple[str, Severity | None]] = []
    complaints: list[_Complaint] = []
    for name, word in value.items():
        if message := unknown_rule(name):
            complaints.append(_Complaint(message, (name,)))
        elif not isinstance(word, str) or word not in SEVERITIES:
            words = ", ".join(map(_quoted, SEVERITIES))
            meant = _suggestion(word, SEVERITIES) if isinstance(word, str) else ""
            complaints.append(_Complaint(f"`{key}.{name}` must be one of {words}{meant}", (name,)))
        else:
            severities.append((name, SEVERITIES[word]))
    return tuple(severities), complaints


def _overrides(key: str, value: object) -> _Read:
    if not isinstance(value, list) or not all(isinstance(table, dict) for table in value):
        return None, [_Complaint(f"`{key}` must be a list of tables")]
    overrides: list[Override] = []
    complaints: list[_Complaint] = []
    for number, table in enumerate(value):
        override, inner = _override(key, table)
        overrides += [override] if override is not None else []
        complaints += [_below(complaint, f"[{number}]") for complaint in inner]
    return tuple(overrides), complaints


def _override(key: str, table: dict[str, object]) -> tuple[Override | None, list[_Complaint]]:
    include, complaints = _strings(f"{key}.include", table.get("include", []))
    if not complaints and ("" in include or not include):
        missing = "must have at least one pattern, none of them empty"
        include, complaints = None, [_Complaint(f"`{key}.include` {missing}")]
    complaints = [_below(complaint, "include") for complaint in complaints]
    ignored, inner = _rule_names(f"{key}.ignore", table.get("ignore", []))
    complaints += [_below(complaint, "ignore") for complaint in inner]
    severities, inner = _severities(f"{key}.rules", table.get("rules", {}))
    complaints += [_below(complaint, "rules") for complaint in inner]
    for name in table:
        if name not in OVERRIDE_KEYS:
            complaints.append(_Complaint(f"unknown key `{key}.{name}`{_suggestion(name, OVERRIDE_KEYS)}", (name,)))
    if include is None:
        return None, complaints
    return Override(include, (*((rule, None) for rule in ignored or ()), *(severities or ()))), complaints


def _below(complaint: _Complaint, key: str) -> _Complaint:
    """A complaint about a value that is below a key."""
    return _Complaint(complaint.message, (key, *complaint.below), complaint.value)


def _evidence(key: str, value: object) -> _Read:
    from btq_lang.workspace.project_evidence import read_evidence  # few projects have logs

    settings, complaints = read_evidence(value)
    return settings, [_Complaint(message, below) for message, below in complaints]


def _simulation(key: str, value: object) -> _Read:
    from btq_lang.workspace.project_simulation import read_simulation  # few projects simulate runs

    settings, complaints = read_simulation(value)
    return settings, [_Complaint(message, below) for message, below in complaints]


def _requirements(key: str, value: object) -> _Read:
    from btq_lang.workspace.external_requirements import read_requirements  # few projects have this table

    settings, complaints = read_requirements(value)
    return settings, [_Complaint(message, below, named) for message, below, named in complaints]


def _factories(key: str, value: object) -> _Read:
    from btq_lang.workspace.factories import read_factories  # few projects have any

    factories, complaints = read_factories(value)
    return factories, [_Complaint(message, below, named) for message, below, named in complaints]


def _nodes(key: str, value: object) -> _Read:
    from btq_lang.catalog.nav2 import PACKAGED  # few projects have this key
    from btq_lang.workspace.file import CPP_SUFFIXES

    names, complaints = _strings(key, value)
    unknown = [name for name in names or () if name not in PACKAGED and not name.endswith(CPP_SUFFIXES)]
    complaints += [_Complaint(f"unknown nodes `{name}`{_suggestion(name, PACKAGED)}", value=name) for name in unknown]
    return tuple(name for name in dict.fromkeys(names or ()) if name not in unknown), complaints


SEVERITIES: dict[str, Severity | None] = {**{severity.value: severity for severity in Severity}, "off": None}
# What a key sets in a Project, how its value is read, which values that accepts, as the name of a definition in
# project_schema.py, and a line for editors.
KEYS = {
    "engine": ("engines", _engines, "engines", "the versions of BehaviorTree.CPP that must load the missions"),
    "qualities": ("qualities", _qualities, "edition", "the edition of the quality model for files that name none"),
    "include-paths": (
        "include_paths",
        _strings,
        "strings",
        "folders searched for included files, after that of the including file",
    ),
    "nodes": (
        "node_files",
        _nodes,
        "nodes",
        "nodes declared in all files: those that btq knows, as nav2-jazzy, and patterns of C++ sources",
    ),
    "external": ("external", _strings, "strings", "trees that other packages provide, which no file here defines"),
    "exclude": ("exclude", _strings, "strings", "patterns of paths that the check of a folder leaves out"),
    "select": ("select", _rule_names, "rules", "only these rules"),
    "ignore": ("ignore", _rule_names, "rules", "all rules except these"),
    "baseline": ("baseline", _file, "text", "the file with the findings that btq check does not report"),
    "rules": ("severities", _severities, "severities", "the severities of rules"),
    "overrides": ("overrides", _overrides, "overrides", "severities of rules in some files"),
    "evidence": ("evidence", _evidence, "evidence", "logs of what robots did, which btq verify reads"),
    "simulate": (
        "simulation",
        _simulation,
        "simulate",
        "what skills, the world and the program do in simulated runs",
    ),
    "requirements": ("requirements", _requirements, "requirements", "requirements that other tools keep"),
    "factory": ("factories", _factories, "factories", "what one program registers before it creates a tree"),
}


def _toml(text: str) -> object:
    # Only where there is a project file, for it costs more than to check a small file.
    import sys
    from importlib import import_module

    return import_module("tomllib" if sys.version_info >= (3, 11) else "tomli").loads(text)


def _syntax_problem(text: str, error: Exception) -> ProjectProblem:
    if isinstance(error, RecursionError):
        return ProjectProblem("nested too deeply")
    # The parser's messages describe the place in words, counted from 1; only Python 3.14's errors have it as numbers
    # too.
    message, _, place = str(error).partition(" (at ")
    if numbers := _DIGITS.findall(place):
        return ProjectProblem(message, Position(int(numbers[0]) - 1, int(numbers[1]) - 1))
    return ProjectProblem(message, LineIndex(text).position(len(text)) if place else None)


# ---- patterns ----

_BTQ_TABLE = re.compile(r"""(?m)^[ \t]*\[[ \t]*tool[ \t]*\.[ \t]*["']?btq["']?[ \t]*[].]""")
SUPPORTED = f"btq supports {VERSIONS[0]} to {VERSIONS[-1]}"
_CHECKED = f"btq supports {VERSION_3} and {VERSIONS[0]} to {VERSIONS[-1]}"
_NAMED = frozenset((VERSION_3, *PRODUCTS))
_RELEASE_LINE = re.compile(r"4\.(0|[1-9][0-9]?)")
_DIGITS = re.compile(r"\d+")


def _suggestion(name: str, names: Iterable[str]) -> str:
    return did_you_mean(near(name, names, 1))


def _quoted(word: str) -> str:
    return f'"{word}"'


def _joined(folder: str, path: str) -> str:
    return os.path.normpath(os.path.join(folder, path)).replace(os.sep, "/")


def _find(text: str, keys: tuple[str, ...], value: str | None = None) -> Position | None:
    from btq_lang.util.toml_places import find_key  # only for a mistake

    return find_key(text, keys, value)

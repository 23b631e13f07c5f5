"""The facts in the packages around trees for the project file that `btq init --from-xml` writes: the version of the
engine that they depend on, C++ sources that register nodes, and parameter files of Nav2.

One invariant: if places contradict each other, nothing is decided.
"""

from __future__ import annotations

import os.path
import posixpath
import re
from collections.abc import Iterable, Iterator, Mapping
from types import MappingProxyType
from typing import Final

from btq_lang.catalog.versions import MOVEIT_PRO, PRODUCTS, VERSION_3, VERSIONS
from btq_lang.nav2.parameters import read_parameters
from btq_lang.nav2.yaml_reader import YamlMissing, YamlProblem
from btq_lang.projects.tree_servers import TreePrograms, tree_programs
from btq_lang.util.record import Record
from btq_lang.workspace.config import Project
from btq_lang.workspace.file import CPP_SUFFIXES, YAML_SUFFIXES
from btq_lang.workspace.loader import collect, pool_of, read


class Packages(Record):
    """Facts in packages.

    Attributes:
        engines: the versions of the engine that they depend on; empty if none or several do.
        depends_on: the package of the engine, or of a product that has it, on which they depend.
        product: the product, as the key `engine` names it; empty if they depend on none.
        sources: folders with C++ that registers nodes or declares their ports, as patterns.
        registered: the names of nodes that the C++ shows to be registered.
        parameters: files with the parameters of a bt_navigator, each with the distribution of Nav2 that it is for, if
            that is clear.
        named: the names of XML files in Python and in launch files.
        programs: the servers of trees in parameter files, and the trees that clients name.
        registering: the C++ of `sources`.
    """

    engines: tuple[str, ...] = ()
    depends_on: str = ""
    product: str = ""
    sources: tuple[str, ...] = ()
    registered: frozenset[str] = frozenset()
    parameters: Mapping[str, str | None] = MappingProxyType({})
    named: frozenset[str] = frozenset()
    programs: TreePrograms = TreePrograms()
    registering: tuple[str, ...] = ()

    def sources_in(self, packages: Iterable[str]) -> tuple[str, ...]:
        """As `sources`, those below some folders, which are relative to that of the packages."""
        folders = tuple(f"{package}/" for package in packages)
        return tuple(_patterns([path for path in self.registering if path.startswith(folders)]))


def packages_of(folder: str) -> Packages:
    """The facts in the packages below a folder; if they name no engine, that of the package around it."""
    texts = _texts_below(folder, (*_MANIFESTS, *CPP_SUFFIXES, *YAML_SUFFIXES, *_PROGRAMS))
    above = pool_of(folder, folder)
    around = _texts_below(above, _MANIFESTS) if above != folder else {}
    of_product = _product_among(texts) or _product_among(around)
    depends_on = of_product or _engine_among(texts) or _engine_among(around)
    product = MOVEIT_PRO if of_product else ""
    below = {posixpath.relpath(path, folder): text for path, text in texts.items()}
    cpp = {path: text for path, text in below.items() if path.endswith(CPP_SUFFIXES) and not _is_of_tests(path)}
    sources = [path for path, text in cpp.items() if _REGISTERS(text) or _PORTS(text)]
    sources = sources if any(_REGISTERS(cpp[path]) for path in sources) else []
    settings = {path: text for path, text in below.items() if path.endswith(YAML_SUFFIXES) and _NAVIGATOR(text)}
    parameters = {path: _distribution(text) for path, text in settings.items()}
    named = {name for path, text in below.items() if path.endswith(_PROGRAMS) for name in _XML(text)}
    engines = (PRODUCTS[product],) if product else _ENGINES.get(depends_on, ())
    registered = frozenset([name for path in sources for name in _REGISTERED(cpp[path])])
    programs = tree_programs([text for path, text in below.items() if path.endswith(YAML_SUFFIXES)], folder)
    return Packages(
        engines,
        depends_on,
        product,
        tuple(_patterns(sources)),
        registered,
        parameters,
        frozenset(named),
        programs,
        tuple(sources),
    )


def _distribution(text: str) -> str | None:
    """The distribution that the parameters of a bt_navigator are for; None: that is unclear, or they cannot be read."""
    try:
        return read_parameters(text).distribution
    except (YamlMissing, YamlProblem):
        return None


def _texts_below(folder: str, suffixes: tuple[str, ...]) -> dict[str, str]:
    """The files below a folder whose names end with one of the suffixes, with their texts."""
    paths, _ = collect((folder,), Project(), suffixes)
    return {path: read(path)[0] or "" for path in paths}


def _product_among(texts: Mapping[str, str]) -> str:
    """The first package of MoveIt Pro that manifests depend on; empty if they depend on none."""
    manifests = (_COMMENT_IN_XML.sub("", texts[path]) for path in sorted(texts) if path.endswith(_MANIFESTS[0]))
    return next((match.group(1) for match in map(_OF_MOVEIT_PRO.search, manifests) if match is not None), "")


def _engine_among(texts: Mapping[str, str]) -> str:
    """The package of the engine that manifests name, or else CMake, or else includes; empty if none or both are."""
    for suffixes, comments, mention in _MENTIONS:
        named = (path for path in texts if path.endswith(suffixes))
        names = [name for path in named for name in mention.findall(comments.sub("", texts[path]))]
        packages = {_OLD if "3" in name else _NEW for name in names}
        if packages:
            return packages.pop() if len(packages) == 1 else ""
    return ""


def _is_of_tests(path: str) -> bool:
    return not {"test", "tests"}.isdisjoint(path.split("/")[:-1])


def _patterns(sources: Iterable[str]) -> Iterator[str]:
    """A pattern for the sources with one suffix in a folder; one for several folders below the folder around them."""
    folders: dict[tuple[str, str], set[str]] = {}
    for path in sources:
        top = path.rpartition("/")[0].partition("/")[0]
        folders.setdefault((top, os.path.splitext(path)[1]), set()).add(posixpath.dirname(path))
    for (top, suffix), in_folders in folders.items():
        yield posixpath.join(top, f"**/*{suffix}") if len(in_folders) > 1 else posixpath.join(*in_folders, f"*{suffix}")


_OLD: Final = "behaviortree_cpp_v3"
_NEW: Final = "behaviortree_cpp"
_ENGINES: Final = {_OLD: (VERSION_3,), _NEW: VERSIONS}
_NAMES: Final = f"{_OLD}|{_NEW}|behaviortree_ros2"
_MANIFESTS: Final = ("package.xml", "CMakeLists.txt")
_COMMENT_IN_XML: Final = re.compile("<!--.*?-->", re.DOTALL)
_DEPENDS: Final = r"<(?:build_|exec_|run_|build_export_)?depend\b[^>]*>\s*({})\s*</"
# What runs and registers nodes there; it was called MoveIt Studio.
_OF_MOVEIT_PRO: Final = re.compile(_DEPENDS.format(r"moveit_(?:pro|studio)_(?:agent|behavior)(?:_interface)?"))
# How paths end, what is a comment in such a file, and how it names the engine.
_MENTIONS: Final = (
    (
        _MANIFESTS[0],
        _COMMENT_IN_XML,
        re.compile(_DEPENDS.format(_NAMES)),
    ),
    (_MANIFESTS[1], re.compile("#.*"), re.compile(rf"\b({_NAMES}|BehaviorTreeV3)\b")),
    (
        CPP_SUFFIXES,
        re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL),
        re.compile(rf"#\s*include\s*[<\"]({_NAMES})/"),
    ),
)
_REGISTERS: Final = re.compile(
    r"\b(?:registerNodeType|registerBuilder|registerSimple(?:Action|Condition|Decorator)|BT_REGISTER_(?:ROS_)?NODES|CreateRosNodePlugin)\b"
).search
_PORTS: Final = re.compile(r"\bprovidedPorts\s*\(").search
_PROGRAMS: Final = (".py", ".launch.xml", ".launch")
_XML: Final = re.compile(r"[\w.-]+\.xml\b").findall
_NAVIGATOR: Final = re.compile(r"^[ \t]*bt_navigator[ \t]*:", re.MULTILINE).search
_REGISTERED: Final = re.compile(r'(?i:regist)\w*\s*(?:<[^;(){}]*>)?\s*\(\s*"?([A-Za-z_]\w*)"?\s*[,)]').findall

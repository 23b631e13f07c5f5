"""The workspace: many files as one immutable value, and name resolution across them.

One invariant: a workspace is a function of its texts and its project; one reached by edits equals a new one, and shares
with its predecessor all files that did not change.  It does not use the disk: the loader provides the texts, included
ones too.

Names are looked up in a file's scope: the file and what it includes, or in the workspace of a factory all that its
program registers.  The project's other files are known as well: an XML file has them as its pool, for its program may
register them too, and for others they only suggest where a name could be defined.
"""

from __future__ import annotations

import posixpath
from collections.abc import Hashable, Iterable, Iterator, Mapping
from functools import cached_property
from itertools import chain
from typing import TYPE_CHECKING

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nav2 import ENGINES, FILES, PACKAGED, distribution_among, ports_of
from btq_lang.catalog.versions import VERSIONS, is_before_4
from btq_lang.syntax.tree import Include, Model, Qualities, Root
from btq_lang.util.record import replace
from btq_lang.workspace.config import Project, include_candidates
from btq_lang.workspace.file import Definition, File, Origin, is_of_package
from btq_lang.workspace.item_index import Name, Names
from btq_lang.workspace.queries import Store
from btq_lang.workspace.symbols import Target, has_ports_of, interface

if TYPE_CHECKING:
    from btq_lang.workspace.factories import Factory


class Workspace:
    """All files at one moment.

    Attributes:
        files: by path; paths are absolute or all relative to one folder, with `/`.
        project: settings for all of them.
        factory: whose files these are, with all that they include; None: each file is a factory of its own.
    """

    def __init__(self, files: Mapping[str, File], project: Project, factory: Factory | None = None) -> None:
        self.files = files
        self.project = project
        self.factory = factory
        self._scopes: dict[str, Scope] = {}
        self._everywhere: dict[Name, tuple[Definition, ...]] = {}
        self._closures: dict[str, tuple[str, ...]] = {}

    def __reduce__(self) -> tuple[object, ...]:
        """The arguments with which another process makes it again."""
        return Workspace, (self.files, self.project, self.factory)

    @classmethod
    def of(cls, texts: Mapping[str, str], project: Project | None = None) -> Workspace:
        """A workspace of these texts, by path."""
        return cls({path: File(path, text) for path, text in texts.items()}, project or Project())

    def with_file(self, path: str, text: str, origin: Origin | None = None) -> Workspace:
        """The workspace after an edit that replaces the text of a file; every other file is shared.

        Args:
            origin: the file in another language, if `text` is its translation.
        """
        before = self.files.get(path)
        file = before.edited(text, origin) if before else File(path, text, origin)
        after = Workspace({**self.files, path: file}, self.project, self.factory)
        if before is not None and before.inclusion == file.inclusion:
            after._take_over(self, path)
        return after

    def with_read(self, file: File) -> Workspace:
        """The workspace after an edit that replaces a file, which may be in another language, by this one."""
        return self.with_file(file.path, file.text, file.origin)

    @cached_property
    def moved(self) -> Workspace:
        """The same files, for the engine that the project moves to."""
        target = self.project.moves_to or self.project.target
        engines, original = (ENGINES.get(target, target),), self.project.engines
        project = replace(self.project, engines=engines, moves_to=None, original_engines=original)
        return Workspace(self.files, project, self.factory)

    @cached_property
    def moved_nodes(self) -> Workspace:
        """As `moved`, with the nodes of Nav2 in the distribution that the project moves to."""
        target = FILES.get(self.project.moves_to or "")

        def those_of_target(paths: tuple[str, ...]) -> tuple[str, ...]:
            return tuple(target if target is not None and path in FILES.values() else path for path in paths)

        moved, factory = self.moved, self.factory
        project = replace(moved.project, node_files=those_of_target(moved.project.node_files))
        if factory is not None:
            factory = replace(factory, node_files=those_of_target(factory.node_files))
        return Workspace(self.files, project, factory)

    def let_go(self, paths: Iterable[str]) -> None:
        """Release all but text and names of some files; a caller that holds a definition in one must not look it up
        again.

        Args:
            paths: may include paths that are not in this workspace, which are ignored.
        """
        gone = self.files.keys() & paths
        for path in gone:
            if self.files[path].is_parsed:
                self.files[path].let_go()
        self._scopes = {path: scope for path, scope in self._scopes.items() if gone.isdisjoint(scope.paths)}
        self._everywhere.clear()

    def _take_over(self, before: Workspace, edited: str) -> None:
        """Copy cached results about includes, and the scopes of files that do not see the edited one."""
        for attribute in ("included_files", "missions"):
            if attribute in before.__dict__:
                self.__dict__[attribute] = before.__dict__[attribute]
        self._closures = before._closures
        self._scopes = {path: scope for path, scope in before._scopes.items() if edited not in scope.paths}

    @cached_property
    def store(self) -> Store[Workspace]:
        """The cached answers about it."""
        return Store(self)

    def pass_on(self, after: Workspace, topics: Iterable[Hashable]) -> None:
        """Pass the cached answers on to the workspace after an edit."""
        store = after.__dict__["store"] = self.__dict__.pop("store", None) or Store(self)
        store.advance(after, topics)

    def with_project(self, project: Project) -> Workspace:
        return Workspace(self.files, project, self.factory)

    def of_factory(self, factory: Factory) -> Workspace:
        """The workspace of a factory: those of the files that it registers."""
        named = (*factory.files, *factory.node_files, *self.project.node_files)
        inside = dict.fromkeys(each for path in named if path in self.files for each in self.closure(path))
        return Workspace({path: self.files[path] for path in inside}, _project_of(factory, self.project), factory)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Workspace) and (self.files, self.project, self.factory) == (
            other.files,
            other.project,
            other.factory,
        )

    def __hash__(self) -> int:
        return hash(tuple(self.files))

    @cached_property
    def foreign(self) -> Mapping[str, File]:
        """The files that are written in another language, by path."""
        return {path: file for path, file in self.files.items() if file.origin is not None}

    @cached_property
    def xml(self) -> tuple[str, ...]:
        """The files that are XML, which look up in their pool what they lack."""
        return tuple([path for path, file in self.foreign.items() if not file.is_cpp])

    # ---- includes and scopes ----

    def included(self, path: str, include: str, of_package: bool = False) -> str | None:
        """The file that an `include` in `path` refers to, if the workspace has it.

        Args:
            of_package: whether it is in a ROS package, which is known only on the robot.
        """
        candidates = () if of_package else include_candidates(self.project, path, include)
        return next((each for each in candidates if each in self.files), None)

    def included_by(self, path: str, include: Include) -> str | None:
        """As `included`, for an include of the tree."""
        return None if include.path is None else self.included(path, include.path.text, is_of_package(include))

    def closure(self, path: str) -> tuple[str, ...]:
        """A file and all that it includes, included ones first; each once, even if they include each other."""
        if path not in self._closures:
            self._closures[path] = self._closure(path)
        return self._closures[path]

    def registered_with(self, path: str) -> tuple[str, ...]:
        """All files that are registered when a file runs, it last: what it includes, and those of its factory."""
        return (*[each for each in self.scope(path).paths if each != path], path)

    def _closure(self, path: str) -> tuple[str, ...]:
        order: list[str] = []
        seen: set[str] = set()
        waiting = [(path, False)]
        while waiting:
            file, is_left = waiting.pop()
            if is_left:
                order.append(file)
            elif file not in seen:
                seen.add(file)
                waiting += ((file, True), *((target, False) for target in reversed([*self._targets(file)])))
        return tuple(order)

    def _targets(self, path: str) -> Iterator[str]:
        for named in self.files[path].included_paths:
            target = self.included(path, *named)
            if target is not None:
                yield target

    def scope(self, path: str) -> Scope:
        """The names that a file can use."""
        if path not in self._scopes:
            self._scopes[path] = self._scope(self.closure(path)) if self.factory is None else self._of_factory
        return self._scopes[path]

    def _scope(self, paths: tuple[str, ...], node_files: tuple[str, ...] = (), is_known: bool = True) -> Scope:
        """The scope of some files, and of the models in others."""
        nodes = dict.fromkeys((*node_files, *self.project.node_files))
        beside = tuple(path for path in nodes if path in self.files and path not in paths)
        unloaded: frozenset[str] = self.factory.unloaded if self.factory is not None else frozenset()
        return Scope(paths, self, beside, is_known, unloaded)

    @property
    def registered(self) -> tuple[str, ...]:
        """The files that the program registers, in order, each with what it includes; empty without a factory."""
        return self._of_factory.paths if self.factory is not None else ()

    @cached_property
    def _of_factory(self) -> Scope:
        """The scope of all files of the factory, in the order in which the program registers them."""
        assert self.factory is not None, "the caller has looked"
        registered = dict.fromkeys(
            each for path in self.factory.files if path in self.files for each in self.closure(path)
        )
        is_known = not self.factory.lost and not self.factory.has_gaps
        return self._scope(tuple(registered), self.factory.node_files, is_known)

    @cached_property
    def included_files(self) -> frozenset[str]:
        """The files that another file includes; a file of scenarios includes one as a program loads it."""
        including = [path for path, file in self.files.items() if not file.has_only_scenarios]
        return frozenset(target for path in including for target in self._targets(path) if target != path)

    @cached_property
    def missions(self) -> Mapping[str, str]:
        """For each file a name for all that it is linked with by includes, either way, directly or not, or by its
        factory."""
        if self.factory is not None:
            return dict.fromkeys(self.files, min(self.files, default=""))
        leaders = {path: path for path in self.files}

        def first(path: str) -> str:
            while leaders[path] != path:
                path = leaders[path]
            return path

        for path in self.files:
            for target in self._targets(path):
                low, high = sorted((first(path), first(target)))
                leaders[high] = low
        return {path: first(path) for path in self.files}

    def linked(self, *paths: str) -> list[str]:
        """Files, those that see them, and those that they see, directly or not."""
        if not {*self.project.node_files}.isdisjoint(paths):
            return list(self.missions)  # all files see their models
        missions = {self.missions[path] for path in paths}
        return [other for other, mission in self.missions.items() if mission in missions]

    # ---- definitions ----

    def files_defining(self, kind: Kind, name: str) -> tuple[str, ...]:
        """The files of the project that define a name, to suggest where it could come from; this is known even if a
        file's tree was released."""
        foreign = [path for path in self._foreign_defining.get(name, ()) if self.files[path].defines(kind, name)]
        own = [path for path in self._own_files if self.files[path].defines(kind, name)]
        return (*own, *foreign)

    @cached_property
    def _foreign_defining(self) -> Mapping[str, list[str]]:
        """The files in another language that define a tree or model of a name."""
        paths_by_name: dict[str, list[str]] = {}
        for path, file in self.foreign.items():
            for name in file.origin.defines if file.origin is not None else ():
                paths_by_name.setdefault(name, []).append(path)
        return paths_by_name

    @cached_property
    def _own_files(self) -> tuple[str, ...]:
        """The files in this language."""
        return tuple([path for path in self.files if path not in self.foreign])

    def defined_anywhere(self, kind: Kind, name: str) -> tuple[Definition, ...]:
        """Every definition of a name in the project."""
        key = kind, name
        if key not in self._everywhere:
            files = [self.files[path] for path in self.files_defining(kind, name)]
            self._everywhere[key] = tuple([each for file in files for each in file.definitions(kind, name)])
        return self._everywhere[key]

    def find(self, path: str, kind: Kind, name: str) -> Definition | None:
        """The definition that a name means in a file: the first one in scope, else that in the pool, if all agree."""
        definition = self.scope(path).find(kind, name)
        if definition is not None:
            return definition
        pooled = self.pooled(path, kind, name)
        models = [each.symbol.target for each in pooled]
        agree = len({interface(model) if isinstance(model, Model) else id(model) for model in models}) == 1
        return pooled[0] if agree and not _may_be_of_nav2(models[0], name) else None

    def pooled(self, path: str, kind: Kind, name: str) -> tuple[Definition, ...]:
        """The possible meanings of a name outside the scope of an XML file: a tree of its folder's XML, else of its
        project; the project's models of a node.  A program may register all of these files, or only some."""
        anywhere = self.defined_anywhere(kind, name) if self.files[path].origin is not None else ()
        pool = self.project.pool_of(path) if anywhere else None  # most names that are looked up are nowhere
        if pool is None:
            return ()
        scope = self.scope(path).paths
        in_pool = [each for each in anywhere if each.path.startswith(pool) and each.path not in scope]
        folder = posixpath.dirname(path)
        near = [each for each in in_pool if posixpath.dirname(each.path) == folder and each.path in self.foreign]
        return tuple((near or in_pool) if kind is Kind.TREE else in_pool)

    # ---- missions ----

    def edition(self, path: str) -> str:
        """The edition of the quality model that holds for a file."""
        from btq_lang.catalog.qualities import EDITIONS  # its tables are large, and few commands need them

        named = [each.edition.text for each in self.files[path].of_type(Qualities) if each.edition is not None]
        return next((name for name in named if name in EDITIONS), self.project.qualities)

    def main_tree(self, path: str) -> Definition | None:
        """The tree that runs when the engine loads the file: the factory's first main tree, or the one that its `Root`
        names, its only tree, or the only one of its trees that no other of its trees refers to."""
        if self.factory is not None and self.factory.main:
            return self.scope(path).find(Kind.TREE, self.factory.main[0])
        file = self.files[path]
        for root in file.of_type(Root):
            values = (pair.value for pair in root.attributes if pair.key.text == "main_tree_to_execute")
            named = root.name or next(values, None)
            if named is not None:
                return self.scope(path).find(Kind.TREE, named.text)
        trees = file.names.by_kind[Kind.TREE]
        if len(trees) > 1 or any(len(file.names.definitions[Kind.TREE, name]) > 1 for name in trees):
            runs = file.names_used("runs")
            trees = tuple([name for name in trees if name not in runs])
        definitions = file.definitions(Kind.TREE, trees[0]) if len(trees) == 1 else ()
        return definitions[0] if len(definitions) == 1 else None


class Scope:
    """The names that a file can use: its own and those of the files it includes, directly or not, or of its factory.

    Attributes:
        paths: of those files, included ones first.
        node_paths: of files whose models count, and nothing else in them.
        complete: whether all includes were found and understood, and no string may have swallowed the rest of a file,
            so that a name that is not here does not exist.
    """

    def __init__(
        self,
        paths: tuple[str, ...],
        workspace: Workspace,
        node_paths: tuple[str, ...] = (),
        is_known: bool = True,
        unloaded: frozenset[str] = frozenset(),
    ) -> None:
        """Look up names in some files.

        Args:
            is_known: whether all of the scope's files are known.
            unloaded: C++ whose models count only if there are no others, as the program does not load its library.
        """
        self.paths = paths
        self.node_paths = node_paths
        self._files = [workspace.files[path] for path in paths]
        of_models = [*self._files, *(workspace.files[path] for path in node_paths)]
        cpp = [file for file in of_models if file.is_cpp]  # what registers a node counts first
        self._of_models = (
            sorted(of_models, key=lambda file: (file.path in unloaded, not file.is_cpp)) if cpp else of_models
        )
        self._cpp = frozenset([file.path for file in cpp])
        self._unloaded = unloaded
        self.complete = (
            is_known
            and all(
                (target := workspace.included_by(file.path, include)) is not None
                and workspace.files[target].is_understood
                for file in self._files
                for include in file.includes
            )
            and not any(file.is_swallowed for file in self._files)
        )
        self._definitions: dict[Name, tuple[Definition, ...]] = {}
        self._names: dict[Kind, tuple[str, ...]] = {}
        self._repeated: frozenset[Name] | None = None

    def defines(self, kind: Kind, name: str) -> bool:
        """Whether a name is defined."""
        key = kind, name
        return bool([file for file in self.files(kind) if key in file.names.definitions])

    def files(self, kind: Kind) -> list[File]:
        """The files whose definitions of a kind count."""
        return self._of_models if kind is Kind.MODEL else self._files

    def find(self, kind: Kind, name: str) -> Definition | None:
        """The definition of a name that counts: the first one."""
        definitions = self.all(kind, name)
        return definitions[0] if definitions else None

    def target(self, kind: Kind, name: str) -> Target | None:
        """The target of that definition."""
        definition = self.find(kind, name)
        return definition.symbol.target if definition is not None else None

    def all(self, kind: Kind, name: str) -> tuple[Definition, ...]:
        """Every definition of a name, the one that counts first."""
        definitions = self._definitions.get((kind, name))
        return self._look_up(kind, name) if definitions is None else definitions

    def is_repeated(self, kind: Kind, name: str) -> bool:
        """Whether a name has several definitions: hardly any has, so this is worth checking before looking at all of
        them."""
        if self._repeated is None:
            self._repeated = _repeated([file.names for file in self._files])
        return (kind, name) in self._repeated

    def names(self, kind: Kind) -> tuple[str, ...]:
        """All names of a kind, in the order of their definitions."""
        names = self._names.get(kind)
        if names is None:
            by_file = [file.names.by_kind[kind] for file in self.files(kind)]
            names = self._names[kind] = by_file[0] if len(by_file) == 1 else tuple(dict.fromkeys(chain(*by_file)))
        return names

    def _look_up(self, kind: Kind, name: str) -> tuple[Definition, ...]:
        key = kind, name
        definitions: tuple[Definition, ...] = ()
        for file in self.files(kind):
            if key in file.names.definitions:
                definitions += file.definitions(kind, name)
        if kind is Kind.MODEL and self._unloaded and definitions:
            loaded = tuple([each for each in definitions if each.path not in self._unloaded])
            definitions = loaded or definitions
        if kind is Kind.MODEL and len(definitions) > 1 and self.node_paths:
            # Nothing says more than C++ but what is known of Nav2's nodes.
            definitions = _richest_first(
                definitions, tuple(FILES.values()) if definitions[0].path in self._cpp else self.node_paths
            )
        self._definitions[key] = definitions
        return definitions


def _project_of(factory: Factory, project: Project) -> Project:
    """The project as it holds for a factory: a distribution that a factory names determines its engine, whichever the
    project names for its other programs."""
    distribution = distribution_among([PACKAGED[name] for name in factory.nodes if name in PACKAGED])
    if distribution is None or is_before_4(ENGINES[distribution]) == is_before_4(project.target):
        return project
    return replace(project, engines=VERSIONS, names_all=False)


def _may_be_of_nav2(target: object, name: str) -> bool:
    """Whether Nav2 has a node of a name, in no distribution with all ports of the model: either may be meant."""
    nav2_ports = ports_of(name) if isinstance(target, Model) else None
    ports = target.ports if isinstance(target, Model) else ()
    return nav2_ports is not None and not nav2_ports.issuperset([port.id.text for port in ports if port.id is not None])


def _richest_first(models: tuple[Definition, ...], node_paths: tuple[str, ...]) -> tuple[Definition, ...]:
    """The models of a node, the one that counts first: that of a file of nodes, if it has the ports of the first one.

    Groot writes models without types, and not always with all ports; such a file says more about the same node.  A
    model with other ports is of another node.
    """
    for model in models[1:]:
        if model.path in node_paths and has_ports_of(model.symbol, models[0].symbol):
            return model, *(other for other in models if other is not model)
    return models


def _repeated(files: list[Names]) -> frozenset[Name]:
    """The names with several definitions, in one of these files or in two of them."""
    seen: set[Name] = set()
    repeated: set[Name] = set()
    for names in files:
        repeated |= names.repeated
        repeated |= seen & names.all
        seen |= names.all
    return frozenset(repeated)

"""The parameters of bt_navigator in a file, and the distribution that they are for.

One invariant: a parameter is found as ROS 2 finds it: below `bt_navigator`, in a namespace or not, or below `/**`, as
`a: b:` or as `a.b:`; the last one counts.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.nav2 import DISTRIBUTIONS
from btq_lang.catalog.nav2.libraries import LIBRARIES
from btq_lang.catalog.nav2.navigator import (
    NAVIGATORS,
    OWN_PACKAGE,
    PARAMETERS,
    RENAMED,
    SENDERS,
    outside_entries,
)
from btq_lang.nav2.yaml_reader import YamlValue, read_yaml
from btq_lang.util.reach import reached
from btq_lang.util.record import Record
from btq_lang.util.spelling import near
from btq_lang.util.text import Span

if TYPE_CHECKING:
    from btq_lang.catalog.nav2.navigator import OutsideEntry


class ParameterText(Record):
    """A string of a parameter and its place."""

    text: str
    span: Span


class Parameters(Record):
    """The parameters of bt_navigator.

    Attributes:
        values: by name, `a.b` for one below another; each with its key.
        place: of the name of the node; None if the file has no such node.
        goals: the trees that other servers name for the goals that they send to it.
        shared: the names among the values that only a section for all nodes has.
        misspelt: keys that keep the node from its parameters, each with what is meant.
        has_client_nodes: whether it sets parameters of the nodes that only Humble configures by themselves.
    """

    values: dict[str, tuple[YamlValue, YamlValue]]
    place: Span | None
    goals: tuple[ParameterText, ...] = ()
    shared: frozenset[str] = frozenset()
    misspelt: tuple[tuple[ParameterText, str], ...] = ()
    has_client_nodes: bool = False

    def text(self, name: str) -> ParameterText | None:
        """The value of a parameter that is a string."""
        _, value = self.values.get(name, (None, None))
        return None if value is None or value.text is None else ParameterText(value.text, value.span)

    def texts(self, name: str) -> tuple[ParameterText, ...] | None:
        """The values of a parameter that is a list of strings; None if it is not set."""
        if name not in self.values:
            return None
        _, value = self.values[name]
        return tuple(ParameterText(item.text, item.span) for item in value.items if item.text is not None)

    def key(self, name: str) -> Span | None:
        """The place of a parameter's name."""
        return self.values[name][0].span if name in self.values else None

    @property
    def navigators(self) -> tuple[str, ...]:
        """The names of the navigators."""
        names = self.texts("navigators")
        return tuple(NAVIGATORS) if names is None else tuple(name.text for name in names)

    def unread(self, distribution: str) -> Iterator[tuple[str, str]]:
        """The parameters that a distribution does not read, each with its row in the table."""
        for name in self.values:
            row = self.row(name)
            value = self.text(name)
            if row is None or distribution[0] in PARAMETERS[row].of:
                continue
            if value is None or not value.text or value.text != PARAMETERS[row].default:
                yield name, row

    @property
    def distribution(self) -> str | None:
        """The only distribution that the parameters can be for, if there is one."""
        letters = {distribution[0] for distribution in DISTRIBUTIONS}
        for name in self.values:
            row = self.row(name)
            letters &= {*PARAMETERS[row].of} or letters if row is not None else letters
        for parameter, _, _ in NAVIGATORS.values():
            named = self.text(parameter)
            letters &= {"l"} if named is not None and is_id(named.text) else letters
        for _, plugin in self.plugins:
            package = plugin.text[len(OWN_PACKAGE) :] if plugin.text.startswith(OWN_PACKAGE) else ""
            letters &= {*("i" if package.startswith("/") else "jkl" if package.startswith("::") else letters)}
        for library in self.texts("plugin_lib_names") or ():
            _, existing, loaded = LIBRARIES.get(library.text, ((), "", ""))
            letters &= {*existing} or letters
            letters = letters - ({*loaded} & {*_ADDING}) or letters  # twice only by mistake
        if any(prefix.text == "follow_object" for prefix in self.texts("error_code_name_prefixes") or ()):
            letters &= {"l"}
        if self.has_client_nodes and "h" in letters:
            letters = {"h"}
        return (
            next(distribution for distribution in DISTRIBUTIONS if distribution[0] in letters)
            if len(letters) == 1
            else None
        )

    @property
    def plugins(self) -> Iterator[tuple[str, ParameterText]]:
        """The navigators whose class is named, and its name."""
        for navigator in self.navigators:
            if (plugin := self.text(f"{navigator}.plugin")) is not None:
                yield navigator, plugin

    def entries(self, distribution: str) -> tuple[OutsideEntry, ...]:
        """The entries of the blackboard that bt_navigator sets or reads."""
        is_of_navigator = distribution[0] == "l"
        renamed: dict[str, str] = {}
        for parameter, entry in RENAMED.items():
            for name in (f"{navigator}.{parameter}" for navigator in NAVIGATORS) if is_of_navigator else (parameter,):
                if (text := self.text(name)) is not None:
                    renamed[entry] = text.text
        codes = self.texts("error_code_names" if distribution[0] in "ij" else "error_code_name_prefixes")
        return outside_entries(distribution, None if codes is None else tuple(code.text for code in codes), renamed)

    @property
    def period(self) -> int:
        """The time from one tick to the next, in milliseconds."""
        text = self.text("bt_loop_duration")
        return int(text.text) if text is not None and text.text.isdecimal() and int(text.text) > 0 else 10

    def row(self, name: str) -> str | None:
        """The row of a parameter in the table; None if it is not one of Nav2."""
        navigator, _, rest = name.partition(".")
        row_name = f"*.{rest}" if rest and navigator in (*NAVIGATORS, *self.navigators) else name
        return row_name if row_name in PARAMETERS else None


def is_id(named: str) -> bool:
    """Whether Lyrical reads the name of a tree as its ID and not as a file; earlier ones know files only."""
    return not named.endswith(".xml") and _ID.fullmatch(named) is not None


@lru_cache(8)  # a server reads them again and again
def read_parameters(text: str) -> Parameters:
    """The parameters of bt_navigator in a file.

    Raises:
        YamlProblem: it is not YAML.
        YamlMissing: PyYAML is not installed.
    """
    top = read_yaml(text)
    nodes = [*nodes_with_parameters(top)]
    values: dict[str, tuple[YamlValue, YamlValue]] = {}
    own: set[str] = set()
    goals: dict[ParameterText, None] = {}
    place = None
    for key, node in sorted(nodes, key=lambda entry: _last(entry[0]) == NODE):  # what names the node counts most
        if _last(key) in (NODE, "*", "**"):
            place = key.span if _last(key) == NODE else place
            below = {".".join(part.text or "" for part in name): (name[-1], value) for name, value in _flat(node)}
            values.update(below)
            own.update(below if _last(key) == NODE else ())
        named = node.get(SENDERS[_last(key)]) if _last(key) in SENDERS else None
        if named is not None and named.text:
            goals[ParameterText(named.text, named.span)] = None
    is_of_humble = any(_last(key).startswith(f"{NODE}_navigate_") for key, _ in nodes)
    misspelt = tuple(_misspelt(top, place is None))
    return Parameters(values, place, tuple(goals), frozenset(values.keys() - own), misspelt, is_of_humble)


def nodes_with_parameters(top: YamlValue) -> Iterator[tuple[YamlValue, YamlValue]]:
    """The names of nodes with their parameters, in any namespaces."""
    around = reached([top], lambda value: [below for _, below in value.entries if below.get(_PARAMETERS) is None])
    for key, below in (entry for value in around for entry in value.entries):
        if (parameters := below.get(_PARAMETERS)) is not None:
            yield key, parameters


def _misspelt(top: YamlValue, has_no_node: bool) -> Iterator[tuple[ParameterText, str]]:
    """The misspelt keys around the parameters of bt_navigator, each with the right one."""

    def inside(value: YamlValue) -> list[YamlValue]:
        entries = [(key.text or "", below) for key, below in value.entries if below.get(_PARAMETERS) is None]
        return [below for key, below in entries if not near(key, (_PARAMETERS,))]

    for key, below in (entry for value in reached([top], inside) for entry in value.entries):
        if near(key.text or "", (_PARAMETERS,)):
            yield ParameterText(key.text or "", key.span), _PARAMETERS
        elif has_no_node and below.get(_PARAMETERS) is not None and near(_last(key), (NODE,)):
            yield ParameterText(_last(key), key.span), NODE


def _flat(node: YamlValue) -> Iterator[tuple[tuple[YamlValue, ...], YamlValue]]:
    """The parameters of a node, and those one level below; deeper ones do not matter."""
    for key, value in node.entries:
        yield (key,), value
        for name, below in value.entries:
            yield (key, name), below


def _last(key: YamlValue) -> str:
    return (key.text or "").rpartition("/")[2]


_ID: Final = re.compile(r"[\w.-]+")  # what a launch file replaces is often a sentence
NODE: Final = "bt_navigator"
_PARAMETERS: Final = "ros__parameters"
_ADDING: Final = "jkl"  # the distributions that add the named libraries to their own

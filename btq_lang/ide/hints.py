"""What an editor may show between the lines: inlay hints and code lenses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from btq_lang.btcpp.side_elements import element_descriptions
from btq_lang.btcpp.side_file import side_path
from btq_lang.catalog.name_kinds import Kind
from btq_lang.ide import describe
from btq_lang.ide.clause_enforcement import MOST_MISSIONS, missions_of
from btq_lang.ide.meaning import ReferenceAt, Subject, definition, everywhere, home_of, is_main, quality_of, subject
from btq_lang.ide.outline import requirement_detail
from btq_lang.ide.ports import port_of
from btq_lang.ide.scenarios import listed
from btq_lang.ide.violations import EXPLORE_TITLE, askable_names
from btq_lang.requirements.resolve import requirements
from btq_lang.syntax.scenarios import Scenario
from btq_lang.syntax.tree import Entry, Requirement, Root
from btq_lang.util.record import Record
from btq_lang.util.text import Span, counted
from btq_lang.workspace.inputs import everything
from btq_lang.workspace.queries import Store
from btq_lang.workspace.references import What
from btq_lang.workspace.symbols import names_subject
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.ide.verdicts import ProjectVerdicts

_COUNTED = {Kind.REQUIREMENT: What.REQUIREMENT, Kind.TREE: What.TREE}


class Hint(Record):
    """A remark after a word.  tooltip: more about it."""

    offset: int
    label: str
    tooltip: str


class Lens(Record):
    """A remark above a line.

    Attributes:
        places: what it counts, by file.
        runs: the title of the scenario that it runs.
        explores: the requirement that it asks about.
    """

    span: Span
    title: str
    places: tuple[tuple[str, Span], ...]
    runs: str = ""
    explores: str = ""


def inlay_hints(workspace: Workspace, path: str, within: Span) -> tuple[Hint, ...]:
    """The quality of each requirement that is only referred to, and the number that is written to a port for a
    quantity."""
    file = workspace.files[path]
    hints: list[Hint] = []
    for entry in file.parsed.entries:
        for mention in file.mentions_of(entry):
            span = mention.span.shifted(entry.start)
            if span.end < within.start or span.start > within.end:
                continue
            if mention.what is What.REQUIREMENT and not mention.defines:
                referent = subject(workspace, ReferenceAt(path, entry, mention))
                place = definition(workspace, path, referent)
                item = place.symbol.target if place is not None and referent.home else None
                quality = quality_of(place) if place is not None else None
                if isinstance(item, Requirement) and quality is not None:
                    hints.append(Hint(span.end, f": {quality.names[-1].text}", requirement_detail(item)))
            elif mention.what is What.QUANTITY and mention.node is not None and mention.pair is not None:
                port = port_of(workspace, path, mention.node, mention.pair.key.text)
                unit = port.unit if port is not None else None
                number = describe.in_unit(mention.name, unit)
                if number is not None and mention.name.split() != [number, unit]:
                    hints.append(Hint(span.end, f"= {number}", describe.quantity(mention.name, unit) or ""))
    return tuple(hints)


def code_lenses(
    workspace: Workspace,
    path: str,
    side: str | None = None,
    evidence: ProjectVerdicts | None = None,
    outlooks: Mapping[str, str] | None = None,
) -> tuple[Lens, ...]:
    """How many places use a requirement, how many nodes it names itself, how many nodes call a tree; the main tree; and
    what logs show of a requirement, and to explore how it can be violated; and for each scenario, to run it.

    As a reader counts: a requirement that is defined at a node is used there, and has a lens only if there are more
    uses; neither the `Root` that names the main tree nor a scenario calls it.

    Args:
        outlooks: how likely trees succeed, by their names.
    """
    lenses: list[Lens] = []
    asked: frozenset[str] | None = None
    for place in workspace.files[path].defined:
        kind = place.symbol.kind
        if kind not in _COUNTED or workspace.scope(path).find(kind, place.symbol.name) != place:
            continue
        what = _COUNTED[kind]
        own = place.path, place.span
        mentions = [*everywhere(workspace, Subject(what, place.symbol.name, home_of(place)))]
        others = tuple(
            (one.path, one.span)
            for one in mentions
            if (one.path, one.span) != own
            and not _is_root(one.entry)
            and not (kind is Kind.TREE and one.entry is not None and isinstance(one.entry.item, Scenario))
        )
        if kind is Kind.TREE:
            is_top = path not in workspace.included_files and is_main(workspace, path, place.entry)
            is_main_tree = is_top or any(_is_root(one.entry) for one in mentions)
            titles = ["main tree"] if is_main_tree else []
            if others or not is_main_tree:
                titles.append(counted(len(others), "call"))
            lenses.append(Lens(place.span, ", ".join(titles), others))
            if outlooks and place.symbol.name in outlooks:
                lenses.append(Lens(place.span, outlooks[place.symbol.name], ()))
            continue
        is_in_place = not isinstance(place.entry.item, Requirement)
        uses = (own, *others) if is_in_place and others else others
        titles = [counted(len(uses), "use")]
        nodes: tuple[tuple[str, Span], ...] = ()
        if names_subject(place.symbol.target):
            missions = missions_of(workspace, path)
            of_missions = [workspace.store.ask(_by_subject, each) for each in missions[:MOST_MISSIONS]]
            defined = place.symbol.name, place.path
            nodes = tuple(dict.fromkeys(node for each in of_missions for node in each.get(defined, ())))
            more = " or more" if len(missions) > MOST_MISSIONS else ""
            holds = [f"holds for {counted(len(nodes), 'node')}{more}"] if nodes else []
            titles = [*(titles if uses or not nodes else ()), *holds]
        if uses or nodes or not is_in_place:
            lenses.append(Lens(place.span, ", ".join(titles), tuple(dict.fromkeys((*uses, *nodes)))))
        asked = askable_names(workspace, path) if asked is None else asked
        if place.symbol.name in asked:
            lenses.append(Lens(place.span, EXPLORE_TITLE, (), explores=place.symbol.name))
    lenses += [Lens(each.head, "run", (), each.title) for each in listed(workspace, path) if each.title]
    return (*lenses, *_verdict_lenses(workspace, path, evidence), *_build_lenses(workspace, path, side))


def _verdict_lenses(workspace: Workspace, path: str, evidence: ProjectVerdicts | None) -> Iterator[Lens]:
    """The worst verdict on each requirement."""
    if evidence is None:
        return
    from btq_lang.ide.verdicts import verdict_titles  # few projects have logs

    yield from (Lens(*title) for title in verdict_titles(workspace, path, evidence))


def _build_lenses(workspace: Workspace, path: str, side: str | None) -> Iterator[Lens]:
    """How many requirements and qualities each element of XML has by its build; what is wrong with its side file."""
    file = workspace.files[path]
    built = element_descriptions(workspace, path, side)
    if built.problem:
        yield Lens(Span(0, 0), f"{side_path(path.rpartition('/')[2])} {built.problem}", ())
    for tag, lines in sorted(built.lines.items()):
        qualities = sum(line.startswith("satisfices ") for line in lines)
        counts = (counted(len(lines) - qualities, "requirement"), counted(qualities, "quality", "qualities"))
        start = file.from_disk(tag)
        if start is not None:
            shown = ", ".join(each for each in counts if not each.startswith("0 "))
            yield Lens(Span(start, start + 1), shown, ())


def _is_root(entry: Entry | None) -> bool:
    return entry is not None and isinstance(entry.item, Root)


def _by_subject(store: Store[Workspace], mission: str) -> dict[tuple[str, str], tuple[tuple[str, Span], ...]]:
    """The nodes that the claims of requirements name, by name and file, for all of a mission: they are resolved
    together."""
    workspace = store.ask(everything, mission)
    by_requirement: dict[tuple[str, str], dict[tuple[str, Span], None]] = {}
    for applied in requirements(workspace, mission).applied:
        if applied.how == "subject":
            defined_in = applied.requirement.place.path
            assert defined_in is not None, "a definition is in a file"
            nodes = by_requirement.setdefault((applied.requirement.name, defined_in), {})
            for source in applied.nodes:
                nodes[source.path, workspace.files[source.path].span_of(source.place)] = None
    return {key: tuple(nodes) for key, nodes in by_requirement.items()}

"""Clauses with `per` a node in whose activations the other node never starts.

One invariant: nothing is reported where anything unknown may run the two at the same time: a control node that is not
built in, a tree that nothing defines, another file.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain, permutations
from typing import Final

from btq_lang.checks import lookups
from btq_lang.checks.calls import has_gaps, has_meant, runs
from btq_lang.checks.demanded import Demanded, PlacedDiagnostic, diagnostic_at
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Related
from btq_lang.requirements.model import NodeTarget
from btq_lang.requirements.nodes import mission
from btq_lang.syntax.tree import written
from btq_lang.workspace import inputs
from btq_lang.workspace.resolved import ResolvedNode


def never_counted(demanded: Demanded) -> Iterator[PlacedDiagnostic]:
    """A number of starts in each activation of a node that neither runs the other one nor runs at the same time."""
    view = demanded.view
    for _, claim, node, place in demanded.claims:
        subject, per = claim.subject, claim.per
        if not isinstance(subject, NodeTarget) or not isinstance(per, NodeTarget) or subject.through or per.through:
            continue
        holder = per.node
        if node is view.ask(mission):
            continue  # it starts once in a run, which bounds.py reports
        if _is_open(view) or _reaches(view, holder, node) or _may_overlap(view, holder, node):
            continue
        counted, holding = claim.text.partition(f" {claim.head} ")[0], claim.text.rpartition(" per ")[2]
        message = f"`{counted}` never starts while `{holding}` runs, so nothing is counted"
        related = (Related(holder.place, "named by `per`"),)
        tree = node.tree if node.parent is not None else None
        above = f", such as its tree: `per {written(tree)}`" if tree is not None else ""
        notes = (f"after `per` goes a node that runs the other one{above}",)
        yield diagnostic_at(place, "impossible-bound", message, related, notes)


def _is_open(view: View) -> bool:
    """Whether something that is not seen here may run the trees."""
    return len(view.ask(lookups.main_trees)) != 1 or view.is_used_elsewhere or view.ask(has_gaps) or view.ask(has_meant)


def _may_overlap(view: View, one: ResolvedNode, other: ResolvedNode) -> bool:
    """Whether a node of any tree may tick one of two nodes while the other one runs."""
    nodes = chain(*[view.seen_in(*tree).all for tree in view.ask(inputs.trees)])
    return any(
        len(node.node.children) != len(node.children)  # some are in XML, which is not read here
        or any(
            _reaches(view, first, one) and _reaches(view, second, other)
            for first, second in permutations(node.children, 2)
        )
        for node in nodes
        if not _is_one_by_one(node)
    )


def _is_one_by_one(node: ResolvedNode) -> bool:
    """Whether a node ticks no child while another one runs."""
    return node.behavior is not None and node.flow in _ONE_BY_ONE and not node.behavior.reactive


def _reaches(view: View, node: ResolvedNode, other: ResolvedNode) -> bool:
    """Whether a node is another one, or runs it."""
    if node is other or node in other.ancestors():
        return True
    subtrees = [
        below for below in view.seen_in(node.path, node.facts).subtrees if below is node or node in below.ancestors()
    ]
    tree = other.tree or ""
    return any(below.id is not None and view.ask(runs, below.id.text, tree) for below in subtrees)


_ONE_BY_ONE: Final = ("sequence", "fallback", "choice", "switch", "recover", "rotate")

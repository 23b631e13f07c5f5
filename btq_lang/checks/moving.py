"""What changes for a tree when its robot moves on to another version of the engine, or distribution of Nav2
(`btq check --target`).

Sources: the files and tables of `catalog/nav2`.
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.nav2 import DISTRIBUTIONS, ENGINES
from btq_lang.catalog.versions import is_before_4
from btq_lang.checks import lookups
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.syntax.tree import Include


def moving_on(view: View) -> Iterator[Diagnostic]:
    """Nodes and ports that the target does not have, and those that mean something else in it."""
    target = view.project.moves_to
    if target is None:
        return
    from btq_lang.checks.target_changes import engine_changes  # few checks have a target

    yield from engine_changes(view, _engine(view), ENGINES.get(target, target))
    steps = _steps(view)
    if not steps:
        return
    from btq_lang.checks.target_changes import changes_of, ports_in  # as above

    for resolved in view.nodes:
        if (
            not resolved.is_subtree
            and resolved.id is not None
            and ports_in(view, steps[0], resolved.id.text) is not None
        ):
            yield from changes_of(view, resolved, resolved.id, steps)


def moving_include(view: View) -> Iterator[Diagnostic]:
    """An included file that Humble looks for in another folder."""
    path = view.item.path if isinstance(view.item, Include) else None
    steps = _steps(view)
    if path is not None and steps[:1] == ("humble",) and not path.text.startswith("/"):
        what = "from Iron on the path counts from the file that includes it, not from bt_navigator's working folder"
        yield Diagnostic("target-differs", path.span, what, notes=("write the path from the folder of this file",))


def _steps(view: View) -> tuple[str, ...]:
    """The distribution that the trees are for, and those on the way to the target; empty if there is no way."""
    target = view.project.moves_to
    origin = view.ask(lookups.distribution) if target in DISTRIBUTIONS else None
    if target is None or origin is None or origin == target:
        return ()
    start, end = DISTRIBUTIONS.index(origin), DISTRIBUTIONS.index(target)
    return DISTRIBUTIONS[start : end + 1] if start <= end else DISTRIBUTIONS[end : start + 1][::-1]


def _engine(view: View) -> str:
    """The version that the trees are for: by its syntax, its project, or its distribution; else the oldest known."""
    distribution = view.ask(lookups.distribution)
    of_distribution = ENGINES[distribution] if distribution is not None else None
    if is_before_4(view.target):
        is_declared = of_distribution is not None and is_before_4(of_distribution) and not view.project.pinned
        return of_distribution if of_distribution is not None and is_declared else view.target
    return view.target if view.is_pinned else of_distribution or view.engines[0]

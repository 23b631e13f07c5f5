"""What the quality names in a mission mean: the mission's own declarations take precedence over the quality model.

One invariant: every name has a meaning; an unknown name belongs to no characteristic.
"""

from __future__ import annotations

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.qualities import DEFAULT_EDITION, EDITIONS, Edition, Quality, find, fold, get, successors
from btq_lang.syntax.tree import Qualities, QualityDecl
from btq_lang.util.record import Record
from btq_lang.workspace.workspace import Workspace


class NameMeaning(Record):
    """The meaning of a name.

    Attributes:
        id: the declared name, or the model's id; None: unknown.
        ancestors: the ids of the qualities that contain it, the nearest first.
        characteristic: the id of its ISO characteristic; None: it belongs to none.
    """

    id: str | None
    ancestors: tuple[str, ...]
    characteristic: str | None
    definition: str


class Meanings:
    """The meanings of the quality names in a file and in the files it includes."""

    def __init__(self, workspace: Workspace, path: str) -> None:
        scope = workspace.scope(path)
        edition_name = workspace.project.qualities
        for each in scope.paths:
            for item in workspace.files[each].of_type(Qualities):
                edition_name = item.edition.text if item.edition is not None else edition_name
        self.edition: Edition = EDITIONS.get(edition_name, DEFAULT_EDITION)
        definitions = {fold(name): scope.find(Kind.QUALITY, name) for name in scope.names(Kind.QUALITY)}
        targets = {name: each.symbol.target for name, each in definitions.items() if each is not None}
        self._own = {name: each for name, each in targets.items() if isinstance(each, QualityDecl)}

    def of(self, name: str) -> NameMeaning:
        """The meaning of a name, or of names joined by dots."""
        own: list[QualityDecl] = []
        declared = self._own.get(fold(name.rpartition(".")[2]))
        while declared is not None and declared not in own:
            own.append(declared)
            name = declared.parent.text if declared.parent is not None else ""
            declared = self._own.get(fold(name.rpartition(".")[2]))
        ids = [each.name.text for each in own if each.name is not None]
        quality = self._in_model(name) if name and declared is None else None
        model = [quality.id, *([quality.parent] if quality.parent else [])] if quality is not None else []
        if own:
            text = own[0].text.text if own[0].text is not None else ""
            return NameMeaning(ids[0], (*ids[1:], *model), self._characteristic(quality), text)
        if quality is None:
            return NameMeaning(None, (), None, "")
        return NameMeaning(quality.id, tuple(model[1:]), self._characteristic(quality), quality.definition)

    def _in_model(self, name: str) -> Quality | None:
        match = find(tuple(name.split(".")), self.edition)
        if match.quality is None and match.kind == "ambiguous":
            if match.candidates[0].id in successors(fold(name)):  # the old name of a characteristic, as in the checks
                return match.candidates[0]
            parents = {each.parent for each in match.candidates}
            common_parent = parents.pop() if len(parents) == 1 else None
            return get(common_parent, self.edition) if common_parent is not None else None
        return match.quality

    def _characteristic(self, quality: Quality | None) -> str | None:
        """The id of the ISO characteristic: the quality itself, its parent or, for a robotics quality, the nearest
        one.
        """
        if quality is None:
            return None
        if quality.kind == "robotics" and quality.nearest is not None:
            return quality.nearest.partition(".")[0]
        return quality.parent or (None if quality.kind == "robotics" else quality.id)

"""The qualities and requirements of elements of XML that a build wrote."""

from __future__ import annotations

from btq_lang.btcpp.marks import described
from btq_lang.btcpp.side_elements import OfElements, of_elements
from btq_lang.util.record import replace
from btq_lang.workspace.workspace import Workspace


def said_in_xml(workspace: Workspace, path: str, side: str | None) -> OfElements:
    """What the side file says of each element, else the lines that the build has described at it.

    Args:
        side: the text of the side file of an XML file; None if there is none.
    """
    origin = workspace.files[path].origin
    if origin is None:
        return OfElements("", {})
    found = OfElements("", {})
    if side is not None:
        *included, _ = workspace.registered_with(path)
        origins = (workspace.files[each].origin for each in included)
        found = of_elements(side, origin.text, tuple(each.text for each in origins if each is not None))
    return replace(found, lines={**dict(described(origin.text)), **found.lines})

"""The elements of an XML document, to compare."""

from __future__ import annotations

from btq_lang.btcpp.document import Attribute, Content, Document, Element, XmlComment
from btq_lang.util.text import LINE_END


def elements(document: Document) -> list[object]:
    """Every element, comment and text that is not blank, in order, values as XML normalises them."""
    found: list[object] = []
    stack: list[Content] = [*reversed(document.contents)]
    while stack:
        content = stack.pop()
        if isinstance(content, Element):
            found.append((content.tag, [(each.name, normal(each)) for each in content.attributes]))
            stack += reversed(content.children)
        elif isinstance(content, XmlComment):
            found.append(content.text)
        elif content.text.strip():
            found.append(("text", content.text))
    return found


def normal(attribute: Attribute) -> str:
    """XML 1.0 §3.3.3: line ends and tabs as they stand are blanks, referred ones stay."""
    return Attribute(attribute.name, LINE_END.sub(" ", attribute.raw).replace("\t", " ")).value

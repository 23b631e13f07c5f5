"""Whether a text is one well-formed XML element, as `xml "…"` in a file must be."""

from __future__ import annotations

from btq_lang.catalog.names import is_xml_name


def fragment_problem(text: str) -> str | None:
    """What is wrong with a text that should be one element; None if it is one.  Prefixes need no declaration."""
    if text[:1] != "<" or not is_xml_name(text[1:2]):
        return "`xml` takes one element; its text must begin with `<`"
    from lxml import etree  # here, for few files have such elements, and it takes long to import

    parser = etree.XMLParser(resolve_entities=False, no_network=True, huge_tree=True)
    try:
        etree.fromstring(text.encode("utf-8", "replace"), parser)
    except etree.XMLSyntaxError:
        wrong = [each for each in parser.error_log if each.domain != etree.ErrorDomains.NAMESPACE]
        return f"not a well-formed element: {wrong[0].message.rstrip()}" if wrong else None
    return None

"""BehaviorTree.CPP's XML: the document, reading and writing it, a mission as XML, XML as a mission.

document    the elements, comments and texts of one file, and how to write it
reader      XML text to document, as the engine reads it; `strict` asks whether other tools read it, `malformed` and
            `prefixes` find why they refuse it
importing   a document as a mission; `wording` spells its words, `version3` translates files of version 3, `generated`
            removes what a build has added
export      a mission as a document; `source` is what its parts share, `trees`, `models`, `attributes`, `descriptions`
            and `spelling` the parts, `constants` the values of subtrees' ports
enforcement the nodes that requirements add, and how each clause is enforced; `enforceability`: whether it can be,
            `guards` what that takes, `conditions` its scripts, `keys` its names, `wrappers` the elements, which it
            adds and removes; `manual_edits` finds guards that were edited in the XML
outputs     the texts that a build writes, also of a mission with all that it includes; `as_built` finds the mission
            that such texts were made of
opening     files from the disk, XML too, as a workspace
side_file   what of a mission its XML cannot hold; `instances` numbers the nodes as the engine does, and
            `side_elements` finds what it says of each element
restoring   a mission from its XML and its side file
exact_edits an edit of the text that was imported from XML, as an edit of the XML
logged      the tree in a log as the XML that it was created from
xsd         a schema of XML files with a project's nodes; `interfaces`: what these may have inside and beside them
marks       what a build puts into the XML so that an import knows it
recognition which XML is the engine's, and what it defines
typed_xml   the tag at a place of XML that is being typed

One invariant: no other package reads or writes the engine's XML.
"""

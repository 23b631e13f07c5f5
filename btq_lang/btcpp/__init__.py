"""BehaviorTree.CPP's XML: the document, reading and writing it, a mission as XML, XML as a mission.

document    the elements, comments and texts of one file, and how they are written
reader      XML text to document, as the engine reads it; `strict` says what other tools would refuse
importing   a document as a mission; `wording` spells its words, `version3` says old files as new ones, `generated`
            takes out what a build has put in
export      a mission as a document; `source` is what its parts share, `trees`, `models`, `attributes`, `descriptions`
            and `spelling` the parts, `fragment` looks at elements that a mission spells out,
            `undeclared` makes models of what is only used
enforcement what requirements put around nodes, and how each clause is held; `judging` whether the engine can hold it,
            `guards` what it needs, `around` that as data, `conditions` its scripts, `keys` its names, `wrappers` the
            elements, in and out again
bundle      a mission and all that it includes as one document
outputs     the texts that a build writes; `as_built` finds the mission of such texts again
opening     files as they are on the disk, XML too, as a workspace
side_file   what a mission says beyond its XML; `instances` numbers the nodes as the engine does
restoring   a mission from its XML and its side file
marks       what a build puts into the XML so that an import knows it

One invariant: only what stands here knows XML.
"""

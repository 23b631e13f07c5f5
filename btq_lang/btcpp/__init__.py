"""BehaviorTree.CPP's XML: the document, reading and writing it, a mission as XML, XML as a mission.

document    the elements, comments and texts of one file, and how they are written
reader      XML text to document, as the engine reads it

One invariant: only what stands here knows XML.
"""

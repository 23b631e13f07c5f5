"""The names of the formats, for a command line that asks for them without importing the writers."""

from __future__ import annotations

FORMATS = ("table", "csv", "json", "markdown", "html")

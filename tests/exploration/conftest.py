"""The fixture of these tests."""

from exploring import explore as explore

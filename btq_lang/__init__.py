"""btq: quality-aware behavior trees."""

__version__ = "0.1.0.dev0"

"""The version of btq; what writes it into documents need not import anything else."""

__version__ = "0.1.0.dev0"

"""Decompresses parts of a bag, up to a limit that no sane bag exceeds.

One invariant: a chunk or message above the limit is an error before it is in memory, whatever size it declares.
"""

from __future__ import annotations

from typing import Any, Final


def limit_chunks() -> None:
    """Make `rosbags` decompress chunks of MCAP files within the limit; it has none by itself."""
    from lz4.frame import LZ4FrameDecompressor  # type: ignore[import-untyped]  # it has no stubs
    from rosbags.rosbag2 import storage_mcap

    storage_mcap.DECOMPRESSORS["zstd"] = unpacked
    storage_mcap.DECOMPRESSORS["lz4"] = lambda data, size: _whole(data, LZ4FrameDecompressor, size)


def unpacked(data: bytes, size: int | None = None) -> bytes:
    """Decompress data that zstd compressed, to the size that the bag declares, if it does.

    Raises:
        ValueError: it is larger.
    """
    from rosbags.rosbag2.storage_mcap import zstd  # type: ignore[attr-defined]  # whichever module this Python has

    return _whole(data, zstd.ZstdDecompressor, size)


def _whole(data: bytes, decompressor: Any, size: int | None) -> bytes:
    most = MOST if size is None else min(size, MOST)
    found = b""
    while data:  # one frame follows another
        frame = decompressor()
        found += frame.decompress(data, max_length=most + 1 - len(found))
        if len(found) > most:
            raise ValueError(f"{len(data)} packed bytes are more than {most} when unpacked")
        if not frame.eof:
            raise EOFError("what is packed has no end")
        data = frame.unused_data
    return found


MOST: Final = 1 << 28  # bytes; rosbag2 writes chunks of less than 1 MB, or of one message

"""ROS 2 bags, read by `rosbags`: folders with a metadata.yaml, MCAP files and rosbag2's SQLite files.

One invariant: any failure of `rosbags` raises NotALog, or adds one remark once messages are being read.  A chunk or
message that is too large is refused before it is fully decompressed, whatever size it declares.

Only the definitions of requested types are parsed, so a type that `rosbags` cannot read does not affect the rest of its
bag.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from btq_lang.evidence.readers import sqlite
from btq_lang.evidence.readers.tree import NotALog
from btq_lang.evidence.readers.truncated_bags import MCAP, BagDatabase, WholeFile
from btq_lang.evidence.wording import message_of

if TYPE_CHECKING:
    from rosbags.interfaces import Connection

METADATA: Final = "metadata.yaml"
TREE_LOG: Final = "nav2_msgs/msg/BehaviorTreeLog"
TEXT: Final = "std_msgs/msg/String"


class Bag:
    """An open bag: its topics with their types, and notes about the file, complete when the messages have been read."""

    def __init__(self, storages: list[Any], remarks: list[str]) -> None:
        self.connections: Final[list[Connection]] = [
            connection for storage in storages for connection in storage.connections
        ]
        self.remarks: Final = remarks
        self._storages: Final = storages
        self._compressed: Final = [storage for storage in storages if _disable_decompression(storage)]

    def of_type(self, name: str) -> list[Connection]:
        """The topics of a type."""
        return [connection for connection in self.connections if connection.msgtype == name]

    def messages(self, connections: Collection[Connection]) -> Iterator[tuple[str, int, Any]]:
        """The messages of topics in order of reception: topic, time of reception in ns, message."""
        decoders = {connection.msgtype: _decoder(connection) for connection in connections}
        unread = 0
        for storage in self._storages:
            raw = storage.messages([connection for connection in storage.connections if connection in connections])
            while True:
                try:
                    connection, received, data = next(raw)
                except StopIteration:
                    break
                except Exception as error:  # `rosbags` does not wrap what its parts raise
                    self.remarks.append(
                        f"the bag is damaged, and what comes after the damage is left out: {message_of(error)}"
                    )
                    break
                try:
                    received = int(received)
                    message = decoders[connection.msgtype](
                        _decompress_zstd(data) if storage in self._compressed else data
                    )
                except Exception:  # likewise
                    unread += 1
                else:
                    yield connection.topic, received, message
        if unread:
            self.remarks.append(f"messages that cannot be decoded, left out: {unread}")


@contextmanager
def opened(path: str) -> Iterator[Bag]:
    """Open a bag, a folder or a file, for the duration of the context.

    Raises:
        NotALog: `rosbags` is missing, or cannot read it.
        OSError: it cannot be read.
    """
    try:
        import rosbags.rosbag2  # noqa: F401  # whether it is installed
    except ImportError as error:
        raise NotALog("a ROS 2 bag is read with rosbags; install it with pip install 'btq-lang[ros]'") from error
    limit_chunks()
    remarks: list[str] = []
    storages: list[Any] = []
    try:
        storages += _folder(path, remarks) if os.path.isdir(path) else [_file(path, remarks)]
        yield Bag(storages, remarks)
    finally:
        for storage in storages:
            storage.close()


def _folder(path: str, remarks: list[str]) -> list[Any]:
    """The storages of a folder; if its metadata and files disagree, as in a truncated recording, one for each file."""
    from rosbags.rosbag2 import Reader

    databases = sorted(name for name in os.listdir(path) if name.endswith(".db3"))
    if any(sqlite.is_unfinished(os.path.join(path, name)) for name in databases):  # `rosbags` does not read that
        return [_file(os.path.join(path, name), remarks) for name in databases]
    storage = Reader.STORAGE_PLUGINS["dir"](Path(path))
    try:
        storage.open()
    except OSError:
        raise
    except Exception as error:  # whatever the metadata's fault is
        files = sorted(name for name in os.listdir(path) if name.endswith((".mcap", ".db3")))
        if not files:
            raise NotALog(f"the bag cannot be read: {message_of(error)}") from error
        remarks.append(f"its files are read without {METADATA}: {message_of(error)}")
        return [_file(os.path.join(path, name), remarks) for name in files]
    return [storage]


def _disable_decompression(storage: Any) -> bool:
    """Stop a storage from decompressing its messages, which it would do without a size limit; return whether they are
    compressed.
    """
    if getattr(getattr(storage, "metadata", None), "compression_mode", None) != "message":
        return False
    storage.metadata = storage.metadata._replace(compression_mode=None)
    return True


def _file(path: str, remarks: list[str]) -> Any:
    """The storage of a file.

    Raises:
        NotALog: it cannot be read.
    """
    from rosbags.rosbag2 import Reader

    with open(path, "rb") as file:
        is_mcap = file.read(len(MCAP)) == MCAP
    storage: Any
    try:
        if is_mcap:
            storage = Reader.STORAGE_PLUGINS[".mcap"](WholeFile(path, remarks))  # type: ignore[arg-type]  # only opened
            storage.open()
            return storage
        needs_sqlite = sqlite.missing_bytes(path) > 0 or sqlite.is_unfinished(path)
        storage = BagDatabase(path, remarks) if needs_sqlite else Reader.STORAGE_PLUGINS[".db3"](Path(path))
        storage.open()
    except (OSError, NotALog):
        raise
    except Exception as error:  # `rosbags` does not wrap what its parts raise
        raise NotALog(f"the bag cannot be read: {message_of(error)}") from error
    return storage


def files_in(folder: str) -> tuple[str, ...]:
    """The paths of the files of a bag and of its metadata; empty if the folder is not a bag."""
    metadata = os.path.join(folder, METADATA)
    try:
        with open(metadata, encoding="utf-8", errors="replace") as file:
            text = file.read()
        names = os.listdir(folder)
    except OSError:
        return ()
    if "rosbag2_bagfile_information" not in text:
        return ()
    return metadata, *(os.path.join(folder, name) for name in names if name in text)


# ---- messages ----


def _decoder(connection: Connection) -> Callable[[bytes], Any]:
    """A decoder of messages from bytes, by the definition in the bag, else by a known one.

    Raises:
        NotALog: there is no definition of its type.
    """
    from rosbags.interfaces import MessageDefinitionFormat as Format

    name, definition = connection.msgtype, connection.msgdef
    try:
        if definition.format == Format.NONE and name == TREE_LOG:
            # Two definitions: the one since Jazzy, and the older one, in which status changes have no uid.
            texts = (_TREE_LOG_DEFINITION.format(uid=uid) for uid in ("uint16 uid\n", ""))
            return _either(*(_decoder_of(name, "MSG", text) for text in texts))
        return _decoder_of(name, definition.format.name, definition.data)
    except Exception as error:  # a definition may contain anything
        raise NotALog(f"the bag has no usable definition of {name}: {message_of(error)}") from error


@lru_cache(64)
def _decoder_of(name: str, form: str, text: str) -> Callable[[bytes], Any]:
    from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore

    store = get_typestore(Stores.LATEST if form == "NONE" else Stores.EMPTY)
    if form == "MSG":
        store.register(get_types_from_msg(text, name))
    elif form == "IDL":
        for part in text.split(_IDL_RULE):
            store.register(get_types_from_idl(part.partition("\n")[2] if part.startswith("IDL: ") else part))
    store.get_msgdef(name)
    return lambda data: store.deserialize_cdr(data, name)


def _either(first: Callable[[bytes], Any], second: Callable[[bytes], Any]) -> Callable[[bytes], Any]:
    def decode(data: bytes) -> Any:
        try:
            return first(data)
        except Exception:  # bytes of the other form may raise anything
            return second(data)

    return decode


_TREE_LOG_DEFINITION: Final = """\
builtin_interfaces/Time timestamp
nav2_msgs/BehaviorTreeStatusChange[] event_log
================================================================================
MSG: nav2_msgs/BehaviorTreeStatusChange
builtin_interfaces/Time timestamp
string node_name
{uid}string previous_status
string current_status
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
_IDL_RULE: Final = f"{'=' * 80}\n"


# ---- decompression, up to a limit that no sane bag exceeds ----


def limit_chunks() -> None:
    """Make `rosbags` decompress chunks of MCAP files up to MAX_DECOMPRESSED_SIZE; without this it has no limit."""
    from lz4.frame import LZ4FrameDecompressor  # type: ignore[import-untyped]  # it has no stubs
    from rosbags.rosbag2 import storage_mcap

    storage_mcap.DECOMPRESSORS["zstd"] = _decompress_zstd
    storage_mcap.DECOMPRESSORS["lz4"] = lambda data, size: _decompress_frames(data, LZ4FrameDecompressor, size)


def _decompress_zstd(data: bytes, size: int | None = None) -> bytes:
    """Decompress data that zstd compressed, to the size that the bag declares, if it does.

    Raises:
        ValueError: it is larger.
    """
    from rosbags.rosbag2.storage_mcap import zstd  # type: ignore[attr-defined]  # whichever module this Python has

    return _decompress_frames(data, zstd.ZstdDecompressor, size)


def _decompress_frames(data: bytes, decompressor: Any, size: int | None) -> bytes:
    limit = MAX_DECOMPRESSED_SIZE if size is None else min(size, MAX_DECOMPRESSED_SIZE)
    content = b""
    while data:  # the data may consist of several frames
        frame = decompressor()
        content += frame.decompress(data, max_length=limit + 1 - len(content))
        if len(content) > limit:
            raise ValueError(f"{len(data)} compressed bytes decompress to more than {limit} bytes")
        if not frame.eof:
            raise EOFError("the compressed data is truncated")
        data = frame.unused_data
    return content


MAX_DECOMPRESSED_SIZE: Final = 1 << 28  # bytes; rosbag2 writes chunks of less than 1 MB, or of one message

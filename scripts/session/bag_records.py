"""Reads a bag (format 2.0) from its beginning to its end, without its index: one that was cut off is read up to there, in memory that
does not grow with the bag."""
import bz2
import os
import struct

MAGIC = b"#ROSBAG V2.0\n"
NO_BAG = "is no bag of format 2.0"
OP_MESSAGE, OP_CHUNK, OP_CONNECTION = 2, 5, 7
LARGEST_HEADER = 1 << 20  # bytes; a connection's has the message's definition in it
BLOCK = 1 << 15  # bytes, read at once: the messages between two images


class Damaged(Exception):
    """The rest of the file cannot be read."""


def fields_of(header):
    """Names and values of a record's header."""
    fields, at = {}, 0
    while at < len(header):
        if at + 4 > len(header):
            raise Damaged("a header breaks off")
        size = struct.unpack_from("<I", header, at)[0]
        name, separator, value = header[at + 4:at + 4 + size].partition(b"=")
        if not separator or at + 4 + size > len(header):
            raise Damaged("a header is damaged")
        fields[name] = value
        at += 4 + size
    return fields


class FileBytes:
    """Of a file, read in blocks: an image that is jumped over costs one access to the disk, which reads nothing ahead of it."""

    def __init__(self, file):
        self._descriptor = file.fileno()
        self.size = os.fstat(self._descriptor).st_size
        os.posix_fadvise(self._descriptor, 0, 0, os.POSIX_FADV_RANDOM)
        self._begin, self._block = 0, b""

    def at(self, offset, size):
        """Fewer where the file ends."""
        start = offset - self._begin
        if start < 0 or start + size > len(self._block):
            self._block = os.pread(self._descriptor, max(size, BLOCK), offset)
            self._begin, start = offset, 0
        return self._block[start:start + size]


class ChunkBytes:
    """Of a chunk that was decompressed."""

    def __init__(self, content):
        self.size, self._content = len(content), content

    def at(self, offset, size):
        return self._content[offset:offset + size]


class Message:
    """A message of a topic; `data` is read when it is asked for."""

    def __init__(self, topic, kind, time, source, offset, size, place):
        self.topic, self.kind, self.time, self.size = topic, kind, time, size
        self.place = place  # to find it again: see Bag.data_at
        self._source, self._offset = source, offset

    @property
    def data(self):
        return self.head(self.size)

    def head(self, size):
        """Its first bytes: an image is large, and its stamp stands in front."""
        return self._source.at(self._offset, min(size, self.size))


def decompressed(kind, data):
    if kind == b"bz2":
        return bz2.decompress(data)
    if kind == b"lz4":
        import roslz4  # of ROS, beside rosbag
        return roslz4.LZ4Decompressor().decompress(data)
    raise Damaged(f"a chunk is compressed by {kind.decode(errors='replace')}")


class Bag:
    def __init__(self, path):
        self.path = path
        self.problem = ""  # why the rest could not be read; empty: all was read
        self.connections = {}

    def messages(self):
        """All of them, in the order of the file."""
        self._position = 0
        with open(self.path, "rb") as file:
            source = FileBytes(file)
            if source.at(0, len(MAGIC)) != MAGIC:
                self.problem = NO_BAG
                return
            try:
                yield from self._records(source, len(MAGIC), None)
            except (Damaged, struct.error, OSError, EOFError, ValueError) as error:
                self.problem = f"breaks off after {self._position} bytes: {error}"

    def _records(self, source, start, chunk):
        """`chunk`: place of the compressed one that the source is the content of; None: the file itself."""
        while start < source.size:
            if chunk is None:
                self._position = start
            head = source.at(start, 4)
            if len(head) < 4:
                raise Damaged("a record breaks off")
            header_size = struct.unpack("<I", head)[0]
            if header_size > LARGEST_HEADER:
                raise Damaged("a record's header is damaged")
            rest = source.at(start + 4, header_size + 4)
            if len(rest) < header_size + 4:
                raise Damaged("a record breaks off")
            fields = fields_of(rest[:header_size])
            data_size = struct.unpack_from("<I", rest, header_size)[0]
            offset = start + header_size + 8
            op = fields.get(b"op", b"\0")[0]
            if op == OP_CHUNK and fields.get(b"compression") == b"none":
                start = offset  # its records follow
                continue
            if offset + data_size > source.size:
                raise Damaged("a record breaks off")
            if op == OP_MESSAGE:
                yield from self._message(source, fields, offset, data_size, chunk)
            elif op == OP_CONNECTION:
                self._connection(fields, source.at(offset, data_size))
            elif op == OP_CHUNK:
                kind = fields.get(b"compression", b"")
                content = decompressed(kind, source.at(offset, data_size))
                yield from self._records(ChunkBytes(content), 0, (offset, data_size, kind))
            start = offset + data_size

    def _connection(self, fields, data):
        inner = fields_of(data)
        number = struct.unpack("<I", fields[b"conn"])[0]
        self.connections[number] = (fields[b"topic"].decode(errors="replace"), inner.get(b"type", b"").decode(errors="replace"))

    def _message(self, source, fields, offset, size, chunk):
        connection = self.connections.get(struct.unpack("<I", fields[b"conn"])[0])
        if connection:
            seconds, nanoseconds = struct.unpack("<II", fields[b"time"])
            yield Message(*connection, seconds + 1e-9 * nanoseconds, source, offset, size, (chunk, offset, size))

    def data_at(self, place):
        """Of a message that was read before."""
        chunk, offset, size = place
        with open(self.path, "rb") as file:
            if chunk is None:
                file.seek(offset)
                return file.read(size)
            file.seek(chunk[0])
            return decompressed(chunk[2], file.read(chunk[1]))[offset:offset + size]

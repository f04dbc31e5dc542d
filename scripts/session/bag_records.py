"""Reads a bag (format 2.0) from its beginning to its end, without its index: one that was cut off is read up to there, in memory that
does not grow with the bag."""
import bz2
import io
import struct

MAGIC = b"#ROSBAG V2.0\n"
OP_MESSAGE, OP_CHUNK, OP_CONNECTION = 2, 5, 7
LARGEST_HEADER = 1 << 20  # bytes; a connection's has the message's definition in it


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


class Message:
    """A message of a topic; `data` is read when it is asked for."""

    def __init__(self, topic, kind, time, stream, offset, size, place):
        self.topic, self.kind, self.time, self.size = topic, kind, time, size
        self.place = place  # to find it again: see Bag.data_at
        self._stream, self._offset = stream, offset

    @property
    def data(self):
        return self.head(self.size)

    def head(self, size):
        """Its first bytes: an image is large, and its stamp stands in front."""
        self._stream.seek(self._offset)
        return self._stream.read(min(size, self.size))


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
        with open(self.path, "rb") as file:
            size = file.seek(0, io.SEEK_END)
            file.seek(0)
            if file.read(len(MAGIC)) != MAGIC:
                self.problem = "is no bag of format 2.0"
                return
            try:
                yield from self._records(file, size, None)
            except (Damaged, struct.error, OSError, EOFError, ValueError) as error:
                self.problem = f"breaks off after {file.tell() if not file.closed else 0} bytes: {error}"

    def _records(self, stream, size, chunk):
        """`chunk`: place of the compressed one that the stream is the content of; None: the file itself."""
        while True:
            start = stream.tell()
            if start >= size:
                return
            head = stream.read(4)
            if len(head) < 4:
                raise Damaged("a record breaks off")
            header_size = struct.unpack("<I", head)[0]
            if header_size > LARGEST_HEADER:
                raise Damaged("a record's header is damaged")
            rest = stream.read(header_size + 4)
            if len(rest) < header_size + 4:
                raise Damaged("a record breaks off")
            fields = fields_of(rest[:header_size])
            data_size = struct.unpack_from("<I", rest, header_size)[0]
            offset = stream.tell()
            op = fields.get(b"op", b"\0")[0]
            if op == OP_CHUNK and fields.get(b"compression") == b"none":
                continue  # its records follow
            if offset + data_size > size:
                raise Damaged("a record breaks off")
            if op == OP_MESSAGE:
                yield from self._message(stream, fields, offset, data_size, chunk)
            elif op == OP_CONNECTION:
                self._connection(fields, stream.read(data_size))
            elif op == OP_CHUNK:
                kind = fields.get(b"compression", b"")
                content = decompressed(kind, stream.read(data_size))
                yield from self._records(io.BytesIO(content), len(content), (offset, data_size, kind))
            stream.seek(offset + data_size)

    def _connection(self, fields, data):
        inner = fields_of(data)
        number = struct.unpack("<I", fields[b"conn"])[0]
        self.connections[number] = (fields[b"topic"].decode(errors="replace"), inner.get(b"type", b"").decode(errors="replace"))

    def _message(self, stream, fields, offset, size, chunk):
        connection = self.connections.get(struct.unpack("<I", fields[b"conn"])[0])
        if connection:
            seconds, nanoseconds = struct.unpack("<II", fields[b"time"])
            yield Message(*connection, seconds + 1e-9 * nanoseconds, stream, offset, size, (chunk, offset, size))

    def data_at(self, place):
        """Of a message that was read before."""
        chunk, offset, size = place
        with open(self.path, "rb") as file:
            if chunk is None:
                file.seek(offset)
                return file.read(size)
            file.seek(chunk[0])
            return decompressed(chunk[2], file.read(chunk[1]))[offset:offset + size]

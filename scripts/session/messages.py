"""The messages that the report is made of, from their bytes. Fields may have been appended since: only what is needed is read."""
import struct


def header(data):
    """Stamp in s, and where the header ends."""
    _, seconds, nanoseconds, size = struct.unpack_from("<4I", data)
    return seconds + 1e-9 * nanoseconds, 16 + size


def text(data, at):
    size = struct.unpack_from("<I", data, at)[0]
    return data[at + 4:at + 4 + size].decode("utf-8", errors="replace"), at + 4 + size


def homography(data):
    stamp, at = header(data)
    reference = struct.unpack_from("<II", data, at)
    state = data[at + 8]
    values = struct.unpack_from("<10d", data, at + 9 + 18 * 8 + 1)
    rest = at + 9 + 18 * 8 + 1 + 80
    _, processing, corner_error = struct.unpack_from("<Hdd", data, rest)
    return {"stamp": stamp, "reference": reference, "state": state, "corners": values[:8], "visible": values[8], "zncc": values[9],
            "processing": processing, "corner_error": corner_error}


def tracker_state(data):
    stamp, at = header(data)
    state, at = text(data, at)
    reason, at = text(data, at)
    width, height, s, ns = struct.unpack_from("<4I", data, at + 8)
    return {"stamp": stamp, "state": state, "reason": reason, "size": (width, height), "reference": (s, ns),
            "region": struct.unpack_from("<8d", data, at + 24)}


def controller_state(data):
    _, at = header(data)
    task, at = text(data, at)
    state, at = text(data, at)
    reason, at = text(data, at + 1)
    return {"task": task, "state": state, "reason": reason}


def operating_state(data):
    _, at = header(data)
    state, at = text(data, at)
    reason, _ = text(data, at + 2)
    return {"state": state, "reason": reason}


def scope_velocity(data):
    _, at = header(data)
    return struct.unpack_from("<4d", data, at)


def position(data):
    """Of a geometry_msgs/PoseStamped."""
    _, at = header(data)
    return struct.unpack_from("<3d", data, at)


def compressed_image(data):
    """The bytes of the file in it."""
    _, at = header(data)
    _, at = text(data, at)
    size = struct.unpack_from("<I", data, at)[0]
    return data[at + 4:at + 4 + size]


def raw_image(data):
    """Width, height, step, encoding, pixels."""
    _, at = header(data)
    height, width = struct.unpack_from("<II", data, at)
    encoding, at = text(data, at + 8)
    step, size = struct.unpack_from("<II", data, at + 1)
    return width, height, step, encoding, data[at + 9:at + 9 + size]


def string(data):
    return text(data, 0)[0]

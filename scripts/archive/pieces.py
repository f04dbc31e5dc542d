"""A long recording in pieces that are tracked beside each other, and the one table that they are joined to.

Each piece selects the region where its line begins, goes on with the image that lies an overlap before its own part, and searches for the
region from there on: it knows the first view of the region, not what the tracker would have learnt in between. Two pieces are joined at the
last image of their overlap in which both are TRACKING, if their corners are as close there as both claim; otherwise the table has a cut.
"""
import bisect
import math

AGREEMENT = 3.0  # standard deviations of the difference of two estimates that both are right
TRACKING = 1


def spans(start, end, seconds, longest, overlap):
    """Options of track_bag for each piece, as equal as they can be and none above `longest` s; empty: the line is tracked as a whole.
    `start` and `end` are cells of the manifest, `seconds` lie between them; 0: not known."""
    count = math.ceil(seconds / longest) if longest else 1
    if count < 2:
        return []
    first = float(start or 0)
    bounds = [first + seconds * k / count for k in range(1, count)]
    return [{"resume": f"{bounds[k - 1] - overlap:.3f}" if k else "", "end": f"{bounds[k]:.3f}" if k < count - 1 else end} for k in range(count)]


class Rows:
    """Of a table of track_bag."""

    def __init__(self, header, lines):
        self.header, self.lines = header, lines
        names = header.rstrip(b"\n").split(b",")
        self.split = len(names) - 1  # the last one is a text, which may have commas
        self.column = {name.decode(): index for index, name in enumerate(names)}
        self.frames = [int(line.split(b",", 1)[0]) for line in lines]

    @classmethod
    def read(cls, path):
        with open(path, "rb") as file:
            return cls(file.readline(), file.readlines())

    def at(self, k, *names):
        cells = self.lines[k].split(b",", self.split)
        return [float(cells[self.column[name]]) for name in names]

    def corners(self, k, roi):
        g = self.at(k, *(f"g{row}{column}" for row in range(3) for column in range(3)))
        x, y, width, height = roi
        for u, v in ((x, y), (x + width, y), (x + width, y + height), (x, y + height)):
            depth = g[6] * u + g[7] * v + g[8]
            yield (g[0] * u + g[1] * v + g[2]) / depth, (g[3] * u + g[4] * v + g[5]) / depth


def last_of_both(before, after):
    """The last image in which both are TRACKING, as places in their tables; None: there is none."""
    places = {frame: k for k, frame in enumerate(before.frames)}
    for k in reversed(range(bisect.bisect_right(after.frames, before.frames[-1]))):
        place = places.get(after.frames[k])
        if place is not None and before.at(place, "state") == after.at(k, "state") == [TRACKING]:
            return place, k
    return None


def join(before, after, roi):
    """One table of two pieces, the second without its image of the selection. Returns it and what is to be said of the joint: the time, and
    how far apart the worst corner is (px) and may be, or why the two could not be joined."""
    both = last_of_both(before, after)
    joint = {"time": before.at(len(before.lines) - 1, "stamp")[0]}
    kept, begun = len(before.lines), bisect.bisect_right(after.frames, before.frames[-1])
    if both is None:
        joint["cut"] = "in no image of the overlap both pieces are TRACKING"
    else:
        one, other = both
        joint["time"] = before.at(one, "stamp")[0]
        apart = max(math.dist(*pair) for pair in zip(before.corners(one, roi), after.corners(other, roi)))
        allowed = AGREEMENT * math.hypot(*before.at(one, "corner_error"), *after.at(other, "corner_error"))
        if apart <= allowed < math.inf:
            kept, begun = one + 1, other + 1
            joint.update(apart=round(apart, 3), allowed=round(allowed, 3))
        else:
            joint["cut"] = f"the two pieces are {apart:.2f} px apart, and may be {allowed:.2f} px by what they claim"
    return Rows(before.header, before.lines[:kept] + after.lines[begun:]), joint


def join_all(tables, roi):
    """The table of all pieces, and its joints."""
    whole, joints = tables[0], []
    for table in tables[1:]:
        whole, joint = join(whole, Rows(table.header, table.lines[1:]), roi)
        joints.append(joint)
    return whole, joints


def cuts(joints):
    """What is to be said of the cuts, a text for each reason."""
    times = {}
    for joint in joints:
        if "cut" in joint:
            times.setdefault(joint["cut"], []).append(f"{joint['time']:.1f}")
    return [f"cut at {', '.join(places)} s: {reason}" for reason, places in times.items()]

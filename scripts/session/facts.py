"""What happened in a session, collected from bags or from a table of track_bag."""
import array
import bisect
import csv
import math
import struct

from . import messages
from .bag_records import Bag

TRACKER_STATES = ("IDLE", "TRACKING", "SEARCHING", "LOST")
COVERED, CLEAR = 0.7, 0.85  # visible share: below the one it is covered, above the other no more
STILL = 1e-9  # rad/s, m/s: a command below is none


class Series:
    """Rows of numbers, the time first, in little memory."""

    def __init__(self, columns):
        self.columns = [array.array("d") for _ in range(columns)]

    def add(self, *row):
        for column, value in zip(self.columns, row):
            column.append(value)

    def __len__(self):
        return len(self.columns[0])


class Changes:
    """A state over time: where it changed, and why."""

    def __init__(self):
        self.rows = []  # time, state, reason

    def add(self, time, state, reason=""):
        if not self.rows or self.rows[-1][1] != state:
            self.rows.append((time, state, reason))

    def shares(self, end):
        """Time in each state, s."""
        total = {}
        for k, (time, state, _) in enumerate(self.rows):
            until = self.rows[k + 1][0] if k + 1 < len(self.rows) else end
            total[state] = total.get(state, 0.0) + max(until - time, 0.0)
        return total


class TwoCarts(Exception):
    """A bag holds more than one cart, or tracker, and nobody said which one is meant."""


class Session:
    def __init__(self, cart=""):
        name = cart.strip("/")
        self.cart = "/" + name if name else ""  # namespace of the topics that are read; empty: all, which must be of one cart
        self.topics = {}  # what is told by a topic: the one topic that is read for it
        self.sources = []  # path, what is wrong with it
        self.begin, self.end = math.inf, -math.inf
        self.count = 0
        # time, state, visible share, corner error [px], processing time [s], latency [s], stamp, eight coordinates of corners [px]
        self.tracking = Series(15)
        self.commands = Series(5)  # time, pan, tilt, spin [rad/s], insertion [m/s]
        self.positions = Series(4)  # time, x, y, z [m]
        self.tracker, self.controller, self.robot = Changes(), Changes(), Changes()
        self.regions = []  # time, stamp of the reference, corners in the first image
        self.safety = []  # time, who, what, why
        self.images = []  # time, stamp, (bag, kind, place)
        self.session_text = ""

    def reads(self, topic):
        return topic.startswith(self.cart + "/")

    def owns(self, role, topic):
        """Whether the topic is the one that this is read from: the first one seen. A second one is another cart's or tracker's."""
        first = self.topics.setdefault(role, topic)
        if first != topic and role != "images":
            raise TwoCarts(f"holds {role} of two: {first} and {topic}. Choose a cart by the namespace of its topics: --cart NAMESPACE")
        return first == topic

    def seen(self, time):
        self.begin, self.end = min(self.begin, time), max(self.end, time)
        self.count += 1

    def duration(self):
        return max(self.end - self.begin, 0.0) if self.count else 0.0

    def tracker_result(self, time, result):
        state = result["state"]
        name = TRACKER_STATES[state] if state < len(TRACKER_STATES) else str(state)
        self.tracker.add(time, name)
        latency = time - result["stamp"]
        self.tracking.add(time, state, result["visible"], result["corner_error"], result["processing"],
                          latency if 0.0 <= latency < 60.0 else math.nan, result["stamp"], *result.get("corners", (math.nan,) * 8))
        reference = result.get("reference")
        if state != 0 and reference != (0, 0) and (not self.regions or self.regions[-1][1] != reference):
            self.regions.append((time, reference, result.get("corners")))

    def image_at(self, time):
        """The first image recorded from then on, and the region's corners in it; None when there is none within a second."""
        k = bisect.bisect_left(self.images, (time,))
        if k == len(self.images) or self.images[k][0] > time + 1.0:
            return None
        _, stamp, source = self.images[k]
        stamps = self.tracking.columns[6]
        near = bisect.bisect_left(self.tracking.columns[0], time - 2.0)
        while near < len(stamps) and not abs(stamps[near] - stamp) < 1e-6 and self.tracking.columns[0][near] < time + 4.0:
            near += 1
        known = near < len(stamps) and abs(stamps[near] - stamp) < 1e-6
        return source, [column[near] for column in self.tracking.columns[7:15]] if known else None

    def episodes(self):
        """Covered, searched and lost: kind, begin, end, remark; the end is None when the recording ended first."""
        found, open_since = [], {}
        least = 1.0

        def close(kind, time, remark=""):
            found.append((kind, open_since.pop(kind), time, remark))

        for time, state, visible in zip(*self.tracking.columns[:3]):
            lost = state in (2, 3)
            if lost and "lost" not in open_since:
                open_since["lost"] = time
            if not lost and "lost" in open_since:
                close("lost", time, "found again" if state == 1 else "the region was given up")
            covered = state == 1 and visible < (CLEAR if "covered" in open_since else COVERED)
            if covered:
                least = min(least if "covered" in open_since else 1.0, visible)
                open_since.setdefault("covered", time)
            elif "covered" in open_since:
                close("covered", time, f"at least {100 * least:.0f} % of the region stayed visible")
        for kind in list(open_since):
            close(kind, None, "until the end of the recording")
        return sorted(found, key=lambda row: row[1])


SAFE_CONTROLLER, SAFE_ROBOT = ("SERVO", "ARMED"), ("ENABLED",)


def safety_event(session, time, who, state, reason, rows):
    """Every change away from moving, and what undid it."""
    before = rows.rows[-1][1] if rows.rows else None
    rows.add(time, state, reason)
    if before is not None and before != state:
        session.safety.append((time, who, f"{before} → {state}", reason))
    elif before is None:
        session.safety.append((time, who, f"begins as {state}", reason))


def read_bag(session, path, progress):
    bag = Bag(path)
    for message in bag.messages():
        progress(message.time)
        if not session.reads(message.topic):
            continue
        session.seen(message.time)
        try:
            take(session, bag, message)
        except (struct.error, IndexError) as error:  # another version's message
            bag.problem = f"holds messages of {message.topic} that cannot be read: {error}"
        except TwoCarts as error:
            raise TwoCarts(f"{path} {error}") from None
    session.sources.append((str(path), bag.problem))


# Type of a message: how its topic ends, and what it tells.
ROLES = {"laparoscope_servo/ScopeVelocity": ("servo_command", "commands"), "geometry_msgs/PoseStamped": ("measured_cp", "positions"),
         "laparoscope_servo/ControllerState": ("", "the controller's states"),
         "laparoscope_servo/OperatingState": ("", "the robot's states"), "std_msgs/String": ("session", "parameters")}


def role_of(kind, topic):
    """What a message tells of the session; empty: nothing that the report is made of."""
    if kind == "laparoscope_servo/Homography":
        return "" if topic.endswith("/recorded/tracker/homography") else "results"  # the player's copies of earlier ones
    if kind in ("sensor_msgs/CompressedImage", "sensor_msgs/Image"):
        return "" if "/tracker/" in topic else "images"  # the tracker's previews and masks are none of the camera's
    end, role = ROLES.get(kind, ("", ""))
    return role if topic.endswith(end) else ""


def take(session, bag, message):
    kind, time, topic = message.kind, message.time, message.topic
    if kind == "std_msgs/Empty" and topic.endswith("/stop"):  # the controller's and the robot's
        session.safety.append((time, "somebody", f"stop on {topic}", ""))
    role = role_of(kind, topic)
    if not role or not session.owns(role, topic):
        return
    if role == "results":
        session.tracker_result(time, messages.homography(message.data))
    elif role == "commands":
        session.commands.add(time, *messages.scope_velocity(message.data))
    elif role == "positions":
        session.positions.add(time, *messages.position(message.data))
    elif role == "the controller's states":
        state = messages.controller_state(message.data)
        safety_event(session, time, "controller", state["state"], state["reason"], session.controller)
    elif role == "the robot's states":
        state = messages.operating_state(message.data)
        safety_event(session, time, "robot", state["state"], state["reason"], session.robot)
    elif role == "images":
        session.images.append((time, messages.header(message.head(16))[0], (bag, kind, message.place)))
    else:
        session.session_text = messages.string(message.data)


def number(row, name):
    try:
        return float(row[name])
    except (KeyError, TypeError, ValueError):
        return math.nan


def read_csv(session, path, progress):
    problem, last_reason = "", ""
    with open(path, encoding="utf-8", errors="replace", newline="") as file:
        for row in csv.DictReader(file):
            time, state = number(row, "stamp"), number(row, "state")
            if math.isnan(time) or math.isnan(state):
                problem = "has lines that are none of track_bag"
                continue
            progress(time)
            session.seen(time)
            session.tracker_result(time, {"state": int(state), "stamp": math.nan, "visible": number(row, "visible_fraction"), "reference": None,
                                          "corner_error": number(row, "corner_error"), "processing": number(row, "processing_time")})
            reason = row.get("reason") or ""
            if reason and reason != last_reason:
                session.safety.append((time, "tracker", TRACKER_STATES[int(state)] if 0 <= state < 4 else str(state), reason))
            last_reason = reason
    session.sources.append((str(path), problem))

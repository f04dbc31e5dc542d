"""Diagrams as SVG text, and pictures as data."""
import base64
import io
import math

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.fonttype"] = "none"
matplotlib.rcParams["svg.hashsalt"] = "session"
import matplotlib.pyplot as plt  # noqa: E402: after the choice of the back end
import numpy as np  # noqa: E402
from PIL import Image, ImageDraw  # noqa: E402

from . import messages  # noqa: E402

BINS = 1000  # of a diagram: more points than that cannot be told apart
COLOURS = {"TRACKING": "#2e7d32", "SERVO": "#2e7d32", "ENABLED": "#2e7d32", "SEARCHING": "#ef8f00", "HOLD": "#ef8f00", "PAUSED": "#ef8f00",
           "ARMED": "#1565c0", "IDLE": "#90a4ae", "DISABLED": "#90a4ae", "LOST": "#c62828", "FAULT": "#c62828"}


def svg(figure):
    stream = io.StringIO()
    figure.savefig(stream, format="svg", bbox_inches="tight", metadata={"Date": None})
    plt.close(figure)
    text = stream.getvalue()
    return text[text.index("<svg"):]


def thinned(time, values):
    """Least and largest of each bin, so that no spike is lost."""
    time, values = np.asarray(time), np.asarray(values)
    good = np.isfinite(values)
    time, values = time[good], values[good]
    if len(time) <= 2 * BINS:
        return time, values
    edges = np.linspace(0, len(time), BINS + 1).astype(int)
    kept = [k for a, b in zip(edges[:-1], edges[1:]) for k in sorted({a + int(np.argmin(values[a:b])), a + int(np.argmax(values[a:b]))})]
    return time[kept], values[kept]


def bands(session):
    """The states of tracker, controller and robot over time."""
    rows = [(name, c) for name, c in (("tracker", session.tracker), ("controller", session.controller), ("robot", session.robot)) if c.rows]
    if not rows:
        return ""
    figure, axis = plt.subplots(figsize=(10, 0.5 + 0.45 * len(rows)))
    seen = set()
    for y, (name, changes) in enumerate(rows):
        shown = changes.rows if len(changes.rows) <= BINS else changes.rows[:: len(changes.rows) // BINS + 1]
        for k, (time, state, _) in enumerate(shown):
            until = shown[k + 1][0] if k + 1 < len(shown) else session.end
            colour = COLOURS.get(state, "#000000")
            axis.broken_barh([(time - session.begin, max(until - time, 0.0))], (-y - 0.4, 0.8), color=colour, label=None if state in seen else state)
            seen.add(state)
    axis.set_yticks([-y for y in range(len(rows))], [name for name, _ in rows])
    axis.set_xlabel("s")
    axis.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize="small")
    return svg(figure)


def lines(session, series, columns, unit):
    """`columns`: (index, label)."""
    if len(series) == 0:
        return ""
    figure, axis = plt.subplots(figsize=(10, 2.2))
    drawn = False
    for index, label in columns:
        time, values = thinned(series.columns[0], series.columns[index])
        if len(time):
            axis.plot(time - session.begin, values, label=label, linewidth=0.8)
            drawn = True
    axis.set_xlabel("s")
    axis.set_ylabel(unit)
    axis.grid(alpha=0.3)
    if drawn and len(columns) > 1:
        axis.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize="small")
    return svg(figure)


def histogram(values, unit):
    values = np.asarray(values)
    values = values[np.isfinite(values)]
    if len(values) == 0:
        return ""
    figure, axis = plt.subplots(figsize=(5, 2))
    axis.hist(values, bins=60)
    axis.set_xlabel(unit)
    axis.set_ylabel("images")
    return svg(figure)


def opened(source):
    bag, kind, place = source
    data = bag.data_at(place)
    if kind == "sensor_msgs/CompressedImage":
        return Image.open(io.BytesIO(messages.compressed_image(data))).convert("RGB")
    width, height, step, encoding, pixels = messages.raw_image(data)
    raw = {"bgr8": ("RGB", "BGR"), "rgb8": ("RGB", "RGB"), "mono8": ("L", "L")}.get(encoding)
    if raw is None:
        raise ValueError(f"pictures of encoding {encoding} are not shown")
    return Image.frombuffer(raw[0], (width, height), pixels, "raw", raw[1], step, 1).convert("RGB")


def picture(source, corners, width=480):
    """A small JPEG with the region's outline as data for an <img>; empty when it cannot be shown."""
    try:
        image = opened(source)
    except (OSError, ValueError, IndexError) as error:
        print(f"session_report: a picture is left out: {error}")
        return ""
    scale = min(1.0, width / max(image.size))
    small = image.resize((max(1, round(image.width * scale)), max(1, round(image.height * scale))))
    if corners and all(map(math.isfinite, corners)) and any(corners):
        points = [(scale * corners[k], scale * corners[k + 1]) for k in (0, 2, 4, 6, 0)]
        ImageDraw.Draw(small).line(points, fill=(255, 220, 0), width=2)
    stream = io.BytesIO()
    small.save(stream, "JPEG", quality=80)
    return "data:image/jpeg;base64," + base64.b64encode(stream.getvalue()).decode()

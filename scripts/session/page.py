"""The report's page."""
import datetime
import pathlib

import jinja2
import markupsafe
import numpy as np

from . import drawing

MOST_EPISODES, MOST_REGIONS, MOST_EVENTS = 40, 12, 1000  # of which the page tells singly


def seconds(value):
    if value < 100:
        return f"{value:.1f} s"
    return f"{int(value // 60)} min {int(value % 60)} s"


class Page:
    def __init__(self, session, title, comparison=None):
        self.s, self.title, self.comparison = session, title, comparison

    def at(self, time):
        return f"{seconds(time - self.s.begin)}"

    def image(self, time):
        found = self.s.image_at(time)
        return drawing.picture(*found) if found else ""

    def shares(self):
        for who, changes in (("tracker", self.s.tracker), ("controller", self.s.controller), ("robot", self.s.robot)):
            total = changes.shares(self.s.end)
            whole = sum(total.values()) or 1.0
            for state, time in sorted(total.items(), key=lambda item: -item[1]):
                yield who, state, seconds(time), f"{100 * time / whole:.1f} %"

    def regions(self):
        for time, _, corners in self.s.regions[:MOST_REGIONS]:
            text = "selected"
            if corners:
                x, y = corners[0::2], corners[1::2]
                text += f", about {max(x) - min(x):.0f} x {max(y) - min(y):.0f} px at ({min(x):.0f}, {min(y):.0f})"
            yield {"time": self.at(time), "text": text, "image": self.image(time)}

    def episodes(self, all_of_them):
        longest = sorted(all_of_them, key=lambda row: (row[2] or self.s.end) - row[1], reverse=True)[:MOST_EPISODES]
        for kind, begin, end, remark in sorted(longest, key=lambda row: row[1]):
            yield {"time": self.at(begin), "kind": kind, "duration": seconds((end or self.s.end) - begin), "remark": remark, "image": self.image(begin)}

    def motion(self):
        if len(self.s.commands):
            values = np.array(self.s.commands.columns)
            moving = np.any(np.abs(values[1:]) > 1e-9, axis=0)
            yield "commanded to move", f"{100 * np.mean(moving):.1f} % of {len(moving)} commands"
            largest = np.abs(values[1:]).max(axis=1)
            yield "largest command", (f"pan {largest[0]:.3f}, tilt {largest[1]:.3f}, spin {largest[2]:.3f} rad/s, "
                                      f"insertion {1e3 * largest[3]:.1f} mm/s")
        if len(self.s.positions) > 1:
            points = np.array(self.s.positions.columns[1:]).T
            yield "way of the camera", f"{1e3 * np.linalg.norm(np.diff(points, axis=0), axis=1).sum():.0f} mm"
            yield "room it was in", " x ".join(f"{1e3 * (high - low):.0f}" for low, high in zip(points.min(axis=0), points.max(axis=0))) + " mm"

    def latencies(self):
        for label, column in (("image taken to result recorded", 5), ("the tracker's own time", 4)):
            values = 1e3 * np.array(self.s.tracking.columns[column])
            values = values[np.isfinite(values)]
            if len(values):
                yield (label, *(f"{v:.1f} ms" for v in (*np.percentile(values, (50, 95, 99)), values.max())))

    def distances(self):
        values = self.comparison.percentiles() if self.comparison else None
        return [f"{value:.2f} px" for value in values] if values else []

    def html(self):
        s = self.s
        svg = markupsafe.Markup  # drawn by matplotlib, of numbers and of names of states, which it escapes
        episodes = s.episodes()
        environment = jinja2.Environment(loader=jinja2.FileSystemLoader(pathlib.Path(__file__).parent), autoescape=True)
        begin = datetime.datetime.fromtimestamp(s.begin).isoformat(" ", "seconds") if s.count else ""
        return environment.get_template("page.html").render(
            title=self.title, sources=s.sources, count=s.count, begin=begin, duration=seconds(s.duration()), results=len(s.tracking),
            pictures=len(s.images), regions=list(self.regions()), shares=list(self.shares()),
            bands=svg(drawing.bands(s)), visible=svg(drawing.lines(s, s.tracking, [(2, "visible")], "share")),
            error=svg(drawing.lines(s, s.tracking, [(3, "corner error")], "px")), episodes=list(self.episodes(episodes)),
            episode_count=len(episodes), motion=list(self.motion()),
            turning=svg(drawing.lines(s, s.commands, [(1, "pan"), (2, "tilt"), (3, "spin")], "rad/s")),
            inserting=svg(drawing.lines(s, s.commands, [(4, "insertion")], "m/s")),
            path=svg(drawing.lines(s, s.positions, [(1, "x"), (2, "y"), (3, "z")], "m")), latencies=list(self.latencies()),
            latency_histogram=svg(drawing.histogram(1e3 * np.array(s.tracking.columns[5]), "ms, image taken to result recorded")),
            comparison=self.comparison, distances=self.distances(),
            apart=svg(drawing.lines(s, self.comparison, [(1, "worst corner")], "px")) if self.comparison else "",
            safety=[(self.at(t), who, what, why) for t, who, what, why in s.safety[:MOST_EVENTS]], safety_count=len(s.safety),
            session_text=s.session_text)

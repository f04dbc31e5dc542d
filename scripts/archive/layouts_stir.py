"""STIR: clips at whose beginning and end points, tattooed into the tissue, are seen in infrared.

  COLLECTION/left/seq00/frames/0ms-4000ms-visible.mp4
  COLLECTION/left/seq00/segmentation/icgstartseg.png, icgendseg.png    each point a spot that is not black; which is which is not known
"""
import functools
import os

import cv2
import numpy as np

from . import metrics, truth

NAME = "STIR"
SAYS = "accuracy at 4 to 64 px and average Jaccard, each point of the left view a line"
KEYS = ("point",)
# px: of the region about a point. STIRMetrics' own tracker has 29 px of an image of half the size.
SIDE = 58


def folders(_folder):
    return []


def recognises(recording):
    clip = recording.parent.parent
    sides = ("left", "right")
    return recording.parent.name == "frames" and clip.name.startswith("seq") and clip.parent.name.startswith(sides) and recording.is_file()


def case(recording, folder):
    return truth.case_of(recording.parent.parent, folder)


def points(path, size=None):
    """Centres of the spots as STIRLoader has them: whole px, of the rectangles around them."""
    return read_points(str(path), os.stat(path).st_mtime_ns if os.path.isfile(path) else 0, size)


@functools.lru_cache(maxsize=4)  # a clip's lines, one after the other, have one picture
def read_points(path, _modified, size):
    picture = cv2.imread(path, cv2.IMREAD_COLOR)
    if picture is None:
        raise truth.BadTruth([f"{path} cannot be read, expected a picture"])
    problems = []
    if size and picture.shape[1::-1] != size:
        problems.append(f"{path} has {picture.shape[1]} x {picture.shape[0]} px, the recording {size[0]} x {size[1]}, expected the same")
    contours = cv2.findContours(cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY), cv2.RETR_TREE, cv2.CHAIN_APPROX_SIMPLE)[-2]
    if not contours:
        problems.append(f"{path} shows no point, expected one or more")
    if problems:
        raise truth.BadTruth(problems)
    return [(x + width // 2, y + height // 2) for x, y, width, height in map(cv2.boundingRect, contours)]


def size_of(facts):
    return (int(facts["width"]), int(facts["height"])) if facts else None


def lines(recording, facts, _manifest):
    clip = recording.parent.parent
    if not clip.parent.name.startswith("left"):
        return []
    problems, folder = [], clip / "segmentation"
    starts = truth.attempt(problems, points, folder / "icgstartseg.png", size_of(facts))
    truth.attempt(problems, points, folder / "icgendseg.png", size_of(facts))
    if problems:
        raise truth.BadTruth(problems)
    return [{"roi": truth.square_about(point, SIDE, size_of(facts)), "truth": str(folder / "icgendseg.png"),
             "benchmark": f"{NAME} point={point[0]},{point[1]}"} for point in sorted(starts)]


class Truth:
    def __init__(self, start, ends):
        self.start, self.ends = np.array(start, float), np.array(ends, float)

    def nearest(self, point):
        return float(metrics.distances(point, self.ends).min())

    def score(self, tracked):
        """`tracked`: None when the tracker was never started."""
        claimed, distance = False, np.inf
        if tracked is not None:
            tracked.expect_start(0)
            claimed, g = tracked.last()
            distance = self.nearest(metrics.moved(g, self.start[None])[0])
        return {"name": NAME, "distance": round(distance, 3) if np.isfinite(distance) else None, "claimed": bool(claimed),
                "unmoved": round(self.nearest(self.start), 3)}


def load(row, facts=None):
    problems = []
    settings = truth.attempt(problems, truth.settings_of, row["benchmark"], NAME, KEYS)
    point = settings["point"].split(",") if settings else []
    if settings and not (len(point) == 2 and all(value.isdigit() for value in point)):
        problems.append(f"benchmark: point is '{settings['point']}', expected x,y in px")
    ends = truth.attempt(problems, points, row["truth"], size_of(facts))
    if problems:
        raise truth.BadTruth(problems)
    return Truth([int(value) for value in point], ends)


def of_case(scores):
    """Of STIRMetrics, and TAP-Vid's average Jaccard, all points being visible at the end; `unmoved`: of who says that nothing moves."""
    distance = np.array([np.inf if score["distance"] is None else score["distance"] for score in scores])
    claimed = np.array([score["claimed"] for score in scores])
    at = {f"accuracy at {limit:.0f} px": metrics.within(distance, limit) for limit in metrics.STIR_THRESHOLDS}
    unmoved = [metrics.within([score["unmoved"] for score in scores], limit) for limit in metrics.STIR_THRESHOLDS]
    return {**at, "average accuracy, 4 to 64 px": float(np.mean(list(at.values()))), "average accuracy of no motion": float(np.mean(unmoved)),
            "average accuracy, 2 to 32 px": metrics.average_accuracy(distance, True),
            "average Jaccard, 2 to 32 px": metrics.average_jaccard(distance, True, claimed),
            "points": len(scores), "claimed": int(claimed.sum())}


def of_all(rows):
    return of_case([score for _, score in rows])

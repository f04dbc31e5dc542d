"""What is published for trackers of points and planes, of sequences with ground truth: see scripts/archive/metrics.py."""
import csv
import json
import pathlib
import sys

import cv2
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
from archive import metrics  # noqa: E402: scripts/ has to be found first

AREAS_ACROSS = 14  # of the region in each direction, as sequences with truth have them


def region_points(roi):
    """The points that are judged: the centres of the region's areas, row by row."""
    x, y, width, height = roi
    across = (np.arange(AREAS_ACROSS) + 0.5) / AREAS_ACROSS
    return np.stack(np.meshgrid(x - 0.5 + width * across, y - 0.5 + height * across), axis=-1).reshape(-1, 2)


def corners(roi):
    """Centres of the corner pixels."""
    x, y, width, height = roi
    return np.array([(x, y), (x + width - 1.0, y), (x + width - 1.0, y + height - 1.0), (x, y + height - 1.0)])


def visible(places, covered, size):
    """Which points can be seen: less than half of their area is covered, and they lie in the image of width, height."""
    inside = (places >= 0.0).all(axis=-1) & (places <= np.array(size) - 1.0).all(axis=-1)
    return inside & (np.asarray(covered) < 0.5)


def table(path):
    with open(path, encoding="utf-8", newline="") as file:
        return np.array([[float(cell) for cell in row] for row in list(csv.reader(file))[1:]])


class Truth:
    """Of a sequence's folder. The first image, the reference, counts nowhere."""

    def __init__(self, folder):
        folder = pathlib.Path(folder)
        roi = json.loads((folder / "scene.json").read_text(encoding="utf-8"))["roi"]
        self.points, self.corners = region_points(roi), corners(roi)
        g = table(folder / "truth.csv")[1:, 1:10].reshape(-1, 3, 3)
        self.places, self.corner_places = metrics.moved(g, self.points), metrics.moved(g, self.corners)
        height, width = cv2.imread(str(min((folder / "frames").iterdir()))).shape[:2]
        covered = table(folder / "areas.csv")[1:, 1:] if (folder / "areas.csv").is_file() else 0.0
        self.visible = visible(self.places, covered, (width, height))

    def judge(self, tracker):
        """Metrics by name, of a tracker of bench_compare's JSON."""
        g = np.array(tracker["g"], float).reshape(-1, 3, 3)[1:]
        claimed = np.array(tracker["claims"])[1:, None] > 0.0
        distance = metrics.distances(metrics.moved(g, self.points), self.places)
        alignment = metrics.alignment_error(metrics.moved(g, self.corners), self.corner_places)
        return {"average_jaccard": metrics.average_jaccard(distance, self.visible, claimed), "average_accuracy": metrics.average_accuracy(distance, self.visible),
                "average_claimed_accuracy": metrics.average_accuracy(distance, self.visible, claimed), "alignment_median": float(np.median(alignment)),
                **{f"precision_{limit:.0f}": metrics.within(alignment, limit) for limit in metrics.ALIGNMENT_LIMITS}}

"""Figures 3 to 5 of Bourger et al. (2007): the areas, and e_occl of (13), with and without detection of occlusions."""
import json
import pathlib

import cv2
import matplotlib.pyplot as plt
import numpy as np

from .document import LOST, number, short
from .drawing import AREAS, draw, frames_of
from .measuring import Job, column, table_of

CONFIGURATIONS = ("none", "published", "default")
COLOURS = {"none": "tab:blue", "published": "tab:red", "default": "tab:green"}
PAPERS_FRAMES = [10, 15, 20, 25, 30]  # of still_sheet


class Scene:
    """A sequence with ground truth, or a recording, and what the three trackers made of it."""

    def __init__(self, a, name, path, roi_text=None, still=False):
        self.name, self.path, self.roi_text, self.still = name, pathlib.Path(path), roi_text, still
        self.tables = {c: a.out / f"occlusion_{name}_{c}.csv" for c in CONFIGURATIONS}
        self.covered = self.truth = None
        self.K = np.eye(3)
        if roi_text is None:
            rows = table_of(self.path / "truth.csv")
            self.covered, self.truth = column(rows, "occluded"), homographies(rows)
            scene = json.loads((self.path / "scene.json").read_text())
            self.roi, self.K = scene["roi"], np.array(scene["K"])
        else:
            self.roi = [float(v) for v in roi_text.split(",")]

    def is_covered(self):
        return self.covered is not None and self.covered.max() > 0

    def read(self):
        self.rows = {c: table_of(f) for c, f in self.tables.items()}
        self.G = {c: homographies(rows) for c, rows in self.rows.items()}
        self.flags = {c: np.array([[int(r[f"o{k}"]) for k in range(AREAS * AREAS)] for r in rows]) for c, rows in self.rows.items()}
        self.count = {c: f.sum(1) for c, f in self.flags.items()}
        self.tracking = {c: column(rows, "state") == 1 for c, rows in self.rows.items()}
        self.images = frames_of(self.path)
        self.peak = int(np.argmax(self.covered if self.is_covered() else self.count["default"]))
        if self.still:
            height, width = self.images[0].shape[:2]
            self.K = np.array([[width, 0, width / 2], [0, width, height / 2], [0, 0, 1.0]])  # not known: it only scales the error
            self.truth = np.array([np.eye(3)] * len(self.rows["none"]))
        if self.truth is None:
            return
        self.e_occl = {c: e_occl(self.G[c], self.truth, self.K) for c in CONFIGURATIONS}
        self.corner = {c: corner_errors(self.G[c], self.truth, self.roi) for c in CONFIGURATIONS}
        # The other two have no states of their own: they are followed wherever they go.
        self.e_occl["default"][~self.tracking["default"]] = np.nan


def homographies(rows):
    return np.array([[float(r[f"g{i}{j}"]) for i in range(3) for j in range(3)] for r in rows]).reshape(-1, 3, 3)


def corner_errors(G, truth, roi):
    """Distance of the worst of the ROI's corners from where it should be, px; infinite where it goes through infinity."""
    x, y, w, h = roi
    corners = np.array([[x, x + w - 1, x + w - 1, x], [y, y, y + h - 1, y + h - 1], [1, 1, 1, 1.0]])
    p, q = G @ corners, truth @ corners
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = np.hypot(p[:, 0] / p[:, 2] - q[:, 0] / q[:, 2], p[:, 1] / p[:, 2] - q[:, 1] / q[:, 2]).max(1)
    return np.where((p[:, 2] > 0).all(1), distance, np.inf)


def e_occl(G, truth, K):
    """Equation (13), Frobenius, of normalised coordinates."""
    Ki = np.linalg.inv(K)
    return np.array([np.linalg.norm(Ki @ g @ np.linalg.inv(t) @ K - np.eye(3)) for g, t in zip(G, truth)])


def scenes(a):
    made = [Scene(a, n, p) for n, p in a.sequences.items()]
    return [s for s in made if s.is_covered()] + [Scene(a, pathlib.Path(f).stem, f, r) for f, r in a.video] + \
        [Scene(a, pathlib.Path(f).stem, f, r, still=True) for f, r in a.still_video]


def jobs(a):
    return [Job(file, [a.programs / "bench_occlusion", s.path, "--config", c, "--csv", "RESULT"] + (["--roi", s.roi_text] if s.roi_text else []))
            for s in scenes(a) for c, file in s.tables.items()]


def write_table(report, s):
    rows = []
    if s.is_covered():
        rows.append(["truth", f"{round(s.covered[s.peak] * AREAS * AREAS)} of {AREAS * AREAS}", number(1 - s.covered[s.peak], 2), "", "", "", "0", "0"])
    for c in CONFIGURATIONS:
        row = [c, f"{s.count[c][s.peak]} of {AREAS * AREAS}", number(float(s.rows[c][s.peak]["visible_fraction"]), 2), s.tracking[c].sum()]
        if s.truth is not None:
            sure = s.corner[c][s.tracking[c]]
            row += [(sure >= LOST).sum() if c == "default" else "", number(sure.max(initial=0), 2), short(s.e_occl[c][s.peak]),
                    short(np.nanmax(s.e_occl[c]))]
        rows.append(row + [""] * (8 - len(row)))
    report.table(["detection", f"areas occluded at the peak (frame {s.peak})", "of the ROI used", "images TRACKING", "lies", "worst corner [px]",
                  "e_occl there", "e_occl at most"], rows)


def write_curves(report, s):
    figure, axes = plt.subplots(1, 2 if s.truth is not None else 1, figsize=(11, 3.2), squeeze=False)
    areas = axes[0][-1]
    if s.truth is not None:
        for c in CONFIGURATIONS:
            axes[0][0].semilogy(np.maximum(s.e_occl[c], 1e-6), color=COLOURS[c], label=c)
        axes[0][0].set(xlabel="frame", ylabel="e_occl (13), normalised", title="error")
        axes[0][0].legend()
    for c in CONFIGURATIONS[1:]:
        areas.plot(s.count[c], color=COLOURS[c], label=c)
    if s.is_covered():
        areas.plot(s.covered * AREAS * AREAS, "k:", label="truth (ROI covered, in areas)")
    areas.set(xlabel="frame", ylabel="areas taken for occluded", title="areas")
    areas.legend()
    report.figure(figure, f"occlusion_{s.name}_curves", f"{s.name}: e_occl (13) over time with and without detection (the paper's figure 4), "
                  "and the areas taken for occluded" if s.truth is not None else f"{s.name}: areas taken for occluded")


def write_images(report, s, chosen):
    x, y, w, h = s.roi
    top, bottom = max(0, int(y - 0.45 * h)), min(s.images[0].shape[0], int(y + 1.45 * h))
    left, right = max(0, int(x - 0.45 * w)), min(s.images[0].shape[1], int(x + 1.45 * w))
    chosen = [n for n in chosen or np.unique(np.clip(s.peak + np.array([-12, -6, 0, 6, 12]), 0, len(s.images) - 1)) if n < len(s.images)]
    lines = (("none", False), ("published", False), ("published", True), ("default", True))
    figure, axes = plt.subplots(len(lines), len(chosen), figsize=(2.3 * len(chosen), 2.3 * len(lines)), squeeze=False)
    for line, (c, areas) in zip(axes, lines):
        for axis, n in zip(line, chosen):
            shown = draw(s.images[n], s.G[c][n], s.roi, s.flags[c][n] if areas else ())
            axis.imshow(cv2.cvtColor(shown[top:bottom, left:right], cv2.COLOR_BGR2RGB))
            axis.set(xticks=[], yticks=[])
            axis.set_title(f"{c}, frame {n}", fontsize=7)
    report.figure(figure, f"occlusion_{s.name}_images", f"{s.name}: blue the ROI in the reference, red where the tracker takes it to be, filled "
                  "squares the areas taken for occluded (the paper's figures 3 and 5)")


def write(report, a):
    report.text("## Occlusion, as in the paper", "`none`: ESM on grey levels without any detection; `published`: with the detection of Bourger et "
                "al. (2007), 14 x 14 areas; `default`: this package's. The first two have no test of their estimate and follow it wherever it "
                "goes. In the paper 155 of 196 areas are occluded at the peak, and e_occl is a third with detection.")
    for s in scenes(a):
        s.read()
        report.text(f"### {s.name}")
        write_table(report, s)
        write_curves(report, s)
        write_images(report, s, PAPERS_FRAMES if s.name == "still_sheet" and not a.sequence else None)

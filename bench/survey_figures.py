#!/usr/bin/python3
"""Figures 7 to 11 of Marchand and Chaumette (2004), with ours: of the runs that `bench_loop --pictures FOLDER` has written.

  bench/survey_figures.py FOLDER OUT    writes OUT/figure_7.png, figure_8_9.png, figure_10.png and figure_11.png

What the survey shows stands in each title: its figures themselves are not part of this project.
"""
import argparse
import csv
import pathlib

import cv2
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


class Run:
    """The table of a run, and its images by their numbers."""

    def __init__(self, folder, name):
        table = folder / f"{name}.csv"
        with open(table) as stream:
            self.rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(stream)]
        if not self.rows:
            raise SystemExit(f"{table}: no images")
        self.files = {int(f.stem.rsplit("_", 1)[1]): f for f in sorted(folder.glob(f"{name}_[0-9]*.png"))}

    def image(self, number):
        return cv2.cvtColor(cv2.imread(str(self.files[number])), cv2.COLOR_BGR2RGB)

    def numbers(self, most):
        """Of so many images at most, evenly, the first and the last among them."""
        numbers = sorted(self.files)
        return [numbers[k] for k in np.unique(np.linspace(0, len(numbers) - 1, min(most, len(numbers))).round().astype(int))]


def sheet(run, axes):
    """Images with what the survey marks: the estimated place, a cross, and the image's middle, a diamond."""
    for axis in axes:
        axis.axis("off")
    for axis, number in zip(axes, run.numbers(len(axes))):
        image, row = run.image(number), run.rows[number]
        height, width = image.shape[:2]
        axis.imshow(image)
        axis.plot((width - 1) / 2, (height - 1) / 2, "D", mfc="none", mec="white", ms=7)
        axis.plot(row["x"], row["y"], "+", color="lime", ms=11, mew=2)
        axis.set_xlim(-0.5, width - 0.5)
        axis.set_ylim(height - 0.5, -0.5)
        axis.set_title(f"{row['t']:.1f} s", fontsize=8)


def follow(run, out):
    figure, axes = plt.subplots(4, 6, figsize=(13, 7.5))
    sheet(run, axes.ravel())
    figure.suptitle("Fig. 7 (survey: a pedestrian, kept at the image's middle by pan and tilt). Ours: FOLLOW, an object of 8 % of the image that slides over tissue\n"
                    "cross: estimated middle of the object; diamond: middle of the image")
    save(figure, out / "figure_7.png")


def stabilise(without, run, out):
    figure = plt.figure(figsize=(13, 8.5), constrained_layout=True)
    above, below, last = figure.subfigures(3, 1, height_ratios=(1, 1, 1.2))
    for part, which, title in ((above, without, "Fig. 8 (survey: rocks, a camera that is not controlled). Ours: tissue that goes to and fro, without a task"),
                               (below, run, "Fig. 9 (survey: the same, stabilised). Ours: STABILISE")):
        sheet(which, part.subplots(1, 6))
        part.suptitle(title)
    axis = last.subplots()
    for which, name in ((without, "without a task"), (run, "STABILISE")):
        t = [row["t"] for row in which.rows]
        off = [np.hypot(row["true_x"] - which.rows[0]["true_x"], row["true_y"] - which.rows[0]["true_y"]) for row in which.rows]
        axis.plot(t, off, label=name)
    axis.set_xlabel("s")
    axis.set_ylabel("px from the anchor image, truth")
    axis.legend()
    axis.grid(alpha=0.3)
    save(figure, out / "figure_8_9.png")


def field(a, size):
    """Eq. (8) on a grid: pixels, and their velocities."""
    width, height = size
    u, v = np.meshgrid(np.linspace(0.06, 0.94, 13) * width, np.linspace(0.06, 0.94, 10) * height)
    x, y = u - width / 2, v - height / 2
    return u, v, a[0] + a[2] * x + a[3] * y + a[6] * x * x + a[7] * x * y, a[1] + a[4] * x + a[5] * y + a[6] * x * y + a[7] * y * y


def parallel(run, out):
    height, width = run.image(min(run.files)).shape[:2]
    fields = np.array([[row[f"a{k}"] for k in range(8)] for row in run.rows])
    # In the middle of the first quarter of the circle, which takes 4 s: the arm is at its full speed.
    number = min(range(len(run.rows)), key=lambda k: abs(run.rows[k]["t"] - 0.9))
    current = fields[number]
    desired = current.copy()
    desired[2:6] = 0.0  # for g1 = g2 = 0 and no motion along the axis eq. (8) has no affine part
    figure, axes = plt.subplots(1, 2, figsize=(12, 5))
    for axis, a, title in zip(axes, (current, desired), ("(a) current: measured on the circle, before tissue slanted by %.0f degrees" % run.rows[number]["slant"],
                                                         "(b) desired: of the same pan and tilt before parallel tissue")):
        axis.quiver(*field(a, (width, height)), angles="xy", scale_units="xy", scale=0.15, width=0.0025)
        axis.set_xlim(0, width)
        axis.set_ylim(height, 0)
        axis.set_aspect("equal")
        axis.set_title(title, fontsize=9)
    figure.suptitle("Fig. 10 (survey: current and desired motion field). Ours: PARALLEL")
    save(figure, out / "figure_10.png")

    figure, axes = plt.subplots(1, 3, figsize=(15, 4.3))
    numbers = sorted(run.files)
    for axis, number, title in zip(axes, (numbers[0], numbers[-1]), ("(a) initial", "(b) final")):
        axis.imshow(run.image(number))
        axis.axis("off")
        axis.set_title(f"{title}: {run.rows[number]['slant']:.2f} degrees", fontsize=9)
    axes[2].plot([row["t"] for row in run.rows], [row["slant"] for row in run.rows])
    axes[2].set_xlabel("s")
    axes[2].set_ylabel("degrees, of the image plane against the tissue")
    axes[2].grid(alpha=0.3)
    figure.suptitle("Fig. 11 (survey: a camera parallel to a plane, initial and final image). Ours: PARALLEL")
    save(figure, out / "figure_11.png")


def save(figure, file):
    figure.savefig(file, dpi=80)
    plt.close(figure)
    print(file)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    a = parser.parse_args()
    a.out.mkdir(parents=True, exist_ok=True)
    follow(Run(a.folder, "follow"), a.out)
    stabilise(Run(a.folder, "stabilise_without"), Run(a.folder, "stabilise"), a.out)
    parallel(Run(a.folder, "parallel"), a.out)


if __name__ == "__main__":
    main()

"""POT-210 and POT-280, planar object tracking in the wild.

  V01/V01_1.avi, or a folder V01_1 of its images
  annotation/V01_1_gt_points.txt    a line an image: x1 y1 ... x4 y4 of the target's corners, all 0 where they are not annotated
  annotation/V01_1_flag.txt         a line an image: 0 where it counts (1 covered, 2 out of view, 3 blurred)
"""
import os
import pathlib
import re

import cv2
import numpy as np

from . import metrics, truth

NAME = "POT"
SAYS = "precision at 5 and 15 px of the alignment error, and success, the region being the largest upright rectangle in the target"
KEYS = ()
SEQUENCE = re.compile(r"V\d\d_\d")
LEVELS = 4  # folders above a recording in which the annotation is looked for
DISCREPANCIES = (10.0, 30.0)  # of the homography: PlanarTrack's evaluation, which has POT's form, steps by the one and ranks by the other
PICTURES = {".jpg", ".jpeg", ".png", ".bmp"}


def folders(folder):
    found = []
    for place, _, names in os.walk(folder):
        path = pathlib.Path(place)
        if SEQUENCE.fullmatch(path.name) and any(pathlib.Path(name).suffix.lower() in PICTURES for name in names):
            found.append(path)
    return found


def annotation(recording):
    """The file of corners; None: there is none."""
    name = f"{recording.stem}_gt_points.txt"
    places = [place for above in list(recording.parents)[:LEVELS] for place in (above, above / "annotation", above / "annotation" / "annotation")]
    return next((place / name for place in places if (place / name).is_file()), None)


def recognises(recording):
    return SEQUENCE.fullmatch(recording.stem) is not None and annotation(recording) is not None


def case(recording, folder):
    return truth.case_of(recording.with_suffix(""), folder)


def numbers(path, columns):
    """A row of numbers for each line."""
    try:
        with open(path, encoding="utf-8") as file:
            rows = [line.replace(",", " ").split() for line in file if line.strip()]
    except (OSError, UnicodeDecodeError) as error:
        raise truth.BadTruth([f"{path}: {getattr(error, 'strerror', None) or error}, expected a table of {NAME}"]) from error
    problems, values = [], []
    for number, row in enumerate(rows, 1):
        try:
            values.append([float(cell) for cell in row])
        except ValueError:
            values.append([np.nan])
        if len(row) != columns or not np.isfinite(values[-1]).all():
            problems.append(f"{path}:{number}: '{' '.join(row)}', expected {columns} numbers")
    if problems or not rows:
        raise truth.BadTruth(problems[:5] + [f"{path} has {len(problems) or 'no'} such lines"] if problems else [f"{path} is empty, expected a line an image"])
    return np.array(values)


def largest_rectangle(corners):
    """x, y, width, height in whole px of the largest upright rectangle in a convex quadrilateral: its sides are bound by their ends alone."""
    low, high = int(np.ceil(corners[:, 1].min())), int(np.floor(corners[:, 1].max()))
    rows, sides = np.arange(low, high + 1), list(zip(corners, np.roll(corners, -1, axis=0)))
    left, right = np.full(len(rows), np.inf), np.full(len(rows), -np.inf)
    for (x0, y0), (x1, y1) in sides:
        if y0 == y1:
            continue
        share = (rows - y0) / (y1 - y0)
        x = np.where((share >= 0.0) & (share <= 1.0), x0 + share * (x1 - x0), np.nan)
        left, right = np.fmin(left, x), np.fmax(right, x)
    left, right = np.ceil(left), np.floor(right)
    width = np.minimum.outer(right, right) - np.maximum.outer(left, left) + 1.0
    height = rows[None, :] - rows[:, None] + 1.0
    area = np.where((width > 0.0) & (height > 0.0), width * height, 0.0)
    if not area.any():
        return None
    top, bottom = np.unravel_index(np.argmax(area), area.shape)
    return int(max(left[top], left[bottom])), int(rows[top]), int(width[top, bottom]), int(height[top, bottom])


class Truth:
    def __init__(self, corners, flags):
        self.corners = corners.reshape(-1, 4, 2)
        self.counts = np.any(corners != 0.0, axis=1) & (flags == 0.0)
        self.counts[0] = False  # the tracker is given it

    def score(self, tracked):
        """`tracked`: None when the tracker was never started. What it says where it does not claim to track counts, as published."""
        answers = {} if tracked is None else tracked.images
        if tracked is not None:
            tracked.expect_start(0)
        errors, discrepancies, claims = [], [], []
        first = self.corners[0].astype(np.float32)
        for image in np.flatnonzero(self.counts):
            claimed, g = answers.get(int(image), (False, None))
            between = cv2.getPerspectiveTransform(first, self.corners[image].astype(np.float32))
            error = np.inf if g is None else float(metrics.alignment_error(metrics.moved(g, self.corners[0]), self.corners[image]))
            discrepancy = np.inf if g is None else metrics.homography_discrepancy(g, between)
            errors.append(round(error, 3) if np.isfinite(error) else None)
            discrepancies.append(round(discrepancy, 3) if np.isfinite(discrepancy) else None)
            claims.append(bool(claimed))
        return {"name": NAME, "errors": errors, "discrepancies": discrepancies, "claims": claims}


def read(path, facts):
    """Corners and flags, of as many images as the recording has."""
    problems, path = [], pathlib.Path(path)
    if not path.name.endswith("_gt_points.txt"):
        raise truth.BadTruth([f"truth is '{path}', expected a file that ends in _gt_points.txt"])
    flag_file = path.with_name(path.name.replace("_gt_points.txt", "_flag.txt"))
    corners, flags = truth.attempt(problems, numbers, path, 8), truth.attempt(problems, numbers, flag_file, 1)
    if corners is not None:
        truth.check_images(path, len(corners), facts, problems)
        if not cv2.isContourConvex(corners[0].reshape(4, 2).astype(np.float32)):
            problems.append(f"{path}:1: '{' '.join(map(str, corners[0]))}', expected the corners of a convex quadrilateral, one after the other")
        if flags is not None and len(flags) != len(corners):
            problems.append(f"{flag_file} is of {len(flags)} images, {path.name} of {len(corners)}, expected as many")
    if problems:
        raise truth.BadTruth(problems)
    return corners, flags[:, 0]


def lines(recording, facts, _manifest):
    path = annotation(recording)
    corners, _ = read(path, facts)
    region = largest_rectangle(corners[0].reshape(4, 2))
    if region is None:
        raise truth.BadTruth([f"{path}:1: '{' '.join(map(str, corners[0]))}' has no upright rectangle in it, expected room for a region"])
    return [{"roi": ",".join(map(str, region)), "truth": str(path), "benchmark": NAME}]


def load(row, facts=None):
    problems = []
    truth.attempt(problems, truth.settings_of, row["benchmark"], NAME, KEYS)
    tables = truth.attempt(problems, read, row["truth"], facts)
    if problems:
        raise truth.BadTruth(problems)
    return Truth(*tables)


def of_case(scores):
    def joined(key):
        return np.array([np.inf if value is None else value for score in scores for value in score[key]], float)
    errors, discrepancies, claims = joined("errors"), joined("discrepancies"), joined("claims")
    claimed = np.where(claims > 0.0, errors, np.inf)
    median = float(np.median(errors)) if errors.size else None
    return {**{f"precision at {limit:.0f} px": metrics.within(errors, limit) for limit in metrics.ALIGNMENT_LIMITS},
            **{f"claimed precision at {limit:.0f} px": metrics.within(claimed, limit) for limit in metrics.ALIGNMENT_LIMITS},
            **{f"success at {limit:.0f}": metrics.within(discrepancies, limit) for limit in DISCREPANCIES},
            "alignment error, median [px]": median if median is not None and np.isfinite(median) else None,
            "images": int(errors.size), "claimed": int(claims.sum())}


def of_all(rows):
    return of_case([score for _, score in rows])

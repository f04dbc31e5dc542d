"""The files of SurgT, read and checked: see layouts_surgt.py."""
import functools
import os

import cv2
import numpy as np
import yaml

from . import truth

LEVELS = 5  # folders above a sample in which config.yaml is looked for
STACKS = {"vertical": (1, 2), "horizontal": (2, 1)}  # views side by side and above one another
MOST_TOLD = 5  # of images that are wrong in one file


class Loader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):
    """Plain data, and the tuples that Python's writer marks."""


Loader.add_constructor("tag:yaml.org,2002:python/tuple", lambda loader, node: loader.construct_sequence(node, deep=True))


def read_yaml(path):
    try:
        with open(path, encoding="utf-8") as file:
            return yaml.load(file, Loader)  # a safe one
    except OSError as error:
        raise truth.BadTruth([f"{path}: {error.strerror}, expected a file of SurgT"]) from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise truth.BadTruth([f"{path} is no YAML: {' '.join(str(error).split())}"]) from error


def information(folder):
    """What info.yaml says of a sample."""
    path = folder / "info.yaml"
    info, problems = read_yaml(path), []
    info = info if isinstance(info, dict) else {}
    size = info.get("resolution") if isinstance(info.get("resolution"), dict) else {}
    for name in ("width", "height"):
        if not isinstance(size.get(name), int) or size[name] < 1:
            problems.append(f"{path}: resolution {name} is {size.get(name)}, expected px from 1 on")
    if info.get("video_stack") not in STACKS:
        problems.append(f"{path}: video_stack is {info.get('video_stack')}, expected {' or '.join(STACKS)}")
    names = info.get("name_ground_truth")
    if not isinstance(names, list) or not names or not all(isinstance(name, str) for name in names):
        problems.append(f"{path}: name_ground_truth is {names}, expected a list of files")
    if problems:
        raise truth.BadTruth(problems)
    return info


def size_of(info):
    """Of one view: width, height."""
    return info["resolution"]["width"], info["resolution"]["height"]


def is_box(box):
    return isinstance(box, list) and len(box) == 4 and all(isinstance(v, (int, float)) and np.isfinite(v) for v in box) and min(box[2:]) > 0


@functools.lru_cache(maxsize=4)
def read_truth(path, _modified):
    """For each image: visible, difficult, boxes of both views or None."""
    table, problems = read_yaml(path), []
    table = dict(enumerate(table)) if isinstance(table, list) else table
    if not isinstance(table, dict) or set(table) != set(range(len(table))) or not table:
        raise truth.BadTruth([f"{path}: expected an entry for each image, numbered from 0 on"])
    for image, entry in table.items():
        good = isinstance(entry, list) and len(entry) == 3 and all(isinstance(flag, bool) for flag in entry[:2])
        good = good and (entry[2] is None or (isinstance(entry[2], list) and len(entry[2]) == 2 and all(box is None or is_box(box) for box in entry[2])))
        if not good:
            problems.append(f"{path}: image {image} is {entry}, expected visible, difficult, and two boxes x, y, width, height or null")
        elif entry[0] and not entry[1] and (entry[2] is None or entry[2][0] is None or entry[2][1] is None):
            problems.append(f"{path}: image {image} shows the target, and has no boxes")
    if problems:
        raise truth.BadTruth(problems[:MOST_TOLD] + ([f"{path}: {len(problems) - MOST_TOLD} more images are wrong"] if len(problems) > MOST_TOLD else []))
    return [table[image] for image in range(len(table))]


def table_of(path):
    try:
        return read_truth(str(path), os.stat(path).st_mtime_ns)
    except OSError as error:
        raise truth.BadTruth([f"{path}: {error.strerror}, expected a file of SurgT"]) from error


def configuration(folder):
    """config.yaml of SurgT_benchmarking and the part of it that is about this sample; empty ones where there is none."""
    for path in (above / "config.yaml" for above in list(folder.parents)[:LEVELS]):
        config = read_yaml(path) if path.is_file() else None
        if isinstance(config, dict) and "is_to_rectify" in config:
            parts = [part for part in config.values() if isinstance(part, dict)]
            return config, next((part for part in parts if part.get("subdir") == folder.parents[1].name), {})
    return {}, {}


def calibration(folder, size):
    """Of the left view, as ROS has it: the rectification that SurgT's boxes are in."""
    path = folder / "calibration.yaml"
    if not path.is_file():
        raise truth.BadTruth([f"{path} does not exist, expected a calibration as OpenCV writes it"])
    shapes, found = {"M1": (3, 3), "D1": None, "M2": (3, 3), "D2": None, "R": (3, 3), "T": None}, {}
    try:
        storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_READ)
        found = {name: storage.getNode(name).mat() for name in shapes}
    except (cv2.error, SystemError) as error:
        raise truth.BadTruth([f"{path} cannot be read, expected a calibration as OpenCV writes it"]) from error
    problems = [f"{path}: {name} is missing" for name, value in found.items() if value is None]
    problems += [f"{path}: {name} has {found[name].shape[0]} x {found[name].shape[1]} values, expected 3 x 3" for name, shape in shapes.items()
                 if shape and found[name] is not None and found[name].shape != shape]
    for name, counts in (("D1", (4, 5, 8)), ("D2", (4, 5, 8)), ("T", (3,))):
        if found[name] is not None and found[name].size not in counts:
            problems.append(f"{path}: {name} has {found[name].size} values, expected {' or '.join(map(str, counts))}")
    if problems:
        raise truth.BadTruth(problems)
    m1, d1, m2, d2, r, t = (np.asarray(found[name], float) for name in shapes)
    r1, _, p1, *_ = cv2.stereoRectify(m1, d1.ravel(), m2, d2.ravel(), size, r, t.reshape(3, 1), flags=cv2.CALIB_ZERO_DISPARITY, alpha=0.0)

    def matrix(value):
        return {"rows": value.shape[0], "cols": value.shape[1], "data": [float(v) for v in value.ravel()]}
    return {"image_width": size[0], "image_height": size[1], "camera_name": "left", "camera_matrix": matrix(m1),
            "distortion_model": "rational_polynomial" if d1.size == 8 else "plumb_bob", "distortion_coefficients": matrix(d1.reshape(1, -1)),
            "rectification_matrix": matrix(r1), "projection_matrix": matrix(p1)}

"""SurgT (MICCAI 2022): stereo videos, each with a folder of its own.

  CASE/SAMPLE/info.yaml            name_video, video_stack (vertical or horizontal: left view above or left), resolution of one view,
                                   name_ground_truth: a file for each target
  CASE/SAMPLE/calibration.yaml     M1 D1 M2 D2 R T, as OpenCV writes them
  CASE/SAMPLE/gt_rectified_0.yaml  by image: visible in both views, difficult, boxes x, y, width, height in the left and the right view
                                   after rectification, or null
  config.yaml of SurgT_benchmarking, in a folder above: anchors, and the lengths that EAO is over
"""
import hashlib
import pathlib

import numpy as np
import yaml

from . import files, layouts_surgt_files as sample, metrics, metrics_surgt, truth

NAME = "SurgT"
SAYS = "accuracy, robustness, error and expected average overlap of the left view, each anchor a line"
KEYS = ("target", "anchor", "lengths")
ANCHOR_STEP = 50  # images: of the published anchors


def folders(_folder):
    return []


def recognises(recording):
    return (recording.parent / "info.yaml").is_file() and recording.is_file()


def case(recording, folder):
    return truth.case_of(recording.parent, folder)


def first_image(table, anchor, size):
    """Where a tracker can be started from an anchor on: the target is in sight, and its boxes are inside of the images. None: nowhere."""
    def inside(box):
        return box[0] >= 0 and box[1] >= 0 and box[0] + box[2] < size[0] and box[1] + box[3] < size[1]
    return next((image for image in range(anchor, len(table))
                 if table[image][0] and not table[image][1] and all(map(inside, table[image][2]))), None)


def starts_of(part, folder, target, table, size):
    """(anchor, first image) by config.yaml; without it every 50th image, as the published ones lie, and none twice."""
    given = ((part.get("anchors") or {}).get(folder.parent.name) or {}).get(folder.name)
    if given is None:
        starts = {first_image(table, anchor, size): anchor for anchor in range(len(table) - 1 - (len(table) - 1) % ANCHOR_STEP, -1, -ANCHOR_STEP)}
        return sorted((anchor, start) for start, anchor in starts.items() if start is not None)
    anchors = given[target] if isinstance(given, list) and len(given) > target else None
    if not isinstance(anchors, list) or not all(isinstance(anchor, int) and anchor >= 0 for anchor in anchors):
        raise truth.BadTruth([f"config.yaml: anchors of {folder.parent.name} {folder.name} are {given}, expected a list of images for each target"])
    starts = [(anchor, first_image(table, anchor, size)) for anchor in anchors]
    late = [str(anchor) for anchor, start in starts if start is None]
    if late:
        raise truth.BadTruth([f"config.yaml: {folder.parent.name} {folder.name} has anchor {', '.join(late)}, but the target is not in sight from there on"])
    return starts


def write_camera(manifest, folder, size):
    """Files beside the manifest by which the tracker rectifies the left view, as columns of a line. Samples of one calibration share a file."""
    text = yaml.safe_dump(sample.calibration(folder, size), default_flow_style=None)
    place = pathlib.Path(f"{manifest}.cameras").resolve()
    camera, params = place / f"{hashlib.sha256(text.encode()).hexdigest()[:12]}.yaml", place / "rectify.yaml"
    files.write_text(camera, text)
    files.write_text(params, "rectify: true\n")
    return {"camera_info": str(camera), "params": str(params)}


def lines(recording, facts, manifest):
    folder, problems, rows = recording.parent, [], []
    info, configuration = truth.attempt(problems, sample.information, folder), truth.attempt(problems, sample.configuration, folder)
    if problems:
        raise truth.BadTruth(problems)
    (config, part), size = configuration, sample.size_of(info)
    across, down = sample.STACKS[info["video_stack"]]
    if (int(facts["width"]), int(facts["height"])) != (across * size[0], down * size[1]):
        problems.append(f"{recording} has {facts['width']} x {facts['height']} px, expected {across * size[0]} x {down * size[1]} for two views")
    camera = truth.attempt(problems, write_camera, manifest, folder, size) if config.get("is_to_rectify", True) else {}
    lengths = f"{part['N_min']}:{part['N_max']}" if all(isinstance(part.get(name), int) for name in ("N_min", "N_max")) else "usual"
    for target, name in enumerate(info["name_ground_truth"]):
        table = truth.attempt(problems, sample.table_of, folder / name)
        if table is None:
            continue
        truth.check_images(folder / name, len(table), facts, problems)
        for anchor, start in truth.attempt(problems, starts_of, part, folder, target, table, size) or []:
            rows.append({"start": truth.start_text(start, facts), "roi": ",".join(map(str, table[start][2][0])), "crop": f"0,0,{size[0]},{size[1]}",
                         "truth": str(folder / name), "benchmark": f"{NAME} target={target} anchor={anchor} lengths={lengths}", **(camera or {})})
    if problems:
        raise truth.BadTruth(problems)
    return rows


class Truth:
    def __init__(self, table, start, settings):
        self.table, self.start, self.settings = table, start, settings

    def score(self, tracked):
        """`tracked`: None when the tracker was never started. Where it does not claim to track, it has told no box."""
        told = {}
        if tracked is not None:
            tracked.expect_start(self.start)
            boxes = {image: self.box(g) for image, (tracking, g) in tracked.images.items() if tracking}
            told = {image: box for image, box in boxes.items() if box is not None}
        left = [(visible, difficult, boxes[0] if boxes else None) for visible, difficult, boxes in self.table]
        return {"name": f"{NAME} lengths={self.settings['lengths']}", "target": int(self.settings["target"]), **metrics_surgt.judge(left, self.start, told)}

    def box(self, g):
        """The start's box where its centre was taken to, as much larger as the tissue there: SurgT's boxes are those of a ball in the tissue.
        None where it goes through infinity."""
        x, y, width, height = self.table[self.start][2][0]
        middle = np.array([x + width / 2.0, y + height / 2.0])
        centre, right, left, below, above = metrics.moved(g, middle + np.array([(0, 0), (0.5, 0), (-0.5, 0), (0, 0.5), (0, -0.5)]))
        if not np.isfinite([centre, right, left, below, above]).all():
            return None
        size = np.sqrt(abs(np.linalg.det(np.array([right - left, below - above])))) * np.array([width, height])
        return [float(value) for value in (*(centre - size / 2.0), *size)]


def load(row, facts=None):
    problems = []
    settings = truth.settings_of(row["benchmark"], NAME, KEYS)
    for name in ("target", "anchor"):
        if not settings[name].isdigit():
            problems.append(f"benchmark: {name} is '{settings[name]}', expected a number from 0 on")
    first, _, last = settings["lengths"].partition(":")
    if settings["lengths"] != "usual" and not (first.isdigit() and last.isdigit() and int(first) < int(last)):
        problems.append(f"benchmark: lengths is '{settings['lengths']}', expected usual, or images as 150:829")
    info = truth.attempt(problems, sample.information, pathlib.Path(row["truth"]).parent)
    table = truth.attempt(problems, sample.table_of, row["truth"])
    if table:
        truth.check_images(row["truth"], len(table), facts, problems)
    if problems:
        raise truth.BadTruth(problems)
    start = first_image(table, int(settings["anchor"]), sample.size_of(info))
    if start is None:
        raise truth.BadTruth([f"benchmark: anchor is {settings['anchor']}, but in {row['truth']} the target is not in sight from there on"])
    return Truth(table, start, settings)


def of_case(scores):
    return metrics_surgt.metrics(scores)


def of_all(rows):
    """EAO joins the starts of a target first, and then the targets."""
    targets = {}
    for name, score in rows:
        targets.setdefault((name, score["target"]), []).append(score["sequence"])
    sequences, lengths = [targets[key] for key in sorted(targets)], rows[0][1]["name"].partition("=")[2]
    first, last = metrics_surgt.usual_lengths(sequences) if lengths == "usual" else map(int, lengths.split(":"))
    return {"expected average overlap": metrics_surgt.expected_average_overlap(sequences, (first, last)), "from image": first, "to image": last - 1,
            **metrics_surgt.metrics([score for _, score in rows])}

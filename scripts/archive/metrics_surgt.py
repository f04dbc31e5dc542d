"""SurgT's metrics, of one view: accuracy, robustness, error and expected average overlap (EAO), as SurgT_benchmarking defines them.

A tracker is started at an anchor, and is not helped again until the end: it has failed when it missed the target in more than
MISSES_ALLOWED images one after the other. Then the images of these misses do not count for accuracy and error, and those that follow
count as missed. Images in which the target is not visible, or that are marked as difficult, count for nothing, but that a box where
there is none lowers robustness.
"""
import math

MISSES_ALLOWED = 10
OVERLAP_LIMIT = 0.1  # up to it the target is missed


def overlap(a, b):
    """Intersection over union of two boxes x, y, width, height."""
    width = min(a[0] + a[2], b[0] + b[2]) - max(a[0], b[0])
    height = min(a[1] + a[3], b[1] + b[3]) - max(a[1], b[1])
    common = max(width, 0.0) * max(height, 0.0)
    return common / (a[2] * a[3] + b[2] * b[3] - common)


def centre_distance(a, b):
    """px, between the boxes' centres, each cut to whole px as published."""
    centres = [(int(box[0] + box[2] / 2), int(box[1] + box[3] / 2)) for box in (a, b)]
    return math.hypot(centres[0][0] - centres[1][0], centres[0][1] - centres[1][1])


def judge(truth, start, told):
    """`truth`: for each image whether the target is visible, whether it is difficult, and its box or None; `told`: box by image, where
    there is one; `start`: the image in which the tracker was given its box, which does not count. Returns what metrics() and
    expected_average_overlap() pool; the sequence has None for images that do not count, and ends with the last one that does."""
    overlaps, errors, sequence = [], [], []
    seen = right = excessive = misses = 0
    failed = None
    for image in range(start + 1, len(truth)):
        visible, difficult, box = truth[image]
        answer = told.get(image) if failed is None else None
        if difficult or not visible:
            excessive += not difficult and box is None and answer is not None
            sequence.append(None)
            continue
        seen += 1
        value = 0.0 if answer is None else overlap(box, answer)
        sequence.append(round(value, 6))
        if failed is not None:
            continue
        overlaps.append(None if answer is None else value)
        errors.append(None if answer is None else centre_distance(box, answer))
        right += value > OVERLAP_LIMIT
        misses = 0 if value > OVERLAP_LIMIT else misses + 1
        if misses > MISSES_ALLOWED:
            failed = image
            del overlaps[-misses:], errors[-misses:]
    while sequence and sequence[-1] is None:
        sequence.pop()
    overlaps, errors = ([value for value in values if value is not None] for values in (overlaps, errors))
    return {"sequence": sequence, "overlap_sum": sum(overlaps), "error_sum": sum(errors), "overlaps": len(overlaps), "right": right, "seen": seen,
            "excessive": excessive, "failed": failed}


def metrics(runs):
    """Accuracy, robustness and error [px] of all these runs: means weighted by images, as published."""
    overlaps, asked = sum(run["overlaps"] for run in runs), sum(run["seen"] + run["excessive"] for run in runs)
    return {"accuracy": sum(run["overlap_sum"] for run in runs) / overlaps if overlaps else None,
            "robustness": sum(run["right"] for run in runs) / asked if asked else None,
            "error 2D [px]": sum(run["error_sum"] for run in runs) / overlaps if overlaps else None,
            "starts": len(runs), "failures": sum(run["failed"] is not None for run in runs)}


def mean_sequence(sequences):
    """Image by image the mean of those that go on so long; None where none of them counts."""
    means = []
    for image in range(max(map(len, sequences), default=0)):
        values = [sequence[image] for sequence in sequences if len(sequence) > image and sequence[image] is not None]
        means.append(sum(values) / len(values) if values else None)
    return means


def usual_lengths(targets):
    """First length and the one behind the last, of sequences that differ from the mean by a standard deviation at most."""
    lengths = [len(sequence) for sequences in targets for sequence in sequences]
    if not lengths:
        return 0, 0
    mean = sum(lengths) / len(lengths)
    deviation = math.sqrt(sum((length - mean) ** 2 for length in lengths) / len(lengths))
    return max(1, int(round(mean - deviation))), int(round(mean + deviation))


def expected_average_overlap(targets, lengths):
    """EAO of targets, each with the sequences of its starts, which are joined first so that long videos have no more weight. `lengths`:
    first, last; the mean is over the sequences' elements first, ..., last - 1."""
    first, last = lengths
    curve = mean_sequence([mean_sequence(sequences) for sequences in targets])
    values = [value for value in curve[first:last] if value is not None]
    return sum(values) / len(values) if values else None

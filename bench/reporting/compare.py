"""This tracker beside its peers: error, frames kept, lies, time."""
import json

import matplotlib.pyplot as plt
import numpy as np

from .document import LOST, number
from .measuring import Job
from .published import Truth


def jobs(a):
    return [Job(a.out / "compare.json", [a.programs / "bench_compare", *a.sequences.values(), "--json", "RESULT"], timed=True)]


def draw(report, sequence):
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 3.4), gridspec_kw={"width_ratios": [2.4, 1]})
    for t in sequence["trackers"]:
        error = np.array([np.nan if e is None else max(e, 1e-3) for e in t["error"]])
        left.semilogy(np.where(np.array(t["claims"]) > 0, error, np.nan), label=t["name"], lw=1)
    left.axhline(LOST, color="k", lw=0.5, ls=":")
    left.set(xlabel="frame", ylabel="worst corner [px]", ylim=(5e-3, 1e3), title="error where it claims to track")
    covered = np.array([c or 0 for c in sequence["covered"]])
    if covered.max() > 0:
        twin = left.twinx()
        twin.fill_between(range(len(covered)), covered, color="0.85", zorder=0)
        twin.set(ylim=(0, 1), ylabel="share covered")
        left.set_zorder(twin.get_zorder() + 1)
        left.patch.set_visible(False)
    left.legend(fontsize=7, loc="upper left")
    right.barh([t["name"] for t in sequence["trackers"]], [t["cpu_ms_median"] or 0 for t in sequence["trackers"]])
    right.invert_yaxis()
    right.set(xscale="log", xlabel="ms per image, median", title="processor time")
    report.figure(figure, f"compare_{sequence['sequence']}", f"{sequence['sequence']}: error and time")


def ratio(a, b):
    return None if a is None or not b else a / b


def write_summary(report, sequences):
    """This tracker, which comes first, and how much longer each of its peers takes."""
    rows = []
    for sequence in sequences:
        ours, *peers = sequence["trackers"]
        rows.append([sequence["sequence"], number(ours["error_mean"]), number(ours["error_p95"]), f"{ours['kept']:.0f} of {sequence['frames']:.0f}",
                     f"{ours['lies']:.0f}", number(ours["ms_median"]), number(ratio(ours["ms_p99"], ours["ms_median"]), 1),
                     *[f"{number(p['time_ratio'], 1)} ({p['kept']:.0f} kept, {p['lies']:.0f} lies)" for p in peers]])
    names = [t["name"] for t in sequences[0]["trackers"]]
    report.table(["sequence", f"{names[0]}: error mean [px]", "p95 [px]", "kept", "lies", "median [ms]", "p99 / median",
                  *[f"{name}: its time over ours" for name in names[1:]]], rows)


def write(report, a):
    report.text("## Beside its peers", "All trackers get each image in turn, on one thread, in one run. Error: the worst corner, mean "
                f"over the frames kept. Kept: said to be tracked, and wrong by less than {LOST:.0f} px. Lies: said to be tracked, and wrong by "
                "more. Peers that have no test of their own claim every frame unless they give up. Median, p99: wall time per image while it goes on; "
                "the ratio is of processor times.",
                "Beside these, what the field publishes. Points are the centres of the region's 14 x 14 areas; one is visible where less than half of its area "
                "is covered and it lies in the image; it is claimed when the tracker says that it tracks, which it says of all points at once. Average Jaccard (TAP-Vid): "
                "points that are visible, claimed and near, over those that are visible and those wrongly claimed. Average accuracy (TAP-Vid, STIR): the share of visible points that "
                "are near, whatever is claimed; and with those wrong that are not claimed. Both are means over what is near: 2, 4, 8, 16 and 32 px of the image. "
                "Alignment error (POT): root mean square of the four corners, and the share of images in which it is up to 5 and 15 px. The first image does not count.")
    sequences = json.loads(jobs(a)[0].result.read_text())
    write_summary(report, sequences)
    for sequence, folder in zip(sequences, a.sequences.values()):
        truth = Truth(folder)
        report.text(f"### {sequence['sequence']}, {sequence['frames']:.0f} frames")
        report.table(["tracker", "error mean [px]", "p95 [px]", "kept", "lies", "given up", "median [ms]", "p99 [ms]", "p99 / median",
                      "time over ours"],
                     [[t["name"], number(t["error_mean"]), number(t["error_p95"]), f"{t['kept']:.0f}", f"{t['lies']:.0f}",
                       f"{t['silent']:.0f}", number(t["ms_median"]), number(t["ms_p99"]), number(ratio(t["ms_p99"], t["ms_median"]), 1),
                       number(t["time_ratio"], 2)] for t in sequence["trackers"]])
        report.table(["tracker", "average Jaccard", "average accuracy", "the same, claimed", "alignment error, median [px]", "up to 5 px", "up to 15 px"],
                     [[t["name"], *map(number, truth.judge(t).values())] for t in sequence["trackers"]])
        draw(report, sequence)

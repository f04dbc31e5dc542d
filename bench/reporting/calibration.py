"""What the tracker's claims of its own error are worth, against the truth and against a second measurement."""
import json

import matplotlib.pyplot as plt
import numpy as np

from .document import number
from .honesty import bins_of
from .measuring import Job

TITLES = {"truth": "against the truth", "noise_1": "noise of 1 grey level", "noise_3": "noise of 3 grey levels", "encoding": "two encodings",
          "start": "another start", "backward": "backward in time"}


def jobs(a):
    if not a.track_bag:
        return []
    few = ["--limit", 60] if a.quick else []
    films = ["--data", a.data, "--regions", a.regions] if a.data else []
    sequences = [option for folder in a.sequences.values() for option in ("--sequence", folder)]
    return [Job(a.out / "calibration.json", [a.here / "calibration.py", a.track_bag, *sequences, *films, *few, "--jobs", a.jobs, "--json", "RESULT"])]


def line(row):
    values = [TITLES[row["way"]], row["images"]]
    for what in ("corner", "centre"):
        claimed, measured = (np.array(row.get(what, {}).get(k, [])) for k in ("claimed", "measured"))
        if not len(claimed):
            values += ["-"] * 4
            continue
        z = measured / claimed
        values += [number(np.sqrt(np.mean(claimed ** 2))), number(np.sqrt(np.mean(measured ** 2))), number(np.sqrt(np.mean(z ** 2)), 2), number(z.max(), 1)]
    return values + [row.get("refused", "")]


def draw(report, rows):
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.8))
    for axis, what in zip(axes, ("corner", "centre")):
        for colour, (way, title) in enumerate(TITLES.items()):
            of = [r[what] for r in rows if r["way"] == way and what in r]
            claimed, measured = (np.concatenate([v[k] for v in of]) if of else np.array([]) for k in ("claimed", "measured"))
            known = np.isfinite(measured)
            claimed, measured = claimed[known], measured[known]
            if not len(claimed):
                continue
            axis.loglog(claimed, np.maximum(measured, 1e-4), ".", ms=2, alpha=0.15, color=f"C{colour}")
            points = np.array([(c, np.sqrt(np.mean(m ** 2))) for c, m in bins_of(claimed, measured)]).reshape(-1, 2)
            axis.loglog(*points.T, "o-", ms=4, color=f"C{colour}", label=title)
        ends = np.array(axis.get_xlim())
        for factor, style in ((1, "-"), (5, ":")):
            axis.plot(ends, factor * ends, "k", lw=0.7, ls=style)
        axis.set(xlabel=f"claimed error of the {what} [px]", ylabel="measured [px]", xlim=ends, ylim=(1e-3, None))
        axis.legend(fontsize=7)
    report.figure(figure, "calibration", "Claimed and measured error, image by image, and root mean square of those claimed alike; lines: as claimed, and 5 times")


def write(report, a):
    if not a.track_bag:
        return
    rows = json.loads(jobs(a)[0].result.read_text())
    report.text("## Calibration", "`corner_error` and `centre_error` beside what is measured: on sequences the true error, on films how far two "
                "measurements of the same region differ, beside what both claim together (bench/calibration.py says how). Ratio: root mean square over images of measured "
                "over claimed; the most of one image. Above 1 the tracker is too sure.")
    draw(report, rows)
    head = ["way", "images", *(f"{what}: {c}" for what in ("corner", "centre") for c in ("claim [px]", "rms [px]", "ratio", "most")), ""]
    for name in dict.fromkeys(r["name"] for r in rows):
        report.text(f"### {name}")
        report.table(head, [line(r) for r in rows if r["name"] == name])

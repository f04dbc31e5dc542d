"""From how far off alignment converges, as in the papers on ESM."""
import json
import pathlib

import matplotlib.pyplot as plt

from .document import number
from .measuring import Job


def jobs(a):
    ranges = {"corners": "2:20:6", "shifts": "10:40:10"} if a.quick else {"corners": a.corners, "shifts": a.shifts}
    trials = 10 if a.quick else a.trials
    if a.scene:
        scenes = {f"{pathlib.Path(f.rsplit('@', 1)[0]).stem}_{f.rsplit('@', 1)[-1] if '@' in f else 0}": ["--image", f, "--roi", roi] for f, roi in a.scene}
    else:
        scenes = {name: ["--sequence", folder] for name, folder in list(a.sequences.items())[:1]}
    work = []
    for name, scene in scenes.items():
        # Two files, so that two processors can share the work.
        for kind, other in (("corners", "shifts"), ("shifts", "corners")):
            work.append(Job(a.out / f"convergence_{name}_{kind}.json",
                            [a.programs / "bench_convergence", *scene, "--trials", trials, f"--{kind}", ranges[kind], f"--{other}", "none",
                             "--json", "RESULT"]))
    return work


def draw(axis, data, curve):
    for who, share in curve["share"].items():
        axis.plot(curve["distance"], share, marker=".", label=who, lw=2 if who == "ours" else 1)
    axis.set(xlabel="noise of the corners [px]" if curve["kind"] == "corners" else "shift [px]", ylabel="share that converges",
             ylim=(-0.03, 1.03), title=f"{data['scene']}, {data['side']:.0f} px, {data['trials']:.0f} trials")
    axis.grid(alpha=0.3)


def write(report, a):
    report.text("## Convergence", "Share of trials that end with every corner within 1 px. Each trial is a new view of the scene, its ROI's "
                "corners displaced by normal noise (of that standard deviation in each coordinate), or the whole of it by a shift in a random "
                "direction, with two grey levels of noise in both images; everybody starts from the identity. `esm_...` is ESM alone as "
                "configured by default, but for the number of levels; `plain_esm_...` has neither light nor weights, as in the papers, and 50 "
                "iterations, as ECC has; `visp_tuned_1` has one level, `visp_tuned` three; `ours` is the whole tracker, shown the second image "
                "right after the first.")
    work = jobs(a)
    for pair in zip(work[::2], work[1::2]):
        figure, axes = plt.subplots(1, 2, figsize=(11, 3.6))
        for axis, job in zip(axes, pair):
            data = json.loads(job.result.read_text())
            data["scene"] = pathlib.Path(data["scene"]).name
            for curve in data["curves"]:
                draw(axis, data, curve)
                report.table([curve["kind"] + " [px]"] + [f"{d:g}" for d in curve["distance"]],
                             [[who] + [number(s, 2) for s in share] for who, share in curve["share"].items()])
        axes[0].legend(fontsize=7)
        report.figure(figure, pair[0].result.stem.rsplit("_", 1)[0], f"Convergence on {data['scene']}")

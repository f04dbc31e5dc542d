"""What the tracker's words are worth: its state, the scores behind it, and the error that it predicts."""
import matplotlib.pyplot as plt
import numpy as np

from .document import LOST, number, percent
from .measuring import Job, column, table_of

# Largest that each may be, as used by the tracker: quality.cpp, and the default of quality/max_corner_error [px].
UNEXPLAINED = (0.10, 2.0)  # 1 - zncc: constant, and factor on that of the record
SIGMA = (1.0, 2.0)         # residual: grey levels, and factor on that of the record
MAX_CORNER_ERROR = 1.5


def jobs(a):
    options = ["--every", 20, "--trials", 2] if a.quick else []
    return [Job(a.out / "honesty.csv", [a.programs / "bench_honesty", *a.sequences.values(), "--csv", "RESULT", *options])]


def scores(rows):
    """Candidates for a score, each with what makes it greater for better estimates: name -> (values, sign)."""
    zncc, sigma, corner = column(rows, "zncc"), column(rows, "sigma"), np.nan_to_num(column(rows, "corner_error"), nan=1e3, posinf=1e3)
    record_zncc, record_sigma = column(rows, "record_zncc"), column(rows, "record_sigma")
    worst = np.max([(1 - zncc) / (UNEXPLAINED[0] + UNEXPLAINED[1] * (1 - record_zncc)), sigma / (SIGMA[0] + SIGMA[1] * record_sigma),
                    corner / MAX_CORNER_ERROR], 0)
    return {"zncc": (zncc, 1), "sigma / its record": (sigma / record_sigma, -1), "corner_error [px]": (corner, -1),
            "all three, each over its limit": (worst, -1)}


def curve(values, sign, right):
    """For every threshold, from strict to lax: the threshold, share of what passes that is right, share of the right ones that pass."""
    order = np.argsort(-sign * values, kind="stable")
    passed, good = np.arange(1, len(values) + 1), np.cumsum(right[order])
    last = np.append(np.diff(values[order]) != 0, True)  # equal values pass together
    return values[order][last], (good / passed)[last], (good / max(1, right.sum()))[last]


def write_states(report, rows):
    state = [r for r in rows if r["source"] == "sequence"]
    error, tracking = column(state, "error"), column(state, "accepted") == 1
    of = np.array([r["sequence"] for r in state])
    lines = [[n, (of == n).sum(), (tracking & (error < LOST))[of == n].sum(), (tracking & (error >= LOST))[of == n].sum(),
              (~tracking)[of == n].sum()] for n in dict.fromkeys(of)]
    report.text("### The state, image by image")
    report.table(["sequence", "frames", "TRACKING and right", "TRACKING and wrong (lies)", "not TRACKING"],
                 lines + [["all", *np.sum([line[1:] for line in lines], 0)]])


def write_scores(report, rows):
    thrown = [r for r in rows if r["source"] == "jump"]
    trials = [r for r in thrown if r["estimated"] == "1" and np.isfinite(float(r["record_sigma"]))]
    if not trials:
        return
    right, accepted = column(trials, "error") < LOST, column(trials, "accepted") == 1
    report.text("### The scores, where starts are bad", f"The tracker is thrown onto a later image that is displaced besides, by up to 60 px: "
                f"{len(thrown)} times. {len(trials)} estimates came out, {(~right).sum()} of them wrong, a far greater share than in any video. "
                "Precision: share of what passes the threshold that is right. Kept: share of the right ones that pass. `all three` is the "
                "greatest of zncc, residual and predicted error, each over the limit that the tracker has for it: it accepts up to 1, and tests "
                "more than that (visibility, shape, how far the estimate is from the prediction).")
    figure, axes = plt.subplots(1, 4, figsize=(17, 3.6))
    lines = []
    for axis, (name, (values, sign)) in zip(axes, scores(trials).items()):
        threshold, precision, kept = curve(values, sign, right)
        axis.plot(threshold, precision, label="precision")
        axis.plot(threshold, kept, label="kept")
        axis.set(xlabel=name + (" at least" if sign > 0 else " at most"), ylim=(-0.02, 1.03))
        if sign < 0:
            axis.set_xscale("log")
        axis.grid(alpha=0.3)
        used = {"corner_error [px]": MAX_CORNER_ERROR, "all three, each over its limit": 1.0}.get(name)
        if used:
            axis.axvline(used, color="k", lw=0.7, ls=":")
        pure = np.flatnonzero(precision >= 1.0)
        at = pure[-1] if pure.size else None
        area = np.trapz(precision, kept) if len(kept) > 1 else np.nan
        lines.append([name, number(threshold[at], 3) if pure.size else "-", number(kept[at]) if pure.size else "0", number(area)])
    axes[0].legend()
    report.figure(figure, "honesty_scores", "Precision and share kept against the threshold of each score; dotted: as used")
    report.table(["score alone", "laxest threshold with no wrong one", "right ones kept there", "area under precision over kept"], lines)
    strict = [r for r in rows if r["source"] == "accepted"]
    wrong = (column(strict, "error") >= LOST).sum() if strict else 0
    report.text(f"The tracker itself, as configured by default, after eight images and thrown the same way: TRACKING in {len(strict)} of {len(thrown)}, "
                f"{wrong} of these wrong (lies); it kept {percent((right & accepted).sum(), right.sum())} of the right estimates above.")


def bins_of(predicted, error, ratio=1.6, fewest=8):
    """By what was predicted, each up to `ratio` times the last: the median prediction, the frames' errors."""
    bins = np.floor(np.log(predicted / predicted.min()) / np.log(ratio))
    for k in np.unique(bins):
        if (bins == k).sum() >= fewest:
            yield np.median(predicted[bins == k]), error[bins == k]


def write_reliability(report, rows):
    report.text("### The error that is predicted", "`corner_error` says what standard deviation the worst corner has, in px, as root of the mean square of "
                "its distance. Frames that are TRACKING, in bins of what was predicted: where the points lie on the line, the prediction is right; "
                "above it, the tracker is too sure. The true error is that of whichever corner is worst in that frame, so that it is greater than that of a "
                "given one: for four corners as uncertain as each other by about 1.3.")
    figure, axis = plt.subplots(figsize=(5.4, 4.6))
    lines = []
    for source, label, colour in (("sequence", "image by image", "tab:blue"), ("accepted", "thrown", "tab:orange")):
        said = [r for r in rows if r["source"] == source and r["accepted"] == "1" and float(r["corner_error"]) > 0]
        if len(said) < 20:
            continue
        predicted, error = column(said, "corner_error"), column(said, "error")
        axis.loglog(predicted, np.maximum(error, 1e-3), ".", ms=2, alpha=0.25, color=colour)
        points = np.array([(p, np.sqrt(np.mean(e ** 2)), np.quantile(e, 0.95)) for p, e in bins_of(predicted, error)])
        axis.loglog(points[:, 0], points[:, 1], "o-", ms=4, color=colour, label=f"{label}: rms")
        axis.loglog(points[:, 0], points[:, 2], "^--", ms=4, lw=0.8, color=colour, label=f"{label}: 95th percentile")
        of = np.array([r["sequence"] for r in said])
        for name in [*dict.fromkeys(of), "all"]:
            p, e = (predicted[of == name], error[of == name]) if name != "all" else (predicted, error)
            z = e / p
            lines.append([label, name, len(p), number(np.median(p)), number(np.sqrt(np.mean(e ** 2))), number(np.sqrt(np.mean(z ** 2)), 2),
                          *[percent((z <= k).sum(), len(z)) for k in (1, 2, 3)]])
    if not lines:
        report.text("Too few frames for it.")
        plt.close(figure)
        return
    ends = np.array([max(1e-3, axis.get_xlim()[0]), axis.get_xlim()[1]])
    axis.plot(ends, ends, "k", lw=0.7)
    axis.axhline(LOST, color="k", lw=0.5, ls=":")
    axis.set(xlabel="predicted corner error [px]", ylabel="true error of the worst corner [px]")
    axis.legend(fontsize=7)
    report.figure(figure, "honesty_reliability", "Predicted corner error and true one")
    report.table(["frames", "sequence", "TRACKING", "predicted, median [px]", "true, rms [px]", "rms of true / predicted", "within 1", "within 2", "within 3"],
                 lines)


def write(report, a):
    rows = table_of(jobs(a)[0].result)
    report.text("## Honesty", f"Wrong is an error of {LOST:.0f} px or more at the worst corner.")
    write_states(report, rows)
    write_scores(report, rows)
    write_reliability(report, rows)

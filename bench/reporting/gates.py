"""Each gate of occlusion alone and together: areas found, clean areas lost, what it does to the estimate."""
import numpy as np

from .document import number, percent
from .measuring import Job, column, table_of


def jobs(a):
    folders = [f for f in a.sequences.values() if (f / "areas.csv").exists()]
    return [Job(a.out / "gates.csv", [a.programs / "bench_gates", *folders, "--csv", "RESULT"])] if folders else []


def summary(name, rows):
    """A line of the table, over all of the sequences in `rows`."""
    total = {key: column(rows, key).sum() for key in rows[0] if key not in ("sequence", "gates")}
    kept = column(rows, "kept")
    mean = np.nansum(column(rows, "error_mean") * kept) / max(1, kept.sum())
    return [name, percent(total["covered_rejected"], total["covered"]), percent(total["clean_rejected"], total["clean"]),
            percent(total["darker_rejected"], total["darker"]), percent(total["brighter_rejected"], total["brighter"]),
            f"{kept.sum():.0f} of {total['frames']:.0f}", f"{total['lies']:.0f}", number(mean), number(np.nanmax(column(rows, "claimed_worst")), 2)]


def write(report, a):
    work = jobs(a)
    report.text("## Gates of occlusion", "The tracker as configured by default, but for the gates: `published` is the paper's colour gate, `colour` the "
                "same with each pixel's colour divided by its intensity, `structure` the gate after convergence, `robust` Tukey's weights and no gate, "
                "`default` all of the last three. Recall: share of the areas covered by half or more that are kept out; clean areas rejected: of "
                "those not covered at all; both in the frames that are kept (TRACKING, and wrong by less than 5 px), so a tracker that gives up "
                "early is asked less. Under other light: the first image, still, with its brightness changed at once. Error: of the worst corner, "
                "mean over the frames kept, worst over those said to be tracked.")
    if not work:
        report.text("Not measured: no sequence says which areas are covered (areas.csv).")
        return
    rows = table_of(work[0].result)
    names = list(dict.fromkeys(r["gates"] for r in rows))
    head = ["gates", "recall", "clean rejected", "at gain 0.8", "at gain 1.25", "frames kept", "lies", "error mean [px]", "worst [px]"]
    report.text("### All sequences")
    report.table(head, [summary(g, [r for r in rows if r["gates"] == g]) for g in names])
    for sequence in dict.fromkeys(r["sequence"] for r in rows):
        of = [r for r in rows if r["sequence"] == sequence]
        report.text(f"### {sequence}")
        report.table(head, [summary(r["gates"], [r]) for r in of])

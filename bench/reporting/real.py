"""Real footage: this tracker and its peers over regions of films, each judged without ground truth and without asking the tracker."""
import json

from .document import number
from .measuring import Job

COLUMNS = ("tracker", "TRACKING", "WRONG", "UNSUPPORTED", "longest run in sight", "median (unavoidable) [px]", "rms / corner_error", "median [ms]", "p99 [ms]")


def jobs(a):
    if not a.checker:
        return []
    few = ["--limit", 60] if a.quick else []
    # the judge takes far longer than the trackers; times are of the processor
    return [Job(a.out / "real.json", [a.here / "real.py", a.build, "--data", a.data, "--checker", a.checker, "--regions", a.regions, *few, "--json", "RESULT"],
                timed=True)]


def line(row):
    if "failed" in row:
        return [row["tracker"], row["failed"], *[""] * (len(COLUMNS) - 2)]
    return [row["tracker"], number(row["tracking"]), row["wrong"], row["unsupported"], row["longest_seen_run"],
            f"{number(row['error_median'], 2)} ({number(row['unavoidable_median'], 2)})", number(row.get("rms_to_corner_error"), 2), number(row.get("ms_median"), 2),
            number(row.get("ms_p99"), 1)]


def write(report, a):
    if not a.checker:
        return
    rows = json.loads(jobs(a)[0].result.read_text())
    report.text("## Real footage", "Each image is warped back by what the tracker says, and parts of the region are looked for there. TRACKING: share of images. "
                "WRONG: images that say so though the region's inside lies 5 px or more elsewhere (median). UNSUPPORTED: images that say so where nothing of the "
                "region is found. The longest run of images in which the region is seen as a whole, and is not said to be tracked. Median: how far the "
                "inside is off, and what no homography could avoid, as tissue is curved and deforms. Times are of the processor.")
    for region in dict.fromkeys(r["region"] for r in rows):
        report.text(f"### {region}")
        report.table(COLUMNS, [line(r) for r in rows if r["region"] == region])

"""The search for a lost region: which points find tissue again, and how long it takes until the region is tracked."""
import json

from .document import number
from .measuring import Job


def jobs(a):
    if not a.region:
        return []
    films = [f"{film}:{roi}" for film, roi in a.region]
    few = ["--images", 1] if a.quick else []
    return [Job(a.out / "search.json", [a.programs / "bench_search", *films, *few, "--json", "RESULT"], timed=True),
            *(Job(a.out / f"returns_{absence}.json",
                  [a.programs / "bench_returns", *films, *few, "--absence", absence, "--json", "RESULT"], timed=True) for absence in (0, 5, 60))]


def write(report, a):
    if not a.region:
        return
    methods = json.loads((a.out / "search.json").read_text())["methods"]
    report.text("## Search", "Share of views of a region in which the matches of points lead to within a fifth of the region's side, and ms of one core "
                "for drawing the points of an image and for matching them with the reference. The views are other images of the same film, as they "
                "are and changed. `surroundings`: also points around the region, as far as half its diagonal.")
    changes = list(methods[0]["changes"])
    report.table(["points", "recall", "wrong", "draw [ms]", "match [ms]", "recall per ms", *changes],
                 [[m["name"], number(m["recall"]), number(m["wrong"]), number(m["drawing_ms"], 1), number(m["matching_ms"], 1),
                   number(m["recall"] / (m["drawing_ms"] + m["matching_ms"])), *(number(m["changes"][c], 2) for c in changes)] for m in methods])
    for absence in (0, 5, 60):
        data = json.loads((a.out / f"returns_{absence}.json").read_text())
        report.text(f"Time to return after half a second of black images and {absence} s: the region is tracked again within 25 images, the most "
                    f"that it took, and how often TRACKING was said with a corner off by 5 px. Searching takes {number(data['searching_median'], 1)} "
                    f"ms of one core for an image (median), {number(data['searching_p99'], 1)} (99 %).")
        report.table(["what", "trials", "back", "images, at most", "wrong"],
                     [[name, f"{t['trials']:.0f}", f"{t['back']:.0f}", number(max(t["images"], default=None), 0), f"{t['wrong']:.0f}"]
                      for group in ("change", "film") for name, t in data[group].items()])

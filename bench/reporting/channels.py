"""What ESM tracks of the colours: error and time of one channel, of the strongest mixture, of all three."""
import json

import numpy as np

from .document import number
from .measuring import Job

VARIANTS = ("ours_luma", "ours_strongest", "ours_colour")


def jobs(a):
    options = [option for name in VARIANTS for option in ("--tracker", name)]
    return [Job(a.out / "channels.json", [a.programs / "bench_compare", *a.sequences.values(), *options, "--json", "RESULT"], timed=True)]


def row(sequence, tracker):
    return [sequence["sequence"], tracker["name"].split("_")[1], number(tracker["error_mean"]), number(tracker["error_p95"]),
            f"{tracker['kept']:.0f} of {sequence['frames']:.0f}", f"{tracker['lies']:.0f}", number(tracker["cpu_ms_median"]),
            number(tracker["time_ratio"], 2)]


def total(sequences, k):
    """Over all sequences: errors over the frames kept, the geometric mean of the times."""
    of = [s["trackers"][k] for s in sequences]
    kept = np.array([t["kept"] for t in of])
    error = np.sum([t["error_mean"] * t["kept"] for t in of if t["kept"] > 0]) / max(1, kept.sum())
    mean = lambda key: np.exp(np.mean([np.log(t[key]) for t in of if t[key]]))  # noqa: E731
    return ["all", of[0]["name"].split("_")[1], number(error), "", f"{kept.sum():.0f} of {sum(s['frames'] for s in sequences):.0f}",
            f"{sum(t['lies'] for t in of):.0f}", number(mean("cpu_ms_median")), number(mean("time_ratio"), 2)]


def write(report, a):
    report.text("## Channels", "This tracker with each value of `esm/channels`: luma, the mixture of the colours that varies most across the region "
                "(default), and blue, green and red with a residual each, as Bourger et al. extend ESM. Counted as beside its peers; times are the "
                "processor's, the last column over that of luma; over all sequences their geometric mean.")
    sequences = json.loads(jobs(a)[0].result.read_text())
    report.table(["sequence", "channels", "error mean [px]", "p95 [px]", "kept", "lies", "median [ms]", "time over luma"],
                 [row(s, t) for s in sequences for t in s["trackers"]] + [total(sequences, k) for k in range(len(VARIANTS))])

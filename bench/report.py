#!/usr/bin/python3
"""Runs the programs in bench/ and writes report.md with tables and plots. One command, see README.md:

  bench/report.py BUILD_FOLDER OUT_FOLDER [options]

Results that are in the output folder already are used again, unless --again is given. Without --sequence, sequences with known ground
truth are made (make_sequences.py). Times are worth something only on a machine that does nothing else.
"""
import argparse
import csv
import datetime
import itertools
import json
import pathlib
import subprocess

import cv2
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402: the backend comes first
import numpy as np  # noqa: E402

import make_sequences  # noqa: E402: beside this file

LOST = 5.0  # px
AREAS = 14
CONFIGURATIONS = ("none", "published", "default")
PARTS = ("kernels", "compare", "convergence", "honesty", "occlusion")


class Report:
    def __init__(self, folder):
        self.folder = folder
        self.lines = []

    def text(self, *lines):
        self.lines += [*lines, ""]

    def table(self, head, rows):
        self.lines += ["| " + " | ".join(map(str, row)) + " |" for row in [head, ["---"] * len(head), *rows]] + [""]

    def figure(self, figure, name, caption):
        figure.tight_layout()
        figure.savefig(self.folder / f"{name}.png", dpi=110)
        plt.close(figure)
        self.text(f"![{caption}]({name}.png)", caption)

    def write(self):
        (self.folder / "report.md").write_text("\n".join(self.lines))


def number(x, digits=3):
    return "-" if x is None or not np.isfinite(x) else f"{x:.{digits}f}"


def short(x):
    return "-" if not np.isfinite(x) else f"{x:.3g}"


def run(again, result, command):
    """Runs `command`, which writes `result`, unless that is there. What a program printed is shown as it comes."""
    if again or not result.exists():
        print("$", *[str(c).replace("RESULT", str(result)) for c in command], flush=True)
        part = result.with_suffix(".part")
        subprocess.run([str(part) if c == "RESULT" else str(c).replace("RESULT", str(part)) for c in command], check=True)
        part.rename(result)
    return result


def table_of(file):
    rows = list(csv.DictReader(open(file, encoding="utf-8")))
    if not rows:
        raise SystemExit(f"{file}: empty")
    return rows


def column(rows, name):
    return np.array([float(r[name]) for r in rows])


# ------------------------------------------------------------------------------------------------------------ kernels

def kernels(report, file):
    runs = {b["name"]: b for b in json.loads(file.read_text())["benchmarks"]}
    bandwidth = {int(n.split("/")[2]): b["bytes_per_second"] for n, b in runs.items() if n.startswith("machine/triad")}
    copy = {int(n.split("/")[2]): b["bytes_per_second"] for n, b in runs.items() if n.startswith("machine/copy")}
    peak = max(b["flops_per_second"] for n, b in runs.items() if n.startswith("machine/multiply_add"))
    report.text("## Kernels", "Processor time per pixel of the ROI, on one thread (for the pyramid: of the region it is built of), next to "
                "what the machine allows: the longer of moving the bytes at the speed of a triad on as much memory, and of doing the "
                "arithmetic in nothing but multiply-adds. Bytes and operations are counted from the source, once per patch that is read "
                "or written; divisions, roots and gathers count as one operation, so the limit is not to be reached.")
    report.table(["machine", "value"], [["multiply-add, float", f"{peak / 1e9:.0f} Gflop/s"]] + [
        [f"copy / triad on {kb} kB", f"{copy[kb] / 1e9:.0f} / {bandwidth[kb] / 1e9:.0f} GB/s"] for kb in sorted(bandwidth)])
    rows = []
    for name, b in runs.items():
        if name.startswith("peer/remap_image/"):
            rows.append(["cv::remap, whole image", "x".join(name.split("/")[2:4]), number(b["ns_per_px"], 2), "", "", "",
                         number(b["cpu_time"] / 1e3, 2) + " ms"])
        if not name.startswith("kernel/"):
            continue
        _, kernel, side = name.split("/")
        row = [kernel, f"{side}²", number(b["ns_per_px"], 2)]
        if "bytes_per_px" in b:
            working_set = int(side) ** 2 * b["bytes_per_px"] / 1024
            rate = bandwidth[min((kb for kb in bandwidth if kb >= working_set), default=max(bandwidth))]
            by_memory, by_arithmetic = 1e9 * b["bytes_per_px"] / rate, 1e9 * b["flops_per_px"] / peak
            row += [number(by_memory, 2), number(by_arithmetic, 2), f"{100 * max(by_memory, by_arithmetic) / b['ns_per_px']:.0f} %"]
        else:
            row += ["", "", ""]
        rows.append(row + [number(b["cpu_time"] / 1e3, 2) + " ms" if kernel.startswith("track") else ""])
    report.table(["kernel", "ROI", "ns/px", "memory's limit", "arithmetic's limit", "of the limit", "per image"], rows)


# ------------------------------------------------------------------------------------------------------------ compare

def compare(report, file):
    report.text("## Beside its peers", "All trackers get each image in turn, on one thread, in one run. Error: the worst corner, mean "
                f"over the frames kept. Kept: said to be tracked, and wrong by less than {LOST:.0f} px. Lies: said to be tracked, and wrong by "
                "more. Peers that have no test of their own claim every frame unless they give up. Median, p99: wall time per image while it goes on; "
                "the ratio is of processor times.")
    for sequence in json.loads(file.read_text()):
        report.text(f"### {sequence['sequence']}, {sequence['frames']:.0f} frames")
        report.table(["tracker", "error mean [px]", "p95 [px]", "kept", "lies", "given up", "median [ms]", "p99 [ms]", "p99 / median",
                      "time over ours"],
                     [[t["name"], number(t["error_mean"]), number(t["error_p95"]), f"{t['kept']:.0f}", f"{t['lies']:.0f}",
                       f"{t['silent']:.0f}", number(t["ms_median"]), number(t["ms_p99"]), number(t["ms_p99"] / t["ms_median"], 1),
                       number(t["time_ratio"], 2)] for t in sequence["trackers"]])
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
        names = [t["name"] for t in sequence["trackers"]]
        right.barh(names, [t["cpu_ms_median"] for t in sequence["trackers"]])
        right.invert_yaxis()
        right.set(xscale="log", xlabel="ms per image, median", title="processor time")
        report.figure(figure, f"compare_{sequence['sequence']}", f"{sequence['sequence']}: error and time")


# -------------------------------------------------------------------------------------------------------- convergence

def convergence(report, files):
    report.text("## Convergence", "Share of trials that end with every corner within 1 px. Each trial is a new view of the scene, its ROI's "
                "corners displaced by normal noise (of that standard deviation in each coordinate), or the whole of it by a shift in a random "
                "direction, with two grey levels of noise in both images; everybody starts from the identity. `esm_...` is ESM alone as "
                "configured by default, but for the number of levels; `plain_esm_...` has neither light nor weights, as in the papers; "
                "`ours` is the whole tracker, and has to say TRACKING as well.")
    for file in files:
        data = json.loads(file.read_text())
        figure, axes = plt.subplots(1, 2, figsize=(11, 3.6))
        for axis, curve in zip(axes, data["curves"]):
            for who, share in curve["share"].items():
                axis.plot(curve["distance"], share, marker=".", label=who)
            axis.set(xlabel="noise of the corners [px]" if curve["kind"] == "corners" else "shift [px]", ylabel="share that converges",
                     ylim=(-0.03, 1.03), title=f"{data['scene']}, {data['side']:.0f} px, {data['trials']:.0f} trials")
            axis.grid(alpha=0.3)
            report.table([curve["kind"] + " [px]"] + [f"{d:g}" for d in curve["distance"]],
                         [[who] + [number(s, 2) for s in share] for who, share in curve["share"].items()])
        axes[0].legend(fontsize=7)
        report.figure(figure, file.stem, f"Convergence on {data['scene']}")


# ------------------------------------------------------------------------------------------------------------ honesty

SCORES = {  # what the tracker knows of an estimate; the sign makes greater better
    "zncc": (1, "zncc"), "corner_error": (-1, "corner_error"), "visible_fraction": (1, "visible_fraction"), "sigma": (-1, "sigma"),
    "last_step": (-1, "last_step"), "iterations": (-1, "iterations")}


def limit(name, threshold):
    sign = SCORES[name][0]
    return f"{name} {'≥' if sign > 0 else '≤'} {sign * threshold:.4g}"


def roc(score, right):
    """Share of wrong estimates accepted, share of right ones accepted, for every threshold from strict to lax."""
    order = np.argsort(-score, kind="stable")
    right = right[order]
    return np.cumsum(~right) / max(1, (~right).sum()), np.cumsum(right) / max(1, right.sum())


def two_thresholds(one, other, right):
    """a and b so that `one` >= a and `other` >= b let no wrong estimate pass and reject fewest right ones: (share kept, a, b)."""
    best = (0.0, np.inf, np.inf)
    for b in np.unique(np.quantile(other[right], np.linspace(0, 0.98, 200))):
        inside = other >= b
        wrong = one[inside & ~right]
        a = max(one[inside & right].min(), np.nextafter(wrong.max(), np.inf) if wrong.size else -np.inf)
        best = max(best, ((inside & right & (one >= a)).sum() / right.sum(), a, b))
    return best


def honesty(report, file):
    rows = table_of(file)
    report.text("## Honesty", f"Wrong is an error of {LOST:.0f} px or more at the worst corner. What can be known of an estimate without the truth, "
                "for right and wrong ones: of the tracker image by image (`sequence`), of the tracker thrown onto a later, displaced image, "
                "its limits as lax as can be set (`jump`), and of ESM with the gates from displaced starts (`esm`). The curves are the data to choose "
                "the thresholds of the state on.")
    state = [r for r in rows if r["source"] == "sequence"]
    if state:
        error, tracking = column(state, "error"), column(state, "state") == 1
        names = sorted({r["sequence"] for r in state})
        of = np.array([r["sequence"] for r in state])
        report.table(["sequence", "frames", "TRACKING and right", "TRACKING and wrong (lies)", "not TRACKING"],
                     [[n, (of == n).sum(), (tracking & (error < LOST))[of == n].sum(), (tracking & (error >= LOST))[of == n].sum(),
                       (~tracking)[of == n].sum()] for n in names])
    for source in ("jump", "esm"):
        trials = [r for r in rows if r["source"] == source]
        everything = len(trials)
        # What the tracker refuses without asking for a score is not the scores' matter.
        trials = [r for r in trials if (int(r["state"]) == 1 if source == "jump" else int(r["status"]) in (0, 1))]
        if not trials:
            continue
        right = column(trials, "error") < LOST
        zncc, corner = column(trials, "zncc"), np.clip(np.nan_to_num(column(trials, "corner_error"), nan=1e3, posinf=1e3), 1e-3, 1e3)
        figure, axes = plt.subplots(1, 4, figsize=(17, 4))
        for axis, values, bins, label in ((axes[0], zncc, np.linspace(0, 1, 51), "zncc"),
                                          (axes[1], corner, np.logspace(-3, 3, 61), "corner error that the residuals predict [px]")):
            axis.hist([values[right], values[~right]], bins=bins, label=["right", "wrong"], color=["tab:blue", "tab:red"])
            axis.set(xlabel=label, yscale="log", ylabel="estimates")
        axes[1].set_xscale("log")
        axes[0].legend()
        axes[2].loglog(corner[right], 1 - zncc[right] + 1e-4, ".", ms=2, color="tab:blue")
        axes[2].loglog(corner[~right], 1 - zncc[~right] + 1e-4, ".", ms=3, color="tab:red")
        axes[2].set(xlabel="predicted corner error [px]", ylabel="1 - zncc")
        lines, scores = [], {}
        for name, (sign, key) in SCORES.items():
            values = np.nan_to_num(column(trials, key), nan=np.nan, posinf=1e9)
            if np.isnan(values).all():
                continue
            score = scores[name] = sign * np.nan_to_num(values, nan=sign * -1e9)
            if not right.any() or right.all():
                continue  # no curve without both
            wrong_in, right_in = roc(score, right)
            axes[3].plot(wrong_in, right_in, label=name)
            at_none = right_in[wrong_in == 0].max() if (wrong_in == 0).any() else 0.0
            at_percent = right_in[wrong_in <= 0.01].max() if (wrong_in <= 0.01).any() else 0.0
            lines.append([name, number(np.trapz(right_in, wrong_in)), number(at_none), number(at_percent)])
        axes[3].set(xlabel="wrong ones accepted", ylabel="right ones accepted", xscale="symlog")
        axes[3].set_xscale("symlog", linthresh=0.01)
        axes[3].legend(fontsize=7)
        report.text(f"### {source}: {len(trials)} estimates of {everything} trials, {(~right).sum()} of them wrong")
        report.table(["score alone", "area under the curve", "right accepted with no wrong", "with 1 % of the wrong"], lines)
        pairs = []
        for one, other in itertools.combinations([n for n in ("zncc", "corner_error", "sigma", "visible_fraction") if n in scores], 2):
            if right.any() and not right.all():
                kept, a, b = two_thresholds(scores[one], scores[other], right)
                pairs.append([limit(one, a), limit(other, b), number(kept)])
        report.table(["two together", "", "right accepted with no wrong (chosen on these very data)"], pairs)
        report.figure(figure, f"honesty_{source}", f"Evidence of right and wrong estimates: {source}")


# ---------------------------------------------------------------------------------------------------------- occlusion

def frames_of(path):
    path = pathlib.Path(path)
    if path.is_dir():
        folder = path / "frames" if (path / "frames").is_dir() else path
        return [cv2.imread(str(f)) for f in sorted(folder.iterdir()) if f.suffix.lower() in (".png", ".jpg", ".jpeg", ".bmp", ".ppm")]
    video, images = cv2.VideoCapture(str(path)), []
    while True:
        ok, image = video.read()
        if not ok:
            return images
        images.append(image)


def homographies(rows):
    return np.array([[float(r[f"g{i}{j}"]) for i in range(3) for j in range(3)] for r in rows]).reshape(-1, 3, 3)


def corner_errors(G, truth, roi):
    """Distance of the worst of the ROI's corners from where it should be, px; infinite where it goes through infinity."""
    x, y, w, h = roi
    corners = np.array([[x, x + w - 1, x + w - 1, x], [y, y, y + h - 1, y + h - 1], [1, 1, 1, 1.0]])
    p, q = G @ corners, truth @ corners
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = np.hypot(p[:, 0] / p[:, 2] - q[:, 0] / q[:, 2], p[:, 1] / p[:, 2] - q[:, 1] / q[:, 2]).max(1)
    return np.where((p[:, 2] > 0).all(1), distance, np.inf)


def quadrilateral(G, x0, y0, x1, y1):
    p = G @ np.array([[x0, x1, x1, x0], [y0, y0, y1, y1], [1, 1, 1, 1.0]])
    return None if not (p[2] > 1e-9).all() else np.clip((p[:2] / p[2]).T, -1e4, 1e4).round().astype(np.int32)


def draw(image, G, roi, occluded, areas):
    image = image.copy()
    x, y, w, h = roi
    if areas:
        filled = image.copy()
        for k in np.flatnonzero(occluded):
            r, c = divmod(k, AREAS)
            q = quadrilateral(G, x + c * w / AREAS, y + r * h / AREAS, x + (c + 1) * w / AREAS - 1, y + (r + 1) * h / AREAS - 1)
            if q is not None:
                cv2.fillPoly(filled, [q], (255, 0, 0))
        image = cv2.addWeighted(filled, 0.6, image, 0.4, 0)
    cv2.rectangle(image, (int(x), int(y)), (int(x + w - 1), int(y + h - 1)), (255, 0, 0), 2)
    q = quadrilateral(G, x, y, x + w - 1, y + h - 1)
    if q is not None:
        cv2.polylines(image, [q], True, (0, 0, 255), 2)
    return image


def e_occl(G, truth, K):
    """Equation (13), Frobenius, of normalised coordinates."""
    Ki = np.linalg.inv(K)
    return np.array([np.linalg.norm(Ki @ g @ np.linalg.inv(t) @ K - np.eye(3)) for g, t in zip(G, truth)])


def occlusion(report, name, path, tables, roi, truth, K, covered, chosen):
    report.text(f"### {name}")
    data = {c: table_of(f) for c, f in tables.items()}
    G = {c: homographies(rows) for c, rows in data.items()}
    flags = {c: np.array([[int(r[f"o{k}"]) for k in range(AREAS * AREAS)] for r in rows]) for c, rows in data.items()}
    count = {c: f.sum(1) for c, f in flags.items()}
    tracking = {c: column(rows, "state") == 1 for c, rows in data.items()}
    error, corner = None, {}
    if truth is not None:
        error = {c: e_occl(G[c], truth, K) for c in data}
        corner = {c: corner_errors(G[c], truth, roi) for c in data}
        # The other two have no states of their own: they are followed wherever they go.
        error["default"][~tracking["default"]] = np.nan
    peak = int(np.argmax(covered)) if covered is not None and covered.max() > 0 else int(np.argmax(count["default"]))
    rows = []
    for c in CONFIGURATIONS:
        row = [c, f"{count[c][peak]} of {AREAS * AREAS}", number(float(data[c][peak]["visible_fraction"]), 2), tracking[c].sum()]
        if error:
            sure = corner[c][tracking[c]]
            row += [(sure >= LOST).sum() if c == "default" else "", number(sure.max(), 2), short(error[c][peak]), short(np.nanmax(error[c]))]
        rows.append(row + [""] * (8 - len(row)))
    if covered is not None and covered.max() > 0:
        rows.insert(0, ["truth", f"{round(covered[peak] * AREAS * AREAS)} of {AREAS * AREAS}", number(1 - covered[peak], 2), "", "", "", "0", "0"])
    report.table(["detection", f"areas occluded at the peak (frame {peak})", "of the ROI used", "images TRACKING", "lies", "worst corner [px]", "e_occl there",
                  "e_occl at most"], rows)
    figure, axes = plt.subplots(1, 2 if error else 1, figsize=(11, 3.2), squeeze=False)
    colours = {"none": "tab:blue", "published": "tab:red", "default": "tab:green"}
    if error:
        for c in CONFIGURATIONS:
            axes[0][0].semilogy(np.maximum(error[c], 1e-6), color=colours[c], label=c)
        axes[0][0].set(xlabel="frame", ylabel="e_occl (13), normalised", title="error")
        axes[0][0].legend()
    for c in CONFIGURATIONS[1:]:
        axes[0][-1].plot(count[c], color=colours[c], label=c)
    if covered is not None and covered.max() > 0:
        axes[0][-1].plot(covered * AREAS * AREAS, "k:", label="truth (ROI covered, in areas)")
    axes[0][-1].set(xlabel="frame", ylabel="areas taken for occluded", title="areas")
    axes[0][-1].legend()
    report.figure(figure, f"occlusion_{name}_curves", f"{name}: e_occl (13) over time with and without detection (the paper's figure 4), "
                  "and the areas taken for occluded" if error else f"{name}: areas taken for occluded")
    images = frames_of(path)
    x, y, w, h = roi
    top, bottom = max(0, int(y - 0.45 * h)), min(images[0].shape[0], int(y + 1.45 * h))
    left, right = max(0, int(x - 0.45 * w)), min(images[0].shape[1], int(x + 1.45 * w))
    rows = (("none", False), ("published", False), ("published", True), ("default", True))
    chosen = [n for n in chosen or np.unique(np.clip(peak + np.array([-12, -6, 0, 6, 12]), 0, len(images) - 1)) if n < len(images)]
    figure, axes = plt.subplots(len(rows), len(chosen), figsize=(2.3 * len(chosen), 2.3 * len(rows)), squeeze=False)
    for line, (c, areas) in zip(axes, rows):
        for axis, n in zip(line, chosen):
            shown = draw(images[n], G[c][n], roi, flags[c][n], areas)[top:bottom, left:right]
            axis.imshow(cv2.cvtColor(shown, cv2.COLOR_BGR2RGB))
            axis.set(xticks=[], yticks=[])
            axis.set_title(f"{c}, frame {n}", fontsize=7)
    report.figure(figure, f"occlusion_{name}_images", f"{name}: blue the ROI in the reference, red where the tracker takes it to be, filled "
                  "squares the areas taken for occluded (the paper's figures 3 and 5)")


def occlusions(report, a, programs, sequences, videos):
    report.text("## Occlusion, as in the paper", "`none`: ESM on grey levels without any detection; `published`: with the detection of Bourger et "
                "al. (2007), 14 x 14 areas; `default`: this package's. The first two have no test of their estimate and follow it wherever it "
                "goes. In the paper 155 of 196 areas are occluded at the peak, and e_occl is a third with detection.")
    jobs = [(n, p, None, False) for n, p in sequences.items()] + [(pathlib.Path(f).stem, f, r, s) for f, r, s in videos]
    for name, path, roi_text, still in jobs:
        covered = truth = None
        K = np.eye(3)
        if roi_text is None:
            rows = table_of(pathlib.Path(path) / "truth.csv")
            covered, truth = column(rows, "occluded"), homographies(rows)
            if not covered.max() > 0:
                continue
            scene = json.loads((pathlib.Path(path) / "scene.json").read_text())
            roi, K = scene["roi"], np.array(scene["K"])
        else:
            roi = [float(v) for v in roi_text.split(",")]
        tables = {}
        for c in CONFIGURATIONS:
            tables[c] = run(a.again, a.out / f"occlusion_{name}_{c}.csv",
                            [programs / "bench_occlusion", path, "--config", c, "--csv", "RESULT"] + (["--roi", roi_text] if roi_text else []))
        if still:
            first = frames_of(path)[0].shape
            K = np.array([[first[1], 0, first[1] / 2], [0, first[1], first[0] / 2], [0, 0, 1.0]])  # not known; the scale of the error only
            truth = np.array([np.eye(3)] * len(table_of(tables["none"])))
        paper = name == "still_sheet" and not a.sequence
        occlusion(report, name, path, tables, roi, truth, K, covered, [10, 15, 20, 25, 30] if paper else None)


# --------------------------------------------------------------------------------------------------------------- main

def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("build", type=pathlib.Path, help="build folder, configured with -DLAPAROSCOPE_SERVO_BENCH=ON")
    p.add_argument("out", type=pathlib.Path)
    p.add_argument("--sequence", action="append", type=pathlib.Path, default=[], help="folder with ground truth; may be repeated")
    p.add_argument("--photograph", type=pathlib.Path, help="scene of the sequences that are made")
    p.add_argument("--video", nargs=2, action="append", default=[], metavar=("FILE", "X,Y,W,H"), help="for the figures; may be repeated")
    p.add_argument("--still-video", nargs=2, action="append", default=[], metavar=("FILE", "X,Y,W,H"),
                   help="likewise, of a still camera and target: the truth is the identity")
    p.add_argument("--only", action="append", choices=PARTS, help="this part only; may be repeated")
    p.add_argument("--again", action="store_true", help="run all programs again, whatever results there are")
    p.add_argument("--all-scenes", action="store_true", help="convergence on every sequence's first image, not only the first one's")
    p.add_argument("--quick", action="store_true", help="few trials: to see that it works")
    a = p.parse_args()
    programs = a.build / "bench"
    if not (programs / "bench_compare").exists():
        p.error(f"{programs}: no bench_compare; build the target `bench` first")
    a.out.mkdir(parents=True, exist_ok=True)
    only = a.only or PARTS
    sequences = {s.name.rsplit("-", 1)[0]: s for s in a.sequence} or make_sequences.make(a.out / "sequences", a.photograph)
    folders = list(sequences.values())

    report = Report(a.out)
    model = [line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8") if line.startswith("model name")]
    report.text("# Measurements of laparoscope_servo", f"{datetime.date.today()}, {model[0] if model else 'unknown processor'}, one thread. Written by "
                "bench/report.py.")
    if "kernels" in only and (programs / "bench_kernels").exists():
        kernels(report, run(a.again, a.out / "kernels.json",
                            [programs / "bench_kernels", "--benchmark_out=RESULT", "--benchmark_out_format=json",
                             f"--benchmark_min_time={0.05 if a.quick else 0.5}"]))
    if "compare" in only:
        compare(report, run(a.again, a.out / "compare.json", [programs / "bench_compare", *folders, "--json", "RESULT"]))
    if "convergence" in only:
        options = ["--trials", 10, "--corners", "2:20:6", "--shifts", "10:40:10"] if a.quick else []
        scenes = sequences if a.all_scenes else dict(list(sequences.items())[:1])
        convergence(report, [run(a.again, a.out / f"convergence_{n}.json", [programs / "bench_convergence", s, "--json", "RESULT", *options])
                             for n, s in scenes.items()])
    if "honesty" in only:
        options = ["--every", 20, "--trials", 2] if a.quick else []
        honesty(report, run(a.again, a.out / "honesty.csv", [programs / "bench_honesty", *folders, "--csv", "RESULT", *options]))
    if "occlusion" in only:
        videos = [(*v, False) for v in a.video] + [(*v, True) for v in a.still_video]
        occlusions(report, a, programs, sequences, videos)
    report.write()
    print(a.out / "report.md")


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Real footage, whose truth is not known: this tracker and its peers over each region, and what a judge says of each.

  bench/real.py BUILD_FOLDER --data FOLDER --checker PROGRAM [options]
  bench/real.py BUILD_FOLDER --data FOLDER --checker PROGRAM --random 60 --seed 1 --limit 120 --tracker ours --keep FOLDER

The regions are those of regions.csv (film, roi, image from which it lies there) whose films lie in the folder of --data. bench_film tracks each,
all trackers image by image in turn. Then PROGRAM FILM CSV --roi x,y,w,h judges each tracker's table without asking the tracker, and prints
its verdict as a line of JSON, of which the columns are taken. With --track-bag, the program that users run is a tracker of the table, too. With
--random the regions are drawn instead, from all films of the folder and over all of their length: as many as are said, without those that the first
tracker of the table refuses; `drawn.csv` in the folder of --keep is their table, for --regions of another build. After them stands a row per film. A
row per region and tracker:
  TRACKING     share of the images
  WRONG        images that say so though the region's inside lies 5 px or more elsewhere
  UNSUPPORTED  images that say so where nothing of the region is found
  run          images one after another, at most, in which the region is seen and TRACKING is not said
  median       px, how far the inside lies from where it is said to be; in brackets what no homography could avoid
  rms / claim  how far it lies off, over `corner_error`; of trackers that claim an error
  ms, p99      per image until it gives up for good: of processor time; of track_bag: of wall time
"""
import argparse
import concurrent.futures
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np

import footage  # beside this file

JUDGED = ("tracking", "wrong", "unsupported", "unclear", "seen_not_tracking", "longest_seen_run", "error_median", "error_p95", "unavoidable_median",
          "rms_to_corner_error")
MOST_REFUSED = 50  # regions for each that is taken, and then the films are given up


def track_bag(program, region, table, limit):
    """A table as long as those of bench_film."""
    start = ["--start", (region.first - 0.25) / footage.rate_of(region.film)] if region.first else []
    whole = table.with_suffix(".whole")
    footage.track(program, region.film, region.roi, whole, start)
    with open(whole, encoding="utf-8") as lines, open(table, "w", encoding="utf-8") as out:
        out.writelines(line for k, line in enumerate(lines) if not limit or k <= limit)
    whole.unlink()


def track(a, region, folder):
    """Writes a table for each tracker."""
    command = [a.build / "bench" / "bench_film", region.film, "--roi", region.roi_text, "--from", region.first, "--limit", a.limit, "--rate",
               footage.rate_of(region.film), "--tables", folder]
    for name in a.tracker:
        command += ["--tracker", name]
    subprocess.run([str(c) for c in command], check=True, env={**os.environ, "OMP_NUM_THREADS": "1"})  # ViSP's: all on one thread
    if a.track_bag:
        track_bag(a.track_bag, region, folder / "track_bag.csv", a.limit)


def times(table):
    with open(table, encoding="utf-8") as lines:
        ms = 1e3 * np.array([float(r["processing_time"]) for r in csv.DictReader(lines)][1:])
    ms = ms[np.isfinite(ms)]  # who has stopped for good takes no time
    return {"ms_median": float(np.median(ms)), "ms_p99": float(np.quantile(ms, 0.99))} if len(ms) else {}


def judge(checker, region, table):
    """The verdict, or what the checker has to say instead."""
    more = ["--frames", table.with_suffix(".frames"), "--picture", table.with_suffix(".png")]
    run = subprocess.run([str(c) for c in [checker, region.film, table, "--roi", region.roi_text, *more]], capture_output=True, text=True, check=False)
    if run.returncode:
        return {"failed": run.stderr.strip()[-300:]}
    verdict = json.loads(run.stdout.splitlines()[-1])
    return {k: verdict[k] for k in JUDGED if k in verdict}


def shown(region, first):
    return f"{region} from {first}" if first else region


def show(row):
    text = lambda key, digits: "-" if row.get(key) is None else f"{row[key]:.{digits}f}"  # noqa: E731
    name = shown(row["region"], row["from"])
    if "failed" in row:
        print(f"{name:46s} {row['tracker']:13s} {row['failed']}", flush=True)
        return
    print(f"{name:46s} {row['tracker']:13s} {text('tracking', 3):>8s} {row['wrong']:5d} {row['unsupported']:11d} {row['longest_seen_run']:4d}"
          f" {text('error_median', 2):>6s} ({text('unavoidable_median', 2):>4s}) {text('rms_to_corner_error', 2):>11s} {text('ms_median', 2):>6s}"
          f" {text('ms_p99', 1):>6s}", flush=True)


def images_in(table):
    with open(table, encoding="utf-8") as lines:
        return sum(1 for _ in csv.DictReader(lines))


def claims_at_all(table):
    """Whether the tracker took the region."""
    with open(table, encoding="utf-8") as lines:
        return next(csv.DictReader(lines))["state"] == str(footage.TRACKING)


def tables_of(a, region, folder):
    """Tracks the region. Tables of all trackers, ours first."""
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.csv"):
        old.unlink()
    try:
        track(a, region, folder)
    except (footage.Refused, subprocess.CalledProcessError) as error:
        sys.exit(f"real: {region.name}: {error}")
    return sorted(folder.glob("*.csv"), key=lambda t: (not t.stem.startswith(("ours", "track_bag")), t.stem))


def tracked(a, temporary):
    """(region, tables) of each region, of those that are drawn as far as they are taken."""
    folder_of = lambda region: pathlib.Path(a.keep or temporary, shown(region.name, region.first).replace(" ", "_"))  # noqa: E731
    if not a.random:
        for region in footage.read_regions(a.regions, a.data, a.only):
            yield region, tables_of(a, region, folder_of(region))
        return
    taken, refused = [], 0
    for region in footage.random_regions(a.data, a.seed, a.limit):
        tables = tables_of(a, region, folder_of(region))
        if claims_at_all(tables[0]):
            taken.append(region)
            yield region, tables
        else:
            refused += 1
            shutil.rmtree(folder_of(region))
        if len(taken) == a.random:
            break
        if refused > MOST_REFUSED * (len(taken) + 1):
            sys.exit(f"real: {refused} regions were refused, {len(taken)} taken: these films have none")
    print(f"{refused} regions were refused")
    if a.keep:
        footage.write_regions(a.keep / "drawn.csv", taken)


def totals(rows):
    """A row per film and tracker, and one of all films."""
    print()
    for tracker in sorted({r["tracker"] for r in rows}):
        own = [r for r in rows if r["tracker"] == tracker and "failed" not in r]
        for film in [*sorted({r["film"] for r in own}), "all films"]:
            of_film = [r for r in own if film in (r["film"], "all films")]
            count = sum(r["images"] for r in of_film)
            total = {k: sum(r[k] for r in of_film) for k in ("wrong", "unsupported", "unclear")}
            claimed = sum(round(r["tracking"] * r["images"]) for r in of_film)
            print(f"{film:46s} {tracker:13s} {claimed / max(1, count):8.3f} {total['wrong']:5d} {total['unsupported']:11d}   of {claimed} TRACKING images"
                  f" of {len(of_film)} regions, {total['unclear']} unclear", flush=True)


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("build", type=pathlib.Path, help="build folder, configured with -DLAPAROSCOPE_SERVO_BENCH=ON")
    p.add_argument("--data", type=pathlib.Path, required=True, help="folder of the films")
    p.add_argument("--checker", type=pathlib.Path, required=True, help="program that judges a table")
    p.add_argument("--regions", type=pathlib.Path, default=footage.REGIONS, help="table film,roi,from")
    p.add_argument("--only", action="append", default=[], help="regions whose name contains this; may be repeated")
    p.add_argument("--random", type=int, default=0, help="draw so many regions, instead of those of a table")
    p.add_argument("--seed", type=int, default=1, help="of --random: another one draws others")
    p.add_argument("--tracker", action="append", default=[], help="this one only, as bench_compare names it; may be repeated")
    p.add_argument("--track-bag", type=pathlib.Path, help="the program: one more tracker")
    p.add_argument("--limit", type=int, default=0, help="so many images of each film, 0: all")
    p.add_argument("--keep", type=pathlib.Path, help="folder for tables, the judge's words on each image, and its pictures")
    p.add_argument("--jobs", type=int, default=1, help="tables judged at once; tracking is never beside anything")
    p.add_argument("--json", type=pathlib.Path, help="write everything there")
    a = p.parse_args()
    rows = []
    print(f"{'region':46s} {'tracker':13s} {'TRACKING':>8s} {'WRONG':>5s} {'UNSUPPORTED':>11s} {'run':>4s} {'median':>6s} {'(least)':>6s} {'rms / claim':>11s}"
          f" {'ms':>6s} {'p99':>6s}", flush=True)
    with tempfile.TemporaryDirectory() as temporary, concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        for region, tables in tracked(a, temporary):
            for table, verdict in zip(tables, pool.map(lambda t, r=region: judge(a.checker, r, t), tables)):
                more = {"film": region.film.stem, "from": region.first, "images": images_in(table)}
                rows.append({"region": region.name, "tracker": table.stem, **more, **verdict, **times(table)})
                show(rows[-1])
    if a.random:
        totals(rows)
    if a.json:
        a.json.write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()

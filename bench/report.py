#!/usr/bin/python3
"""Runs the programs in bench/ and writes report.md with tables and plots. One command, see README.md:

  bench/report.py BUILD_FOLDER OUT_FOLDER [options]

Results that are in the output folder already are used again, unless --again is given. Without --sequence, sequences with known ground
truth are made (make_sequences.py). Times are worth something only on a machine that does nothing else.
"""
import argparse
import datetime
import os
import pathlib

import footage  # beside this file, as are these two:
import make_sequences
from reporting import calibration, channels, compare, convergence, gates, honesty, kernels, measuring, occlusion, real, search
from reporting.document import Report

PARTS = {"kernels": kernels, "compare": compare, "channels": channels, "convergence": convergence, "honesty": honesty, "gates": gates, "occlusion": occlusion,
         "search": search, "real": real, "calibration": calibration}


def arguments():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("build", type=pathlib.Path, help="build folder, configured with -DLAPAROSCOPE_SERVO_BENCH=ON")
    p.add_argument("out", type=pathlib.Path)
    p.add_argument("--sequence", action="append", type=pathlib.Path, default=[], help="folder with ground truth; may be repeated")
    p.add_argument("--photograph", type=pathlib.Path, help="scene of the sequences that are made")
    p.add_argument("--video", nargs=2, action="append", default=[], metavar=("FILE", "X,Y,W,H"), help="for the figures; may be repeated")
    p.add_argument("--still-video", nargs=2, action="append", default=[], metavar=("FILE", "X,Y,W,H"),
                   help="likewise, of a still camera and target: the truth is the identity")
    p.add_argument("--scene", nargs=2, action="append", default=[], metavar=("IMAGE or VIDEO@FRAME", "X,Y,W,H"),
                   help="for convergence, instead of the first sequence's first image; may be repeated")
    p.add_argument("--region", nargs=2, action="append", default=[], metavar=("VIDEO or VIDEO@FRAME", "X,Y,W,H"),
                   help="for the search: a region of a film from that image on; may be repeated, without one this part is left out")
    p.add_argument("--data", type=pathlib.Path, help="folder of films, for real footage and calibration; without one they are left out")
    p.add_argument("--regions", type=pathlib.Path, default=footage.REGIONS, help="table film,roi,from of regions in these")
    p.add_argument("--checker", type=pathlib.Path, help="program that judges a tracker's table of a film, as real.py says: for real footage")
    p.add_argument("--track-bag", type=pathlib.Path, help="the program: for calibration, also on sequences alone")
    p.add_argument("--trials", type=int, default=200, help="of convergence, at each distance")
    p.add_argument("--corners", default="1:20", help="px, FIRST:LAST[:STEP], of convergence: noise of the corners")
    p.add_argument("--shifts", default="5:40:5", help="px, FIRST:LAST[:STEP], likewise: translation")
    p.add_argument("--only", action="append", choices=PARTS, help="this part only; may be repeated")
    p.add_argument("--again", action="store_true", help="run all programs again, whatever results there are")
    p.add_argument("--jobs", type=int, default=os.cpu_count(), help="programs at once, of those that do not measure times")
    p.add_argument("--quick", action="store_true", help="few trials: to see that it works")
    a = p.parse_args()
    a.here = pathlib.Path(__file__).resolve().parent
    a.programs = a.build / "bench"
    if not (a.programs / "bench_compare").exists():
        p.error(f"{a.programs}: no bench_compare; build the target `bench` first")
    if a.checker and not a.data:
        p.error("--checker judges films: --data says where they are")
    return a


def main():
    a = arguments()
    a.out.mkdir(parents=True, exist_ok=True)
    a.sequences = {s.name.rsplit("-", 1)[0]: s for s in a.sequence} or make_sequences.make(a.out / "sequences", a.photograph)
    parts = [part for name, part in PARTS.items() if name in (a.only or PARTS)]
    measuring.run_all([job for part in parts for job in part.jobs(a)], a.again, max(1, a.jobs))

    report = Report(a.out)
    model = [line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8") if line.startswith("model name")]
    report.text("# Measurements of laparoscope_servo", f"{datetime.date.today()}, {model[0] if model else 'unknown processor'}, one thread. Written by "
                "bench/report.py.")
    for part in parts:
        part.write(report, a)
    report.write()
    print(a.out / "report.md")


if __name__ == "__main__":
    main()

"""Runs the programs in bench/ and reads what they wrote."""
import concurrent.futures
import csv
import dataclasses
import os
import pathlib
import subprocess

import numpy as np


@dataclasses.dataclass
class Job:
    """A command that writes the file `result`, whose name stands in it as RESULT."""
    result: pathlib.Path
    command: list
    timed: bool = False  # measures times: nothing else may run meanwhile


def run(job, again):
    """Unless the result is there. What the program prints is shown as it comes."""
    if job.result.exists() and not again:
        return
    part = job.result.with_suffix(".part")
    print("$", *[str(c).replace("RESULT", str(job.result)) for c in job.command], flush=True)
    alone = {**os.environ, "OMP_NUM_THREADS": "1"}  # ViSP's: all are measured on one thread
    subprocess.run([str(part) if c == "RESULT" else str(c).replace("RESULT", str(part)) for c in job.command], check=True, env=alone)
    part.rename(job.result)


def run_all(jobs, again, side_by_side):
    """Those that measure times first, one by one; then the others, `side_by_side` at once."""
    for job in jobs:
        if job.timed:
            run(job, again)
    with concurrent.futures.ThreadPoolExecutor(side_by_side) as pool:
        for done in [pool.submit(run, job, again) for job in jobs if not job.timed]:
            done.result()


def table_of(file):
    with open(file, encoding="utf-8") as lines:
        rows = list(csv.DictReader(lines))
    if not rows:
        raise SystemExit(f"{file}: empty")
    return rows


def column(rows, name):
    return np.array([float(r[name]) for r in rows])

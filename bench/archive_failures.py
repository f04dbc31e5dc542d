#!/usr/bin/env python3
"""What failures of an archive's jobs cost: what is run again, how much work is lost, and how long it takes until the work goes on.

  bench/archive_failures.py --data FOLDER [--slurm]

FOLDER has the films. Two lines are tracked, a long one and a short one; the long one's track_bag is struck when it has used half of the
processor time that it takes. `--slurm`: on a Slurm of its own as well, as the tests start one (root; see test/archive/slurm_cluster.py).
Prints for each failure the jobs of the workflow that were run beyond those of a run without it, the processor s that were thrown away, and the
s by the clock from the failure to the job's next start, or of a broken recording to its end.
"""
import argparse
import ctypes
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "test" / "archive")]
import slurm_cluster  # noqa: E402: what is in the package has to be found first
from conftest import call, plan, run, snakemake  # noqa: E402
from test_workflow import ids, processes, records, wait_for  # noqa: E402

LONG, SHORT = ("chol_blood.mp4", "140,110,60,80"), ("bowel_slow_camera.mp4", "90,40,120,100")
RULE = "\nrule track:"  # what snakemake prints for each start of a job
TICK = os.sysconf("SC_CLK_TCK")


def used(process):
    """Processor s of a process, 0 when it has ended."""
    try:
        fields = pathlib.Path(f"/proc/{process}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / TICK
    except OSError:
        return 0.0


class Trial:
    """An archive of both lines in a folder of its own."""

    def __init__(self, data, folder, seconds, profile="local"):
        self.folder, self.profile = folder, profile
        folder.mkdir(exist_ok=True)
        self.film = folder / "long.mp4"
        shutil.copy(data / LONG[0], self.film)
        self.archive = plan(folder, [{"case": "short", "file": data / SHORT[0], "roi": SHORT[1], "end": "3"},
                                     {"case": "long", "file": self.film, "roi": LONG[1], "end": seconds}])
        self.targets = [f"results/records/{identity}.json" for identity in ids(self.archive).values()]

    def start(self, *options):
        # On one machine one line after the other, so that the short one is not beside the long one
        return snakemake(self.archive, *(["--cores", "1"] if self.profile == "local" else ["--jobs", "2"]), *options, *self.targets, profile=self.profile)

    def tracking(self):
        return processes(["track_bag", str(self.film)])

    def at(self, seconds):
        """The process that tracks the long line, when it has used so many processor s."""
        wait_for(lambda: any(used(process) >= seconds for process in self.tracking()), 600)
        return self.tracking()[0]

    def next_start(self, but):
        begin = time.monotonic()
        wait_for(lambda: set(self.tracking()) - {but}, 600)
        return time.monotonic() - begin

    def jobs(self, process, status=0):
        text = process.communicate(timeout=1200)[0].decode()
        assert (process.returncode == 0) == (status == 0), text
        return text.count(RULE)


def tell(name, jobs, lost, after):
    print(f"{name}: {jobs} run again, {lost:.1f} processor s lost, {after}", flush=True)


def killed(trial, half, strike=lambda process: os.kill(process, signal.SIGKILL), name="a job is killed"):
    workflow = trial.start()
    process = trial.at(half)
    lost = used(process)
    strike(process)
    after = trial.next_start(process)
    tell(name, trial.jobs(workflow) - 2, lost, f"goes on after {after:.1f} s")


def machine_dies(trial, half):
    workflow = trial.start()
    process = trial.at(half)
    lost = used(process)
    os.killpg(workflow.pid, signal.SIGKILL)
    begun = workflow.communicate()[0].decode().count(RULE)
    wait_for(lambda: not trial.tracking())
    there = len(records(trial.archive))
    run(trial.archive, "--unlock")
    workflow = trial.start()
    after = trial.next_start(process)
    assert trial.jobs(workflow) == 2 - there, "what was done is not done again"
    tell("snakemake and its jobs are killed", begun - there, lost, f"goes on {after:.1f} s after the next start")


def disk_is_full(data, folder, seconds, whole):
    disk = folder / "disk"
    disk.mkdir()
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.mount(b"tmpfs", os.fsencode(disk), b"tmpfs", 0, b"size=11m") != 0:
        print("the disk is full: no file system can be mounted here")
        return
    try:
        trial = Trial(data, disk, seconds)
        (disk / "ballast").write_bytes(b"x" * (shutil.disk_usage(disk).free - 300_000))
        workflow = trial.start("--restart-times", "0")
        most = 0.0
        while workflow.poll() is None:
            most = max([most, *map(used, trial.tracking())])
            time.sleep(0.05)
        begun = trial.jobs(workflow, status=1)
        there = len(records(trial.archive))
        (disk / "ballast").unlink()
        workflow = trial.start()
        after = trial.next_start(None)
        assert trial.jobs(workflow) == 2 - there, "what was done is not done again"
        tell(f"the disk is full, the long line needs {whole:.1f} s", begun - there, most, f"goes on {after:.1f} s after the next start")
    finally:
        libc.umount2(os.fsencode(disk), 2)


def broken(trial):
    trial.film.write_bytes(trial.film.read_bytes()[:50_000])  # of an MP4 whose index is at its end, or its first pictures
    begin = time.monotonic()
    jobs = trial.jobs(trial.start())
    told = records(trial.archive)[ids(trial.archive)["long"]]
    tell(f"a recording is broken ({told['state']})", jobs - 2, told["cpu_seconds"], f"both lines are there after {time.monotonic() - begin:.1f} s")


def drained(trial, cluster, half):
    workflow = trial.start()
    process = trial.at(half)
    cluster.ask("scontrol", "update", f"NodeName={cluster.host}", "State=DRAIN", "Reason=measured")
    identity = ids(trial.archive)["long"]
    wait_for(lambda: identity in records(trial.archive), 600)
    begin = time.monotonic()
    cluster.ask("scontrol", "update", f"NodeName={cluster.host}", "State=RESUME")
    tell("a node is drained", trial.jobs(workflow) - 2, 0.0 if set(trial.tracking()) <= {process} else used(process),
         f"all is done {time.monotonic() - begin:.1f} s after it was resumed, the long line was done before")


def cancel(process):
    environment = dict(pair.partition("=")[::2] for pair in pathlib.Path(f"/proc/{process}/environ").read_text(errors="replace").split("\0"))
    subprocess.run(["scancel", environment["SLURM_JOB_ID"]], check=True)


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--data", type=pathlib.Path, required=True, help=f"folder with {LONG[0]} and {SHORT[0]}")
    p.add_argument("--seconds", type=float, default=100.0, help="of the long recording that are tracked")
    p.add_argument("--slurm", action="store_true")
    a = p.parse_args()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="failures_"))
    try:
        trial = Trial(a.data, folder / "clean", a.seconds)
        trial.jobs(trial.start())
        whole = records(trial.archive)[ids(trial.archive)["long"]]["cpu_seconds"]
        half = whole / 2
        killed(Trial(a.data, folder / "killed", a.seconds), half)
        machine_dies(Trial(a.data, folder / "machine", a.seconds), half)
        disk_is_full(a.data, folder, a.seconds, whole)
        broken(Trial(a.data, folder / "broken", a.seconds))
        if a.slurm:
            with slurm_cluster.running() as cluster:
                killed(Trial(a.data, folder / "slurm_killed", a.seconds, "slurm"), half, name="Slurm: a job's track_bag is killed")
                killed(Trial(a.data, folder / "slurm_cancelled", a.seconds, "slurm"), half, cancel, "Slurm: a job is cancelled, as when its time is over")
                drained(Trial(a.data, folder / "slurm_drained", a.seconds, "slurm"), cluster, half)
        print(call("archive_status", trial.archive).strip())
    finally:
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main()

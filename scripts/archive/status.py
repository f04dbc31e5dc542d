"""Where an archive stands: each line of its plan is in one of five states, and the counts add up to the lines."""
import contextlib
import os
import pathlib
import socket
import subprocess
import time

from . import files, plan

STATES = ("done", "damaged", "failed", "running", "interrupted", "waiting")
ALIVE = 60.0  # s: track_bag writes to its log every 10 s, so a log that is older belongs to a job that is gone


def slurm_knows(job):
    """Whether Slurm has the job running; None where Slurm cannot be asked."""
    try:
        done = subprocess.run(["squeue", "-h", "-j", job, "-o", "%T"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=30, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return None
    return done.stdout.decode().strip() in ("RUNNING", "COMPLETING", "SUSPENDED") if done.returncode == 0 else None


def is_running(marker, log):
    mark = files.read_json(marker)
    if mark["slurm_job"]:
        known = slurm_knows(mark["slurm_job"])
        if known is not None:
            return known
    elif mark["host"] == socket.gethostname():
        try:
            return b"archive_track" in pathlib.Path(f"/proc/{mark['process']}/cmdline").read_bytes()
        except OSError:
            return False
    return log.is_file() and time.time() - log.stat().st_mtime < ALIVE


def begun(private):
    """By lines, the markers of what was begun and has not ended: of the line itself, or of its pieces."""
    found = {}
    for path in (private / "running").glob("*.json"):
        found.setdefault(path.name.partition(".")[0], []).append(path)
    return found


def where_it_runs(markers, private):
    """Of a line's markers; empty: it runs nowhere."""
    places = []
    for marker in markers:
        with contextlib.suppress(FileNotFoundError):  # it has ended meanwhile
            if is_running(marker, private / "logs" / f"{marker.stem}.log"):
                where = files.read_json(marker)
                piece = f"piece {marker.stem.partition('.')[2]} " if "." in marker.stem else ""
                places.append(f"{piece}on {where['host']}" + (f", Slurm job {where['slurm_job']}" if where["slurm_job"] else ""))
    return "; ".join(sorted(places))


def state_of(archive, identity, markers):
    """State and reason of a line."""
    private = archive / "private"
    record = archive / "results" / "records" / f"{identity}.json"
    where = where_it_runs(markers, private)
    if where:
        return "running", where
    if any(marker.is_file() for marker in markers):
        return "interrupted", "ended without a result (killed, or its machine was lost); it runs again with the next start"
    try:
        told = files.read_json(record)
    except FileNotFoundError:
        return "waiting", ""
    job = private / "jobs" / f"{identity}.json"
    if job.stat().st_mtime_ns > record.stat().st_mtime_ns:
        return "waiting", "its line was changed since it was tracked"
    return told["state"], "; ".join(told["reasons"])


def of(archive):
    """(id, state, reason) of every line."""
    archive = pathlib.Path(archive)
    markers = begun(archive / "private")
    return [(row["id"], *state_of(archive, row["id"], markers.get(row["id"], []))) for row in plan.read(archive)]


def forget(archive, identities):
    """Takes the records of these lines away, so that the workflow tracks them again, and nothing else."""
    for identity in identities:
        os.unlink(pathlib.Path(archive) / "results" / "records" / f"{identity}.json")

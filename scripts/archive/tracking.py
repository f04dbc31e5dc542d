"""One line of a manifest: tracked, its table kept, and a record of what came of it.

A recording that cannot be tracked is a result, too, since it would end in the same way again: the record has the reason. What
another machine or another day would do otherwise (killed, out of memory, disk full) is none: TrackingEnded is raised, nothing
is kept, and Snakemake runs the line again.
"""
import contextlib
import gzip
import hashlib
import os
import pathlib
import re
import resource
import shutil
import signal
import socket
import subprocess

from . import files, programs, summary

DROPPED = "processing_time"  # of the table: it differs from run to run, all else does not
MOST_REASONS = 5
PROGRESS = re.compile(r"^image \d+( of \d+)?, [\d.]+ images/s")


class TrackingEnded(Exception):
    """Tracking ended for a reason that is not the recording's."""


class Stopped(Exception):
    """A signal asked this process to end."""


def forbid_names(text, job):
    """The text without the paths and names of the line's files, which may be a patient's."""
    words = {}
    for column in ("truth", "params", "camera_info", "file"):
        for path in {job[column], os.path.realpath(job[column])} if job.get(column) else ():
            word = "RECORDING" if column == "file" else column.upper()
            words.update({os.path.dirname(path): "FOLDER", path: word, os.path.basename(path): word, pathlib.Path(path).stem: word})
    for name in sorted(words, key=len, reverse=True):
        if len(name) > 1:
            text = text.replace(name, words[name])
    return text


def said(log, job):
    """What track_bag had to say, without its progress."""
    lines = pathlib.Path(log).read_text(encoding="utf-8", errors="replace").splitlines()
    return [forbid_names(line, job).replace("track_bag: ", "") for line in lines if line and not PROGRESS.match(line)]


def run(command, log):
    """Exit status (negative: by a signal) and what the process used. A signal to this process goes on to it."""
    with open(log, "wb") as output:
        process = subprocess.Popen(command, stdout=output, stderr=output, stdin=subprocess.DEVNULL)

        def stop(number, _frame):
            process.send_signal(number)
            raise Stopped(signal.Signals(number).name)

        before = {number: signal.signal(number, stop) for number in (signal.SIGTERM, signal.SIGINT)}
        try:
            process.wait()
        except Stopped as name:
            process.wait()
            raise TrackingEnded(f"ended by {name}") from None
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return process.returncode, {"cpu_seconds": round(usage.ru_utime + usage.ru_stime, 2), "peak_mb": round(usage.ru_maxrss / 1024)}


def compress(source, target, identity):
    """The table with the line's id in front and without times of processing. Two runs give the same bytes. Returns their sum."""
    with open(source, "rb") as table, files.whole(target, "wb") as file:
        with gzip.GzipFile(filename="", mode="wb", fileobj=file, mtime=0) as packed:
            dropped = table.readline().rstrip(b"\n").split(b",").index(DROPPED.encode())
            table.seek(0)
            for number, line in enumerate(table):
                cells = line.split(b",", dropped + 1)  # what lies behind may have commas in quotes
                packed.write(b",".join([b"id" if number == 0 else identity.encode(), *cells[:dropped], *cells[dropped + 1:]]))
    return hashlib.sha256(pathlib.Path(target).read_bytes()).hexdigest()


@contextlib.contextmanager
def marked(path, identity):
    """While this goes on, a file says where: for archive_status."""
    files.write_json(path, {"id": identity, "host": socket.gethostname(), "process": os.getpid(), "slurm_job": os.environ.get("SLURM_JOB_ID", "")})
    try:
        yield
    finally:
        path.unlink()


def thumbnail(job, target):
    """The first image with the region; that it cannot be made is no failure of the line."""
    partial = target.with_name(f".{job['id']}.{os.getpid()}.jpg")
    command = [programs.program("describe_recording"), job["file"], "--roi", job["roi"], "--picture", str(partial),
               *programs.source_options({**job, "end": ""})]
    with contextlib.suppress(FileNotFoundError):
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
        if done.returncode == 0:
            os.replace(partial, target)
        else:
            partial.unlink()


def track(job, archive):
    """Writes images/ID.csv.gz, thumbnails/ID.jpg and then records/ID.json below results/. Returns the record."""
    archive, identity = pathlib.Path(archive), job["id"]
    results, private = archive / "results", archive / "private"
    for folder in (results / "images", results / "thumbnails", private / "logs", private / "running"):
        folder.mkdir(parents=True, exist_ok=True)
    record_file = results / "records" / f"{identity}.json"
    with contextlib.suppress(FileNotFoundError):
        record_file.unlink()
    for left in (private / "scratch").glob(f"{identity}.*"):  # of a process that was killed, or that another machine may still run: it fails then
        shutil.rmtree(left, ignore_errors=True)
    scratch = private / "scratch" / f"{identity}.{os.getpid()}"
    scratch.mkdir(parents=True)
    try:
        with marked(private / "running" / f"{identity}.json", identity):
            record = track_in(scratch, job, results, private / "logs" / f"{identity}.log")
            files.write_json(record_file, record)
    except OSError as error:
        raise TrackingEnded(str(error)) from error
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
    return record


def judged(record, job, table):
    """The record, with what the line's truth says of the table, None when there is none. Without a truth that can be used it has failed."""
    if not job.get("benchmark"):
        return record
    from . import layouts, truth  # OpenCV behind them takes a while to load, which lines without truth do without
    try:
        record["benchmark"] = layouts.load(job).score(truth.Tracked.read(table) if table else None)
    except truth.BadTruth as error:
        reasons = [forbid_names(text, job) for text in error.problems[:MOST_REASONS]]
        return {**{name: record[name] for name in ("id", "case", "cpu_seconds", "peak_mb")}, "state": "failed", "reasons": reasons}
    return record


def track_in(scratch, job, results, log):
    table = scratch / "images.csv"
    command = [programs.program("track_bag"), job["file"], "--tracker", job["tracker"], "--roi", job["roi"], "--csv", str(table),
               *programs.source_options(job)]
    status, used = run(command, log)
    words = said(log, job)
    if status < 0 or status > 2:
        raise TrackingEnded(f"track_bag ended by {signal.Signals(-status).name}" if status < 0 else f"track_bag ended with status {status}")
    if any("cannot be written" in line for line in words):  # full disk, quota, storage that is gone
        raise TrackingEnded(words[-1])
    record = {"id": job["id"], "case": job["case_id"], "state": "done", "reasons": [], **used}
    if not table.is_file():
        return judged({**record, "state": "failed", "reasons": words[-MOST_REASONS:] or [f"track_bag ended with status {status}"]}, job, None)
    if status != 0:
        lost = [line for line in words if "is left out" in line or "could not be processed" in line or "damaged" in line]
        record.update(state="damaged", reasons=lost[:MOST_REASONS - 1] + words[-1:])
    record.update(summary.summarise(table))
    record["sha256"] = compress(table, results / "images" / f"{job['id']}.csv.gz", job["id"])
    thumbnail(job, results / "thumbnails" / f"{job['id']}.jpg")
    return judged(record, job, table)

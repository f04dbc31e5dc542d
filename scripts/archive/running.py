"""track_bag, run and watched: what it said without the names of files, what it used, and whether it ended by itself."""
import contextlib
import os
import pathlib
import re
import signal
import socket
import subprocess

from . import files, programs

MOST_REASONS = 5
PROGRESS = re.compile(r"^image \d+( of \d+)?, [\d.]+ images/s")
TOPIC = re.compile(r"^(\s+)\S+ (\(\w+/\w+\))$", re.MULTILINE)  # in track_bag's list of what a bag holds
ABSOLUTE = re.compile(r"(?<![\w./-])/[^\s'\",;:()]+")  # a path or a topic


class TrackingEnded(Exception):
    """Tracking ended for a reason that is not the recording's."""


class Stopped(Exception):
    """A signal asked this process to end."""


def forbid_names(text, job):
    """The text without paths, topics, and the names of the line's files, which may be a patient's."""
    words = {job["image_topic"]: "TOPIC"} if job.get("image_topic") else {}
    for column in ("truth", "params", "camera_info", "file"):
        for path in {job[column], os.path.realpath(job[column])} if job.get(column) else ():
            word = "RECORDING" if column == "file" else column.upper()
            words.update({os.path.dirname(path): "FOLDER", path: word, os.path.basename(path): word, pathlib.Path(path).stem: word})
    for name in sorted(words, key=len, reverse=True):
        if len(name) > 1:
            text = text.replace(name, words[name])
    return ABSOLUTE.sub("NAME", TOPIC.sub(r"\1TOPIC \2", text))


def said(log, job):
    """What track_bag had to say, without its progress. No name stays in the log."""
    text = pathlib.Path(log).read_text(encoding="utf-8", errors="replace")
    told = forbid_names(text, job)
    if told != text:
        files.write_text(log, told, lasting=False)
    return [line.replace("track_bag: ", "") for line in told.splitlines() if line and not PROGRESS.match(line)]


def run(command, log):
    """Exit status (negative: by a signal) and what the process used. A signal to this process goes on to it."""
    with open(log, "wb") as output:
        process = subprocess.Popen(command, stdout=output, stderr=output, stdin=subprocess.DEVNULL)

        def stop(number, _frame):
            process.send_signal(number)
            raise Stopped(signal.Signals(number).name)

        before = {number: signal.signal(number, stop) for number in (signal.SIGTERM, signal.SIGINT)}
        try:
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = programs.exit_status(status)
        except Stopped as name:
            process.wait()
            raise TrackingEnded(f"ended by {name}") from None
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)
    return process.returncode, {"cpu_seconds": round(usage.ru_utime + usage.ru_stime, 2), "peak_mb": round(usage.ru_maxrss / 1024)}


@contextlib.contextmanager
def marked(path, identity):
    """While this goes on, a file says where: for archive_status."""
    files.write_json(path, {"id": identity, "host": socket.gethostname(), "process": os.getpid(), "slurm_job": os.environ.get("SLURM_JOB_ID", "")})
    try:
        yield
    finally:
        path.unlink(missing_ok=True)  # of a second process of this line


def track_table(job, table, log, *options):
    """The table of track_bag; there is none when the recording cannot be tracked. Returns state and reasons of a record, and what it took."""
    command = [programs.program("track_bag"), job["file"], "--tracker", job["tracker"], "--roi", job["roi"], "--csv", str(table),
               *programs.source_options(job), *options]
    status, used = run(command, log)
    words = said(log, job)
    if status < 0 or status > 2:
        raise TrackingEnded(f"track_bag ended by {signal.Signals(-status).name}" if status < 0 else f"track_bag ended with status {status}")
    if any("cannot be written" in line for line in words):  # full disk, quota, storage that is gone
        raise TrackingEnded(words[-1])
    if not table.is_file():
        return {"state": "failed", "reasons": words[-MOST_REASONS:] or [f"track_bag ended with status {status}"], **used}
    if status != 0:
        lost = [line for line in words if "is left out" in line or "could not be processed" in line or "damaged" in line]
        return {"state": "damaged", "reasons": list(dict.fromkeys(lost[:MOST_REASONS - 1] + words[-1:])), **used}
    return {"state": "done", "reasons": [], **used}

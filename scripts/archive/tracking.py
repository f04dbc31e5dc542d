"""One line of a manifest: tracked, its table and its page kept, and a record of what came of it.

A recording that cannot be tracked is a result, too, since it would end in the same way again: the record has the reason. What
another machine or another day would do otherwise (killed, out of memory, disk full) is none: TrackingEnded is raised, nothing
is kept, and Snakemake runs the line, or its piece, again.
"""
import contextlib
import gzip
import hashlib
import os
import pathlib
import shutil
import subprocess

from . import files, pages, pieces, programs, running, summary
from .running import TrackingEnded

DROPPED = "processing_time"  # of the table: it differs from run to run, all else does not
STATES = ("done", "damaged", "failed")  # from the best to the worst


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


class Line:
    """A line of an archive, and where its files are."""

    def __init__(self, job, archive):
        archive = pathlib.Path(archive)
        self.job, self.identity, self.archive = job, job["id"], archive
        self.results, self.private = archive / "results", archive / "private"
        for folder in (self.results / "images", self.results / "thumbnails", self.private / "logs", self.private / "running", self.private / "pieces"):
            folder.mkdir(parents=True, exist_ok=True)

    @contextlib.contextmanager
    def work(self, name):
        """A folder for the line or one of its pieces, that goes away; while it is there, a file says where the work goes on."""
        for left in (self.private / "scratch").glob(f"{name}.[0-9]*p"):  # of what was killed, or goes on on a machine that counts as lost: it fails then
            shutil.rmtree(left, ignore_errors=True)
        scratch = self.private / "scratch" / f"{name}.{os.getpid()}p"
        scratch.mkdir(parents=True)
        try:
            with running.marked(self.private / "running" / f"{name}.json", self.identity):
                yield scratch
        except OSError as error:
            raise TrackingEnded(str(error)) from error
        finally:
            shutil.rmtree(scratch, ignore_errors=True)

    def piece_file(self, number, kind):
        return self.private / "pieces" / f"{self.identity}.{number}.{kind}"

    def track_piece(self, number):
        """Writes table and record of a piece below private/pieces/."""
        name = f"{self.identity}.{number}"
        table, record_file = self.piece_file(number, "csv"), self.piece_file(number, "json")
        record_file.unlink(missing_ok=True)
        with self.work(name) as scratch:
            span = self.job["pieces"][number]
            options = [f"--resume={span['resume']}"] if span["resume"] else []
            record = running.track_table({**self.job, "end": span["end"]}, scratch / "images.csv", self.private / "logs" / f"{name}.log", *options)
            with contextlib.suppress(FileNotFoundError):  # of a piece that failed
                os.replace(scratch / "images.csv", table)
            files.write_json(record_file, {**record, "job": self.job})

    def piece(self, number):
        """The record of a piece, which is tracked now if it was not yet, or for another plan."""
        with contextlib.suppress(FileNotFoundError):
            record = files.read_json(self.piece_file(number, "json"))
            if record["job"] == self.job:
                return record
        self.track_piece(number)
        return files.read_json(self.piece_file(number, "json"))

    def joined(self, parts, table):
        """Joins the pieces' tables, and their records to one."""
        reasons = list(dict.fromkeys(reason for part in parts for reason in part["reasons"]))
        record = {"state": max((part["state"] for part in parts), key=STATES.index), "reasons": reasons[:running.MOST_REASONS],
                  "cpu_seconds": round(sum(part["cpu_seconds"] for part in parts), 2), "peak_mb": max(part["peak_mb"] for part in parts)}
        if record["state"] == "failed":
            return record
        roi = [float(part) for part in self.job["roi"].split(",")]
        rows, joints = pieces.join_all([pieces.Rows.read(self.piece_file(number, "csv")) for number in range(len(parts))], roi)
        table.write_bytes(b"".join([rows.header, *rows.lines]))
        record["reasons"] += pieces.cuts(joints)
        return {**record, **summary.of_joints(joints)}

    def judged(self, record, table):
        """The record, with what the line's truth says of the table, or of nothing where the line has failed. Without a truth that can be used
        it has failed."""
        if not self.job.get("benchmark"):
            return record
        from . import layouts, truth  # OpenCV behind them takes a while to load, which lines without truth do without
        try:
            return {**record, "benchmark": layouts.load(self.job).score(truth.Tracked.read(table) if record["state"] != "failed" else None)}
        except truth.BadTruth as error:
            reasons = [running.forbid_names(text, self.job) for text in error.problems[:running.MOST_REASONS]]
            return {**{name: record[name] for name in ("id", "case", "cpu_seconds", "peak_mb")}, "state": "failed", "reasons": reasons}

    def track(self):
        """Writes images/ID.csv.gz, thumbnails/ID.jpg, lines/ID.html and then records/ID.json below results/. Returns the record."""
        record_file = self.results / "records" / f"{self.identity}.json"
        record_file.unlink(missing_ok=True)
        parts = [self.piece(number) for number in range(len(self.job.get("pieces", [])))]
        with self.work(self.identity) as scratch:
            table = scratch / "images.csv"
            record = self.joined(parts, table) if parts else running.track_table(self.job, table, self.private / "logs" / f"{self.identity}.log")
            record.update(id=self.identity, case=self.job["case_id"])
            if record["state"] != "failed":
                record.update(summary.summarise(table))
                pages.write_line(self.archive, self.identity, table)
                record["sha256"] = compress(table, self.results / "images" / f"{self.identity}.csv.gz", self.identity)
                thumbnail(self.job, self.results / "thumbnails" / f"{self.identity}.jpg")
            record = self.judged(record, table)
            files.write_json(record_file, record)
        for number in range(len(parts)):
            for kind in ("csv", "json"):
                self.piece_file(number, kind).unlink(missing_ok=True)
        return record

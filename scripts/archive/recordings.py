"""Recordings: which a folder holds, and what is known of each without tracking it."""
import concurrent.futures
import json
import os
import pathlib
import subprocess

from . import files, programs

VIDEOS = {".mp4", ".m4v", ".mov", ".mkv", ".avi", ".mpg", ".mpeg", ".ts", ".m2ts", ".mts", ".vob", ".wmv", ".webm", ".mxf"}
BAGS = {".bag"}
FACTS = ("file", "image_topic", "bytes", "modified", "width", "height", "images", "rate", "roi", "error")


def find(folder):
    """Videos and bags below `folder`, by their names; links to folders are not followed."""
    found = []
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        found += [pathlib.Path(place) / name for name in sorted(names)
                  if pathlib.Path(name).suffix.lower() in VIDEOS | BAGS and not name.startswith(".")]
    return found


def state_of(file):
    """Size and time of a file, or of what a folder of images holds: when they are as before, so is the recording."""
    path = pathlib.Path(file)
    entries = [path] if path.is_file() else sorted(path.iterdir())
    stats = [entry.stat() for entry in entries]
    return str(sum(s.st_size for s in stats)), str(max((s.st_mtime_ns for s in stats), default=0))


def describe(file, image_topic=""):
    """Facts of one recording; `error` says why it cannot be tracked, and is empty otherwise."""
    facts = dict.fromkeys(FACTS, "")
    facts.update(file=str(file), image_topic=image_topic)
    try:
        facts["bytes"], facts["modified"] = state_of(file)
    except OSError as error:
        facts["error"] = error.strerror
        return facts
    command = [programs.program("describe_recording"), str(file), *programs.source_options(facts)]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    if done.returncode == 0:
        told = json.loads(done.stdout)
        facts.update({name: str(told[name]) for name in ("width", "height", "images", "rate", "roi")})
    else:
        words = done.stderr.decode(errors="replace").strip().splitlines()
        facts["error"] = words[-1].partition("describe_recording: ")[2] or words[-1] if words else f"ended by signal {-done.returncode}"
    return facts


class Facts:
    """What is known of recordings, kept in a table: a recording that has not changed is not opened again."""

    def __init__(self, path, jobs=1):
        self.path, self.jobs = pathlib.Path(path), jobs
        rows = files.read_table(self.path) if self.path.is_file() else []
        self.known = {(row["file"], row["image_topic"]): row for row in rows}
        self.opened = 0

    def of(self, recordings):
        """Facts of (file, image topic), in a dictionary; the table is written when something was new."""
        wanted = list(dict.fromkeys(recordings))
        stale = [key for key in wanted if not self.is_fresh(key)]
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            for key, facts in zip(stale, pool.map(lambda key: describe(*key), stale)):
                self.known[key] = facts
        self.opened += len(stale)
        if stale:
            files.write_table(self.path, FACTS, [self.known[key] for key in sorted(self.known)])
        return {key: self.known[key] for key in wanted}

    def is_fresh(self, key):
        facts = self.known.get(key)
        try:
            return facts is not None and (facts["bytes"], facts["modified"]) == state_of(key[0])
        except OSError:
            return False


def seconds(facts):
    """Length by what the file says; 0: not known."""
    rate = float(facts["rate"] or 0)
    return int(facts["images"] or 0) / rate if rate > 0 else 0.0

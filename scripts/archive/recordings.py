"""Recordings: which a folder holds, and what is known of each without tracking it."""
import concurrent.futures
import json
import os
import pathlib
import subprocess
import time

from . import files, programs

VIDEOS = {".mp4", ".m4v", ".mov", ".mkv", ".avi", ".mpg", ".mpeg", ".ts", ".m2ts", ".mts", ".vob", ".wmv", ".webm", ".mxf"}
BAGS = {".bag"}
FACTS = ("file", "image_topic", "bytes", "modified", "width", "height", "images", "rate", "roi", "scenes", "error")
KEPT_EVERY = 10.0  # s: what is known is written so often, since looking for cuts takes long


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


def describe(file, image_topic="", cuts=False):
    """Facts of one recording; `error` says why it cannot be tracked, and is empty otherwise. With `cuts`, all of it is read, and
    `scenes` tells in JSON what lies between its cuts; see scenes()."""
    facts = dict.fromkeys(FACTS, "")
    facts.update(file=str(file), image_topic=image_topic)
    try:
        facts["bytes"], facts["modified"] = state_of(file)
    except OSError as error:
        facts["error"] = error.strerror
        return facts
    command = [programs.program("describe_recording"), str(file), *programs.source_options(facts), *(["--cuts"] if cuts else [])]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    if done.returncode == 0:
        told = json.loads(done.stdout)
        facts.update({name: str(told[name]) for name in ("width", "height", "images", "rate", "roi")})
        facts["scenes"] = json.dumps(told["scenes"]) if cuts else ""
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

    def of(self, recordings, cuts=False):
        """Facts of (file, image topic), in a dictionary; with `cuts` also their scenes. The table is written when something was new."""
        wanted = list(dict.fromkeys(recordings))
        stale = [key for key in wanted if not self.is_fresh(key, cuts)]
        kept = time.monotonic()
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            opened = {pool.submit(describe, *key, cuts): key for key in stale}
            for done in concurrent.futures.as_completed(opened):
                self.known[opened[done]] = done.result()
                self.opened += 1
                if time.monotonic() - kept > KEPT_EVERY:
                    self.keep()
                    kept = time.monotonic()
        if stale:
            self.keep()
        return {key: self.known[key] for key in wanted}

    def keep(self):
        files.write_table(self.path, FACTS, [self.known[key] for key in sorted(self.known)])

    def is_fresh(self, key, cuts=False):
        facts = self.known.get(key)
        try:
            return (facts is not None and (facts["bytes"], facts["modified"]) == state_of(key[0])
                    and (not cuts or bool(facts.get("scenes") or facts["error"])))
        except OSError:
            return False


def scenes(facts, cuts=True):
    """Of a recording, each with `start` and `end` in s and `roi`: one, and no end, where no cut is known, or none counts."""
    told = json.loads(facts.get("scenes") or "null") if cuts else None
    return told or [{"start": 0.0, "roi": facts["roi"]}]


def seconds(facts):
    """Length by what the file says; 0: not known."""
    rate = float(facts["rate"] or 0)
    return int(facts["images"] or 0) / rate if rate > 0 else 0.0

"""What is to be done: a file for each line of the manifest, under names that say nothing of patients.

  plan.csv                     id, case, and what the work will be by length and size
  private/key.csv              which id stands for which case, file and line; readable by its owner alone
  private/jobs/ID.json         all that tracking the line needs; written only when that changes, so that a line is done again when it did
"""
import hashlib
import os
import pathlib
import secrets

from . import files, manifest, pieces, recordings

PLAN = ("id", "case", "width", "height", "seconds", "images", "pieces")
KEY = ("id", "case_id", *manifest.COLUMNS, "line")
SAME_LINE = ("case", "file", "start", "end", "benchmark")  # of a line whose region was corrected


def digest(path):
    return hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest() if path else ""


class Names:
    """The ids given so far, and new ones. They are drawn by lot: a number in order would tell the order of the names."""

    def __init__(self, key_rows):
        self.case_ids = {row["case"]: row["case_id"] for row in key_rows}
        self.numbers = {}  # the highest of each case's lines
        self.known = {columns: {} for columns in (manifest.COLUMNS, SAME_LINE)}  # ids by what a line says; the oldest last
        for row in reversed(key_rows):
            case_id, _, number = row["id"].rpartition("-")
            self.numbers[case_id] = max(self.numbers.get(case_id, 0), int(number))
            for columns, ids in self.known.items():
                ids.setdefault(tuple(row[name] for name in columns), []).append(row["id"])
        self.taken = set()

    def take(self, row, columns):
        ids = self.known[columns].get(tuple(row[name] for name in columns), [])
        while ids:
            identity = ids.pop()
            if identity not in self.taken:
                self.taken.add(identity)
                return identity
        return None

    def of(self, rows):
        """An id for each line: the one that it had, also when only its region was corrected."""
        ids = [self.take(row, manifest.COLUMNS) for row in rows]
        ids = [known or self.take(row, SAME_LINE) for known, row in zip(ids, rows)]
        return [known or self.new(row["case"]) for known, row in zip(ids, rows)]

    def new(self, case):
        while case not in self.case_ids:
            name = "c" + secrets.token_hex(4)
            if name not in self.numbers:
                self.case_ids[case] = name
        case_id = self.case_ids[case]
        self.numbers[case_id] = self.numbers.get(case_id, 0) + 1
        return f"{case_id}-{self.numbers[case_id]}"


def span(row):
    """Seconds and images that are tracked, by what the recording says of itself."""
    facts = row["facts"]
    rate, length = float(facts["rate"]), recordings.seconds(facts)
    start, end = float(row["start"] or 0), float(row["end"] or length)
    seconds = max(min(end, length) - start, 0.0) if length else max(end - start, 0.0)
    return seconds, round(seconds * rate)


def job(row, identity, case_id, cut):
    """All that tracking depends on; `cut`: see write."""
    wanted = {name: row[name] for name in manifest.COLUMNS if name != "case"}
    wanted.update(id=identity, case_id=case_id, bytes=row["facts"]["bytes"], modified=row["facts"]["modified"],
                  params_sha256=digest(row["params"]), camera_info_sha256=digest(row["camera_info"]), truth_sha256=digest(row["truth"]))
    # What is published is of a tracker that nobody has started in between.
    parts = [] if row["benchmark"] else pieces.spans(row["start"], row["end"], span(row)[0], *cut)
    return {**wanted, "pieces": parts} if parts else wanted


def write(rows, archive, cut=(0.0, 0.0)):
    """Writes plan, key and jobs of a manifest without problems. `cut`: the longest piece of a recording and how long two of them overlap, in s;
    0: no recording is cut. Returns (lines, new or changed ones, results without a line)."""
    archive = pathlib.Path(archive)
    private = archive / "private"
    private.mkdir(parents=True, exist_ok=True)
    private.chmod(0o700)
    key_file = private / "key.csv"
    old = files.read_table(key_file) if key_file.is_file() else []
    names = Names(old)
    ids = names.of(rows)
    case_ids = [names.case_ids[row["case"]] for row in rows]
    key = {row["id"]: row for row in old}  # a line that is left out keeps its name, for results that are kept
    for row, identity, case_id in zip(rows, ids, case_ids):
        key[identity] = {**{name: row[name] for name in (*manifest.COLUMNS, "line")}, "id": identity, "case_id": case_id}
    present = set(ids)
    for identity in set(key) - present:
        key[identity] = {**key[identity], "line": ""}
    before = os.umask(0o077)
    try:
        files.write_table(key_file, KEY, key.values())
        jobs = [job(row, identity, case_id, cut) for row, identity, case_id in zip(rows, ids, case_ids)]
        changed = sum(files.write_if_changed(private / "jobs" / f"{wanted['id']}.json", wanted) for wanted in jobs)
    finally:
        os.umask(before)
    left_out = [path for path in (private / "jobs").glob("*.json") if path.stem not in present]
    for path in left_out:
        path.unlink()
    table = []
    for row, wanted in zip(rows, jobs):
        seconds, images = span(row)
        table.append({"id": wanted["id"], "case": wanted["case_id"], "width": row["facts"]["width"], "height": row["facts"]["height"],
                      "seconds": f"{seconds:.2f}", "images": images, "pieces": len(wanted.get("pieces", [None]))})
    files.write_table(archive / "plan.csv", PLAN, table)
    return len(rows), changed, len(left_out)


def read(archive):
    return files.read_table(pathlib.Path(archive) / "plan.csv")

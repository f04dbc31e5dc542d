"""The manifest of an archive: a table, one region of one recording a line."""
import csv
import math
import os
import pathlib

from . import recordings

COLUMNS = ("case", "file", "start", "end", "roi", "image_topic", "camera_info", "tracker", "params", "crop", "truth", "benchmark")
NEEDED = ("case", "file", "roi")
FILES = ("file", "camera_info", "params", "truth")  # paths, seen from the manifest
TRACKERS = ("region",)  # others need a file that says what is tracked, for which a line has no place
END_TOLERANCE = 1.0  # s: the length that a file states is rounded, and so is what people write


class Problems:
    """Everything that is wrong, each with the line it stands in."""

    def __init__(self):
        self.found = []

    def add(self, line, text):
        self.found.append((line, text))

    def lines(self, name):
        return [f"{name}:{line}: {text}" for line, text in sorted(self.found, key=lambda row: row[0])]


def read(path, problems):
    """Rows as dictionaries, with `line` counted from 1 as editors do; paths are absolute, seen from the manifest's folder."""
    folder = pathlib.Path(path).resolve().parent
    rows = []
    with open(path, encoding="utf-8-sig", errors="replace", newline="") as file:
        reader = csv.reader(file)
        header = [name.strip() for name in next(reader, [])]
        problems_of_header(header, problems)
        if problems.found:
            return []
        line = reader.line_num + 1
        for cells in reader:
            if len(cells) > len(header) or (cells and len(cells) < len(header)):
                problems.add(line, f"has {len(cells)} cells, expected {len(header)}")
            elif cells:
                row = dict.fromkeys(COLUMNS, "")
                row.update(zip(header, (cell.strip() for cell in cells)), line=line)
                for name in FILES:
                    row[name] = str(folder / os.path.expanduser(row[name])) if row[name] else ""
                row["tracker"] = row["tracker"] or TRACKERS[0]
                rows.append(row)
            line = reader.line_num + 1
    if not rows and not problems.found:
        problems.add(1, "holds no recording")
    return rows


def problems_of_header(header, problems):
    for name in NEEDED:
        if name not in header:
            problems.add(1, f"has no column {name}")
    for name in header:
        if name not in COLUMNS:
            problems.add(1, f"has a column '{name}', expected only {', '.join(COLUMNS)}")
        elif header.count(name) > 1 and f"has the column {name} twice" not in [text for _, text in problems.found]:
            problems.add(1, f"has the column {name} twice")


def number(row, name, problems):
    """Of a time in s; None when the cell is empty or wrong."""
    if not row[name]:
        return None
    try:
        value = float(row[name])
    except ValueError:
        value = math.nan
    if not (0.0 <= value < math.inf):
        problems.add(row["line"], f"{name} is '{row[name]}', expected seconds from 0 on")
        return None
    return value


def region(row, problems):
    """x, y, width, height in px, or None."""
    if not row["roi"]:
        problems.add(row["line"], "roi is empty, expected x,y,width,height in px")
        return None
    try:
        x, y, width, height = (float(part) for part in row["roi"].split(","))
        if all(map(math.isfinite, (x, y))) and 0 < width < math.inf and 0 < height < math.inf:
            return x, y, width, height
    except ValueError:
        pass
    problems.add(row["line"], f"roi is '{row['roi']}', expected x,y,width,height in px, width and height more than 0")
    return None


def crop_of(row, problems):
    """x, y, width, height in whole px, or None."""
    if not row["crop"]:
        return None
    values = row["crop"].split(",")
    if len(values) == 4 and all(value.isdigit() for value in values) and int(values[2]) > 0 and int(values[3]) > 0:
        return tuple(map(int, values))
    problems.add(row["line"], f"crop is '{row['crop']}', expected x,y,width,height in whole px, width and height more than 0")
    return None


def check_cells(row, problems):
    """What can be seen without the recording. Returns start, end, region, each None where it is empty or wrong."""
    if not row["case"]:
        problems.add(row["line"], "case is empty")
    if not row["file"]:
        problems.add(row["line"], "file is empty")
    if row["tracker"] not in TRACKERS:
        problems.add(row["line"], f"tracker is '{row['tracker']}', expected {' or '.join(TRACKERS)}")
    for name in ("camera_info", "params"):
        if row[name] and not os.access(row[name], os.R_OK):
            problems.add(row["line"], f"{name} '{row[name]}' cannot be read")
    start, end = number(row, "start", problems), number(row, "end", problems)
    if end is not None and not end > (start or 0.0):
        problems.add(row["line"], f"end is {row['end']} s, expected more than start, {row['start'] or 0} s")
    return start, end, region(row, problems)


def check_doubled(rows, problems):
    first, case_of = {}, {}
    for row in rows:
        whole = tuple(row[name] for name in COLUMNS)
        if first.setdefault(whole, row["line"]) != row["line"]:
            problems.add(row["line"], f"is line {first[whole]} again")
        case, line = case_of.setdefault(os.path.realpath(row["file"]), (row["case"], row["line"]))
        if case != row["case"]:
            problems.add(row["line"], f"calls '{row['file']}' case '{row['case']}', line {line} calls it '{case}'")


def check_recording(row, cells, facts, problems):
    start, end, roi = cells
    if facts["error"]:
        problems.add(row["line"], f"'{row['file']}': {facts['error']}")
        return
    width, height, length = int(facts["width"]), int(facts["height"]), recordings.seconds(facts)
    crop = crop_of(row, problems)
    if crop:
        if pathlib.Path(row["file"]).suffix.lower() in recordings.BAGS:
            problems.add(row["line"], f"crop is '{row['crop']}', expected none of a bag")
        if crop[0] + crop[2] > width or crop[1] + crop[3] > height:
            problems.add(row["line"], f"crop {row['crop']} lies outside of the image, which has {width} x {height} px")
        width, height = crop[2:]
    if roi and (roi[0] < 0 or roi[1] < 0 or roi[0] + roi[2] > width or roi[1] + roi[3] > height):
        problems.add(row["line"], f"roi {row['roi']} lies outside of the {'crop' if crop else 'image'}, which has {width} x {height} px")
    if length and start is not None and not start < length:
        problems.add(row["line"], f"start is {row['start']} s, the recording has {length:.1f} s")
    if length and end is not None and end > length + END_TOLERANCE:
        problems.add(row["line"], f"end is {row['end']} s, the recording has {length:.1f} s")


def check_truths(rows, problems):
    """Once for each thing that is wrong: many lines may have one truth."""
    with_truth = [row for row in rows if row["benchmark"] or row["truth"]]
    if not with_truth:
        return
    from . import layouts, truth  # OpenCV behind them takes a while to load, which lines without truth do without
    told = set()
    for row in with_truth:
        try:
            layouts.load(row, row.get("facts"))
        except truth.BadTruth as error:
            for text in error.problems:
                if text not in told:
                    problems.add(row["line"], text)
                told.add(text)


def check(path, facts, problems):
    """Rows of the manifest, each with its recording's facts; whatever is wrong is added to `problems`."""
    rows = read(path, problems)
    cells = [check_cells(row, problems) for row in rows]
    check_doubled(rows, problems)
    known = facts.of((row["file"], row["image_topic"]) for row in rows if row["file"])
    for row, values in zip(rows, cells):
        if row["file"]:
            row["facts"] = known[row["file"], row["image_topic"]]
            check_recording(row, values, row["facts"], problems)
    check_truths(rows, problems)
    return rows

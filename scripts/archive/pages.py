"""Pages of an archive: one for each case with its lines, and the index, sorted by what deserves a look."""
import pathlib

import jinja2
import markupsafe

from . import files

COLOURS = {"IDLE": "#90a4ae", "TRACKING": "#2e7d32", "SEARCHING": "#ef8f00", "LOST": "#c62828"}  # as in session/drawing.py
BAND_WIDTH, BAND_HEIGHT = 400, 14  # px
TABLE = ("id", "case", "state", "images", "seconds", "tracking_images", "tracking_share", "covered", "lost", "found", "lost_at_end", "longest_lost",
         "joints", "joint_px", "cuts", "visible", "corner_error", "corner_error_99", "ms", "ms_99", "cpu_seconds", "peak_mb", "sha256", "reasons")
BENCHMARKS = ("benchmark", "case", "id", "metric", "value")


def band(record):
    """The states over time as SVG."""
    if not record.get("changes") or not record["seconds"]:
        return ""
    scale = BAND_WIDTH / record["seconds"]
    ends = [time for time, _ in record["changes"][1:]] + [record["seconds"]]
    parts = [f'<rect x="{scale * begin:.1f}" width="{max(scale * (end - begin), 0.5):.1f}" height="{BAND_HEIGHT}" fill="{COLOURS.get(state, "#000000")}"/>'
             for (begin, state), end in zip(record["changes"], ends)]
    return markupsafe.Markup(f'<svg width="{BAND_WIDTH}" height="{BAND_HEIGHT}">{"".join(parts)}</svg>')


def urgency(record):
    """Sorts by what deserves a look: failed, damaged, cut, lost until the end, then by the share that was not tracked."""
    order = ("failed", "damaged", "done").index(record["state"])
    return order, -record.get("cuts", 0), not record.get("lost_at_end", False), record.get("tracking_share", 0.0), record["id"]


def benchmark_groups(records):
    """layouts.groups() of the records."""
    if not any("benchmark" in record for record in records):
        return []
    from . import layouts  # OpenCV behind it takes a while to load, which an archive without truth does without
    return list(layouts.groups(records))


def benchmark_rows(groups):
    """Of benchmarks.csv: a row for each metric, of a line, of a case, of all of a data set."""
    rows = []
    for group in groups:
        for record, values in group.lines:
            rows += [(group.name, record["case"], record["id"], metric, value) for metric, value in values.items()]
        rows += [(group.name, case, "", metric, value) for case, values in group.cases for metric, value in values.items()]
        rows += [(group.name, "", "", metric, value) for metric, value in group.whole.items()]
    return [dict(zip(BENCHMARKS, row)) for row in rows]


def shown_value(value):
    """A share with three digits, a count without any; empty where there is no value."""
    return "" if value is None or isinstance(value, jinja2.Undefined) else f"{value:.3f}" if isinstance(value, float) else str(value)


def environment():
    e = jinja2.Environment(loader=jinja2.FileSystemLoader(pathlib.Path(__file__).parent), autoescape=True)
    e.filters.update(percent=lambda v: "" if v is None else f"{100 * v:.1f} %", number=lambda v, digits=1: "" if v is None else f"{v:.{digits}f}", value=shown_value)
    return e


def shown(record, archive):
    return {**record, "band": band(record), "picture": (archive / "results" / "thumbnails" / f"{record['id']}.jpg").is_file()}


def write_line(archive, identity, table):
    """The page that session_report makes of a table of track_bag."""
    from session.facts import Session, read_csv  # matplotlib behind it takes a second to load, which the index does without
    from session.page import Page
    session = Session()
    read_csv(session, table, lambda stamp: None)
    session.sources = [(f"images/{identity}.csv.gz", "")]
    files.write_text(archive / "results" / "lines" / f"{identity}.html", Page(session, identity).html())


def write_case(archive, case, records):
    page = environment().get_template("case.html").render(case=case, records=[shown(r, archive) for r in records], benchmarks=benchmark_groups(records))
    files.write_text(archive / "results" / "cases" / f"{case}.html", page)


def write_index(archive, records):
    files.write_table(archive / "results" / "lines.csv", TABLE,
                      [{**{k: r[k] for k in TABLE if r.get(k) is not None}, "reasons": "; ".join(r["reasons"])} for r in records])
    ordered = [shown(r, archive) for r in sorted(records, key=urgency)]
    total = {"lines": len(records), "cases": len({r["case"] for r in records}), "hours": sum(r.get("seconds", 0.0) for r in records) / 3600,
             "images": sum(r.get("images", 0) for r in records), "tracking": sum(r.get("tracking_images", 0) for r in records),
             "cpu_hours": sum(r["cpu_seconds"] for r in records) / 3600,
             **{state: sum(r["state"] == state for r in records) for state in ("done", "damaged", "failed")}}
    groups = benchmark_groups(records)
    page = environment().get_template("index.html").render(records=ordered, total=total, colours=COLOURS, benchmarks=groups)
    files.write_text(archive / "results" / "index.html", page)
    rows = benchmark_rows(groups)
    table = archive / "results" / "benchmarks.csv"
    if rows:
        files.write_table(table, BENCHMARKS, rows)
    elif table.is_file():
        table.unlink()

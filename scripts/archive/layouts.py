"""Data sets that the field knows: their layouts are recognised, and where they carry truth, their published metrics come out.

Each layout is a module with
  NAME, SAYS, KEYS                    its name, what comes out, and what a line's `benchmark` says
  folders(folder)                     folders of images that are recordings; videos are found anyway
  recognises(recording)               whether the file or folder is one of this layout
  case(recording, folder)             a name for what belongs together, of which each line is a part
  lines(recording, facts, manifest)   columns of its lines in a manifest; raises truth.BadTruth
  load(row, facts)                    the truth of a line, with score(tracked); raises truth.BadTruth. Without facts, lengths are not compared
  of_case(scores), of_all(rows)       metrics by name: of lines that belong together, and of all rows (case, score)
Where KEYS is None there is no truth, and none of the last four functions: its lines are those of any recording.
A line names in `truth` a file of the data set, and in `benchmark` the layout and what of it is meant: "STIR point=311,208".
"""
import typing

from . import layouts_cholec80, layouts_pot, layouts_stir, layouts_surgt, truth

KNOWN = (layouts_surgt, layouts_stir, layouts_pot, layouts_cholec80)
WITH_TRUTH = {layout.NAME: layout for layout in KNOWN if layout.KEYS is not None}


class Group(typing.NamedTuple):
    """Metrics of one data set, by name."""
    name: str
    says: str
    lines: list  # (record, metrics)
    cases: list  # (case, metrics)
    whole: dict


def find(folder, videos):
    """Recordings below a folder with their layouts, None for those of no data set: the videos and bags that were found, and folders of images."""
    recordings = sorted({*videos, *(path for layout in KNOWN for path in layout.folders(folder))})
    return [(path, next((layout for layout in KNOWN if layout.recognises(path)), None)) for path in recordings]


def load(row, facts=None):
    """The truth of a manifest's line, None where it has none; raises truth.BadTruth."""
    if not row["benchmark"] and not row["truth"]:
        return None
    for there, missing in (("truth", "benchmark"), ("benchmark", "truth")):
        if row[there] and not row[missing]:
            raise truth.BadTruth([f"{missing} is empty beside {there} '{row[there]}', expected both or none"])
    layout = WITH_TRUTH.get(row["benchmark"].split()[0])
    if layout is None:
        raise truth.BadTruth([f"benchmark is '{row['benchmark']}', expected one that begins with {' or '.join(WITH_TRUTH)}"])
    return layout.load(row, facts)


def groups(records):
    """What came of each data set in these records."""
    found = {}
    for record in records:
        if record.get("benchmark"):
            found.setdefault(record["benchmark"]["name"], []).append(record)
    for name, members in sorted(found.items()):
        layout = WITH_TRUTH[name.split()[0]]
        cases = {}
        for record in members:
            cases.setdefault(record["case"], []).append(record["benchmark"])
        yield Group(name, layout.SAYS, [(record, layout.of_case([record["benchmark"]])) for record in members],
                    [(case, layout.of_case(scores)) for case, scores in sorted(cases.items())],
                    layout.of_all([(record["case"], record["benchmark"]) for record in members]))

#!/usr/bin/python3
"""How flat the choice of a constant is: what becomes of tracker and controller when each is taken 0.7 and 1.4 times.

Works in a copy of the tree, in which each number of a `constexpr double|float|int k... = NUMBER, k... = NUMBER;` of src/tracking and src/servo, and of a
`constexpr TYPE k... = {NUMBERS};`, asks for its value when the program starts. So all variants but a few come of one build: a constant
that has to be known when it is compiled (the size of an array) is built anew with another number. A count changes by at least one.
  tracker     bench_compare on the sequences that are given: images kept, lies, mean error of the worst corner; and bench_film on the regions of
              swept_regions.csv, so many images of each: share that says TRACKING, images that say so in one of the two runs only, and
              how far the worst corner lies from where it is with the numbers as they are (95 %)
  controller  simulate_servo on scenarios, several seeds: settled [s], rest [px], runs held and stopped, and how far a wrong picture
              leads the scope [degrees]
Prints a row of a table in Markdown for each constant: both results beside those of the numbers as they are. `=` stands for a result that is
the same to the last digit, `fails` for a program that ends otherwise than with 0. With --csv the rows are kept in a file, and what stands
there already is not measured again. An example:
  bench/sweep.py --work build/sweep --part tracker --data FILMS --csv bench/swept_tracker.csv [--only kFarOff]
"""
import argparse
import csv
import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys

import numpy as np

import footage  # beside this file, as the next one
from constants import DECLARATION, FOLDER, NUMBER, NUMBERS, numbers_of

TREE = pathlib.Path(__file__).resolve().parent.parent
COPIED = ["CMakeLists.txt", "package.xml", "nodelet_plugins.xml", "rviz_plugins.xml", "LICENSE", "cmake", "src", "include", "bench",
          "config", "msg", "srv", "launch", "linux", "scripts", "env-hooks", "rviz", "demo", "test/support"]
REGIONS = pathlib.Path(__file__).with_name("swept_regions.csv")
FACTORS = (0.7, 1.4)
SCENARIOS = {  # name: seeds
    "small_start": 5, "large_starts": 20, "breathing_rate_searched": 3, "effect_pulling": 3}
WRONG = {"effect_rolled_90": 10, "effect_mirrored": 10}
KEY = ("file", "constant", "is", "times")
VARIABLE = "LAPAROSCOPE_SERVO_SWEEP"  # of the environment: NAME=VALUE
ASKED = f'''#ifndef LAPAROSCOPE_SERVO_SWEPT
#define LAPAROSCOPE_SERVO_SWEPT
#include <cstdlib>
#include <cstring>
namespace laparoscope_servo {{
[[maybe_unused]] static double sweptConstant(const char* name, double usual) {{
  const char* swept = std::getenv("{VARIABLE}");
  const std::size_t length = std::strlen(name);
  return swept && std::strncmp(swept, name, length) == 0 && swept[length] == '=' ? std::atof(swept + length + 1) : usual;
}}
}}  // namespace laparoscope_servo
#endif
'''
FIXED = re.compile(r"the value of ‘(?:\w+::|\(anonymous namespace\)::|\{anonymous\}::)*(k\w+)’ is not usable in a constant expression")
ERROR = re.compile(r"^(/\S+):(\d+):\d+: error: ", re.MULTILINE)
NEEDED = re.compile(r"‘(?:[\w{}() ]+::)*(k\w+)’ (?:was not initialized with a constant expression|is not)")


class Failed(Exception):
    """A program that ended otherwise than with 0."""


def run(command, **options):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, **options)
    if done.returncode:
        raise Failed(f"{' '.join(map(str, command))}: exit {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


class Source:
    """A file of the copy, whose numbers ask for their values, but for those that have to be constants."""

    def __init__(self, original, copy):
        self.file, self.text = copy, original.read_text()
        self.name = str(original.relative_to(TREE / "src"))
        self.numbers = numbers_of(self.text)
        self.fixed = set()

    def label(self, constant):
        return f"{self.name}:{constant}"

    def write(self, changed=None, value=None):
        def asked(m):
            kind = m[2]
            indent = m[1][:len(m[1]) - len(m[1].lstrip())]
            statements = []
            for constant, number in NUMBER.findall(m[3]):
                if constant in self.fixed:
                    statements.append(f"{m[1]} {constant} = {value if constant == changed else number};")
                else:
                    asks = f'sweptConstant("{self.label(constant)}", {number})'
                    statements.append(f"{indent}static const {kind} {constant} = static_cast<{kind}>({asks});")
            return " ".join(statements)  # in one line, so that errors name the lines of the source
        def each_asked(m):
            numbers = (f'sweptConstant("{self.label(f"{m[3]}[{k}]")}", {number.strip()})' for k, number in enumerate(m[4].split(",")))
            return f"{m[1]}static const {m[2]} {m[3]} = {{{', '.join(numbers)}}};"
        text = NUMBERS.sub(each_asked, DECLARATION.sub(asked, self.text))
        first = text.index("\nnamespace ")  # behind what is included
        text = text[:first] + "\n" + ASKED + text[first:]
        self.file.parent.mkdir(parents=True, exist_ok=True)
        if not self.file.exists() or self.file.read_text() != text:
            self.file.write_text(text)


def other(kind, number, factor):
    if kind != "int":
        return repr(eval(number, {"__builtins__": {}}) * factor)  # an expression of numbers, by the pattern NUMBER
    value = int(number)
    return str(min(value - 1, round(value * factor)) if factor < 1 else max(value + 1, round(value * factor)))


class Tracker:
    targets = ("bench_compare", "bench_film")

    def __init__(self, arguments):
        self.sequences = arguments.sequence
        self.regions = footage.read_regions(arguments.regions, arguments.data) if arguments.data else []
        self.limit = arguments.limit
        self.usual = None
        if not self.sequences and not self.regions:
            sys.exit("tracker: expected --sequence, or --data, or both")

    def films(self, build, env):
        folder = build / "sweep_tables"
        folder.mkdir(exist_ok=True)
        tracks = []
        for region in self.regions:
            run([build / "bench/bench_film", region.film, "--roi", region.roi_text, "--from", region.first, "--limit", self.limit, "--rate",
                 footage.rate_of(region.film), "--tracker", "ours", "--tables", folder], env=env)
            tracks.append(footage.read_track(folder / "ours.csv"))
        self.usual = self.usual or tracks
        moved = np.concatenate([footage.apart(t.homography, u.homography, footage.corners(r.roi)).max(axis=-1)[t.tracking & u.tracking]
                                for t, u, r in zip(tracks, self.usual, self.regions)])
        return {"TRACKING": round(float(np.mean([t.tracking.mean() for t in tracks])), 4),
                "differ": sum(int(np.sum(t.tracking != u.tracking)) for t, u in zip(tracks, self.usual)),
                "moved px": round(float(np.quantile(moved, 0.95)), 2) if len(moved) else "-"}

    def measure(self, build, tree, env):
        result = {}
        if self.sequences:
            file = build / "sweep.json"
            run([build / "bench/bench_compare", "--tracker", "ours", "--json", file, *self.sequences], env=env)
            results = [sequence["trackers"][0] for sequence in json.loads(file.read_text())]
            result = {"kept": round(sum(r["kept"] for r in results)), "lies": round(sum(r["lies"] for r in results)),
                      "error px": " ".join(f"{r['error_mean']:.4f}" for r in results)}
        return {**result, **self.films(build, env)} if self.regions else result


class Controller:
    targets = ("laparoscope_servo_simulate_servo",)

    def __init__(self, arguments):
        pass

    def runs(self, build, tree, env, scenario, seeds):
        file = build / "sweep.csv"
        program = next(p for devel in (build / "devel", build.parent / "devel") for p in devel.rglob("simulate_servo") if p.is_file())
        parameters = [tree / "config" / f for f in ("controller.yaml", "simulate_servo.yaml", f"scenarios/{scenario}.yaml")]
        run([program, *[part for p in parameters for part in ("--params", p)], "--runs", seeds, "--summary", file], env=env)
        with file.open() as lines:
            return [{k: float(row[k]) for k in ("settled", "centre_rms", "holds", "stopped", "turned")} for row in csv.DictReader(lines)]

    def measure(self, build, tree, env):
        healthy = [row for scenario, seeds in SCENARIOS.items() for row in self.runs(build, tree, env, scenario, seeds)]
        wrong = [row for scenario, seeds in WRONG.items() for row in self.runs(build, tree, env, scenario, seeds)]
        return {"settled s": round(statistics.median(row["settled"] for row in healthy), 3),
                "rest px": round(statistics.median(row["centre_rms"] for row in healthy), 3),
                "holds": round(sum(row["holds"] for row in healthy)),
                "stops": sum(row["stopped"] >= 0 for row in healthy),
                "wrong stopped": sum(row["stopped"] >= 0 for row in wrong),
                "wrong, degrees": round(57.2958 * max(row["turned"] for row in wrong), 2)}


class Build:
    def __init__(self, arguments, targets):
        self.tree = (arguments.tree or arguments.work / "tree").resolve()
        self.folder = (arguments.build or arguments.work / "build").resolve()
        self.jobs, self.targets = arguments.jobs, targets
        files = [f for folder in FOLDER.values() for f in sorted((TREE / folder).rglob("*")) if f.suffix in (".h", ".cpp")]
        self.sources = [s for s in (Source(f, self.tree / f.relative_to(TREE)) for f in files) if s.numbers]
        swept = {s.file for s in self.sources}
        for name in COPIED:  # also over what an earlier sweep has written
            for file in [TREE / name] if (TREE / name).is_file() else TREE.joinpath(name).rglob("*"):
                copy = self.tree / file.relative_to(TREE)
                if file.is_file() and copy not in swept and not (copy.exists() and copy.read_bytes() == file.read_bytes()):
                    copy.parent.mkdir(parents=True, exist_ok=True)
                    shutil.copy(file, copy)
        if not arguments.build:
            for source in self.sources:
                source.write()
            run(["cmake", "-S", self.tree, "-B", self.folder, "-DLAPAROSCOPE_SERVO_BENCH=ON", "-DCATKIN_ENABLE_TESTING=OFF",
                 "-DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON", "-DPYTHON_EXECUTABLE=/usr/bin/python3", "-DPython3_EXECUTABLE=/usr/bin/python3"])

    def make(self):
        """Whether it compiled, and what the compiler said."""
        done = subprocess.run(["make", "-k", "-C", str(self.folder), f"-j{self.jobs}", *self.targets], capture_output=True, text=True,
                              env={**os.environ, "LC_ALL": "C.UTF-8"})
        return done.returncode == 0, done.stderr

    @staticmethod
    def named_where_it_fails(said):
        """The constants on the lines that the compiler complains of: of another file, as the size of an array."""
        lines = (pathlib.Path(file).read_text().splitlines()[int(line) - 1] for file, line in set(ERROR.findall(said)))
        return {name for line in lines for name in re.findall(r"\bk\w+", line)}

    def ask(self):
        """Makes every number ask, until only those are fixed without which it does not compile."""
        known = self.folder / "swept_fixed.txt"  # of an earlier sweep, which saves finding them by compiling
        names = set(known.read_text().split()) if known.is_file() else set()
        for source in self.sources:
            source.fixed = {name for name in source.numbers if source.label(name) in names}
        while True:
            for source in self.sources:
                source.write()
            compiled, said = self.make()
            if compiled:
                known.write_text("\n".join(source.label(name) for source in self.sources for name in sorted(source.fixed)))
                return
            names = set(FIXED.findall(said)) | set(NEEDED.findall(said))
            new = [(s, name) for s in self.sources for name in names & (set(s.numbers) - s.fixed) if f"{s.name}:" in said]
            new = new or [(s, name) for s in self.sources for name in self.named_where_it_fails(said) & (set(s.numbers) - s.fixed)]
            if not new:
                sys.exit(f"the copy does not compile:\n{said[-3000:]}")
            for source, name in new:
                source.fixed.add(name)


class Kept:
    """The file of --csv: rows of (file, constant, is, times) with their results."""

    def __init__(self, file):
        self.file, self.rows = file, {}
        if file and file.exists():
            with file.open() as lines:
                self.rows = {tuple(row[k] for k in KEY): row for row in csv.DictReader(lines)}

    def has(self, key):
        return key in self.rows

    def add(self, key, result):
        self.rows[key] = {**dict(zip(KEY, key)), **result}
        if not self.file:
            return
        columns = [*KEY, *(name for name in result)]
        with self.file.open("w") as lines:
            writer = csv.DictWriter(lines, columns, lineterminator="\n", restval="")
            writer.writeheader()
            writer.writerows(self.rows.values())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("build/sweep"), help="folder for the copy of the tree and its build")
    parser.add_argument("--tree", type=pathlib.Path, help="a copy of the tree that exists; its sources are written over")
    parser.add_argument("--build", type=pathlib.Path, help="the build of that copy, with the bench; saves building all of it anew")
    parser.add_argument("--part", choices=list(FOLDER), required=True)
    parser.add_argument("--sequence", action="append", default=[], help="folder with frames/, truth.csv, scene.json; may be repeated")
    parser.add_argument("--data", type=pathlib.Path, help="folder of films")
    parser.add_argument("--regions", type=pathlib.Path, default=REGIONS, help=f"table of regions of these films (default {REGIONS.name})")
    parser.add_argument("--limit", type=int, default=40, help="images of each film")
    parser.add_argument("--only", action="append", help="name of a constant; may be repeated")
    parser.add_argument("--under", action="append", help="of the part: a folder or a file, as align or align/quality.cpp; may be repeated, in this order")
    parser.add_argument("--one-build", action="store_true", help="leaves out constants that have to be known when they are compiled")
    parser.add_argument("--csv", type=pathlib.Path, help="file of rows; those that it has are not measured again")
    parser.add_argument("--jobs", default="2", help="of make")
    arguments = parser.parse_args()
    if bool(arguments.tree) != bool(arguments.build):
        parser.error("--tree and --build go together")
    part = {"tracker": Tracker, "controller": Controller}[arguments.part](arguments)
    build = Build(arguments, part.targets)
    build.ask()
    kept = Kept(arguments.csv)

    def measured(swept=""):
        return part.measure(build.folder, build.tree, {**os.environ, VARIABLE: swept, "OMP_NUM_THREADS": "1"})

    usual = measured()
    print("| constant | is | times |", " | ".join(usual), "|")
    print("| --- | --- | --- |", " | ".join("---" for _ in usual), "|")
    print("| as it is | | |", " | ".join(map(str, usual.values())), "|", flush=True)
    kept.add(("", "as it is", "", ""), usual)
    part_folder = FOLDER[arguments.part][len("src/"):] + "/"
    wanted = [part_folder + under for under in arguments.under or [""]]
    for source in [s for under in wanted for s in build.sources if s.name.startswith(under)]:
        for constant, (kind, number) in source.numbers.items():
            if (arguments.only and constant not in arguments.only) or (arguments.one_build and constant in source.fixed):
                continue
            for factor in FACTORS:
                key = (source.name, constant, number, str(factor))
                if kept.has(key):
                    continue
                value = other(kind, number, factor)
                try:
                    if constant in source.fixed:
                        source.write(constant, value)
                        compiled, _ = build.make()
                        result = measured() if compiled else dict.fromkeys(usual, "does not compile")
                    else:
                        result = measured(f"{source.label(constant)}={value}")
                except Failed:
                    result = dict.fromkeys(usual, "fails")
                cells = {name: "=" if result[name] == usual[name] else str(result[name]) for name in usual}
                kept.add(key, cells)
                print(f"| `{source.name}` {constant} | {number} | {factor} |", " | ".join(cells.values()), "|", flush=True)
            if constant in source.fixed:
                source.write()
                build.make()


if __name__ == "__main__":
    main()

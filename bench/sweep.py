#!/usr/bin/python3
"""How flat the choice of a constant is: what becomes of tracker and controller when each is taken 0.7 and 1.4 times.

Works in a copy of the tree, in which each `constexpr double|float|int k... = NUMBER;` of src/tracking and src/servo asks for its value
when the program starts. So all variants but a few come of one build: a constant that has to be known when it is compiled (the size
of an array) is built anew with another number. A count changes by at least one.
  tracker     bench_compare on the sequences that are given: images kept, lies, mean error of the worst corner; and bench_film on the regions of
              regions.csv, so many images of each: share that says TRACKING, images that say so in one of the two runs only, and
              how far the worst corner lies from where it is with the numbers as they are (95 %)
  controller  simulate_servo on scenarios, several seeds: settled [s], rest [px], runs held and stopped, and how far a wrong picture
              leads the scope [degrees]
Prints a row of a table in Markdown for each constant: both results beside those of the numbers as they are. `=` stands for a result that is
the same to the last digit. An example:
  bench/sweep.py --work build/sweep --part tracker --sequence FOLDER --data FILMS [--only kFarOff]
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

import footage  # beside this file

TREE = pathlib.Path(__file__).resolve().parent.parent
COPIED = ["CMakeLists.txt", "package.xml", "nodelet_plugins.xml", "rviz_plugins.xml", "LICENSE", "cmake", "src", "include", "bench",
          "config", "msg", "srv", "launch", "linux", "scripts", "env-hooks", "rviz", "demo"]
FACTORS = (0.7, 1.4)
SCENARIOS = {  # name: seeds
    "small_start": 5, "large_starts": 20, "breathing_rate_searched": 3, "effect_pulling": 3}
WRONG = {"effect_rolled_90": 10, "effect_mirrored": 10}
FOLDER = {"tracker": "src/tracking", "controller": "src/servo"}
NUMBER = re.compile(r"^( *)constexpr (double|float|int) (k\w+) =\s+([-+.0-9e]+)f?;", re.MULTILINE)
VARIABLE = "LAPAROSCOPE_SERVO_SWEEP"  # of the environment: NAME=VALUE
ASKED = f'''#include <cstdlib>
#include <cstring>
namespace laparoscope_servo {{
[[maybe_unused]] static double sweptConstant(const char* name, double usual) {{
  const char* swept = std::getenv("{VARIABLE}");
  const std::size_t length = std::strlen(name);
  return swept && std::strncmp(swept, name, length) == 0 && swept[length] == '=' ? std::atof(swept + length + 1) : usual;
}}
}}  // namespace laparoscope_servo
'''
FIXED = re.compile(r"the value of ‘(?:\w+::|\(anonymous namespace\)::|\{anonymous\}::)*(k\w+)’ is not usable in a constant expression")
NEEDED = re.compile(r"‘(?:[\w{}() ]+::)*(k\w+)’ (?:was not initialized with a constant expression|is not)")


def run(command, **options):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, **options)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}: exit {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


class Source:
    """A file of the copy, whose numbers ask for their values, but for those that have to be constants."""

    def __init__(self, file, tree):
        self.file, self.text = file, file.read_text()
        self.name = str(file.relative_to(tree / "src"))
        self.numbers = {m[3]: (m[2], m[4]) for m in NUMBER.finditer(self.text)}
        self.fixed = set()

    def label(self, constant):
        return f"{self.name}:{constant}"

    def write(self, changed=None, value=None):
        def asked(m):
            indent, kind, constant, number = m[1], m[2], m[3], m[4]
            if constant in self.fixed:
                return m[0][:m.start(4) - m.start()] + value + m[0][m.end(4) - m.start():] if constant == changed else m[0]
            return f'{indent}static const {kind} {constant} = static_cast<{kind}>(sweptConstant("{self.label(constant)}", {number}));'
        text = NUMBER.sub(asked, self.text)
        first = text.index("\nnamespace ")  # behind what is included
        text = text[:first] + "\n" + ASKED + text[first:]
        if not self.file.exists() or self.file.read_text() != text:
            self.file.write_text(text)


def other(kind, number, factor):
    if kind != "int":
        return repr(float(number) * factor)
    value = int(number)
    return str(min(value - 1, round(value * factor)) if factor < 1 else max(value + 1, round(value * factor)))


class Tracker:
    targets = ("bench_compare", "bench_film")

    def __init__(self, arguments):
        self.sequences = arguments.sequence
        self.regions = footage.read_regions(footage.REGIONS, arguments.data) if arguments.data else []
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
            return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(lines)]

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
        self.tree, self.folder = arguments.work.resolve() / "tree", arguments.work.resolve() / "build"
        self.jobs, self.targets = arguments.jobs, targets
        for name in COPIED:  # also over what an earlier sweep has written
            for file in [TREE / name] if (TREE / name).is_file() else TREE.joinpath(name).rglob("*"):
                copy = self.tree / file.relative_to(TREE)
                if file.is_file() and not (copy.exists() and copy.read_bytes() == file.read_bytes()):
                    copy.parent.mkdir(parents=True, exist_ok=True)
                    shutil.copy(file, copy)
        run(["cmake", "-S", self.tree, "-B", self.folder, "-DLAPAROSCOPE_SERVO_BENCH=ON", "-DCATKIN_ENABLE_TESTING=OFF",
             "-DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON", "-DPYTHON_EXECUTABLE=/usr/bin/python3", "-DPython3_EXECUTABLE=/usr/bin/python3"])
        sources = [Source(f, self.tree) for folder in FOLDER.values() for f in sorted((self.tree / folder).rglob("*.cpp"))]
        self.sources = [s for s in sources if s.numbers]

    def make(self):
        """Whether it compiled, and what the compiler said."""
        done = subprocess.run(["make", "-k", "-C", str(self.folder), f"-j{self.jobs}", *self.targets], capture_output=True, text=True,
                              env={**os.environ, "LC_ALL": "C.UTF-8"})
        return done.returncode == 0, done.stderr

    def ask(self):
        """Makes every number ask, until only those are fixed without which it does not compile."""
        while True:
            for source in self.sources:
                source.write()
            compiled, said = self.make()
            if compiled:
                return
            names = set(FIXED.findall(said)) | set(NEEDED.findall(said))
            new = [(s, name) for s in self.sources for name in names & (set(s.numbers) - s.fixed) if f"{s.name}:" in said]
            if not new:
                sys.exit(f"the copy does not compile:\n{said[-3000:]}")
            for source, name in new:
                source.fixed.add(name)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for the copy of the tree and its build")
    parser.add_argument("--part", choices=list(FOLDER), required=True)
    parser.add_argument("--sequence", action="append", default=[], help="folder with frames/, truth.csv, scene.json; may be repeated")
    parser.add_argument("--data", type=pathlib.Path, help="folder of the films of regions.csv")
    parser.add_argument("--limit", type=int, default=60, help="images of each film")
    parser.add_argument("--only", action="append", help="name of a constant; may be repeated")
    parser.add_argument("--jobs", default="2", help="of make")
    arguments = parser.parse_args()
    part = {"tracker": Tracker, "controller": Controller}[arguments.part](arguments)
    build = Build(arguments, part.targets)
    build.ask()

    def measured(swept=""):
        return part.measure(build.folder, build.tree, {**os.environ, VARIABLE: swept, "OMP_NUM_THREADS": "1"})

    usual = measured()
    print("| constant | is | times |", " | ".join(usual), "|")
    print("| --- | --- | --- |", " | ".join("---" for _ in usual), "|")
    print("| as it is | | |", " | ".join(map(str, usual.values())), "|", flush=True)
    for source in build.sources:
        if not source.name.startswith(FOLDER[arguments.part].removeprefix("src/")):
            continue
        for constant, (kind, number) in source.numbers.items():
            if arguments.only and constant not in arguments.only:
                continue
            for factor in FACTORS:
                value = other(kind, number, factor)
                if constant in source.fixed:
                    source.write(constant, value)
                    compiled, _ = build.make()
                    result = measured() if compiled else dict.fromkeys(usual, "does not compile")
                    source.write()
                else:
                    result = measured(f"{source.label(constant)}={value}")
                cells = ["=" if result[name] == usual[name] else str(result[name]) for name in usual]
                print(f"| `{source.name}` {constant} | {number} | {factor} |", " | ".join(cells), "|", flush=True)
            if constant in source.fixed:
                build.make()


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""How flat the choice of a constant is: what becomes of tracker and controller when each is taken 0.7 and 1.4 times.

Works in a copy of the tree: writes the changed number there, builds what it needs, measures, and puts the number back. A count
changes by at least one.
  tracker     bench_compare on the sequences that are given, this tracker alone: images kept, lies, mean error of the worst corner
  controller  simulate_servo on scenarios, several seeds: settled [s], rest [px], runs held and stopped, and how far a wrong picture
              leads the scope [degrees]
Prints a row of a table in Markdown for each constant: both results beside those of the number as it is. An example:
  bench/sweep.py --work build/sweep --part tracker --sequence FOLDER [--only kFarOff]
"""
import argparse
import csv
import json
import pathlib
import re
import statistics
import subprocess
import sys

TREE = pathlib.Path(__file__).resolve().parent.parent
COPIED = ["CMakeLists.txt", "package.xml", "nodelet_plugins.xml", "rviz_plugins.xml", "LICENSE", "cmake", "src", "include", "bench",
          "config", "msg", "srv", "launch", "linux", "scripts", "env-hooks", "rviz", "demo"]
FACTORS = (0.7, 1.4)
SCENARIOS = {  # name: seeds
    "small_start": 5, "large_starts": 20, "breathing_rate_searched": 3, "effect_pulling": 3}
WRONG = {"effect_rolled_90": 10, "effect_mirrored": 10}

# What doc/constants.md calls chosen, as far as it is a single number: folder or file, names.
CHOSEN = {
    "tracker": {
        "motion_filter.cpp": "kLearningTime kImagesOfDoubt kLongestGap kGuessedNoise",
        "align/quality.cpp": "kNearlyConverged kMinOfImage kRecordTime kMaxGainChange kGainChangeRate kEnoughBlocks kRecognised kNear "
                             "kMostOff kTelling kVisibleTelling kFewBlocks kMostlyVisible kUnproven kGoodZncc kGoodSigma",
        "align/region_aligner.cpp": "kNearOff kFarOff kMostOff kMostMissing kBlockVisible kGateShift",
        "align/block_matching.cpp": "kLargest kAround kFloor kMost kLeastEnergy kPeak kLead kApart kLeastValid",
        "align/shift_fit.cpp": "kRounds kPlace",
        "align/channel_choice.cpp": "kBrighter kNearly",
        "esm/esm.cpp": "kContraction kSlowest kSlow kLongest kSameLight",
        "esm/esm_level.cpp": "kLightBlocksAlong",
        "occlusion/occlusion_gates.cpp": "kGrowSaturated kLeastAgreed kLeastKept kLeastBetter kLeastFound kManyMore kAsBefore",
        "occlusion/colour_gate.cpp": "kDark",
        "occlusion/light_fit.cpp": "kMostClipped kIterations kLeastSigma kLeastWeight kLeastCorrelation",
    },
    "controller": {
        "prediction/harmonic_filter.cpp": "kSearchPeriod kMaxUnexplained kShorter kShortest kPeriods kSeededPeriods kLongMemory "
                                          "kSmallPart kShortMemory kUsual",
        "prediction/delay_estimator.cpp": "kCorrelated",
        "shaping/dead_zone.cpp": "kSteep",
        "shaping/hysteresis_band.cpp": "kFar",
        "safety/opposed_motion.cpp": "kLasts",
        "safety/effect_guard.cpp": "kJump kOnset kConfirmed kLeastReach",
        "safety/pose_watch.cpp": "kStampJitter kLastingJump kJumps kForgotten",
        "scope_servo.cpp": "kBlocked",
        "controller_implementation.cpp": "kSlowerAside kSlowest kSeen",
    },
}
FOLDER = {"tracker": "src/tracking", "controller": "src/servo"}
NUMBER = re.compile(r"(constexpr (double|float|int) (k\w+) =\s+)([-+.0-9e]+?)(f?;)")


def run(command, **options):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, **options)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}: exit {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def constants(tree, part):
    """File, name, text of the number and whether it is a count, of each number of the part that is swept."""
    for name, wanted in CHOSEN[part].items():
        file = tree / FOLDER[part] / name
        numbers = {found[3]: found for found in NUMBER.finditer(file.read_text())}
        missing = set(wanted.split()) - set(numbers)
        if missing:
            sys.exit(f"{file}: no constant {', '.join(sorted(missing))}, expected what doc/constants.md calls chosen")
        for constant in wanted.split():
            yield file, constant, numbers[constant][4], numbers[constant][2] == "int"


def changed(number, is_count, factor):
    if not is_count:
        return repr(float(number) * factor)
    value = int(number)
    return str(min(value - 1, round(value * factor)) if factor < 1 else max(value + 1, round(value * factor)))


class Tracker:
    target = "bench_compare"

    def __init__(self, arguments):
        self.sequences = arguments.sequence or sys.exit("--sequence: expected at least one folder")

    def measure(self, build, tree):
        file = build / "sweep.json"
        run([build / "bench/bench_compare", "--tracker", "ours", "--json", file, *self.sequences])
        results = [sequence["trackers"][0] for sequence in json.loads(file.read_text())]
        return {"kept": round(sum(result["kept"] for result in results)), "lies": round(sum(result["lies"] for result in results)),
                "error px": " ".join(f"{result['error_mean']:.4f}" for result in results)}


class Controller:
    target = "laparoscope_servo_simulate_servo"

    def __init__(self, arguments):
        pass

    def runs(self, build, tree, scenario, seeds):
        file = build / "sweep.csv"
        program = next(p for devel in (build / "devel", build.parent / "devel") for p in devel.rglob("simulate_servo") if p.is_file())
        parameters = [tree / "config" / f for f in ("controller.yaml", "simulate_servo.yaml", f"scenarios/{scenario}.yaml")]
        run([program, *[part for p in parameters for part in ("--params", p)], "--runs", seeds, "--summary", file])
        with file.open() as lines:
            return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(lines)]

    def measure(self, build, tree):
        healthy = [row for scenario, seeds in SCENARIOS.items() for row in self.runs(build, tree, scenario, seeds)]
        wrong = [row for scenario, seeds in WRONG.items() for row in self.runs(build, tree, scenario, seeds)]
        return {"settled s": round(statistics.median(row["settled"] for row in healthy), 3),
                "rest px": round(statistics.median(row["centre_rms"] for row in healthy), 3),
                "holds": round(sum(row["holds"] for row in healthy)),
                "stops": sum(row["stopped"] >= 0 for row in healthy),
                "wrong stopped": sum(row["stopped"] >= 0 for row in wrong),
                "wrong, degrees": round(57.2958 * max(row["turned"] for row in wrong), 2)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for the copy of the tree and its build")
    parser.add_argument("--part", choices=list(CHOSEN), required=True)
    parser.add_argument("--sequence", action="append", help="folder with frames/, truth.csv, scene.json; may be repeated")
    parser.add_argument("--only", action="append", help="name of a constant; may be repeated")
    parser.add_argument("--jobs", default="2", help="of make")
    arguments = parser.parse_args()
    part = {"tracker": Tracker, "controller": Controller}[arguments.part](arguments)
    tree, build = arguments.work.resolve() / "tree", arguments.work.resolve() / "build"
    if not tree.exists():
        tree.mkdir(parents=True)
        run(["cp", "-r", *[TREE / name for name in COPIED if (TREE / name).exists()], tree])
        run(["cmake", "-S", tree, "-B", build, "-DLAPAROSCOPE_SERVO_BENCH=ON", "-DCATKIN_ENABLE_TESTING=OFF",
             "-DPYTHON_EXECUTABLE=/usr/bin/python3", "-DPython3_EXECUTABLE=/usr/bin/python3"])

    def measured():
        run(["make", "-C", build, f"-j{arguments.jobs}", part.target])
        return part.measure(build, tree)

    usual = measured()
    print("| constant | is | times |", " | ".join(usual), "|")
    print("| --- | --- | --- |", " | ".join("---" for _ in usual), "|")
    print("| as it is | | |", " | ".join(map(str, usual.values())), "|", flush=True)
    for file, name, number, is_count in list(constants(tree, arguments.part)):
        if arguments.only and name not in arguments.only:
            continue
        text = file.read_text()
        for factor in FACTORS:
            other = changed(number, is_count, factor)
            file.write_text(NUMBER.sub(lambda m: m[1] + other + m[5] if m[3] == name else m[0], text))
            try:
                result = measured()
            finally:
                file.write_text(text)
            print(f"| `{file.stem}` {name} | {number} | {factor} |", " | ".join(map(str, result.values())), "|", flush=True)
    run(["make", "-C", build, f"-j{arguments.jobs}", part.target])


if __name__ == "__main__":
    main()

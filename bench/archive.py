#!/usr/bin/python3
"""What an archive of recordings costs (doc/archives.md): track_bag over one film at several sizes, and what the workflow adds to it.

  bench/archive.py --data FOLDER [--runs 5] [--sizes 256x256,1920x1080] [--lines 20000]

The film of --data is resized by ffmpeg (the package) in a temporary folder, and its region with it; for a region that is lost, all but its first
second is replaced by another film. The workspace has to be sourced. Prints
  a row per size: processor ms an image of decoding, of what remains (conversion, tracking, table), of both; images a second of one core; MB; and of
               both while the region is lost
  two cores    at the first and the last size: by how much two processes on two cores do more than one on one, by wall time and by processor time. The first is what counts, and
               says something on a machine that does nothing else; the second leaves out what others took
  workflow     processor s that a line takes beside its track_bag, and s of wall time, one line after the other
  dry run      processor s and MB of a plan of so many lines, where all is to be done, and of archive_status
Medians of the runs. The processor time of starting, selecting and one search is taken off the first rows.
"""
import argparse
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "scripts"))
from archive import files, manifest, plan, programs  # noqa: E402: what is beside this folder has to be found first

OTHER = "scope_withdrawn.mp4"
FILM, SIZE, ROI = "cholecystectomy_moving_camera.mp4", (1280, 720), (580, 180, 220, 340)
SIZES = "256x256,640x512,1280x720,1920x1080"
LENGTH, PERIOD = 10.0, 0.04  # s, of the film
FEW = ("--resume", "0.06", "--end", "0.1")  # the first image and the third, which is searched
LAST = ("--resume", str(LENGTH - 1.5 * PERIOD))  # the first image and the last: all between them are decoded only
SHORT_LINES = 20


def run(command):
    """Processor s, MB and wall s of a process with its children."""
    begin = time.monotonic()
    process = subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    said = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = programs.exit_status(status)
    if process.returncode:
        raise SystemExit(f"{command[0]} ended with {process.returncode}: {said.decode(errors='replace')[-500:]}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, time.monotonic() - begin


def resized(data, width, height, folder):
    """The film, and the one in which the region is lost; the region."""
    clip = folder / f"{width}x{height}.mp4"
    scale, encode = f"scale={width}:{height}:flags=lanczos", ["-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p"]
    run(["ffmpeg", "-v", "error", "-i", data / FILM, "-vf", scale, *encode, clip])
    joined = f"[0]trim=end=1,{scale},setsar=1[a];[1]trim=start=10:end=19,setpts=PTS-STARTPTS,{scale},setsar=1[b];[a][b]concat"
    run(["ffmpeg", "-v", "error", "-i", data / FILM, "-i", data / OTHER, "-filter_complex", joined, *encode, lost_in(clip)])
    x, y, w, h = (round(v * s) for v, s in zip(ROI, (width / SIZE[0], height / SIZE[1]) * 2))
    return clip, f"{x},{y},{w},{h}"


def lost_in(clip):
    return clip.with_name(f"lost_{clip.name}")


def track(clip, roi, table, *options):
    return [programs.program("track_bag"), clip, "--roi", roi, "--csv", table, *options]


def together(commands, cores):
    """Wall s and processor s of processes at the same time, each on its core."""
    begin = time.monotonic()
    running = [subprocess.Popen(list(map(str, command)), stderr=subprocess.DEVNULL, preexec_fn=lambda core=core: os.sched_setaffinity(0, {core}))
               for command, core in zip(commands, cores)]
    used = 0.0
    for process in running:
        usage = os.wait4(process.pid, 0)[2]
        used += usage.ru_utime + usage.ru_stime
    return time.monotonic() - begin, used


def size_row(clip, roi, folder, runs):
    table = folder / "images.csv"
    begun = statistics.median(run(track(clip, roi, table, *FEW))[0] for _ in range(runs))
    skipped = statistics.median(run(track(clip, roi, table, *LAST))[0] for _ in range(runs))
    whole = [run(track(clip, roi, table)) for _ in range(runs)]
    images = round(LENGTH / PERIOD)
    decoding, total = (1e3 * (value - begun) / (images - 3) for value in (skipped, statistics.median(cpu for cpu, *_ in whole)))
    second = round(1 / PERIOD)
    first = statistics.median(run(track(lost_in(clip), roi, table, "--end", "1"))[0] for _ in range(runs))
    lost = 1e3 * (statistics.median(run(track(lost_in(clip), roi, table))[0] for _ in range(runs)) - first) / (images - second)
    states = [row["state"] for row in files.read_table(table)][second:]
    print(f"{clip.stem:>10}: decoding {decoding:.2f} ms, the rest {total - decoding:.2f} ms, both {total:.2f} ms an image: {1e3 / total:.0f} images/s; "
          f"{max(mb for _, mb, _ in whole):.0f} MB; while it is lost (TRACKING in {states.count('1')} of {len(states)} images) {lost:.2f} ms", flush=True)


def two_cores(clip, roi, folder, runs):
    cores = sorted(os.sched_getaffinity(0))[:2]
    if len(cores) < 2:
        print("two cores: there is one only")
        return
    commands = [track(clip, roi, folder / f"{k}.csv") for k in range(2)]
    by_wall, by_cpu = [], []
    for _ in range(runs):
        alone, beside = together(commands[:1], cores), together(commands, cores)
        by_wall.append(2 * alone[0] / beside[0])
        by_cpu.append(2 * 2 * alone[1] / beside[1])
    print(f"two cores, {clip.stem}: {statistics.median(by_wall):.2f} of one by wall time, {statistics.median(by_cpu):.2f} by processor time", flush=True)


def workflow(archive, *options):
    return run(["/usr/bin/python3", "/usr/bin/snakemake", "--snakefile", ROOT / "workflow" / "Snakefile", "--profile", ROOT / "workflow" / "profiles" / "local",
                "--directory", archive, "--cores", "1", *options])


def overhead(clip, folder, runs):
    """A line more, from the difference of an archive of many short lines and one of a single one."""
    width, height = (int(v) for v in clip.stem.split("x"))
    spent = {}
    for count in (1, SHORT_LINES):
        for k in range(runs):
            rows = [{"case": f"{i}", "file": folder / f"{i}.mp4", "roi": f"{width // 3},{height // 3},{width // 3},{height // 3}", "end": 2 * PERIOD} for i in range(count)]
            for row in rows:
                if not row["file"].exists():
                    os.link(clip, row["file"])
            table, archive = folder / f"manifest_{count}.csv", folder / f"archive_{count}_{k}"
            files.write_table(table, manifest.COLUMNS, rows)
            run([ROOT / "scripts" / "archive_manifest", "plan", table, archive])
            cpu, _, wall = workflow(archive)
            tracked = sum(files.read_json(path)["cpu_seconds"] for path in (archive / "results" / "records").iterdir())
            spent.setdefault(count, []).append((cpu - tracked, wall - tracked))
    more = [(statistics.median(row[k] for row in spent[SHORT_LINES]) - statistics.median(row[k] for row in spent[1])) / (SHORT_LINES - 1) for k in range(2)]
    print(f"workflow: {more[0]:.2f} processor s a line beside its track_bag, {more[1]:.2f} s of wall time; {statistics.median(row[0] for row in spent[1]):.1f} "
          "processor s for an archive of one line", flush=True)


def dry_run(lines, folder):
    facts = {"bytes": "1", "modified": "1", "width": "1920", "height": "1080", "images": "180000", "rate": "25", "error": ""}
    rows = [{**dict.fromkeys(manifest.COLUMNS, ""), "case": f"case {k}", "file": f"/data/{k}.mp4", "roi": "1,2,30,40", "tracker": "region", "line": k, "facts": facts}
            for k in range(lines)]
    begin = time.process_time()
    plan.write(rows, folder / "many")
    written = time.process_time() - begin
    cpu, mb, wall = workflow(folder / "many", "--dry-run", "--quiet")
    status = run([ROOT / "scripts" / "archive_status", folder / "many"])
    print(f"{lines} lines: plan {written:.1f} s; dry run {cpu:.0f} s of processor, {wall:.0f} s of wall time, {mb:.0f} MB; archive_status {status[0]:.1f} s", flush=True)


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--data", type=pathlib.Path, required=True, help=f"folder with {FILM} and {OTHER}")
    p.add_argument("--runs", type=int, default=5)
    p.add_argument("--sizes", default=SIZES)
    p.add_argument("--lines", type=int, default=20000)
    a = p.parse_args()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="archive_"))
    try:
        clips = [resized(a.data, *(int(v) for v in size.split("x")), folder) for size in a.sizes.split(",")]
        for clip, roi in clips:
            size_row(clip, roi, folder, a.runs)
        for clip, roi in (clips[0], clips[-1]):
            two_cores(clip, roi, folder, a.runs)
        overhead(clips[0][0], folder, a.runs)
        dry_run(a.lines, folder)
    except programs.NotFound as error:
        raise SystemExit(str(error)) from error
    finally:
        shutil.rmtree(folder)


if __name__ == "__main__":
    main()

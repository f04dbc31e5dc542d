"""The workflow on one machine: what comes out, that it is the same in every way to run it, and what is run again after a failure."""
import ctypes
import gzip
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time

import pytest
from archive import files
from conftest import PATIENT, ROI, ROOT, call, plan, run, snakemake, write_clip

LONG = 1500  # images: some seconds of tracking, so that it can be killed in the middle
SOME = 800


def records(archive):
    return {path.stem: files.read_json(path) for path in (archive / "results" / "records").glob("*.json")}


def ids(archive):
    """Ids by case, in the order of the manifest."""
    return {row["case"]: row["id"] for row in files.read_table(archive / "private" / "key.csv")}


def times(archive):
    return {path.name: path.stat().st_mtime_ns for path in (archive / "results" / "records").iterdir()}


def wait_for(condition, seconds=120.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it did not come"
        time.sleep(0.05)


def processes(words):
    """Processes whose command line has all of these words: of this test alone, by the archive's or the file's path."""
    found = []
    for place in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            line = (place / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
        except OSError:
            continue
        if all(word in line for word in words):
            found.append(int(place.name))
    return found


@pytest.fixture(scope="module")
def done(clips, tmp_path_factory):
    """An archive with two whole recordings, one of them with two regions, and one that is cut off; it is only read."""
    folder = tmp_path_factory.mktemp("work")
    archive = plan(folder, [("first", clips / "a" / "whole.avi", ROI), ("first", clips / "a" / "whole.avi", "70,50,60,50"),
                            ("second", clips / "b" / "other.avi", ROI), ("third", clips / "c" / "cut.avi", ROI)])
    run(archive)
    return archive


def test_every_line_has_a_result(done):
    states = {row["case"]: records(done)[row["id"]]["state"] for row in files.read_table(done / "private" / "key.csv")}
    assert states == {"first": "done", "second": "done", "third": "damaged"}
    assert call("archive_status", done).splitlines()[-1] == "3 done, 1 damaged, 0 failed, 0 running, 0 interrupted, 0 waiting; 4 lines"
    for identity, record in records(done).items():
        with gzip.open(done / "results" / "images" / f"{identity}.csv.gz", "rt") as table:
            rows = table.read().splitlines()
        assert rows[0].startswith("id,frame,stamp,state,g00") and "processing_time" not in rows[0]
        assert len(rows) == record["images"] + 1 and all(row.startswith(identity + ",") for row in rows[1:])
        assert record["tracking_share"] == 1.0 and record["cpu_seconds"] > 0 and record["peak_mb"] > 0


def test_the_pages_show_every_line(done):
    index = (done / "results" / "index.html").read_text()
    for identity, record in records(done).items():
        assert identity in index and (done / "results" / "cases" / f"{record['case']}.html").read_text().count(f"<h2>{identity}") == 1
        assert f"{record['images']} results of the tracker" in (done / "results" / "lines" / f"{identity}.html").read_text() and f"thumbnails/{identity}.jpg" in index
    third = ids(done)["third"]
    assert all(index.index(third) < index.index(other) for other in records(done) if other != third), "what is damaged comes first"
    links = re.findall(r'(?:href|src)="([^"]*)"', index)
    assert links and all((done / "results" / link).is_file() for link in links), "nothing is fetched, and nothing is missing"


def test_a_second_run_does_nothing(done):
    before = times(done)
    assert "Nothing to be done" in run(done)
    assert times(done) == before


def test_by_hand_and_on_one_core_the_tables_are_the_same(done):
    before = {identity: record["sha256"] for identity, record in records(done).items()}
    one = ids(done)["second"]
    key = {row["id"]: row for row in files.read_table(done / "private" / "key.csv")}
    command = ["taskset", "-c", str(min(os.sched_getaffinity(0))), ROOT / "scripts" / "archive_track", done, one]
    subprocess.run(list(map(str, command)), check=True)
    assert records(done)[one]["sha256"] == before[one]
    from archive import programs, tracking
    table, packed = done / "by_hand.csv", done / "by_hand.csv.gz"
    subprocess.run([programs.program("track_bag"), key[one]["file"], "--roi", key[one]["roi"], "--csv", table], check=True)
    assert tracking.compress(table, packed, one) == before[one]


def test_a_broken_recording_is_a_result_and_does_not_stop_the_rest(tmp_path, clips):
    clip = write_clip(tmp_path / PATIENT / "clip.avi", 30)
    archive = plan(tmp_path, [("good", clips / "b" / "other.avi", ROI), ("bad", clip, ROI)])
    good, bad = ids(archive)["good"], ids(archive)["bad"]
    clip.write_bytes(b"overwritten behind the plan")
    run(archive)
    assert records(archive)[good]["state"] == "done" and records(archive)[bad]["state"] == "failed"
    said = call("archive_status", archive, status=1)
    assert f"{bad}: failed: 'RECORDING' cannot be opened as a video" in said and "1 done, 0 damaged, 1 failed" in said
    assert PATIENT not in said and str(clip) in call("archive_status", archive, "--names", status=1)
    assert bad in (archive / "results" / "index.html").read_text()
    write_clip(clip, 30)
    call("archive_status", archive, "--again")
    before = times(archive)
    run(archive)
    assert records(archive)[bad]["state"] == "done"
    assert times(archive)[f"{good}.json"] == before[f"{good}.json"], "the failed one alone is run again"


def test_no_reason_has_the_name_of_a_file(tmp_path, clips):
    wrong = tmp_path / PATIENT / "Jane.yaml"
    wrong.parent.mkdir()
    wrong.write_text("tracking: {esm: {max_iterations: many}}", encoding="utf-8")
    camera = tmp_path / PATIENT / "Jane_camera.yaml"
    camera.write_text("camera_matrix: many", encoding="utf-8")
    archive = plan(tmp_path, [{"case": "a", "file": clips / "a" / "whole.avi", "roi": ROI, "params": wrong},
                              {"case": "b", "file": clips / "b" / "other.avi", "roi": ROI, "camera_info": camera}])
    for identity in ids(archive).values():
        call("archive_track", archive, identity)
    reasons = {case: " ".join(records(archive)[identity]["reasons"]) for case, identity in ids(archive).items()}
    assert "PARAMS" in reasons["a"] and "CAMERA_INFO" in reasons["b"], reasons
    assert not any(name in text for text in reasons.values() for name in (PATIENT, "Jane", str(tmp_path)))


def test_a_corrected_region_is_tracked_again_and_nothing_else(tmp_path, clips):
    rows = [("a", clips / "a" / "whole.avi", ROI), ("b", clips / "b" / "other.avi", ROI)]
    archive = plan(tmp_path, rows)
    run(archive)
    before = times(archive)
    plan(tmp_path, [rows[0], ("b", clips / "b" / "other.avi", "66,50,60,50")])
    assert "its line was changed" in call("archive_status", archive)
    run(archive)
    after = times(archive)
    assert [name for name in after if after[name] != before[name]] == [f"{ids(archive)['b']}.json"]


def test_a_job_that_is_killed_is_run_again_and_nothing_else(tmp_path, clips):
    clip = write_clip(tmp_path / "long.avi", LONG)
    archive = plan(tmp_path, [("short", clips / "b" / "other.avi", ROI), ("long", clip, ROI)])
    short, long = ids(archive)["short"], ids(archive)["long"]
    process = snakemake(archive, "--cores", "1")
    wait_for(lambda: processes(["track_bag", str(clip)]))
    killed = processes(["track_bag", str(clip)])
    for number in killed:
        os.kill(number, signal.SIGKILL)
    text = process.communicate(timeout=600)[0].decode()
    assert process.returncode == 0, text
    assert "Trying to restart job" in text and text.count("\nrule track:") == 3, text
    assert records(archive)[long]["state"] == "done" and records(archive)[long]["images"] == LONG and records(archive)[short]["state"] == "done"
    assert not list((archive / "results").rglob("*.partial")) and not list((archive / "private" / "scratch").iterdir())


def test_after_the_machine_died_only_what_was_under_way_is_run_again(tmp_path, clips):
    clip = write_clip(tmp_path / "long.avi", LONG)
    archive = plan(tmp_path, [("short", clips / "b" / "other.avi", ROI), ("long", clip, ROI)])
    short, long = ids(archive)["short"], ids(archive)["long"]
    run(archive, f"results/records/{short}.json")
    process = snakemake(archive)
    wait_for(lambda: processes(["track_bag", str(clip)]))
    assert f"{long}: running: on " in call("archive_status", archive)
    os.killpg(process.pid, signal.SIGKILL)
    process.communicate()
    wait_for(lambda: not processes(["track_bag", str(clip)]))
    before = times(archive)
    said = call("archive_status", archive)
    assert f"{long}: interrupted" in said and "1 done, 0 damaged, 0 failed, 0 running, 1 interrupted, 0 waiting; 2 lines" in said
    run(archive, "--unlock")
    text = run(archive)
    assert text.count("\nrule track:") == 1 and records(archive)[long]["images"] == LONG
    assert not list((archive / "private" / "scratch").iterdir()), "nor is anything left of what was killed"
    assert times(archive)[f"{short}.json"] == before[f"{short}.json"]


@pytest.fixture
def small_disk(tmp_path):
    """A file system of 1 MB, and what makes it larger."""
    folder = tmp_path / "disk"
    folder.mkdir()
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.mount(b"tmpfs", os.fsencode(folder), b"tmpfs", 0, b"size=1m") != 0:
        pytest.skip(f"no file system can be mounted here: {os.strerror(ctypes.get_errno())}")
    yield folder, lambda: libc.mount(b"tmpfs", os.fsencode(folder), b"tmpfs", 32, b"size=100m")  # MS_REMOUNT
    libc.umount2(os.fsencode(folder), 2)


def test_a_full_disk_leaves_no_half_result(small_disk, tmp_path, clips):
    folder, enlarge = small_disk
    clip = write_clip(tmp_path / "long.avi", SOME)
    archive = plan(folder, [("short", clips / "b" / "other.avi", ROI), ("long", clip, ROI)])
    short, long = ids(archive)["short"], ids(archive)["long"]
    call("archive_track", archive, short)
    free = shutil.disk_usage(folder).free
    (folder / "others").write_bytes(b"x" * (free - 160_000))  # the table needs more: a row of it has some 300 bytes
    text = run(archive, "--restart-times", "0", status=1)
    assert "No space left on device" in text, text
    assert set(records(archive)) == {short} and records(archive)[short]["state"] == "done"
    assert {path.name for path in (archive / "results" / "images").iterdir()} == {f"{short}.csv.gz"}
    assert "1 done, 0 damaged, 0 failed, 0 running, 0 interrupted, 1 waiting; 2 lines" in call("archive_status", archive)
    before = times(archive)
    assert enlarge() == 0
    run(archive)
    assert records(archive)[long]["images"] == SOME and times(archive)[f"{short}.json"] == before[f"{short}.json"]

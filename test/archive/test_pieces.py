"""Recordings that are tracked in pieces: where they are cut, how the tables are joined, and that the numbers are the same in every way to run it."""
import csv
import gzip
import os
import shutil
import signal
import subprocess

import pytest
from archive import files, pieces
from conftest import ROI, ROOT, by_hand, call, plan, run, snakemake, write_clip
from test_workflow import ids, processes, records, wait_for

HEADER = b"frame,stamp,state,g00,g01,g02,g10,g11,g12,g20,g21,g22,visible_fraction,zncc,iterations,processing_time,corner_error,centre_error,gain,bias,reason\n"
BOX = (10.0, 20.0, 30.0, 40.0)
SHORT_PIECES = ("--pieces", "0.05", "--overlap", "1")  # of 3 s at most


def table(frames, state=1, shift=0.0, error=0.1):
    """Of a region that is `shift` px to the right of its place, at 10 images a second; `state` may be a function of the image."""
    lines = [b"%d,%g,%d,1,0,%g,0,1,0,0,0,1,1,1,5,0.001,%g,%g,1,0,\"a reason, with a comma\"\n" %
             (k, k / 10, state(k) if callable(state) else state, shift, error, error) for k in frames]
    return pieces.Rows(HEADER, lines)


def frames_of(rows):
    return [int(line.split(b",")[0]) for line in rows.lines]


@pytest.mark.parametrize("start, end, seconds, longest, expected", [
    ("", "", 0.0, 600.0, []), ("", "", 600.0, 600.0, []), ("", "", 7200.0, 0.0, []),
    ("", "", 1000.0, 600.0, [("", "500.000"), ("480.000", "")]),
    ("100", "1600", 1500.0, 600.0, [("", "600.000"), ("580.000", "1100.000"), ("1080.000", "1600")])])
def test_where_a_recording_is_cut(start, end, seconds, longest, expected):
    assert [(span["resume"], span["end"]) for span in pieces.spans(start, end, seconds, longest, 20.0)] == expected


def test_pieces_are_joined_at_the_last_image_that_both_track():
    before, after = table(range(0, 20), lambda k: 1 if k < 17 else 2), table(range(10, 30), lambda k: 2 if k < 13 else 1, shift=0.3)
    whole, joint = pieces.join(before, after, BOX)
    assert frames_of(whole) == list(range(30))
    assert whole.lines[:17] == before.lines[:17] and whole.lines[17:] == after.lines[7:]
    assert joint == {"time": 1.6, "apart": 0.3, "allowed": pytest.approx(3 * 0.1 * 2 ** 0.5, abs=1e-3)}


@pytest.mark.parametrize("before, after, words", [
    (table(range(20)), table(range(10, 30), shift=0.5), "0.50 px apart, and may be 0.42 px"),
    (table(range(20), error=float("inf")), table(range(10, 30)), "0.00 px apart, and may be inf px"),
    (table(range(20), 2), table(range(10, 30)), "in no image of the overlap"),
    (table(range(20)), table(range(10, 30), lambda k: 1 if k >= 20 else 2), "in no image of the overlap"),
    (table(range(20)), table(range(20, 30)), "in no image of the overlap")])
def test_what_cannot_be_joined_is_a_cut_where_the_first_one_ends(before, after, words):
    whole, joint = pieces.join(before, after, BOX)
    assert frames_of(whole) == list(range(30)) and whole.lines[:20] == before.lines
    assert words in joint["cut"] and joint["time"] == 1.9 and "apart" not in joint


def test_a_recording_that_breaks_off_leaves_later_pieces_empty():
    only_the_selection = table([0])
    whole, joints = pieces.join_all([table(range(20)), only_the_selection, only_the_selection], BOX)
    assert frames_of(whole) == list(range(20)) and all("cut" in joint for joint in joints)


def test_cuts_for_the_same_reason_are_one_text():
    joints = [{"time": 1.0, "cut": "no"}, {"time": 2.0, "apart": 0.1, "allowed": 1.0}, {"time": 3.04, "cut": "no"}, {"time": 4.0, "cut": "far"}]
    assert pieces.cuts(joints) == ["cut at 1.0, 3.0 s: no", "cut at 4.0 s: far"]


def test_an_image_that_one_piece_left_out_is_no_joint():
    before, after = table([k for k in range(20) if k != 19]), table([k for k in range(10, 30) if k != 18])
    whole, joint = pieces.join(before, after, BOX)
    assert joint["time"] == 1.7 and frames_of(whole) == [*range(18), *range(19, 30)]


@pytest.mark.parametrize("options, words", [(("--pieces", "0"), "more than 0"), (("--pieces", "nan"), "more than 0"),
                                            (("--pieces", "1", "--overlap", "31"), "at most half of a piece, 30.0 s"), (("--pieces", "1", "--overlap", "0"), "more than 0")])
def test_wrong_pieces_are_refused(tmp_path, options, words):
    assert words in call("archive_manifest", "plan", tmp_path / "m.csv", tmp_path / "archive", *options, status=2)


def test_the_table_is_the_same_by_hand_on_one_core_and_after_a_piece_was_killed(tmp_path):
    clip = write_clip(tmp_path / "clip.avi", 1000)
    archive = plan(tmp_path, [("a", clip, ROI)], "--pieces", "0.25", "--overlap", "2")
    identity = ids(archive)["a"]
    copy = tmp_path / "copy"
    shutil.copytree(archive, copy)
    process = snakemake(archive, "--cores", "2")
    wait_for(lambda: processes(["track_bag", str(clip), "--resume="]))
    for number in processes(["track_bag", str(clip), "--resume="])[:1]:
        os.kill(number, signal.SIGKILL)
    text = process.communicate(timeout=600)[0].decode()
    assert process.returncode == 0 and text.count("\nrule track_piece:") == 3 + 1 and text.count("\nrule track:") == 1, text
    command = ["taskset", "-c", str(min(os.sched_getaffinity(0))), ROOT / "scripts" / "archive_track", copy, identity]
    subprocess.run(list(map(str, command)), check=True)
    record = records(archive)[identity]
    assert record["sha256"] == records(copy)[identity]["sha256"]
    assert record["state"] == "done" and record["images"] == 1000 and record["joints"] == 2 and record["cuts"] == 0
    assert record["joint_px"] < 0.5 and record["tracking_share"] == 1.0
    with gzip.open(archive / "results" / "images" / f"{identity}.csv.gz", "rt") as rows:
        assert [int(row["frame"]) for row in csv.DictReader(rows)] == list(range(1000))
    for place in (archive, copy):
        assert not [path for folder in ("pieces", "running", "scratch") for path in (place / "private").glob(f"{folder}/*")]
    assert "Nothing to be done" in run(archive)


def test_another_plan_tracks_a_piece_again(tmp_path):
    clip = write_clip(tmp_path / "clip.avi", 150)
    archive = plan(tmp_path, [("a", clip, ROI)], *SHORT_PIECES)
    identity = ids(archive)["a"]
    call("archive_track", archive, identity, "--piece", "1")
    assert "the line has 2 pieces" in call("archive_track", archive, identity, "--piece", "2", status=2)
    log = archive / "private" / "logs" / f"{identity}.1.log"
    before = log.stat().st_mtime_ns
    plan(tmp_path, [("a", clip, "62,50,60,50")], *SHORT_PIECES)
    call("archive_track", archive, identity)
    assert records(archive)[identity]["images"] == 150 and records(archive)[identity]["cuts"] == 0 and log.stat().st_mtime_ns != before
    in_pieces = records(archive)[identity]["sha256"]
    plan(tmp_path, [("a", clip, "62,50,60,50")])
    assert "its line was changed" in call("archive_status", archive)
    call("archive_track", archive, identity)
    assert records(archive)[identity]["images"] == 150 and "joints" not in records(archive)[identity] and records(archive)[identity]["sha256"] != in_pieces


def test_a_cut_is_told(tmp_path):
    """The picture is another one in the second half: no piece finds the region there."""
    clip = write_clip(tmp_path / "two.avi", 200, other_from=100)
    archive = plan(tmp_path, [("a", clip, ROI)], *SHORT_PIECES)
    identity = ids(archive)["a"]
    by_hand(archive)
    record = records(archive)[identity]
    assert record["state"] == "done" and record["images"] == 200 and record["cuts"] >= 1
    assert "cut at" in call("archive_status", archive) and "cut at" in (archive / "results" / "index.html").read_text()
    assert files.read_table(archive / "results" / "lines.csv")[0]["cuts"] == str(record["cuts"])

"""archive_manifest: what it proposes, what it finds wrong, and what of the patients' names gets where."""
import os
import stat

import pytest
from archive import files, manifest
from conftest import PATIENT, ROI, call, plan, write_clip, write_manifest


def test_proposes_every_recording_and_names_the_broken_ones(clips, tmp_path):
    table = tmp_path / "manifest.csv"
    said = call("archive_manifest", "propose", clips, table)
    rows = files.read_table(table)
    assert [row["case"] for row in rows] == ["a/whole", "b/other", "c/cut"]
    assert all(row["tracker"] == "region" and len(row["roi"].split(",")) == 4 for row in rows)
    assert "noise.avi" in said and "1 left out" in said
    assert call("archive_manifest", "check", table).endswith("0 recordings were opened\n")
    assert "exists" in call("archive_manifest", "propose", clips, table, status=1)


def test_an_edited_film_has_a_line_for_each_scene(tmp_path):
    folder = tmp_path / "films"
    write_clip(folder / "edited.avi", 110, other_from=60)
    write_clip(folder / "short.avi", 70, other_from=60)
    write_clip(folder / "whole.avi", 30)
    said = call("archive_manifest", "propose", folder, tmp_path / "m.csv")
    rows = files.read_table(tmp_path / "m.csv")
    assert [(row["case"], row["start"], row["end"]) for row in rows] == [("edited", "", "2.380"), ("edited", "2.380", ""), ("short", "", "2.380"), ("whole", "", "")]
    assert all(len(row["roi"].split(",")) == 4 for row in rows)
    assert "edited.avi has 1 cuts" in said and "the scene at 2.38 s of" in said and "whole.avi has" not in said
    assert "nothing is wrong; 0 recordings were opened" in call("archive_manifest", "check", tmp_path / "m.csv")


def test_cuts_are_looked_for_when_they_are_asked_for(tmp_path):
    folder = tmp_path / "films"
    write_clip(folder / "edited.avi", 110, other_from=60)
    call("archive_manifest", "propose", folder, tmp_path / "m.csv", "--no-cuts")
    assert len(files.read_table(tmp_path / "m.csv")) == 1
    (tmp_path / "m.csv").unlink()
    call("archive_manifest", "propose", folder, tmp_path / "m.csv")
    assert len(files.read_table(tmp_path / "m.csv")) == 2, "that the film is known without its cuts is not enough"
    (tmp_path / "m.csv").unlink()
    said = call("archive_manifest", "propose", folder, tmp_path / "m.csv", "--no-cuts")
    assert len(files.read_table(tmp_path / "m.csv")) == 1 and "a line for each scene" not in said, "known cuts do not count either"


def test_a_changed_recording_is_opened_again(tmp_path):
    clip = write_clip(tmp_path / "a.avi", 10)
    table = write_manifest(tmp_path / "m.csv", [("a", clip, ROI)])
    assert "1 recordings were opened" in call("archive_manifest", "check", table)
    assert "0 recordings were opened" in call("archive_manifest", "check", table)
    write_clip(clip, 12)
    assert "1 recordings were opened" in call("archive_manifest", "check", table)


def test_all_that_is_wrong_is_told_at_once_with_its_line(clips, tmp_path):
    whole = clips / "a" / "whole.avi"
    rows = [{"case": "a", "file": whole, "roi": ROI},                                               # line 2: nothing
            {"case": "b", "file": clips / "nothing.avi", "roi": ROI},
            {"case": "c", "file": clips / "b" / "noise.avi", "roi": ROI},
            {"case": "a", "file": whole, "roi": "150,50,60,50"},
            {"case": "a", "file": whole, "roi": "1,2,3"},
            {"case": "a", "file": whole, "roi": ROI, "start": "soon"},
            {"case": "a", "file": whole, "roi": ROI, "start": "2", "end": "1"},
            {"case": "a", "file": whole, "roi": ROI, "start": "10"},
            {"case": "a", "file": whole, "roi": ROI},
            {"case": "z", "file": whole, "roi": "61,50,60,50"},
            {"case": "a", "file": whole, "roi": "62,50,60,50", "tracker": "magic"},
            {"case": "a", "file": whole, "roi": "63,50,60,50", "params": tmp_path / "none.yaml"},
            {"case": "", "file": "", "roi": ""}]
    said = call("archive_manifest", "check", write_manifest(tmp_path / "m.csv", rows), status=1).splitlines()
    expected = {3: "does not exist|No such file", 4: "noise.avi", 5: "outside of the image, which has 200 x 160 px", 6: "'1,2,3'", 7: "'soon'",
                8: "end is 1 s", 9: "the recording has 2.4 s", 10: "is line 2 again", 11: "line 2 calls it 'a'", 12: "'magic'", 13: "none.yaml", 14: "case is empty"}
    for number, words in expected.items():
        found = [line for line in said if f"m.csv:{number}: " in line]
        assert any(word in line for line in found for word in words.split("|")), (number, said)
    assert not any("m.csv:2: " in line for line in said)
    assert said[-1].endswith(f"{len(said) - 1} problems")


@pytest.mark.parametrize("text, words", [("case,roi\n", "no column file"), ("case,file,roi,colour\n", "'colour'"), ("", "no column case"),
                                         ("case,file,roi,roi\n", "twice"), ("case,file,roi\n", "no recording"), ("case,file,roi\na,b\n", "2 cells")])
def test_a_table_that_is_no_manifest(tmp_path, text, words):
    (tmp_path / "m.csv").write_text(text, encoding="utf-8")
    problems = manifest.Problems()
    assert manifest.read(tmp_path / "m.csv", problems) == []
    assert any(words in line for line in problems.lines("m.csv"))


def test_a_quoted_line_break_does_not_shift_the_lines(clips, tmp_path):
    (tmp_path / "m.csv").write_text(f'case,file,roi\n"two\nlines",{clips}/a/whole.avi,"{ROI}"\nb,{clips}/b/other.avi,nothing\n', encoding="utf-8")
    assert "m.csv:4: roi is 'nothing'" in call("archive_manifest", "check", tmp_path / "m.csv", status=1)


def test_names_stay_in_the_private_folder(clips, tmp_path):
    archive = plan(tmp_path, [("Doe, Jane", clips / "a" / "whole.avi", ROI), ("Doe, Jane", clips / "a" / "whole.avi", "70,50,60,50"),
                              ("other", clips / "b" / "other.avi", ROI)])
    shared = [path for path in archive.rglob("*") if path.is_file() and "private" not in path.parts]
    assert shared and not any(name in path.read_text() for path in shared for name in (PATIENT, "Doe", "whole", "other"))
    assert stat.S_IMODE(os.stat(archive / "private").st_mode) == 0o700
    assert stat.S_IMODE(os.stat(archive / "private" / "key.csv").st_mode) == 0o600
    key = files.read_table(archive / "private" / "key.csv")
    assert [row["case"] for row in key] == ["Doe, Jane", "Doe, Jane", "other"]
    assert key[0]["case_id"] == key[1]["case_id"] != key[2]["case_id"]


def test_ids_stay_and_only_changed_lines_are_written(clips, tmp_path):
    rows = [("a", clips / "a" / "whole.avi", ROI), ("b", clips / "b" / "other.avi", ROI)]
    archive = plan(tmp_path, rows)
    before = files.read_table(archive / "plan.csv")
    times = {path.name: path.stat().st_mtime_ns for path in (archive / "private" / "jobs").iterdir()}
    plan(tmp_path, [("new", clips / "c" / "cut.avi", ROI), rows[1], ("a", clips / "a" / "whole.avi", "64,50,60,50")])  # new, moved, corrected
    after = {row["id"]: row for row in files.read_table(archive / "plan.csv")}
    assert len(after) == 3 and {row["id"] for row in before} < set(after)
    changed = [path.name for path in (archive / "private" / "jobs").iterdir() if path.stat().st_mtime_ns != times.get(path.name)]
    assert sorted(changed) == sorted({f"{identity}.json" for identity in after} - {f"{before[1]['id']}.json"})
    plan(tmp_path, rows[1:])  # two are left out: their names stay in the key, for results that are kept
    assert len(files.read_table(archive / "plan.csv")) == 1 and len(list((archive / "private" / "jobs").iterdir())) == 1
    assert {row["case"]: bool(row["line"]) for row in files.read_table(archive / "private" / "key.csv")} == {"new": False, "b": True, "a": False}


def test_a_wrong_manifest_changes_nothing(clips, tmp_path):
    archive = plan(tmp_path, [("a", clips / "a" / "whole.avi", ROI)])
    before = (archive / "plan.csv").read_bytes()
    plan(tmp_path, [("a", clips / "nothing.avi", ROI)], status=1)
    assert (archive / "plan.csv").read_bytes() == before

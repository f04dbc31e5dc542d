"""The workflow on a real Slurm: one node on the loopback address. Skipped, and said so, where Slurm cannot be started."""
import shutil
import time

import pytest
import slurm_cluster
from archive import files
from conftest import ROI, by_hand, call, plan, run, snakemake, write_clip
from test_workflow import LONG, ids, records, wait_for


def ids_of(archive):
    return [row["id"] for row in files.read_table(archive / "plan.csv")]


def targets(archive):
    """The records of all lines: what is to be made, without the pages."""
    return [f"results/records/{identity}.json" for identity in ids_of(archive)]


@pytest.fixture(scope="module")
def slurm():
    try:
        with slurm_cluster.running() as cluster:
            yield cluster
    except slurm_cluster.CannotStart as error:
        pytest.skip(f"Slurm cannot be started here: {error}")


def test_the_results_are_those_of_one_machine(slurm, clips, tmp_path):
    long = write_clip(tmp_path / "long.avi", 150)
    rows = [("a", long, ROI), ("b", clips / "b" / "other.avi", ROI), ("c", clips / "c" / "cut.avi", ROI)]
    archive = plan(tmp_path, rows, "--pieces", "0.05", "--overlap", "1")
    copy = tmp_path / "copy"
    shutil.copytree(archive, copy)
    process, most = snakemake(archive, "--jobs", "2", profile="slurm"), 0
    while process.poll() is None:
        most = max(most, slurm.queued())
        time.sleep(0.2)
    text = process.stdout.read().decode()
    assert process.returncode == 0, text
    assert text.count("has been submitted with SLURM jobid") == 5, text  # three lines, one of them in two pieces; pages are made where snakemake runs
    assert most == 2, "no more jobs are in the queue at once than it was told"
    by_hand(copy)
    assert {i: r["sha256"] for i, r in records(archive).items()} == {i: r["sha256"] for i, r in records(copy).items()}
    assert call("archive_status", archive).splitlines()[-1].startswith("2 done, 1 damaged, 0 failed")


def test_data_sets_have_the_metrics_of_one_machine(slurm, tracked, planned):
    """Lines of SurgT, STIR, POT and Cholec80."""
    text = run(planned, profile="slurm")
    assert text.count("has been submitted with SLURM jobid") == len(ids_of(planned)), text
    assert {i: r["sha256"] for i, r in records(planned).items()} == {i: r["sha256"] for i, r in records(tracked).items()}
    name = "results/benchmarks.csv"
    assert (planned / name).read_bytes() == (tracked / name).read_bytes() and len(files.read_table(planned / name)) > 50


def test_a_drained_node_and_a_restarted_controller_lose_nothing(slurm, clips, tmp_path):
    clip = write_clip(tmp_path / "long.avi", LONG)
    archive = plan(tmp_path, [("a", clip, ROI), ("b", clips / "b" / "other.avi", ROI)])
    process = snakemake(archive, "--jobs", "1", *targets(archive), profile="slurm")
    wait_for(lambda: "running" in call("archive_status", archive))
    slurm.ask("scontrol", "update", f"NodeName={slurm.host}", "State=DRAIN", "Reason=test")
    wait_for(lambda: "drain" in slurm.node_state())
    slurm.stop("slurmctld")
    slurm.start("slurmctld")
    wait_for(lambda: "drain" in slurm.node_state())
    wait_for(lambda: "1 done" in call("archive_status", archive) or "running" in call("archive_status", archive))
    slurm.ask("scontrol", "update", f"NodeName={slurm.host}", "State=RESUME")
    text = process.communicate(timeout=600)[0].decode()
    assert process.returncode == 0, text
    assert len(records(archive)) == 2 and all(record["state"] == "done" for record in records(archive).values())
    assert "Trying to restart job" not in text, text

"""The workflow on a real Slurm: one node on the loopback address. Skipped, and said so, where Slurm cannot be started.

Slurm resolves no address where a machine has none but 127.0.0.1 (AI_ADDRCONFIG); `ip address add 127.0.0.2/8 dev lo` is enough then.
"""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time

import pytest
from conftest import ROI, call, plan, run, snakemake, write_clip
from test_workflow import LONG, ids, records, wait_for

CONFIG = """ClusterName=archive_test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
SchedulerParameters=sched_interval=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} RealMemory=8000 State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Slurm:
    """munged, slurmctld and slurmd of this test alone."""

    def __init__(self, folder):
        self.folder, self.host, self.running = folder, socket.gethostname().partition(".")[0], {}
        for name in ("state", "spool"):
            (folder / name).mkdir()
        self.key, self.config = folder / "munge.key", folder / "slurm.conf"
        self.key.write_bytes(os.urandom(128))
        self.key.chmod(0o600)
        self.config.write_text(CONFIG.format(folder=folder, host=self.host, controller_port=free_port(), node_port=free_port(),
                                             cores=len(os.sched_getaffinity(0))), encoding="utf-8")

    def start(self, name):
        command = {"munged": ["munged", "--foreground", "--force", f"--socket={self.folder}/munge.socket", f"--key-file={self.key}",
                              f"--pid-file={self.folder}/munged.pid", f"--log-file={self.folder}/munged.log", f"--seed-file={self.folder}/munge.seed"],
                   "slurmctld": ["slurmctld", "-D", "-f", str(self.config)],
                   "slurmd": ["slurmd", "-D", "-N", self.host, "-f", str(self.config)]}[name]
        command[0] = shutil.which(command[0], path="/usr/sbin:/usr/bin")
        self.running[name] = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def stop(self, name, number=signal.SIGTERM):
        process = self.running.pop(name, None)
        if process is not None:
            process.send_signal(number)
            try:
                process.wait(timeout=30)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    def ask(self, *command):
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=60, check=False)
        return done.stdout.decode().strip()

    def node_state(self):
        return self.ask("sinfo", "-h", "-o", "%T")

    def ends(self):
        for name in ("slurmd", "slurmctld", "munged"):
            self.stop(name)


def targets(archive):
    """The records of all lines: what is to be made, without the pages."""
    return [f"results/records/{identity}.json" for identity in ids(archive).values()]


@pytest.fixture(scope="module")
def slurm(tmp_path_factory):
    missing = [name for name in ("munged", "slurmctld", "slurmd", "sbatch") if shutil.which(name, path="/usr/sbin:/usr/bin") is None]
    if missing or os.getuid() != 0:
        pytest.skip(f"Slurm cannot be started here: {', '.join(missing) or 'this is not root'}")
    folder = tmp_path_factory.mktemp("slurm")
    for place in [folder, *folder.parents][:4]:
        place.chmod(0o755)  # munged refuses a socket that others cannot reach
    cluster = Slurm(folder)
    before = os.environ.get("SLURM_CONF")
    os.environ["SLURM_CONF"] = str(cluster.config)
    try:
        for name in ("munged", "slurmctld", "slurmd"):
            cluster.start(name)
        end = time.monotonic() + 60
        while "idle" not in cluster.node_state():
            if time.monotonic() > end:
                said = [path.read_text(errors="replace").strip().splitlines()[-1:] for path in sorted(folder.glob("*.log"))]
                pytest.skip(f"Slurm cannot be started here: {cluster.node_state().splitlines()[-1:]}, {said}")
            time.sleep(0.5)
        yield cluster
    finally:
        cluster.ends()
        if before is None:
            del os.environ["SLURM_CONF"]
        else:
            os.environ["SLURM_CONF"] = before


def test_the_results_are_those_of_one_machine(slurm, clips, tmp_path):
    rows = [("a", clips / "a" / "whole.avi", ROI), ("b", clips / "b" / "other.avi", ROI), ("c", clips / "c" / "cut.avi", ROI)]
    archive = plan(tmp_path, rows)
    copy = tmp_path / "copy"
    shutil.copytree(archive, copy)
    text = run(archive, profile="slurm")
    assert text.count("has been submitted with SLURM jobid") == 6, text  # three lines, three cases; the index is made where snakemake runs
    run(copy)
    assert {i: r["sha256"] for i, r in records(archive).items()} == {i: r["sha256"] for i, r in records(copy).items()}
    assert call("archive_status", archive).splitlines()[-1].startswith("2 done, 1 damaged, 0 failed")


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

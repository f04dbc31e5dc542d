"""The workflow on a real Slurm: one node on the loopback address. Skipped, and said so, where Slurm cannot be started.

Slurm resolves no address where a machine has none but 127.0.0.1 (AI_ADDRCONFIG); `ip address add 127.0.0.2/8 dev lo` is enough then.
"""
import contextlib
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import tempfile
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
SlurmdParameters=config_overrides
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
SchedulerParameters=sched_interval=2
MaxArraySize=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} RealMemory=8000 State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count):
    """Of TCP, all different: each is held until the last is known."""
    with contextlib.ExitStack() as held:
        sockets = [held.enter_context(socket.socket()) for _ in range(count)]
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]


class Slurm:
    """munged, slurmctld and slurmd of this test alone."""

    def __init__(self, folder):
        self.folder, self.host, self.running = folder, socket.gethostname().partition(".")[0], {}
        for name in ("state", "spool"):
            (folder / name).mkdir()
        self.key, self.config = folder / "munge.key", folder / "slurm.conf"
        self.key.write_bytes(os.urandom(128))
        self.key.chmod(0o600)
        controller_port, node_port = free_ports(2)
        self.config.write_text(CONFIG.format(folder=folder, host=self.host, controller_port=controller_port, node_port=node_port,
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
        try:
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=60, check=False)
        except subprocess.TimeoutExpired:
            return f"{command[0]} gets no answer"
        return done.stdout.decode().strip()

    def node_state(self):
        return self.ask("sinfo", "-h", "-o", "%T")

    def queued(self):
        return len(self.ask("squeue", "-h", "-t", "PENDING,RUNNING").splitlines())

    def begins(self):
        end = time.monotonic() + 60
        for name, ready in (("munged", (self.folder / "munge.socket").exists), ("slurmctld", lambda: True), ("slurmd", lambda: "idle" in self.node_state())):
            self.start(name)
            while not ready():
                ended = [name for name, process in self.running.items() if process.poll() is not None]
                if ended or time.monotonic() > end:
                    said = [line for path in sorted(self.folder.glob("*.log")) for line in path.read_text(errors="replace").splitlines()[-1:]]
                    pytest.skip(f"Slurm cannot be started here: {', '.join(ended) + ' ended' if ended else 'no node comes'}; {'; '.join(said)}")
                time.sleep(0.5)

    def ends(self):
        self.ask("scancel", "--user", "root")  # jobs of a test that failed
        for name in ("slurmd", "slurmctld", "munged"):
            self.stop(name)


def targets(archive):
    """The records of all lines: what is to be made, without the pages."""
    return [f"results/records/{identity}.json" for identity in ids(archive).values()]


@pytest.fixture(scope="module")
def slurm():
    missing = [name for name in ("munged", "slurmctld", "slurmd", "sbatch") if shutil.which(name, path="/usr/sbin:/usr/bin") is None]
    if missing or os.getuid() != 0:
        pytest.skip(f"Slurm cannot be started here: {', '.join(missing) or 'this is not root'}")
    folder = pathlib.Path(tempfile.mkdtemp(prefix="slurm_"))  # not among pytest's, which others cannot enter: munged refuses a socket there
    folder.chmod(0o755)
    cluster = Slurm(folder)
    before = os.environ.get("SLURM_CONF")
    os.environ["SLURM_CONF"] = str(cluster.config)
    try:
        cluster.begins()
        yield cluster
    finally:
        cluster.ends()
        if before is None:
            del os.environ["SLURM_CONF"]
        else:
            os.environ["SLURM_CONF"] = before
        shutil.rmtree(folder, ignore_errors=True)


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

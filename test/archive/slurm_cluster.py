"""A real Slurm of one node on the loopback address.

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


class CannotStart(Exception):
    """There is no Slurm on this machine, or it does not come up."""


class Slurm:
    """munged, slurmctld and slurmd of this process alone."""

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
                    raise CannotStart(f"{', '.join(ended) + ' ended' if ended else 'no node comes'}; {'; '.join(said)}")
                time.sleep(0.5)

    def ends(self):
        self.ask("scancel", "--user", "root")  # jobs of a test that failed
        for name in ("slurmd", "slurmctld", "munged"):
            self.stop(name)


@contextlib.contextmanager
def running():
    """A Slurm, to which sbatch and its like turn while it is there; raises CannotStart."""
    missing = [name for name in ("munged", "slurmctld", "slurmd", "sbatch") if shutil.which(name, path="/usr/sbin:/usr/bin") is None]
    if missing or os.getuid() != 0:
        raise CannotStart(f"{', '.join(missing)} missing" if missing else "this is not root")
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

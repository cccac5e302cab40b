"""A Slurm cluster of one machine on the loopback: its own munged, slurmctld and slurmd, by the user of the tests."""

import getpass
import os
import shutil
import socket
import subprocess
import tempfile
import time
from pathlib import Path

#: A credential's life, which is how long a requeued job waits: 120 s by default, and below 6 s.
EXPIRE_SECONDS = 6
SECONDS = 60
CONFIGURATION = """
ClusterName=skinglow
SlurmctldHost=localhost(127.0.0.1)
# Else both listen on all addresses.
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
SlurmctldPort={controller_port}
SlurmdPort={node_port}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire={expire}
CredType=cred/munge
SlurmUser={user}
SlurmdUser={user}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
MpiDefault=none
SwitchType=switch/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
JobAcctGatherType=jobacct_gather/none
JobRequeue=1
ReturnToService=2
NodeName=localhost NodeAddr=127.0.0.1 CPUs={cpus} RealMemory={memory} State=UNKNOWN
PartitionName=render Nodes=localhost Default=YES MaxTime=INFINITE State=UP
"""


class Cluster:
    """A context manager: started, idle, and gone at the end."""

    def __init__(self) -> None:
        for name in ("munged", "slurmctld", "slurmd", "sbatch"):
            assert shutil.which(name, path=self.path), (
                f"{name} is not there: scripts/setup --farms installs slurm and munge"
            )
        # Not pytest's folder: a socket's path may have 107 characters.
        self.folder = Path(tempfile.mkdtemp(prefix="slurm"))
        self.environment = {**os.environ, "PATH": self.path, "SLURM_CONF": str(self.folder / "slurm.conf")}
        self._running: list[subprocess.Popen] = []

    @property
    def path(self) -> str:
        return f"{os.environ['PATH']}:/usr/sbin:/sbin"

    def __enter__(self) -> "Cluster":
        try:
            self._start()
        except BaseException:
            self.__exit__()
            raise
        return self

    def _start(self) -> None:
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        ports = free_ports(2)
        text = CONFIGURATION.format(
            folder=self.folder,
            controller_port=ports[0],
            node_port=ports[1],
            user=getpass.getuser(),
            cpus=os.cpu_count(),
            memory=1000 * (os.cpu_count() or 1),
            expire=EXPIRE_SECONDS,
        )
        (self.folder / "slurm.conf").write_text(text)
        (self.folder / "munge.key").write_bytes(os.urandom(1024))
        (self.folder / "munge.key").chmod(0o600)
        files = {"socket": "munge.socket", "pid-file": "munge.pid", "log-file": "munge.log", "seed-file": "munge.seed"}
        options = [f"--{option}={self.folder / name}" for option, name in files.items()]
        self._daemon("munged", "--foreground", "--force", f"--key-file={self.folder}/munge.key", *options)
        self._wait("munged", lambda: (self.folder / "munge.socket").exists())
        self._daemon("slurmctld", "-D", "-c")
        self._daemon("slurmd", "-D")
        self._wait("slurmd", lambda: "idle" in self.run("sinfo", "-h", "-o", "%T", check=False))

    def _daemon(self, *command: str) -> None:
        log = (self.folder / f"{command[0]}.out").open("w")
        running = subprocess.Popen(command, env=self.environment, stdout=log, stderr=log, start_new_session=True)
        log.close()
        self._running.append(running)

    def _wait(self, name: str, is_there: object) -> None:
        until = time.monotonic() + SECONDS
        while not is_there():
            logs = {path.name: path.read_text()[-2000:] for path in self.folder.glob("*.[lo]*[gt]")}
            assert time.monotonic() < until and all(each.poll() is None for each in self._running), (name, logs)
            time.sleep(0.1)

    def run(self, *command: str, check: bool = True, **named: object) -> str:
        """The output of one of Slurm's commands."""
        done = subprocess.run(
            command, env=named.pop("env", self.environment), capture_output=True, text=True, timeout=SECONDS, **named
        )
        assert not check or done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    def __exit__(self, *_exception: object) -> None:
        if len(self._running) == 3:
            self.run("scancel", "--user", getpass.getuser(), check=False)
        for each in reversed(self._running):
            each.terminate()
        for each in self._running:
            try:
                each.wait(SECONDS)
            except subprocess.TimeoutExpired:
                each.kill()
                each.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


def free_ports(count: int) -> list[int]:
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports

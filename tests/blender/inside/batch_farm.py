"""Batches on a farm: several workers, locks, what is read once, exit codes, progress, paths of other machines."""

import contextlib
import errno
import io
import json
import os
import subprocess
import sys
import time
import types

import bpy
import skinglow_blender as sb
from skinglow_blender.batch import command, digests, locks, one_picture, render, worker
from skinglow_blender.batch.frames import parse_frames
from skinglow_blender.batch.manifest import Manifest, this_process

from inside.batch_studio import RIGS, manifest_of, names, raises, studio
from inside.batch_studio import expected as table_at
from inside.scenes import read_exr


@contextlib.contextmanager
def replaced(owner, name, value):
    before = getattr(owner, name)
    setattr(owner, name, value)
    try:
        yield
    finally:
        setattr(owner, name, before)


@contextlib.contextmanager
def variables(**values):
    before = dict(os.environ)
    os.environ.update(values)
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(before)


@contextlib.contextmanager
def windows(held_for=0):
    """Without fcntl, and with a stand-in for msvcrt that refuses a lock `held_for` times as Windows does."""
    calls = []

    def locking(_file, how, count):
        calls.append((how, count))
        if len(calls) <= held_for:
            raise OSError(errno.EDEADLK, "Resource deadlock avoided")

    before = sys.modules["fcntl"] if "fcntl" in sys.modules else None
    sys.modules["fcntl"] = None
    sys.modules["msvcrt"] = types.SimpleNamespace(locking=locking, LK_LOCK=1, LK_UNLCK=0)
    try:
        yield calls
    finally:
        del sys.modules["msvcrt"], sys.modules["fcntl"]
        if before is not None:
            sys.modules["fcntl"] = before


def check_locks(work):
    import fcntl

    path = work / "lock"
    with locks.locked(path) as is_locked:
        assert is_locked
        with path.open("ab") as other:
            try:
                fcntl.flock(other, fcntl.LOCK_EX | fcntl.LOCK_NB)
                raise AssertionError("another process would get the lock")
            except BlockingIOError:
                pass
    with path.open("ab") as other:
        fcntl.flock(other, fcntl.LOCK_EX | fcntl.LOCK_NB)
    with windows(held_for=2) as calls, locks.locked(path) as is_locked:
        assert is_locked and calls == [(1, 1)] * 3
    assert calls == [(1, 1)] * 3 + [(0, 1)]
    assert path.stat().st_size == 0

    def none(*_arguments):
        raise OSError(errno.ENOLCK, "No locks available")

    with replaced(fcntl, "flock", none):
        with locks.locked(path) as is_locked:
            assert not is_locked
        # Each process writes a manifest of its own then.
        folder = work / "no_locks"
        folder.mkdir()
        manifest = Manifest(folder)
        for line in range(2):
            assert manifest.append({"file": f"{line}"})
        Manifest(folder, "named").append({"file": "2"})
    assert names(folder.glob("*.jsonl"), folder) == sorted([f"manifest-{this_process()}.jsonl", "manifest-named.jsonl"])
    assert sorted(entry["file"] for entry in Manifest(folder).entries()) == ["0", "1", "2"]


def check_two_workers_with_the_same_frames_make_each_picture_once(work):
    """Another worker ends a picture before, and one while, this one renders it."""
    studio()
    folder = work / "twice"

    def other_worker(rig, frame):
        return sb.render_batch(folder, frame, [rig], worker="other")

    def in_between(step):
        if step.state == "RENDERED" and (step.rig, step.frame) == ("warm", 1):
            other_worker("warm", 2)

    make_picture = render.make_picture

    def slow(scene, frame, path, ready, publish):
        def late(partial, fields):
            if (ready.rig.name, frame) == ("warm", 3):
                with replaced(render, "make_picture", make_picture):
                    assert len(other_worker("warm", 3).rendered) == 1
            return publish(partial, fields)

        return make_picture(scene, frame, path, ready, late)

    with replaced(render, "make_picture", slow):
        result = sb.render_batch(folder, "1-3", ["warm"], worker="this", progress=in_between)
    assert names(result.rendered, folder) == ["warm/0001.exr"] and result.failed == ()
    assert names(result.kept, folder) == ["warm/0002.exr", "warm/0003.exr"]
    assert sorted(entry["file"] for entry in manifest_of(folder)) == [f"warm/000{n}.exr" for n in (1, 2, 3)]
    assert not list(folder.rglob("*.part*"))


def check_leftovers_of_workers_that_died(work):
    studio()
    folder = work / "leftovers"
    (folder / "warm").mkdir(parents=True)
    ended = subprocess.Popen([sys.executable if bpy.app.binary_path == "" else "true"], stdin=subprocess.DEVNULL)
    ended.wait()
    host = this_process().rpartition("-")[0]
    names_of = {
        "ended": f".0009.{host}-{ended.pid}.part.exr",
        "alive": f".0009.{host}-{os.getppid()}.part.exr",
        "elsewhere": ".0009.elsewhere-1.part.exr",
        "long ago": ".0008.elsewhere-1.part.exr",
    }
    for name in names_of.values():
        (folder / "warm" / name).write_bytes(b"part")
    before = time.time() - one_picture.STALE_SECONDS - 10.0
    os.utime(folder / "warm" / names_of["long ago"], (before, before))
    sb.render_batch(folder, 1, ["warm"])
    left = names((folder / "warm").glob(".*"), folder / "warm")
    assert left == sorted([names_of["alive"], names_of["elsewhere"]]), left


def check_inputs_are_read_once_a_job(work):
    studio()
    blend = work / "once.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(blend))
    folder = work / "once"
    read = []
    file_digest = digests.file_digest

    def count(path):
        read.append(path)
        return file_digest(path)

    with replaced(digests, "file_digest", count):
        sb.render_batch(folder, 1, ["warm"])
        # Just saved: its time would not tell that it was saved once more.
        sb.render_batch(folder, 2, ["warm"])
        assert read == [blend] * 2, read
        with replaced(digests, "COARSEST_TIME", 0.0):
            for frame in (1, 2, 3):
                assert sb.render_batch(folder, frame, ["warm"], worker=f"w{frame}").failed == ()
        assert read == [blend] * 3, read
        # Same size, same time: another file all the same.
        state = blend.stat()
        blend.write_bytes(blend.read_bytes())
        os.utime(blend, ns=(state.st_atime_ns, state.st_mtime_ns))
        assert len(sb.render_batch(folder, "1-3", ["warm"]).kept) == 3
        assert read == [blend] * 4, read
    with (folder / digests.NAME).open("a") as file:
        file.write('["cut sho')
    assert len(sb.render_batch(folder, "1-3", ["warm"]).kept) == 3
    (folder / digests.NAME).unlink()
    (folder / digests.NAME).mkdir()
    assert len(sb.render_batch(folder, "1-3", ["warm"]).kept) == 3


def check_names_of_workers(work):
    with variables(SLURMD_NODENAME="node 7/a"):
        assert worker.worker_name() == "node_7_a"
        with variables(DEADLINE_WORKER_ID="worker-0f"):
            assert worker.worker_name() == "worker-0f"
        studio()
        assert command.run(["--out", str(work / "slurm"), "--frames", "1", "--rigs", "warm"]) == 0
        assert command.run(["--out", str(work / "none"), "--frames", "1", "--rigs", "warm", "--worker="]) == 0
    assert names((work / "slurm").glob("*.jsonl"), work / "slurm") == ["manifest-node_7_a.jsonl"]
    assert names((work / "none").glob("*.jsonl"), work / "none") == ["manifest.jsonl"]
    assert worker.worker_name() == ""


def check_exit_codes_tell_whether_a_retry_helps(work):
    studio()
    options = ["--frames", "1", "--rigs", *RIGS]

    def code_after(error, where=render, name="make_picture"):
        def fail(*_arguments):
            raise error

        with replaced(where, name, fail):
            return command.run(["--out", str(work / "codes"), *options])

    assert code_after(RuntimeError("out of memory")) == 1
    assert code_after(OSError(errno.ENOSPC, "No space left on device")) == 1
    assert code_after(MemoryError()) == 1
    assert code_after(sb.SkinError("too bright")) == 3
    assert code_after(ValueError("NaN")) == 3
    assert code_after(OSError(errno.EACCES, "Permission denied"), Manifest, "check_writable") == 2
    assert code_after(OSError(errno.ESTALE, "Stale file handle"), Manifest, "check_writable") == 1
    assert code_after(KeyError("a fault of ours"), render, "require_health") == 1
    assert command.run(["--timeout=-1"]) == 2 and command.run(["--progress", "none"]) == 2
    assert command.run(["--out", str(work / "codes"), *options]) == 0


def told(arguments):
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        code = command.run(arguments)
    return code, out.getvalue().splitlines()


def check_lines_for_managers(work):
    studio()
    options = ["--frames", "1", "--rigs", *RIGS, "--out", str(work / "lines"), "--timeout", "600", "--progress"]
    code, lines = told([*options, "openjd"])
    assert code == 0 and [x for x in lines if "progress" in x] == ["openjd_progress: 50.0", "openjd_progress: 100.0"]
    assert [line.split(":")[:2] for line in lines if "status" in line] == [
        ["openjd_status", " [1/2] warm, frame 1"],
        ["openjd_status", " [2/2] cold, frame 1"],
    ]
    code, lines = told([*options, "openjd", "--rigs", "nobody"])
    assert code == 2 and lines[0].startswith("openjd_fail: Light rig 'nobody': "), lines
    files = [work / "lines" / rig / "0001.exr" for rig in RIGS]
    code, lines = told([*options, "flamenco"])
    assert lines == [f'skipping existing frame "{file}"' for file in files], lines
    code, lines = told([*options, "flamenco", "--again"])
    # 4.5 prints the time of each picture itself: past Python's standard output.
    ours = not (4, 5) <= bpy.app.version < (5, 0)
    assert lines[:: 1 + ours] == [f"Saved: '{file}'" for file in files], lines
    assert not ours or all(line.startswith("Time: 00:0") for line in lines[1::2]), lines


def check_paths_of_another_machine(work):
    here, there = work / "here", work / "there" / "show"
    here.mkdir()
    rig = {"skinglow_rig": 1, "lights": [{"kind": "POINT", "color": [0.5, 0.25, 0.125], "position": [0, 0, 1]}]}
    (here / "noon.json").write_text(json.dumps(rig))
    (here / "film.png").write_bytes(b"none")
    studio()
    bpy.data.libraries.write(str(here / "library.blend"), {bpy.data.materials["Black"]})
    with bpy.data.libraries.load(str(here / "library.blend"), link=True) as (_have, wanted):
        wanted.materials = ["Black"]
    image = bpy.data.images.new("film", 4, 4)
    image.source, image.filepath, image.use_fake_user = "FILE", str(there / "film.png"), True
    (library,) = bpy.data.libraries
    library.filepath = str(there / "library.blend")
    rules = {
        "version": "pathmapping-1.0",
        "path_mapping_rules": [
            {"source_path_format": "POSIX", "source_path": str(there.parent), "destination_path": "/nowhere"},
            {"source_path_format": "POSIX", "source_path": str(there), "destination_path": str(here)},
            {"source_path_format": "WINDOWS", "source_path": "Z:\\show", "destination_path": str(here)},
        ],
    }
    (work / "rules.json").write_text(json.dumps(rules))
    options = ["--frames", "1", "--out", str(work / "mapped"), "--path-mapping", str(work / "rules.json")]
    assert command.run([*options, "--rigs", f"a={there}/noon.json", "b=z:\\show\\noon.json", "warm"]) == 0
    assert image.filepath == str(here / "film.png") and library.filepath == str(here / "library.blend")
    for name in "ab":
        shown = read_exr(work / "mapped" / name / "0001.exr")[2, 2]
        assert abs(shown - table_at(((0.5, 0.25, 0.125), 1.0))).max() < 1e-5
    (work / "rules.json").write_text('{"path_mapping_rules": [{"source_path": "/a"}]}')
    assert command.run(options) == 2
    raises("path mapping rules", worker.PathMapping, work / "none.json")


def check_frames_as_farms_write_them(work):
    assert parse_frames("1-10:4, 20-20,7") == [1, 5, 9, 20, 7]

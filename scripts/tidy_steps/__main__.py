"""Runs clang-tidy over the files of a compile database, on all processors, over each file once.

A file that clang-tidy found nothing in is left out until what the compiler sees of it changes: a digest of its
preprocessed text, comments included (NOLINT is one), and of .clang-tidy is kept for it.
"""

import argparse
import concurrent.futures
import hashlib
import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

# Clang does not know every warning that GCC's commands carry.
EXTRA = "-Wno-unknown-warning-option"


def digest_of(entry: dict[str, str], settings: bytes) -> str:
    """Of what the database's own compiler sees of a file."""
    words, command, skip = shlex.split(entry["command"]), [], False
    for word in words:
        if not skip and word not in ("-c", "-MD", "-o", "-MT", "-MF"):
            command.append(word)
        skip = word in ("-o", "-MT", "-MF")
    command += ["-E", "-C"]
    text = subprocess.run(command, cwd=entry["directory"], capture_output=True, check=True).stdout
    return hashlib.sha256(settings + text).hexdigest()


def check(entry: dict[str, str], settings: bytes, clean: Path) -> str | None:
    """What clang-tidy said, "" for nothing; None for a file that was clean before."""
    digest = digest_of(entry, settings)
    kept = clean / hashlib.sha256(entry["file"].encode()).hexdigest()
    if kept.exists() and kept.read_text() == digest:
        return None
    command = ["clang-tidy", "-quiet", "-p", entry["database"], f"--extra-arg={EXTRA}", entry["file"]]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode == 0:
        kept.write_text(digest)
        return ""
    return done.stdout or done.stderr


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("database", type=Path, help="folder with compile_commands.json")
    parser.add_argument("clean", type=Path, help="folder for what is kept of clean files")
    parser.add_argument("pattern", help="files whose path matches this regular expression")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    arguments.clean.mkdir(parents=True, exist_ok=True)
    settings = Path(".clang-tidy").read_bytes()
    entries = {}
    for entry in json.loads((arguments.database / "compile_commands.json").read_text()):
        if re.search(arguments.pattern, entry["file"]):
            entries[entry["file"]] = {**entry, "database": str(arguments.database)}
    if not entries:
        sys.exit(f"no file of the compile database matches {arguments.pattern}")
    failed = checked = 0
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        found = [pool.submit(check, entry, settings, arguments.clean) for entry in entries.values()]
        for future in concurrent.futures.as_completed(found):
            said = future.result()
            checked += said is not None
            if said:
                failed += 1
                print(said, flush=True)
    print(f"clang-tidy: {len(entries)} files, {len(entries) - checked} clean as before, {failed} with faults")
    sys.exit(failed > 0)


main()

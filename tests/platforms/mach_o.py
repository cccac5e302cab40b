"""Reads of a macOS module what its loader would look at: what it needs, shows and binds, and its signature.

After Apple's loader.h, nlist.h and cs_blobs.h (64-bit, little-endian; signatures are big-endian).
"""

import hashlib
import re
import struct
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

MAGIC, SIGNATURE_MAGIC, CODE_DIRECTORY_MAGIC = 0xFEEDFACF, 0xFADE0CC0, 0xFADE0C02
SEGMENT, SYMTAB, DYLIB, DYLD_INFO, SIGNATURE, BUILD_VERSION = 0x19, 0x2, 0xC, 0x80000022, 0x1D, 0x32
UNDEFINED, DEFINED_IN_SECTION = 0x00, 0x0E
EXTERNAL, PRIVATE_EXTERNAL, DEBUGGING, TYPE = 0x01, 0x10, 0xE0, 0x0E
DYNAMIC_LOOKUP = 0xFE
ARCHITECTURES = {0x0100000C: "arm64", 0x01000007: "x86_64"}
BUNDLE, WEAK_DEFINES, BINDS_TO_WEAK = 8, 0x8000, 0x10000


@dataclass
class Module:
    """One Mach-O file of one architecture."""

    data: bytes
    architecture: str
    file_type: int
    flags: int
    libraries: list[str] = field(default_factory=list)
    minimum_macos: tuple[int, int] = (0, 0)
    imports: dict[str, int] = field(default_factory=dict)  #: by name, the number of the library, from 1
    exports: set[str] = field(default_factory=set)
    weak_bind_bytes: int = 0
    signature: tuple[int, int] | None = None  #: where, and how long


def read(path: Path) -> Module:
    data = path.read_bytes()
    magic, cpu, _, file_type, commands, _, flags = struct.unpack_from("<7I", data)
    if magic != MAGIC:
        raise ValueError(f"{path}: is no Mach-O of one 64-bit architecture ({magic:#x})")
    module = Module(data, ARCHITECTURES.get(cpu, hex(cpu)), file_type, flags)
    at = 32
    for _ in range(commands):
        command, size = struct.unpack_from("<2I", data, at)
        if command == DYLIB:
            (name,) = struct.unpack_from("<I", data, at + 8)
            module.libraries.append(text(data, at + name))
        elif command == BUILD_VERSION:
            _, least = struct.unpack_from("<2I", data, at + 8)
            module.minimum_macos = (least >> 16, least >> 8 & 0xFF)
        elif command == SYMTAB:
            module.imports = imports(data, *struct.unpack_from("<4I", data, at + 8))
        elif command == DYLD_INFO:
            numbers = struct.unpack_from("<10I", data, at + 8)
            module.weak_bind_bytes = numbers[5]
            module.exports = set(trie_names(data[numbers[8] : numbers[8] + numbers[9]]))
        elif command == SIGNATURE:
            module.signature = struct.unpack_from("<2I", data, at + 8)
        at += size
    return module


def text(data: bytes, at: int) -> str:
    return data[at : data.index(b"\0", at)].decode()


def imports(data: bytes, symbols: int, count: int, strings: int, _: int) -> dict[str, int]:
    found = {}
    for index in range(count):
        name, kind, _, description, _ = struct.unpack_from("<IBBHQ", data, symbols + 16 * index)
        if not kind & DEBUGGING and kind & TYPE == UNDEFINED and kind & EXTERNAL:
            found[text(data, strings + name)] = description >> 8
    return found


def defined_symbols(path: Path) -> set[str]:
    """Those that a library shows by its table of symbols."""
    data, found, at = path.read_bytes(), set(), 32
    for _ in range(struct.unpack_from("<I", data, 16)[0]):
        command, size = struct.unpack_from("<2I", data, at)
        if command == SYMTAB:
            symbols, count, strings, _ = struct.unpack_from("<4I", data, at + 8)
            for index in range(count):
                name, kind, *_ = struct.unpack_from("<IBBHQ", data, symbols + 16 * index)
                shown = kind & EXTERNAL and not kind & (PRIVATE_EXTERNAL | DEBUGGING)
                if shown and kind & TYPE == DEFINED_IN_SECTION:
                    found.add(text(data, strings + name))
        at += size
    return found


def trie_names(trie: bytes, at: int = 0, prefix: str = "") -> Iterator[str]:
    """The names in a trie of exports."""
    if not trie:
        return
    size, at = unsigned(trie, at)
    if size:
        yield prefix
    at += size
    children, at = trie[at], at + 1
    for _ in range(children):
        edge = text(trie, at)
        child, at = unsigned(trie, at + len(edge.encode()) + 1)
        yield from trie_names(trie, child, prefix + edge)


def unsigned(data: bytes, at: int) -> tuple[int, int]:
    """A ULEB128 number, and where the next thing is."""
    value = shift = 0
    while True:
        byte = data[at]
        value |= (byte & 0x7F) << shift
        at, shift = at + 1, shift + 7
        if not byte & 0x80:
            return value, at


def wrong_pages(module: Module) -> list[str]:
    """What is wrong with the signature, each page's digest computed anew."""
    if module.signature is None:
        return ["there is no signature"]
    at, length = module.signature
    magic, _, count = struct.unpack_from(">3I", module.data, at)
    if magic != SIGNATURE_MAGIC or at + length != len(module.data):
        return ["the signature is not the last thing in the file"]
    blobs = [struct.unpack_from(">2I", module.data, at + 12 + 8 * index)[1] for index in range(count)]
    directories = [
        at + blob for blob in blobs if module.data[at + blob :][:4] == CODE_DIRECTORY_MAGIC.to_bytes(4, "big")
    ]
    if len(directories) != 1:
        return [f"there are {len(directories)} code directories"]
    (start,) = directories
    hashes, _, _, pages, limit = struct.unpack_from(">5I", module.data, start + 16)
    digest_size, digest_type, _, page_bits = struct.unpack_from(">4B", module.data, start + 36)
    if (digest_size, digest_type, limit) != (32, 2, at):
        return [f"digests of {digest_size} bytes, type {digest_type}, for {limit} bytes of {at}"]
    page = 1 << page_bits
    wrong = [] if pages == -(-limit // page) else [f"{pages} pages of {page} bytes for {limit}"]
    for index in range(pages):
        held = module.data[start + hashes + 32 * index :][:32]
        if hashlib.sha256(module.data[index * page : min((index + 1) * page, limit)]).digest() != held:
            wrong.append(f"page {index}")
    return wrong


def listed_symbols(tbd: Path) -> set[str]:
    """What a system's library has, by Apple's text of it (any architecture)."""
    lists = re.findall(r"symbols:\s*\[(.*?)\]", tbd.read_text(), re.DOTALL)
    return {name.strip("' \n") for names in lists for name in names.split(",")}

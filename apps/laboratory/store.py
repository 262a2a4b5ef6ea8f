"""Results of steps in files: a step whose file exists is not done again."""

import contextlib
import fcntl
import functools
import hashlib
import json
import os
import pathlib
import sys
from typing import Any, Callable, Iterator

Path = pathlib.Path


class LabError(Exception):
    """What cannot be used as given; its text is for people."""


def log(text: str) -> None:
    print(f"laboratory: {text}", file=sys.stderr, flush=True)


def hash_of(value: Any) -> str:
    """Sixteen hexadecimal digits of anything that JSON can hold."""
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()[:16]


def file_hash(path: Path) -> str:
    """Sixteen hexadecimal digits of a file's content."""
    state = path.stat()
    return _hash_of_content(path, state.st_mtime_ns, state.st_size)


@functools.lru_cache(maxsize=None)
def _hash_of_content(path: Path, _changed: int, _size: int) -> str:
    with open(path, "rb") as file:
        digest = hashlib.sha256()
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()[:16]


@contextlib.contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """A temporary name of the same extension, which becomes `path` when all went well."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.stem}.new{path.suffix}")
    try:
        yield temporary
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="")


def read_result(path: Path) -> Any:
    """What a step left, or None: the file is not there or is none of a step."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


def kept(folder: Path, name: str, inputs: Any, work: Callable[[], Any]) -> Any:
    """The result of `work`: from FOLDER/steps/NAME-HASH.json where that exists; HASH is that of `inputs`."""
    path = folder / "steps" / f"{name}-{hash_of(inputs)}.json"
    result = read_result(path)
    if result is None:
        log(name)
        result = work()
        write_text(path, json.dumps(result, indent=1) + "\n")
    return result


@contextlib.contextmanager
def locked(folder: Path) -> Iterator[None]:
    """One process at a time has a folder."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    except OSError as failure:
        raise LabError(f"{folder}: the folder cannot be made: {failure.strerror}") from failure
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise LabError(f"{folder}: another process is writing to this folder; wait for it, stop it, or name "
                           "another folder") from None
        yield
    finally:
        os.close(handle)

"""Files are written whole or not at all, and read only if they are files."""

from __future__ import annotations

import errno
import os
import resource
import stat
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from permissions import open_folder, without_root
from pinik.files import FileError, check_writable, read_within, write_whole
from start_up import unmeasured

OLD, NEW = b"what was there before", b"something new" * 1000


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "file"
    path.write_bytes(OLD)
    return path


def test_a_new_file_has_the_content_and_the_permissions_of_the_umask(tmp_path):
    before = os.umask(0o027)
    try:
        write_whole(tmp_path / "new", NEW)
    finally:
        os.umask(before)
    assert (tmp_path / "new").read_bytes() == NEW
    assert stat.S_IMODE((tmp_path / "new").stat().st_mode) == 0o640


def test_a_file_that_is_replaced_keeps_its_permissions_and_leaves_nothing_beside_it(file):
    file.chmod(0o604)
    write_whole(str(file), NEW)
    assert (file.read_bytes(), stat.S_IMODE(file.stat().st_mode)) == (NEW, 0o604)
    assert list(file.parent.iterdir()) == [file]


def test_a_link_stays_a_link(file):
    link, hanging = file.with_name("link"), file.with_name("hanging")
    link.symlink_to(file.name)
    hanging.symlink_to("made")
    write_whole(link, NEW)
    write_whole(hanging, NEW)
    assert (link.is_symlink(), file.read_bytes()) == (True, NEW)
    assert (hanging.is_symlink(), file.with_name("made").read_bytes()) == (True, NEW)


def test_a_pipe_gets_the_content_and_stays_a_pipe(tmp_path):
    pipe, got = tmp_path / "pipe", []
    os.mkfifo(pipe)
    reader = threading.Thread(target=lambda: got.append(pipe.read_bytes()))
    reader.start()
    write_whole(pipe, NEW)
    reader.join(timeout=30)
    assert (got, stat.S_ISFIFO(pipe.stat().st_mode)) == ([NEW], True)


@pytest.mark.skipif(not os.path.exists("/dev/fd"), reason="needs /dev/fd")
def test_an_open_pipe_is_written_through_its_link():
    reading, writing = os.pipe()
    try:
        check_writable(Path(f"/dev/fd/{writing}"))
        write_whole(f"/dev/fd/{writing}", OLD)
        assert os.read(reading, 1000) == OLD
    finally:
        os.close(reading)
        os.close(writing)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
def test_a_device_is_written_directly_and_its_error_is_raised():
    write_whole(os.devnull, NEW)
    with pytest.raises(OSError, match="No space left"):
        write_whole("/dev/full", NEW)
    assert stat.S_ISCHR(os.stat("/dev/full").st_mode)


def test_a_disk_that_is_full_midway_leaves_the_old_file(file):
    """As far as a process sees, a limit of file sizes is a disk that becomes full."""
    code = f"from pinik.files import write_whole; write_whole({str(file)!r}, {len(NEW)} * b'x')"
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000)),
        env=unmeasured(os.environ) | {"PYTHONDONTWRITEBYTECODE": "1"},
    )
    assert "File too large" in done.stderr
    assert file.read_bytes() == OLD
    assert list(file.parent.iterdir()) == [file]


@pytest.mark.parametrize("step", ["fsync", "replace"])
@pytest.mark.parametrize("fault", [OSError(errno.ENOSPC, "full"), KeyboardInterrupt()])
def test_whatever_ends_it_midway_the_old_file_is_there_and_nothing_else(file, monkeypatch, step, fault):
    def fail(*_):
        raise fault

    monkeypatch.setattr(os, step, fail)
    with pytest.raises(type(fault)):
        write_whole(file, NEW)
    assert file.read_bytes() == OLD
    assert list(file.parent.iterdir()) == [file]


def test_a_reader_never_sees_half_a_file(file):
    contents = [bytes([letter]) * 200_000 for letter in b"abcdef"]
    writer = threading.Thread(target=lambda: [write_whole(file, content) for content in contents * 5])
    write_whole(file, contents[-1])
    writer.start()
    seen = {file.read_bytes()}
    while writer.is_alive():
        seen.add(file.read_bytes())
    assert seen <= set(contents)


def test_places_that_cannot_be_written_are_known_before_and_refused_after(tmp_path):
    loop = tmp_path / "loop"
    loop.symlink_to(loop)
    for place, number in ((tmp_path, errno.EISDIR), (tmp_path / "no" / "file", errno.ENOENT), (loop, errno.ELOOP)):
        for write in (check_writable, lambda path: write_whole(path, NEW)):
            with pytest.raises(OSError) as caught:  # noqa: PT011 - its number is compared
                write(place)
            assert (caught.value.errno, caught.value.filename) == (number, str(place))  # not the draft beside it
    for place in (tmp_path / "new", Path(os.devnull)):
        check_writable(place)
    assert list(tmp_path.iterdir()) == [loop]


def test_protected_files_and_folders_are_not_replaced():
    with open_folder() as folder:
        file = folder / "protected"
        file.write_bytes(OLD)
        for file_mode, folder_mode in ((0o444, 0o777), (0o666, 0o555)):
            file.chmod(file_mode)
            folder.chmod(folder_mode)
            for write in (check_writable, lambda path: write_whole(path, NEW)):
                with without_root(), pytest.raises(PermissionError):
                    write(file)
        folder.chmod(0o755)
        assert file.read_bytes() == OLD


def test_only_regular_files_of_a_bounded_size_are_read(file, tmp_path):
    assert read_within(file, len(OLD), "a cache") == OLD
    os.mkfifo(tmp_path / "pipe")
    for path, most in ((file, len(OLD) - 1), (tmp_path / "pipe", 9), (Path("/dev/zero"), 9), (tmp_path, 9)):
        with pytest.raises(FileError, match=r"too large for a cache|(pipe or a device|directory), not a cache"):
            read_within(path, most, "a cache")

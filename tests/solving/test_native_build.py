"""How the compiled engine is built: parts of its source, compiled by themselves with the compiler of this machine."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[2] / "src" / "native"
COMPILER = shutil.which(os.environ.get("CXX", "c++"))
CMAKE = shutil.which("cmake")

needs_compiler = pytest.mark.skipif(COMPILER is None, reason="no C++ compiler")

# Stands in for Eigen, of which the header under test only reads these macros.
EIGEN = """
#ifndef EIGEN_MAX_ALIGN_BYTES
#define EIGEN_MAX_ALIGN_BYTES 16
#endif
#define EIGEN_MAX_STATIC_ALIGN_BYTES EIGEN_MAX_ALIGN_BYTES
#ifndef EIGEN_MALLOC_ALREADY_ALIGNED
#define EIGEN_MALLOC_ALREADY_ALIGNED 1
#endif
"""

POOL = r"""
#include "solving/pool.hpp"

#include <cstdio>
#include <cstdlib>
#include <new>

std::atomic<long> allocations{0};
std::atomic<long> failing{-1};  // the first allocation that fails; all later ones fail as well

void* operator new(std::size_t size) {
  const long number = allocations++;
  if (failing >= 0 && number >= failing) throw std::bad_alloc();
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

// Counts to `count` in eight threads, each of which needs memory of its own. Returns whether that ended with bad_alloc.
bool count_to(int count, std::atomic<int>& counted) {
  std::atomic<int> next{0};
  std::atomic<bool> stop{false};
  try {
    pinik::share(
        8, stop,
        [&] {
          return [&, own = std::make_unique<int>()] {
            const std::vector<int> more(100);
            while (!stop && next++ < count) ++counted;
          };
        },
        [] { return true; });
  } catch (const std::bad_alloc&) {
    return true;
  }
  return false;
}

int main() {
  int completed = 0;
  for (long first = 0; first < 60; ++first) {
    std::atomic<int> counted{0};
    allocations = 0;
    failing = first;
    const bool refused = count_to(1000, counted);
    failing = -1;
    if (!refused && counted != 1000) return 1;
    completed += !refused;
  }
  std::atomic<bool> stop{false};
  try {  // whatever a thread throws arrives here, after all threads have ended
    pinik::share(4, stop, [] { return [] { throw 42; }; }, [] { return true; });
    return 2;
  } catch (int thrown) {
    if (thrown != 42) return 3;
  }
  stop = false;
  const auto wait = [&] {
    while (!stop) std::this_thread::yield();
  };
  pinik::share(4, stop, [&] { return wait; }, [] { return false; });
  pinik::share(0, stop, [&] { return wait; }, [] { return true; });
  std::printf("%d of 60 completed\n", completed);
}
"""


def compile_alignment(folder: Path, *flags: str) -> subprocess.CompletedProcess[str]:
    """Compile a file that includes nothing but the header that checks the alignment."""
    (folder / "Eigen").mkdir()
    (folder / "Eigen" / "Core").write_text(EIGEN)
    (folder / "one.cpp").write_text('#include "model/alignment.hpp"\n')
    command = [COMPILER, "-std=c++17", "-fsyntax-only", f"-I{folder}", f"-I{SOURCE}", *flags, folder / "one.cpp"]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@needs_compiler
def test_the_engine_compiles_with_the_alignment_of_pinocchios_libraries(tmp_path):
    done = compile_alignment(tmp_path)
    assert done.returncode == 0, done.stderr


@needs_compiler
@pytest.mark.parametrize(
    ("flag", "words"),
    [
        ("-D__AVX__", "pinik must be compiled without -march=native, -mavx"),  # as -mavx defines it on x86-64
        ("-DEIGEN_MAX_ALIGN_BYTES=32", "pinik must be compiled with Eigen's default alignment of 16 bytes"),
        ("-DEIGEN_MAX_ALIGN_BYTES=0", "pinik must be compiled with Eigen's default alignment of 16 bytes"),
        ("-DEIGEN_MALLOC_ALREADY_ALIGNED=0", "Eigen takes memory from malloc as it is"),  # what ASan makes of it
    ],
)
def test_a_flag_that_changes_the_alignment_is_refused_in_words(tmp_path, flag, words):
    done = compile_alignment(tmp_path, flag)
    assert done.returncode != 0
    assert words in done.stderr


@needs_compiler
def test_threads_that_run_out_of_memory_end_in_an_exception_and_not_with_the_process(tmp_path):
    """Memory is refused from the first allocation on, then from the second on, and so on, in whichever thread it is."""
    (tmp_path / "pool.cpp").write_text(POOL)
    program = tmp_path / "pool"
    command = [COMPILER, "-std=c++17", "-O1", "-pthread", f"-I{SOURCE}", tmp_path / "pool.cpp", "-o", program]
    subprocess.run(command, check=True)
    done = subprocess.run([program], capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 0, done.stderr
    completed = int(done.stdout.split()[0])
    assert 0 < completed < 60  # some refusals came in time, others after all threads had what they need


@pytest.mark.skipif(CMAKE is None, reason="no CMake")
@pytest.mark.parametrize(("system", "origin"), [("", "$ORIGIN"), ("APPLE", "@loader_path")])
def test_an_installed_engine_finds_pinocchio_relative_to_itself_on_linux_and_on_macos(tmp_path, system, origin):
    script = tmp_path / "print.cmake"
    script.write_text(f'include("{SOURCE}/rpath.cmake")\nmessage("${{PINIK_RPATH}}")\n')
    defined = [f"-D{system}=1"] if system else ["-DAPPLE=0"]
    done = subprocess.run([CMAKE, *defined, "-P", script], capture_output=True, text=True, check=True)
    assert done.stderr.strip() == f"{origin}/../cmeel.prefix/lib"

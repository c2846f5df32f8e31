"""What nvcc makes of every device source: no warning, no kernel without effect, no fused multiply-add
where bits are promised, and registers and stack under the caps of cuda_caps.txt. Without nvcc skipped."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
CAPS = Path(__file__).with_name("cuda_caps.txt")
FLAGS = "-std=c++20 -arch=sm_90 --fmad=false -Werror all-warnings,cross-execution-space-call".split()
FLAGS += ["-Xcompiler", "-Wall,-Wextra,-Wconversion,-Wshadow", "-I", str(ROOT)]
FLAGS += ['-DBOXWOOD_CUDA_ARCHITECTURES="90-real"']
# CUB's own kernels are its authors' business.
OURS = re.compile(r"7boxwood")
SOURCES = sorted(p for m in ("kernels", "trees", "bench/stages") for p in (ROOT / m).rglob("*.cu"))
WARP = sorted((ROOT / "build" / "warp" / "lib").glob("python3*/site-packages/warp"))
if WARP:
    SOURCES.append(ROOT / "bench" / "peers" / "warp" / "warp_tree.cu")
    FLAGS += ["-isystem", str(WARP[0].parent), '-DBOXWOOD_WARP_LIBRARY=""']


def find_nvcc():
    """As CMake finds it: the one named, that of scripts/setup --with-cuda, then the PATH."""
    own = sorted((ROOT / "build" / "cuda").glob("lib/python3*/site-packages/nvidia/cu13/bin/nvcc"))
    for nvcc in (os.environ.get("CUDACXX"), *own, shutil.which("nvcc"), "/usr/local/cuda/bin/nvcc"):
        if nvcc and os.access(nvcc, os.X_OK):
            return str(nvcc)
    return None


NVCC = find_nvcc()
needs_nvcc = pytest.mark.skipif(not NVCC, reason="no nvcc here (scripts/setup --with-cuda puts one into build/cuda)")


def entries(ptx):
    """Mangled name -> body of each kernel."""
    return dict(re.findall(r"\.entry\s+(\w+)\s*\(.*?^\{(.*?)^\}", ptx, re.S | re.M))


def stores(body, ptx):
    """Whether it writes to memory or calls a function that does."""
    if re.search(r"\b(st|red|atom)(\.\w+)*\.(global|relaxed|release|v\d|[bfsu]\d+)|\bst\.[bfsu]\d+\b", body):
        return True
    called = set(re.findall(r"^\s*(\w+),\s*$", "\n".join(re.findall(r"call(?:\.uni)?\s[^;]*;", body)), re.M))
    return any(re.search(rf"\.func[^;{{]*\b{name}\b[^;]*?^\{{.*?\bst\.", ptx, re.S | re.M) for name in called)


def usage(said):
    """Mangled name -> (registers, bytes of stack) as ptxas -v says."""
    found = {}
    for block in said.split("Compiling entry function '")[1:]:
        name = block.split("'")[0]
        stack = int(re.search(r"(\d+) bytes stack frame", block).group(1))
        found[name] = int(re.search(r"Used (\d+) registers", block).group(1)), stack
    return found


def caps():
    """Lines of a kernel's name, registers, bytes of stack, and `fma` where it may fuse."""
    for line in CAPS.read_text().splitlines():
        words = line.split("#")[0].split()
        if words:
            yield re.compile(words[0]), int(words[1]), int(words[2]), "fma" in words[3:]


def cap_of(name):
    return next(c[1:] for c in caps() if c[0].search(name))


def problems(ptx, said):
    """What is wrong with the kernels of one source."""
    used = usage(said)
    for name, body in entries(ptx).items():
        if not OURS.search(name):
            continue
        registers, stack, may_fuse = cap_of(name)
        if not stores(body, ptx):
            yield f"{name}: stores nothing"
        if not may_fuse and re.search(r"\bfma\.", body):
            yield f"{name}: has a fused multiply-add"
        if used[name][0] > registers:
            yield f"{name}: {used[name][0]} registers, at most {registers}"
        if used[name][1] > stack:
            yield f"{name}: {used[name][1]} bytes of stack, at most {stack}"


def compiled(source, folder, *more):
    """(PTX, what ptxas says) of a source; fails with nvcc's words."""
    ptx = folder / "a.ptx"
    made = subprocess.run([NVCC, *FLAGS, *more, "--ptx", "-o", ptx, source], capture_output=True, text=True)
    assert made.returncode == 0 and "warning" not in made.stderr, made.stderr
    ptxas = Path(NVCC).resolve().parent / "ptxas"
    said = subprocess.run(
        [ptxas, "-v", "-arch=sm_90", "-o", folder / "a.cubin", ptx], capture_output=True, text=True
    )
    assert said.returncode == 0, said.stderr
    return ptx.read_text(), said.stderr


@needs_nvcc
@pytest.mark.parametrize("source", SOURCES, ids=lambda p: str(p.relative_to(ROOT)))
def test_kernels_store_do_not_fuse_and_stay_under_their_caps(source, tmp_path):
    ptx, said = compiled(source, tmp_path)
    assert not list(problems(ptx, said))


@needs_nvcc
def test_each_fault_is_seen(tmp_path):
    source = tmp_path / "a.cu"
    source.write_text(
        "namespace boxwood {\n"
        "__global__ void fill_packed_leaves(float*) {}\n"
        "__global__ void fill_packed_level(float* x) { x[1] = __fmaf_rn(x[0], x[1], x[2]); }\n"
        "__global__ void subtract(float* x, int n) { float y[99]; for (int i = 0; i < n; ++i) y[i] = x[i];\n"
        "    for (int i = 0; i < n; ++i) x[i] = y[n - i]; }\n"
        "}\n"
    )
    found = "\n".join(problems(*compiled(source, tmp_path)))
    assert found.count("\n") == 2, found
    for said in ("stores nothing", "fused", "bytes of stack"):
        assert said in found, found

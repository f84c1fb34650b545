"""Marks for tests that need something of the machine: a compiler, objdump, or a processor with certain instructions."""

import shutil
from pathlib import Path

import pytest

from symrot.build.cache import missing as missing_compiler
from symrot.certificates.object_code.disassembly import why_no_objdump

HERE = [name for name in ("gcc", "clang") if shutil.which(name)]
PROCESSOR = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else ""
needs_objdump = pytest.mark.skipif(bool(why_no_objdump()) or "gcc" not in HERE, reason="needs gcc and objdump")
needs_avx2 = pytest.mark.skipif(
    not {"avx2", "fma"} <= set(PROCESSOR.split()), reason="needs a processor with AVX2, FMA"
)
needs_compiler = pytest.mark.skipif(bool(missing_compiler()), reason="needs a C compiler")

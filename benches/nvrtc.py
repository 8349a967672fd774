"""Compiles the kernels of `creepage-device` for graphics processors of NVIDIA; none is needed.

    pip install nvidia-cuda-nvrtc-cu12
    cargo run --release -p creepage-device --example kernels | python benches/nvrtc.py

Prints the registers of each kernel, what it spills, and how many of the threads of a processor it leaves room for.
"""

import ctypes
import pathlib
import re
import sys

import nvidia

nvrtc = ctypes.CDLL(str(pathlib.Path(nvidia.__path__[0], "cuda_nvrtc/lib/libnvrtc.so.12")))
REGISTERS, THREADS, BLOCK = 65536, 2048, 256  # of a multiprocessor of sm_80 and sm_90, and of a block


def log(program):
    size = ctypes.c_size_t()
    nvrtc.nvrtcGetProgramLogSize(program, ctypes.byref(size))
    text = ctypes.create_string_buffer(size.value)
    nvrtc.nvrtcGetProgramLog(program, text)
    return text.value.decode()


def compiled(source, architecture):
    program = ctypes.c_void_p()
    nvrtc.nvrtcCreateProgram(ctypes.byref(program), source, b"kernels.cu", 0, None, None)
    options = [f"--gpu-architecture={architecture}", "--fmad=false", "--ptxas-options=-v"]
    given = (ctypes.c_char_p * len(options))(*(option.encode() for option in options))
    if nvrtc.nvrtcCompileProgram(program, len(options), given):
        sys.exit(log(program))
    return log(program)


source = sys.stdin.buffer.read()
for architecture in ("sm_80", "sm_90"):
    kernel = None
    for line in compiled(source, architecture).splitlines():
        if match := re.search(r"Compiling entry function '(\w+)'", line):
            kernel = match[1]
        if match := re.search(r"(\d+) bytes spill stores", line):
            spilled = int(match[1])
        if match := re.search(r"Used (\d+) registers", line):
            registers = int(match[1])
            warp = -(-32 * registers // 256) * 256  # registers are given out to warps by 256
            blocks = min(THREADS // BLOCK, REGISTERS // (warp * BLOCK // 32))
            print(f"{architecture} {kernel}: {registers} registers, {spilled} bytes spilled, "
                  f"{100 * blocks * BLOCK // THREADS} % of the threads")

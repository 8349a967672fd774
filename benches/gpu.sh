#!/bin/bash
# How fast a graphics processor steps blocks of 0.125, 1 and 2 million elements; it builds nothing.
#
#   cargo build --release -p creepage-device --features gpu --example speed
#   benches/gpu.sh target/release/examples/speed
#
# The machine needs a driver with OpenCL. Where no loader of OpenCL is installed, put libOpenCL.so.1 beside the program.
set -euo pipefail
program="${1:?usage: gpu.sh target/release/examples/speed}"
beside="$(dirname "$program")"
[ -e "$beside/libOpenCL.so.1" ] && export OPENCL_DYLIB_PATH="$beside/libOpenCL.so.1"
# a container often has NVIDIA's driver, but not the file that names it
if ! ls /etc/OpenCL/vendors/*.icd >/dev/null 2>&1; then
    icd="$(mktemp -d)"
    echo libnvidia-opencl.so.1 > "$icd/nvidia.icd"
    export OCL_ICD_VENDORS="$icd"
fi
command -v nvidia-smi >/dev/null && nvidia-smi --query-gpu=name,driver_version --format=csv,noheader
exec "$program"

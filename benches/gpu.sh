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
if [ -e "$beside/libOpenCL.so.1" ]; then
    export OPENCL_DYLIB_PATH="$beside/libOpenCL.so.1"
fi
# a container often has NVIDIA's driver, but not the file that names it
if ! grep -qs nvidia /etc/OpenCL/vendors/*.icd; then
    vendors="$(mktemp -d)"
    trap 'rm -r "$vendors"' EXIT
    echo libnvidia-opencl.so.1 > "$vendors/nvidia.icd"
    cp /etc/OpenCL/vendors/*.icd "$vendors" 2>/dev/null || true
    export OCL_ICD_VENDORS="$vendors"
fi
if command -v nvidia-smi >/dev/null; then
    nvidia-smi --query-gpu=name,driver_version --format=csv,noheader
fi
"$program"

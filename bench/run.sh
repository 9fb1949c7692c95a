#!/usr/bin/env bash
# Builds the benchmarks for this machine's processor, measures, and draws the charts. Results go to
# bench/results/<device>.json, charts to docs/charts/. Options are passed on to apsl_kernel_bench (see its --help), such
# as --platform NVIDIA. About ten minutes on two quiet cores; on a busy machine the figures mean little.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake --preset bench
cmake --build --preset bench --target apsl_kernel_bench
# One OpenCL driver a process: several at once have crashed.
if [[ -z "${OCL_ICD_VENDORS:-}" && -f /etc/OpenCL/vendors/pocl.icd && ! -e /dev/nvidiactl && ! -e /dev/kfd ]]; then
  export OCL_ICD_VENDORS=/etc/OpenCL/vendors/pocl.icd
fi
new="$(mktemp --suffix .json)"
trap 'rm -f "$new"' EXIT
build/bench/bench/kernels/apsl_kernel_bench --meshes ../shared/meshes --out "$new" "$@"

# Ours tells the device's name; peers on the processor have the processor's.
device="$(/usr/bin/python3 -c 'import json, re, sys
rows = json.load(open(sys.argv[1]))
name = next((row for row in rows if row["method"].startswith("consistent")), rows[0])["device"]
print(re.sub("[^A-Za-z0-9]+", "-", name).strip("-"))' "$new")"
mkdir -p bench/results
results="bench/results/$device.json"
cp "$new" "$results"
echo "$results"
/usr/bin/python3 bench/charts/kernel_charts.py "$results" --out docs/charts --methods \
  "consistent matrix_free" "consistent assembled_csr" "Eigen CG, 1 thread" "Eigen CG, all threads" "ViennaCL CG" \
  "Eigen reference, float" "Eigen LDLT"
/usr/bin/python3 bench/kernels/summary.py "$results"

#!/usr/bin/env bash
# Is the limiter as fast inside a pipeline as alone? Runs scenes/embedded and bench/kernels in turns, on the same grids
# with the same settings (10 sub-steps of exactly 3 CG iterations), and prints for each round what a call of the limiter
# takes: in the pipeline (from the end of the stage before to the end of the limiter's last command, profiling events),
# alone (wall time from the call to its end, the wait included), and the sum of its kernels alone (profiling events,
# without what lies between them). A small cloth's call is one launch, and alone it also pays for sending it off and for
# waking up; there the kernels are what to compare with. Also the host's waits within frames, counted as
# tests/embed/embedded_example_test.py does.
#     bench/embedded/embedded.sh [ROUNDS, 5 where not given]
# About two minutes on two quiet cores; on a busy machine the ratios mean little.
set -euo pipefail
cd "$(dirname "$0")/../.."

rounds="${1:-5}"
cmake --preset bench >/dev/null
cmake --build --preset bench --target apsl_kernel_bench traced_cloth embedded_cloth_gated
# One OpenCL driver a process: several at once have crashed.
if [[ -z "${OCL_ICD_VENDORS:-}" && -f /etc/OpenCL/vendors/pocl.icd && ! -e /dev/nvidiactl && ! -e /dev/kfd ]]; then
  export OCL_ICD_VENDORS=/etc/OpenCL/vendors/pocl.icd
fi
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

for grid in 33 129 513; do
  APSL_TEST_CALLS="$work/calls_$grid.json" build/bench/tests/embed/embedded_cloth_gated --grid "$grid" --frames 2 >/dev/null
  for ((round = 0; round < rounds; ++round)); do
    build/bench/bench/embedded/traced_cloth --grid "$grid" --frames 10 --bench \
      --trace "$work/trace_${grid}_$round.json" >/dev/null
    build/bench/bench/kernels/apsl_kernel_bench --grids "${grid}x$grid" --awkward-grids none --cloths 0 \
      --copy-megabytes 8 --filter "^filter_call/consistent matrix_free/" --out "$work/alone_${grid}_$round.json" \
      >/dev/null 2>&1
  done
done

/usr/bin/python3 - "$work" "$rounds" <<'PYTHON'
import json
import statistics
import sys
from pathlib import Path

work, rounds = Path(sys.argv[1]), int(sys.argv[2])
DEVICE, WARM_UP_FRAMES = 2, 2
print(f"{'triangles':>9} {'pipeline, ms':>13} {'alone, ms':>10} {'kernels, ms':>12} {'pipeline/alone':>15} "
      f"{'pipeline/kernels':>17}")
for grid in (33, 129, 513):
    ratios, times = [], []
    for number in range(rounds):
        events = json.loads((work / f"trace_{grid}_{number}.json").read_text())["traceEvents"]
        pipeline = 1e-6 * statistics.median(
            event["dur"] for event in events if event["ph"] == "X" and event["tid"] == DEVICE
            and event["name"] == "limit_strain" and event["args"]["frame"] >= WARM_UP_FRAMES)
        rows = json.loads((work / f"alone_{grid}_{number}.json").read_text())
        alone, = (row["median_seconds"] for row in rows if row["quantity"] == "filter_call")
        kernels = sum(row["median_seconds"] for row in rows if row["quantity"] == "phase" and row["clock"] == "device")
        triangles = rows[0]["triangles"]
        ratios.append((pipeline / alone, pipeline / kernels))
        times.append((pipeline, alone, kernels))
        print(f"{triangles:9} {1e3 * pipeline:13.3f} {1e3 * alone:10.3f} {1e3 * kernels:12.3f} {ratios[-1][0]:15.3f} "
              f"{ratios[-1][1]:17.3f}")
    calls = json.loads((work / f"calls_{grid}.json").read_text())["frames"]
    waits = calls["host_waits"] + calls["polls"] + calls["blocking_calls"]
    by_alone, by_kernels = (statistics.median(column) for column in zip(*ratios))
    print(f"{triangles:9} median of {rounds} rounds {by_alone:37.3f} {by_kernels:17.3f}   "
          f"host waits within frames: {waits}")
    # What else the machine does only adds to a time.
    pipeline, alone, kernels = (min(column) for column in zip(*times))
    print(f"{triangles:9} {1e3 * pipeline:13.3f} {1e3 * alone:10.3f} {1e3 * kernels:12.3f} {pipeline / alone:15.3f} "
          f"{pipeline / kernels:17.3f}   least of {rounds} rounds\n")
PYTHON

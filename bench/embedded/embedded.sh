#!/usr/bin/env bash
# Is a call as fast inside a pipeline as alone? Runs scenes/embedded twice over the same frames, traced, and prints for
# each round what a call takes: in the pipeline (from the end of the stage before to the end of the call's last command,
# profiling events), and alone (wall time from the call to its end, where the host waits for each stage before it queues
# the next). Also the host's waits within frames, counted as tests/embed/embedded_example_test.py does.
#     bench/embedded/embedded.sh [ROUNDS, 5 where not given]
# About four minutes on two quiet cores; on a busy machine the ratios mean little.
set -euo pipefail
cd "$(dirname "$0")/../.."

rounds="${1:-5}"
cmake --preset bench >/dev/null
cmake --build --preset bench --target traced_cloth embedded_cloth_gated
# One OpenCL driver a process: several at once have crashed.
if [[ -z "${OCL_ICD_VENDORS:-}" && -f /etc/OpenCL/vendors/pocl.icd && ! -e /dev/nvidiactl && ! -e /dev/kfd ]]; then
  export OCL_ICD_VENDORS=/etc/OpenCL/vendors/pocl.icd
fi
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

for grid in 33 129 257; do
  APSL_TEST_CALLS="$work/calls_$grid.json" build/bench/tests/embed/embedded_cloth_gated --grid "$grid" --frames 2 >/dev/null
  for ((round = 0; round < rounds; ++round)); do
    for wait in "" --wait; do
      # shellcheck disable=SC2086 # an option or none
      build/bench/bench/embedded/traced_cloth --grid "$grid" --frames 10 $wait \
        --trace "$work/trace${wait}_${grid}_$round.json" >/dev/null
    done
  done
done

/usr/bin/python3 - "$work" "$rounds" <<'PYTHON'
import json
import statistics
import sys
from pathlib import Path

work, rounds = Path(sys.argv[1]), int(sys.argv[2])
HOST, DEVICE, WARM_UP_FRAMES = 1, 2, 2


def read_calls(path, row):
    """ms, of each frame"""
    events = json.loads(path.read_text())["traceEvents"]
    return [1e-3 * event["dur"] for event in events if event["ph"] == "X" and event["tid"] == row
            and event["name"] == "step" and event["args"]["frame"] >= WARM_UP_FRAMES]


print(f"{'triangles':>9} {'pipeline, ms':>13} {'alone, ms':>10} {'pipeline/alone':>15}")
for grid in (33, 129, 257):
    triangles = 2 * (grid - 1) ** 2
    pipeline, alone = ([read_calls(work / f"trace{wait}_{grid}_{number}.json", row) for number in range(rounds)]
                       for wait, row in (("", DEVICE), ("--wait", HOST)))
    means = [[statistics.mean(frames) for frames in calls] for calls in (pipeline, alone)]
    for in_pipeline, by_itself in zip(*means):
        print(f"{triangles:9} {in_pipeline:13.3f} {by_itself:10.3f} {in_pipeline / by_itself:15.3f}")
    calls = json.loads((work / f"calls_{grid}.json").read_text())["frames"]
    waits = calls["host_waits"] + calls["polls"] + calls["blocking_calls"]
    ratio = statistics.median(in_pipeline / by_itself for in_pipeline, by_itself in zip(*means))
    print(f"{triangles:9} median of {rounds} rounds {ratio:22.3f}   host waits within frames: {waits}")
    # What else the machine does only adds to a time.
    in_pipeline, by_itself = (statistics.mean(map(min, zip(*calls))) for calls in (pipeline, alone))
    print(f"{triangles:9} {in_pipeline:13.3f} {by_itself:10.3f} {in_pipeline / by_itself:15.3f}   "
          f"each frame's least of {rounds} rounds\n")
PYTHON

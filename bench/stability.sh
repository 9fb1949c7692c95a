#!/usr/bin/env bash
# The atlas of failure: runs ours and the baselines over the maps and cases of bench/stability/maps.py and draws them into
# docs/stability/. Whole results stay in build/stability.
#   bench/stability.sh                  all; half an hour on two cores that do nothing else
#   bench/stability.sh needles ...      these
#   bench/stability.sh --resume         all, without the runs that an interrupted call left in build/stability
#   bench/stability.sh --ours           all, but the baselines' runs from build/stability: after a change of the library
#   bench/stability.sh --coarse         all, every second value of the axes: a quarter of the time
#   bench/stability.sh --charts         the pictures alone, from the outcomes that are there
set -euo pipefail
cd "$(dirname "$0")/.."

measure=true
keep=nothing
every=1
case "${1:-}" in
  --resume) keep=all; shift ;;
  --ours) keep=baselines; shift ;;
  --coarse) every=2; shift ;;
  --charts) measure=false; shift ;;
esac

results=docs/stability
if $measure; then
  cmake/debian_packages.sh
  cmake --preset dev >/dev/null
  cmake --build --preset dev --target apsl_program
  bench/stability/measure.py build/dev/apsl "$@" --keep "$keep" --every "$every" --work build/stability --out "$results"
fi
maps=("$@")
[[ $# -gt 0 ]] || mapfile -t maps < <(bench/stability/summary.py --names)
for map in "${maps[@]}"; do
  bench/charts/stability_map.py "$results/$map.json" --out "$results/$map.png"
done
echo "docs/stability.md quotes: bench/stability/summary.py $results"

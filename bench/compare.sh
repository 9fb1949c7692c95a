#!/usr/bin/env bash
# Speed against accuracy: runs the studies of bench/studies, ours and every baseline, and draws their charts into
# docs/accuracy/. Runs that docs/accuracy/*.json already hold are not made again: delete a file to measure it anew.
#   bench/compare.sh                    all studies; about an hour and a half on two cores that do nothing else
#   bench/compare.sh curtain_8k ...     these studies
#   bench/compare.sh --charts           the charts alone, from the files that are there
set -euo pipefail
cd "$(dirname "$0")/.."

all=(curtain_8k curtain_32k front stretch whole_frame stand_alone refinement locking deviation)
measure=true
[[ "${1:-}" == "--charts" ]] && { measure=false; shift; }
studies=("${@:-${all[@]}}")
for study in "${studies[@]}"; do
  [[ -f "bench/studies/$study.json" ]] || { echo "error: bench/compare.sh $study: no such study, expected of ${all[*]}" >&2; exit 2; }
done

results=docs/accuracy
mkdir -p "$results"
if $measure; then
  cmake/debian_packages.sh
  cmake --preset dev >/dev/null
  cmake --build --preset dev --target apsl_program
  for study in "${studies[@]}"; do
    # One thread each for the local methods there: with two they wait for each other on a machine that has other work.
    threads=()
    [[ "$study" != stretch ]] || threads=(OMP_NUM_THREADS=1)
    # One thread for all: processor time is what counts.
    [[ "$study" != whole_frame ]] || threads=(OMP_NUM_THREADS=1 POCL_MAX_PTHREAD_COUNT=1)
    env "${threads[@]}" build/dev/apsl compare --study "bench/studies/$study.json" --out "$results/$study.json"
    # The largest meshes take too long for every method.
    [[ "$study" != refinement ]] \
      || build/dev/apsl compare --study bench/studies/refinement_500k.json --out "$results/refinement.json"
    [[ "$study" != whole_frame ]] \
      || env "${threads[@]}" build/dev/apsl compare --study bench/studies/whole_frame_131k.json --out "$results/whole_frame.json"
  done
fi

charts=bench/charts
for study in "${studies[@]}"; do
  file="$results/$study.json"
  case "$study" in
    curtain_8k)
      "$charts/pareto_chart.py" "$file" --scene "curtain 65×65" --out "$results/pareto_8k.png"
      "$charts/convergence_chart.py" "$file" --scene "curtain 65×65" --out "$results/convergence_8k.png"
      "$charts/compare_curves.py" "$file" --scene "curtain 65×65" --milliseconds 5 --out "$results/curves_8k.png" ;;
    curtain_32k)
      "$charts/pareto_chart.py" "$file" --scene "curtain 129×129" --out "$results/pareto_32k.png"
      "$charts/convergence_chart.py" "$file" --scene "curtain 129×129" --out "$results/convergence_32k.png" ;;
    stretch) "$charts/stretch_chart.py" "$file" --scene "curtain 65×65" --ceiling 1.1 --out "$results/stretch.png" ;;
    whole_frame) "$charts/whole_frame_chart.py" "$file" --out "$results/whole_frame.png" ;;
    stand_alone) "$charts/pareto_chart.py" "$file" --scene "stand-alone 65×65" --out "$results/pareto_stand_alone.png" ;;
    refinement) "$charts/refinement_chart.py" "$file" --microseconds 1 --target 0.1 --out "$results/refinement.png" ;;
    locking) "$charts/locking_chart.py" "$file" --out "$results/locking.png" ;;
    deviation) "$charts/deviation_chart.py" "$file" --out "$results/deviation.png" ;;
  esac
done

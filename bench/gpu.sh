#!/usr/bin/env bash
# Tests and measures on a GPU, in eight minutes at most, without network or packages: runs what bench/gpu_bundle.sh has
# packed into BUNDLE, and leaves logs and JSON in OUT, which must be new or empty.
#     gpu.sh [OPTION ...] BUNDLE OUT
#       --driver LIBRARY   the OpenCL driver, a path or what the dynamic linker finds; any device of it will do. Without
#                          it the vendors' drivers are looked for, and one with a GPU is taken
#       --device N         its number among the driver's devices; otherwise the first GPU, or 0
#       --seconds N        what all of it may take (470): each part has its share of what is left
#       --grids "N ..."    vertices a side of the square cloths measured ("65 257 1025": 8 k, 131 k, 2.1 M triangles)
#       --copy-megabytes N of each array that copy bandwidth is measured on (256: more than a GPU's caches hold)
#       --tests SPEC       Catch2 selection of the tests (all but those tagged [exact_division], which a GPU may round
#                          otherwise)
# Ends with 0 where every part passed or was skipped for want of memory, with 1 where one failed or ran out of time, and
# with 2 where nothing could be run.
set -euo pipefail
export LC_ALL=C

usage() {
  sed -n '2,/^set /{s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
}
stop() {
  echo "error: $*" >&2
  exit 2
}
# expect_number OPTION VALUE
expect_number() {
  [[ "$2" =~ ^(0|[1-9][0-9]{0,5})$ ]] || stop "$1 $2: expected a whole number"
}

driver="" number="" total=470 grids="65 257 1025" copy_megabytes=256 tests="~[exact_division]"
while [[ "${1:-}" == -* ]]; do
  case "$1" in
    --help | -h) usage; exit 0 ;;
    --driver | --device | --seconds | --grids | --copy-megabytes | --tests)
      [[ $# -ge 2 ]] || stop "$1: expected a value behind it"
      ;;
    *) stop "$1: no such option, see --help" ;;
  esac
  case "$1" in
    --driver) driver="$2" ;;
    --device) expect_number "$1" "$2"; number="$2" ;;
    --seconds) expect_number "$1" "$2"; total="$2" ;;
    --grids)
      for grid in $2; do
        [[ "$grid" =~ ^([2-9]|[1-9][0-9]{1,3})$ ]] || stop "--grids $grid: expected vertices a side, 2 to 9999"
      done
      grids="$2"
      ;;
    --copy-megabytes) expect_number "$1" "$2"; copy_megabytes="$2" ;;
    --tests) tests="$2" ;;
  esac
  shift 2
done
[[ $# -eq 2 ]] || stop "expected a bundle and a folder for the results, see --help"
[[ -x "$1/bin/apsl" ]] || stop "$1: no bundle of bench/gpu_bundle.sh"
[[ ! -e "$2" || (-d "$2" && -z "$(ls -A "$2")") ]] || stop "$2 is there already, expected a new or an empty folder"
bundle="$(cd "$1" && pwd)"
mkdir -p "$2"
out="$(cd "$2" && pwd)"

vendors="$(mktemp -d)"
trap 'rm -rf "$vendors"' EXIT
SECONDS=0

# Libraries: ours, then the machine's. What comes with a compiler is carried too, and used where the machine's is older
# or missing. bench/kernels needs most of it.
export LD_LIBRARY_PATH="$bundle/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
starts() {
  local program
  for program in "$bundle"/bin/*; do
    timeout -k 2 20 "$program" --help >/dev/null 2>"$vendors/why" || return 1
  done
}
if ! starts; then
  LD_LIBRARY_PATH="$bundle/lib:$bundle/lib_of_compiler${LD_LIBRARY_PATH#"$bundle/lib"}"
  starts || stop "the programs of $bundle do not start here: $(head -n 1 "$vendors/why")"
fi

# One driver a process, whatever else is installed: several at once have crashed.
unset OCL_ICD_FILENAMES APSL_TEST_PLATFORM
export OCL_ICD_VENDORS="$vendors/icd"
mkdir "$OCL_ICD_VENDORS"
export RUSTICL_ENABLE="${RUSTICL_ENABLE:-radeonsi,iris,nouveau}" # Mesa's shows no device unless told
# What apsl says of the devices of a driver; fails where there are none.
devices_of() {
  echo "$1" >"$OCL_ICD_VENDORS/driver.icd"
  timeout -k 2 20 "$bundle/bin/apsl" devices 2>"$vendors/why"
}

# The vendors' drivers, where the dynamic linker finds them or a container puts them, then whatever is installed.
candidates() {
  local name folder file
  for name in libnvidia-opencl.so.1 libamdocl64.so libigdrcl.so libRusticlOpenCL.so.1; do
    echo "$name"
    for folder in /usr/lib/x86_64-linux-gnu /usr/lib64 /usr/lib /usr/local/nvidia/lib64 /usr/lib/wsl/lib \
      /opt/rocm*/lib /opt/rocm*/opencl/lib /opt/amdgpu*/lib/x86_64-linux-gnu \
      /usr/lib/x86_64-linux-gnu/intel-opencl /usr/lib64/intel-opencl; do
      for file in "$folder/$name"*; do
        [[ ! -e "$file" ]] || echo "$file"
      done
    done
  done
  cat /etc/OpenCL/vendors/*.icd 2>/dev/null || true
}
if [[ -n "$driver" ]]; then
  [[ "$driver" != */* || -e "$driver" ]] || stop "--driver $driver: no such file"
  [[ "$driver" != */* ]] || driver="$(cd "$(dirname "$driver")" && pwd)/$(basename "$driver")"
  devices="$(devices_of "$driver")" \
    || stop "--driver $driver: no OpenCL device ($(head -n 1 "$vendors/why")); is it a driver, and what it needs here?"
else
  while read -r candidate && [[ $SECONDS -lt 60 ]]; do
    [[ -n "$candidate" ]] || continue
    if devices="$(devices_of "$candidate")" && grep -q '^   GPU,' <<<"$devices"; then
      driver="$candidate"
      break
    fi
  done < <(candidates)
  [[ -n "$driver" ]] || stop "no OpenCL driver with a GPU found: NVIDIA's, AMD's, Intel's and Mesa's were looked for;" \
    "give its library with --driver"
fi

# The device: two lines of apsl's list, "N  NAME" and "   GPU, PLATFORM, driver VERSION, N compute units, N GB".
if [[ -z "$number" ]]; then
  number="$(grep -B 1 '^   GPU,' <<<"$devices" | sed -nE '1s/^([0-9]+)  .*/\1/p' || true)"
  number="${number:-0}"
fi
described="$(grep -A 1 -E "^$number  " <<<"$devices")" || stop "--device $number: $driver has no such device"
device="$(sed -nE '1s/^[0-9]+  (.*)/\1/p' <<<"$described")"
IFS='|' read -r platform version units memory < <(sed -nE \
  '2s/^   (no )?GPU, (.*), driver (.*), ([0-9]+) compute units, ([0-9.]+) GB$/\2|\3|\4|\5/p' <<<"$described") \
  || stop "apsl devices says what this script does not understand: $described"
export APSL_TEST_DEVICE="$number"
export APSL_TEST_THOROUGH=1  # work-groups of 256 too, which is what a GPU gets
APSL_COMMIT="$(cat "$bundle/commit")"
export APSL_COMMIT
echo "device:  $device ($units compute units, $memory GB)"
echo "driver:  $platform, $version ($driver)"
echo "commit:  $APSL_COMMIT"

json_text() {
  local text="${1//[[:cntrl:]]/ }"
  text="${text//\\/\\\\}"
  printf '"%s"' "${text//\"/\\\"}"
}
parts_json=() failed=0
write_summary() {
  {
    printf '{\n  "commit": %s,\n  "device": %s,\n' "$(json_text "$APSL_COMMIT")" "$(json_text "$device")"
    printf '  "platform": %s,\n  "driver": %s,\n' "$(json_text "$platform")" "$(json_text "$version")"
    printf '  "library": %s,\n  "compute_units": %s,\n' "$(json_text "$driver")" "$units"
    printf '  "memory_gb": %s,\n  "system": %s,\n' "$memory" "$(json_text "$(uname -srm)")"
    printf '  "seconds": %s,\n  "parts": [' "$SECONDS"
    local separator="" part
    for part in "${parts_json[@]}"; do
      printf '%s\n    %s' "$separator" "$part"
      separator=","
    done
    printf '\n  ]\n}\n'
  } >"$out/summary.json.new"
  mv "$out/summary.json.new" "$out/summary.json"
}
# record NAME STATUS EXIT SECONDS BOUND RESULTS TOLD
record() {
  local results=null exit_status=null
  [[ -z "$3" ]] || exit_status="$3"
  [[ -z "$6" ]] || results="$(json_text "$6")"
  parts_json+=("{\"part\": \"$1\", \"status\": \"$2\", \"exit\": $exit_status, \"seconds\": $4, \"bound\": $5, \
\"results\": $results, \"told\": $(json_text "$7")}")
  printf '%-14s %-10s %6s s  %s\n' "$1" "$2" "$4" "$7"
  write_summary
}

# Parts with their weights: what is left of the time goes to the parts that are left by these.
names=(kernel_tests filter_tests) weights=(110 150)
for grid in $grids; do
  names+=("kernels_$grid" "frames_$grid")
  if [[ $grid -gt 512 ]]; then weights+=(100 40); else weights+=(30 12); fi
done

# run_tests PROGRAM SPEC: each test in a process of its own, as CTest has them, several at once: most of a test is the
# compilation of its kernels. What a test said is printed where it failed; one that never ended was begun alone.
# shellcheck disable=SC2317 # reached through bash -c
run_tests() {
  local names name
  names="$("$1" "$2" --list-test-names-only 2>/dev/null || true)" # ends with their number
  [[ -n "$names" ]] || names="$("$1" "$2" --list-tests --verbosity quiet)" # Catch2 3
  [[ -n "$names" ]] || { echo "no test matches $2"; return 1; }
  echo "test cases: $(wc -l <<<"$names")"
  while IFS= read -r name; do
    while [[ "$(jobs -rp | wc -l)" -ge "$jobs" ]]; do wait -n || true; done
    run_test "$1" "$name" &
  done <<<"$names"
  wait
}
# shellcheck disable=SC2001,SC2317 # a set of characters; reached through bash -c
run_test() {
  local name log code=0
  name="$(sed 's/[],[\\]/\\&/g' <<<"$2")" # as a selection of this test alone
  log="$(mktemp "$vendors/test.XXXXXX")"
  echo "begun: $2"
  "$1" "$name" >"$log" 2>&1 || code=$?
  # Catch2 ends with 0 after a selection that it does not understand.
  if [[ $code -eq 0 ]] && grep -qE '^(All tests passed|test cases: +1 )' "$log"; then
    echo "passed: $2"
  else
    echo "FAILED with $code: $2" >>"$log"
    cat "$log"
  fi
}
# Of a log of run_tests.
counted() {
  local all passed failed
  all="$(sed -nE 's/^test cases: ([0-9]+)$/\1/p' "$1")"
  passed="$(grep -ac '^passed: ' "$1" || true)"
  failed="$(grep -ac '^FAILED with ' "$1" || true)"
  if [[ -n "$all" ]]; then echo "$passed of $all test cases passed, $failed failed"; else head -n 1 "$1"; fi
}
jobs="$(($(nproc) / 2))"
jobs="$((jobs < 1 ? 1 : jobs > 8 ? 8 : jobs))"
export -f run_tests run_test
export jobs vendors

# run_part NAME BOUND RESULTS COMMAND...
run_part() {
  local name="$1" bound="$2" results="$3" status=passed code=0 begun spent told
  shift 3
  begun="$(date +%s%N)"
  timeout -k 2 "$bound" "$@" >"$out/$name.log" 2>&1 || code=$?
  spent=$(($(date +%s%N) - begun))
  spent="$((spent / 1000000000)).$((spent / 100000000 % 10))"
  if [[ "$name" == *_tests ]]; then
    told="$(counted "$out/$name.log")"
  else
    told="$(grep -a '[^ =~-]' "$out/$name.log" | tail -n 1 | tr -s ' ' | tr -d '\200-\377' | cut -c 1-200 || true)"
  fi
  [[ $code -ne 0 || "$name" != *_tests ]] || ! grep -q '^FAILED with ' "$out/$name.log" || code=1
  if [[ ($code -eq 124 || $code -eq 137) && ${spent%.*} -ge $bound ]]; then
    status=timed_out
    told="ended after $bound s; $told"
  elif [[ $code -ne 0 ]]; then
    status=failed
  fi
  [[ $status == passed ]] || failed=1
  [[ -z "$results" || -e "$out/$results" ]] || results=""
  record "$name" "$status" "$code" "$spent" "$bound" "$results" "$told"
}

# What the machine has left for programs, MB: its own, or what a container may take.
memory_left() {
  local left limit used cgroup=/sys/fs/cgroup
  left="$(sed -nE 's/^MemAvailable: +([0-9]+) kB/\1/p' /proc/meminfo)"
  left=$((${left:-0} / 1000))
  for limit in $cgroup/memory.max $cgroup/memory/memory.limit_in_bytes; do
    limit="$(cat "$limit" 2>/dev/null || true)"
    used="$(cat $cgroup/memory.current $cgroup/memory/memory.usage_in_bytes 2>/dev/null | head -n 1 || true)"
    if [[ "$limit" =~ ^[0-9]{1,17}$ ]]; then
      limit=$(((limit - ${used:-0}) / 1000000))
      [[ $limit -ge $left ]] || left=$limit
    fi
  done
  echo "$left"
}
# Bytes a triangle, of the machine's memory and of the device's, above what is needed anyway. Under pocl, where both are
# one, bench/kernels took 2.1 GB at 2.1 M triangles, and 0.9 GB at 131 k.
host_bytes=1100 device_bytes=500 needed_anyway=500 # MB

for index in "${!names[@]}"; do
  name="${names[index]}"
  weight=0
  for later in "${weights[@]:index}"; do weight=$((weight + later)); done
  bound=$(((total - SECONDS) * weights[index] / weight))
  [[ $bound -ge 1 ]] || bound=1 # the least that timeout takes for a bound
  if [[ $SECONDS -ge $total ]]; then
    failed=1
    record "$name" timed_out "" 0.0 0 "" "not begun: $total s are over"
    continue
  fi
  grid="${name##*_}"
  if [[ "$grid" != tests ]]; then
    triangles=$((2 * (grid - 1) * (grid - 1)))
    host=$((needed_anyway + host_bytes * triangles / 1000000))
    on_device=$((needed_anyway + device_bytes * triangles / 1000000))
    left="$(memory_left)" device_left="${memory%.*}000"
    if [[ $host -gt $left || $on_device -gt $device_left ]]; then
      record "$name" skipped "" 0.0 "$bound" "" "$triangles triangles need about $host MB of memory and $on_device MB \
on the device; there are $left and $device_left"
      continue
    fi
  fi
  case "$name" in
    *_tests)
      # shellcheck disable=SC2016 # expanded by the other bash
      run_part "$name" "$bound" "" bash -c 'run_tests "$@"' bash "$bundle/bin/apsl_$name" "$tests"
      ;;
    kernels_*)
      run_part "$name" "$bound" "$name.json" "$bundle/bin/apsl_kernel_bench" --device "$number" \
        --grids "${grid}x$grid" --awkward-grids none --cloths 0 --max-triangles "$triangles" --repetitions 9 \
        --copy-megabytes "$copy_megabytes" --filter '/(consistent|ViennaCL)' --out "$out/$name.json"
      ;;
    frames_*)
      run_part "$name" "$bound" "$name.json" "$bundle/bin/traced_cloth" --device "$number" --grid "$grid" --frames 10 \
        --kernels "$bundle/touch_sphere.cl" --trace "$out/$name.json"
      ;;
  esac
done
echo "$SECONDS s; logs, results and summary.json in $2"
exit "$failed"

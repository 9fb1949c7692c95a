#!/usr/bin/env bash
# fuzz.sh BUILD_FOLDER scene|obj|ply SECONDS: one fuzzer, from the seeds and what earlier runs in that folder found.
# What breaks a reader stays in BUILD_FOLDER/broken_*; BUILD_FOLDER/fuzz_FORMAT FILE repeats it.
# For hours: tests/stability/readers/fuzz.sh build/fuzz/tests/stability/readers obj 7200
set -euo pipefail
[[ $# -eq 3 ]] || { echo "usage: fuzz.sh BUILD_FOLDER scene|obj|ply SECONDS" >&2; exit 2; }
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1/corpus_$2"
seeds=("$here/seeds/$2")
[[ $2 == scene ]] && seeds=("$here/../../../scenes")
# 64 KiB of input never need 1 GiB or ten seconds: more is an allocation or a loop that some count in the file asked for.
exec "$1/fuzz_$2" -max_total_time="$3" -timeout=10 -rss_limit_mb=1024 -max_len=65536 -dict="$here/$2.dict" \
  -artifact_prefix="$1/broken_" -verbosity=0 -print_final_stats=1 "$1/corpus_$2" "${seeds[@]}"

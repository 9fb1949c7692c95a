#!/usr/bin/env bash
# Draws every picture of docs/pictures and the area-change charts of docs/charts anew from the scenes.
# Runs stay in out/figures.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake/debian_packages.sh
cmake --preset program >/dev/null
cmake --build --preset program
cmake --preset bench >/dev/null
cmake --build --preset bench --target traced_cloth
program=build/program/apsl
embedded=build/program/scenes/embedded/embedded_cloth
traced=build/bench/bench/embedded/traced_cloth
runs=out/figures
mkdir -p "$runs" docs/pictures docs/charts

# run NAME SCENE [--set ...]: leaves $runs/NAME
run() {
  "$program" run "scenes/$2.json" --out "$runs/$1" "${@:3}"
}

# still NAME FRAME [ARGUMENTS]: one frame of $runs/NAME as docs/pictures/NAME.png
still() {
  scenes/pictures/render.py "$runs/$1" --frames "$2" --views cloth,absolute --size 1000x520 --out "$runs/$1/still" "${@:3}"
  mv "$runs/$1/still"/frame_*.png "docs/pictures/$1.png"
}

run curtain curtain
run curtain_unfiltered curtain_unfiltered
run paper_fig1 paper_fig1
run paper_fig1_unfiltered paper_fig1 --set strain_limiting=null
run paper_fig6 paper_fig6
run stand_alone_curtain stand_alone_curtain
run pushed_curtain pushed_curtain
run twist twist
run skirt skirt
run sphere_drape sphere_drape

scenes/pictures/side_by_side.py "$runs/curtain_unfiltered" "$runs/curtain" --frame 30 --out docs/pictures/side_by_side.png
scenes/pictures/side_by_side.py "$runs/paper_fig1_unfiltered" "$runs/paper_fig1" --frame 45 --out docs/pictures/paper_fig1.png
still paper_fig6 110 --zoom 1.2
still pushed_curtain 150 --zoom 1.3 --views cloth,stretch --red-stretch 1.2
still twist 150
still skirt 179
still sphere_drape 89 --zoom 1.45

mkdir -p "$runs/embedded"
echo '{"colliders": [{"sphere": {"center": [0, -0.35, 0], "radius": 0.3}}]}' > "$runs/embedded/colliders.json"
"$embedded" --out "$runs/embedded"
still embedded last --scene "$runs/embedded/colliders.json" --azimuth 50 --elevation 20
"$traced" --frames 16 --trace "$runs/embedded/trace.json"
scenes/pictures/draw_trace.py "$runs/embedded/trace.json" --out docs/pictures/embedded_trace.png

bench/charts/area_change_curves.py "$runs/curtain_unfiltered/report.json" "$runs/curtain/report.json" \
  "$runs/stand_alone_curtain/report.json" --labels "filter off" "filter on" "stand-alone" \
  --title "Greatest area change per frame, 65×65 curtain" --out docs/charts/area_change_curtain.png
bench/charts/area_change_curves.py "$runs/paper_fig1_unfiltered/report.json" "$runs/paper_fig1/report.json" \
  "$runs/paper_fig6/report.json" --labels "Fig. 1, filter off" "Fig. 1, filter on" "Fig. 6, stand-alone" \
  --title "Greatest area change per frame, the paper's figures" --out docs/charts/area_change_paper.png

#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Energy, area change and memory over a long run, from the JSON of apsl_long_run."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "bench" / "charts"))
from chart_tools import (COLOURS, ChartError, OneLineParser, exit_code_of, new_chart, plain,  # noqa: E402
                         read_json, save_chart)


def run(arguments):
    parser = OneLineParser(description=__doc__)
    parser.add_argument("run", help="JSON of apsl_long_run")
    parser.add_argument("--out", required=True, help="a .png")
    options = parser.parse_args(arguments)
    results = read_json(options.run)
    try:
        stretches = results["stretches"]
        frames = [stretch["last_frame"] + 1 for stretch in stretches]
        settled = frames[results["settling_stretches"]]
        series = {name: [stretch[name] for stretch in stretches] for name in
                  ("kinetic_energy", "total_energy", "max_area_change", "rms_area_change", "resident_bytes")}
    except (KeyError, IndexError, TypeError) as error:
        raise ChartError(f"{options.run}: no results of apsl_long_run ({error!r})") from None
    figure, axes = new_chart(rows=3, height=7.0, sharex=True)
    axes[0].plot(frames, series["total_energy"], color=COLOURS[0], label="kinetic and potential")
    axes[0].plot(frames, series["kinetic_energy"], color=COLOURS[1], label="kinetic")
    axes[0].set_title("energy, mean of each stretch, J")
    for name, label, colour in (("max_area_change", "greatest", 0), ("rms_area_change", "RMS", 1)):
        axes[1].plot(frames, [100.0 * value for value in series[name]], color=COLOURS[colour], label=label)
    axes[1].set_ylim(bottom=0.0)
    axes[1].set_title("area change, greatest of each stretch, %")
    resident = [value / 2**20 for value in series["resident_bytes"]]
    axes[2].plot(frames, resident, color=COLOURS[0])
    axes[2].set_ylim(0.0, 1.2 * max(resident))
    axes[2].set_title(f"resident memory, MiB; {plain(results['device_bytes'] / 2**20)} of it on the device throughout")
    axes[2].set_xlabel("frame")
    for axis in axes:
        axis.axvline(settled, color="#8a8a8a", linewidth=1.0, linestyle=":", label="from here on nothing may grow")
    axes[0].legend(loc="center right", bbox_to_anchor=(1.0, 0.35))
    axes[1].legend(loc="upper right")
    axes[2].xaxis.set_major_formatter(lambda value, _: plain(value))
    save_chart(figure, options.out)


if __name__ == "__main__":
    sys.exit(exit_code_of(run))

// SPDX-License-Identifier: MIT
#include "compare/compare_command.hpp"
#include "compare/study.hpp"
#include "run/extra_commands.hpp"

#include <CLI/CLI.hpp>
#include <memory>

namespace apsl::scenes {

void add_extra_commands(CLI::App& program, std::function<int()>& chosen) {
    const auto options = std::make_shared<compare::CompareOptions>();
    CLI::App* command = program.add_subcommand("compare", "run scenes with several limiters, measure each");
    command->add_option("SCENE", options->scenes, "scene files, JSON");
    command->add_option("--methods", options->methods, "a,b,... instead of all, or of the study's")->delimiter(',');
    command->add_option("--study", options->study, "scenes, methods and parameters, JSON (docs/study.schema.json)");
    command->add_option("--set", options->overrides, "path=value: change a value of all scenes; repeatable")
        ->take_all()
        ->allow_extra_args(false);
    command->add_option("--frames", options->frames, "instead of the scenes'")
        ->check(CLI::Range(1, 2'000'000'000).description(""));
    command->add_option("--device", options->device, "number from apsl devices; default the first GPU, else 0");
    command->add_flag("--deviation", options->measure_deviation,
                      "measure how far the vertices are from the converged solution, at ten frames");
    command->add_option("--deviation-frames", options->deviation_frames, "a,b,... instead of the ten")->delimiter(',');
    command->add_option("--run-seconds", options->run_seconds, "no frame of a run begins after so long; default 120")
        ->check(CLI::PositiveNumber.description(""));
    command
        ->add_option("--rounds", options->rounds,
                     "make all runs so often, in turn; times are medians over the rounds; default 1")
        ->check(CLI::Range(1, compare::max_rounds).description(""));
    command->add_flag("--profile", options->profile,
                      "run ours a second time for its time on the device, transfers apart");
    command->add_option("--out", options->out, "results, JSON; runs that are in it are not made again")->required();
    command->footer(
        "Time in the limiter is wall time, for ours with the transfers to and from the device.\n"
        "A method that diverges or runs out of time is a result.\n"
        "Example: apsl compare scenes/curtain.json --methods none,apsl,pbd_edges --out results.json");
    command->callback([options, &chosen] { chosen = [options] { return compare::compare_command(*options); }; });
}

}  // namespace apsl::scenes

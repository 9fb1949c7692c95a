// SPDX-License-Identifier: MIT
#include "run/commands.hpp"
#include "run/extra_commands.hpp"
#include "run/input_error.hpp"
#include "tune/tune_command.hpp"

#include <apsl/error.hpp>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <map>
#include <new>
#include <sstream>
#include <string>

namespace {

using namespace apsl::scenes;

int wrong_input(std::string what) {
    // One line, whatever the message was made of.
    what = what.substr(0, what.find_last_not_of("\n\r ") + 1);
    for (char& letter : what)
        if (letter == '\n' || letter == '\r') letter = ' ';
    std::fprintf(stderr, "error: %s\n", what.c_str());
    return exit_wrong_input;
}

// CLI11's own ranges let NaN pass, and print their ends with 300 digits.
CLI::Validator finite_number(double least, bool excluded) {
    return {[least, excluded](const std::string& text) -> std::string {
                double number = 0.0;
                const bool legal = CLI::detail::lexical_cast(text, number) && std::isfinite(number) &&
                                   (excluded ? number > least : number >= least);
                if (legal) return {};
                std::ostringstream expected;
                expected << "is " << text << ", expected a finite number " << (excluded ? "> " : ">= ") << least;
                return expected.str();
            },
            ""};
}

int parse_and_run(int argument_count, char** arguments) {
    CLI::App program{"Cloth scenes with area preserving strain limiting.", "apsl"};
    program.set_version_flag("--version", std::string("apsl ") + APSL_PROGRAM_VERSION);
    program.require_subcommand(0, 1);
    program.get_formatter()->column_width(22);
    program.get_formatter()->label("SUBCOMMAND", "COMMAND");
    program.get_formatter()->label("SUBCOMMANDS", "COMMANDS");
    program.footer(
        "apsl COMMAND --help lists a command's options.\n"
        "Exit: 0 done, 1 the simulation broke down (see the report), 2 wrong input.\n"
        "Example: apsl run scenes/curtain.json --out out/curtain");

    RunOptions options;
    CLI::App* run = program.add_subcommand("run", "simulate a scene");
    run->add_option("SCENE", options.scene, "scene file, JSON")->required();
    const std::map<std::string, Backend> backends{{"opencl", Backend::opencl}, {"reference", Backend::reference}};
    run->add_option("--backend", options.backend, "opencl (default) or reference: this processor")
        ->transform(CLI::Validator(
            [&backends](std::string& text) -> std::string {
                const auto named = backends.find(text);
                if (named == backends.end()) return "is " + text + ", expected opencl or reference";
                text = std::to_string(static_cast<int>(named->second));
                return {};
            },
            ""));
    run->add_option("--device", options.device, "number from apsl devices; default the first GPU, else 0");
    run->add_option("--frames", options.frames, "instead of the scene's")
        ->check(CLI::Range(1, 2'000'000'000).description(""));
    run->add_option("--out", options.out, "folder for frames (ParaView, Blender) and report");
    run->add_option("--report", options.report, "report file, JSON");
    run->add_option("--set", options.overrides, "path=value: change a value of the scene; repeatable")
        ->take_all()
        ->allow_extra_args(false);
    run->add_flag("--profile", options.profile, "time each kernel on the device");

    program.add_subcommand("devices", "list the OpenCL devices and their numbers");

    CLI::App* validate = program.add_subcommand("validate", "check a scene and its mesh, simulate nothing");
    validate->add_option("SCENE", options.scene, "scene file, JSON")->required();
    validate->add_option("--set", options.overrides, "path=value: change a value of the scene; repeatable")
        ->take_all()
        ->allow_extra_args(false);

    TuneOptions tuning;
    CLI::App* tune = program.add_subcommand("tune", "find the cheapest limiter settings that meet a target");
    tune->add_option("SCENE", tuning.scene, "scene file, JSON")->required();
    tune->add_option("--target", tuning.target, "greatest area change, 0.01 is 1 %")
        ->required()
        ->check(finite_number(0.0, true));
    tune->add_option(
            "--target-stretch", tuning.target_stretch,
            "greatest principal stretch after ten frames; default the scene's stretch_ceiling and 0.025, if any")
        ->check(finite_number(least_target_stretch, false));
    tune->add_option("--budget-ms", tuning.budget_ms, "of the limiter, milliseconds a frame")
        ->check(finite_number(0.0, true));
    tune->add_option("--device", tuning.device, "number from apsl devices; default the first GPU, else 0");
    tune->add_option("--frames", tuning.frames, "tune on so many, instead of the scene's")
        ->check(CLI::Range(1, 2'000'000'000).description(""));
    tune->add_option("--out", tuning.out, "the tuned scene; standard output without");
    tune->add_option("--set", tuning.overrides, "path=value: change a value of the scene; repeatable")
        ->take_all()
        ->allow_extra_args(false);
    tune->footer(
        "Times are first quartiles over frames: what else the machine does only adds.\n"
        "Exit: 0 the target is met, 1 nothing tried meets it (the best is written), 2 wrong input.\n"
        "Example: apsl tune scenes/curtain.json --target 0.02 --out tuned.json");

    std::function<int()> extra_command;
    add_extra_commands(program, extra_command);

    try {
        program.parse(argument_count, arguments);
    } catch (const CLI::Success& success) {
        return program.exit(success);  // --help and --version
    } catch (const CLI::ParseError& error) {
        return wrong_input(std::string(error.what()) + " (see apsl --help)");
    }
    if (program.get_subcommands().empty())
        return wrong_input("no command, expected run, devices, validate or tune (see apsl --help)");
    if (tune->parsed()) return tune_command(tuning);
    if (extra_command) return extra_command();
    if (run->parsed()) return run_command(options);
    if (validate->parsed()) return validate_command(options.scene, options.overrides);
    return devices_command();
}

int run_reporting_errors(int argument_count, char** arguments) {
    try {
        return parse_and_run(argument_count, arguments);
    } catch (const InputError& error) {
        return wrong_input(error.what());
    } catch (const apsl::Error& error) {
        return wrong_input(error.what());
    } catch (const std::bad_alloc&) {
        return wrong_input("not enough memory for this scene");
    } catch (const std::exception& error) {
        return wrong_input(error.what());
    }
}

}  // namespace

int main(int argument_count, char** arguments) {
    const int code = run_reporting_errors(argument_count, arguments);
    // What is lost there must not pass for done. What CLI11 writes goes through std::cout.
    const bool written = std::cout.flush() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
    if (written) return code;
    const int lost = wrong_input("standard output: writing failed, is the disk full?");
    return code == exit_done ? lost : code;
}

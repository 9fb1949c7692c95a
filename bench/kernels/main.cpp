// SPDX-License-Identifier: MIT
//
// apsl_kernel_bench: every kernel and the whole filter, from small to large, beside what else could be used. Google
// Benchmark runs it; the results go into one JSON file (docs/benchmark.schema.json).
#include "benchmarks.hpp"
#include "copy_bandwidth.hpp"

#include <benchmark/benchmark.h>
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

namespace {

using namespace apsl::bench;

struct Arguments {
    std::string out = "kernel_bench.json", filter = ".", platform, meshes;
    std::size_t device = 0, max_triangles = 2'200'000, copy_megabytes = 128;
    int repetitions = 15;
    std::vector<std::string> grids{"33x33", "65x65", "129x129", "257x257", "513x513", "1025x1025"};
    std::vector<std::string> awkward_grids{"47x71", "258x257"};
    std::vector<std::size_t> cloths{50, 1000};
};

void declare(CLI::App& app, Arguments& arguments) {
    app.add_option("--out", arguments.out, "the results, JSON")->capture_default_str();
    app.add_option("--filter", arguments.filter, "regular expression: benchmarks to run")->capture_default_str();
    app.add_option("--repetitions", arguments.repetitions,
                   "about the number of samples; more of what is quick, fewer of what is slow")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    app.add_option("--max-triangles", arguments.max_triangles, "nothing larger")->capture_default_str();
    app.add_option("--grids", arguments.grids, "COLUMNSxROWS vertices, all peers")->delimiter(',');
    app.add_option("--awkward-grids", arguments.awkward_grids,
                   "COLUMNSxROWS vertices, ours and Eigen alone; none for none")
        ->delimiter(',');
    app.add_option("--cloths", arguments.cloths, "cloths of 2,048 triangles in one limiter")->delimiter(',');
    app.add_option("--meshes", arguments.meshes, "folder of OBJ files to measure on as well");
    app.add_option("--platform", arguments.platform, "part of the OpenCL platform's name");
    app.add_option("--device", arguments.device, "number of the device on it")->capture_default_str();
    app.add_option("--copy-megabytes", arguments.copy_megabytes, "of each array that copy bandwidth is measured on")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
}

/// "65x33" → a grid. Throws CLI::ValidationError.
Subject grid_subject(const std::string& text, bool all_peers) {
    unsigned columns = 0, rows = 0;
    int read = 0;
    // NOLINTNEXTLINE(cert-err34-c): the count of what was read says whether it was right
    if (std::sscanf(text.c_str(), "%ux%u%n", &columns, &rows, &read) != 2 ||
        static_cast<std::size_t>(read) != text.size() || columns < 2 || rows < 2 || columns > 20000 || rows > 20000)
        throw CLI::ValidationError("--grids", text + ": expected COLUMNSxROWS, each from 2 to 20000");
    return {text, {columns, rows, {}}, all_peers};
}

std::vector<Subject> subjects(const Arguments& arguments) {
    std::vector<Subject> all;
    for (const std::string& grid : arguments.grids) all.push_back(grid_subject(grid, true));
    for (const std::string& grid : arguments.awkward_grids)
        if (grid != "none") all.push_back(grid_subject(grid, false));
    std::erase_if(all, [&](const Subject& s) { return s.mesh.triangle_count() > arguments.max_triangles; });
    if (!arguments.meshes.empty())
        for (const auto& entry : std::filesystem::directory_iterator(arguments.meshes))
            if (entry.path().extension() == ".obj")
                all.push_back({entry.path().stem().string(), {0, 0, entry.path().string()}, false});
    return all;
}

int run(const Arguments& arguments) {
    Run run{open_device(arguments.platform, arguments.device), {}, arguments.repetitions, false};
    const double bandwidth = copy_bandwidth(run.device, arguments.copy_megabytes << 20);
    run.device.place.copy_bandwidth = bandwidth;
    std::cerr << run.device.place.device << ", " << run.device.place.driver << ", copy bandwidth " << 1e-9 * bandwidth
              << " GB/s\n";

    for (const Subject& subject : subjects(arguments)) register_cloth(run, subject);
    for (const std::size_t copies : arguments.cloths)
        if (copies > 0 && copies * 2048 <= arguments.max_triangles) register_cloths(run, copies);

    std::string program = "apsl_kernel_bench", filter = "--benchmark_filter=" + arguments.filter;
    std::vector<char*> words{program.data(), filter.data()};
    int count = static_cast<int>(words.size());
    benchmark::Initialize(&count, words.data());
    if (benchmark::RunSpecifiedBenchmarks() == 0) throw std::runtime_error("no benchmark left to run");
    benchmark::Shutdown();
    run.results.raise_copy_bandwidth(copy_bandwidth(run.device, arguments.copy_megabytes << 20));
    run.results.write(arguments.out);
    return run.failed ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Measures apsl's kernels and its filter beside what else could be used.");
    Arguments arguments;
    declare(app, arguments);
    try {
        app.parse(argc, argv);
        return run(arguments);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << '\n';
        return 2;
    }
}

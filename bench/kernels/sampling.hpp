// SPDX-License-Identifier: MIT
#pragma once

#include "benchmarks.hpp"

#include <apsl/parameters.hpp>

#include <benchmark/benchmark.h>
#include <algorithm>
#include <chrono>
#include <exception>
#include <functional>
#include <utility>

namespace apsl::bench {

constexpr float regularization = 1.2f;

/// The filter call of every comparison: 10 sub-steps of exactly 3 iterations.
inline Parameters filter_call() {
    Parameters parameters;
    parameters.regularization = regularization;
    parameters.sub_steps = 10;
    parameters.max_iterations = 3;
    parameters.tolerance = 0.0f;
    return parameters;
}

/// A CG iteration is the difference between solves of this many iterations, divided by the difference of these. Not
/// more than a call queues one by one (the limiter leaves a solve's rare later iterations to a single work-group).
constexpr int many_iterations = 8, few_iterations = 2;

template <class Work>
double seconds(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Time of one CG iteration, s, from solve(iterations), which returns its time. Everything around the iterations drops
/// out.
template <class SolveSeconds>
double iteration_seconds(const SolveSeconds& solve) {
    return (solve(many_iterations) - solve(few_iterations)) / (many_iterations - few_iterations);
}

/// Calls `sample`, which returns a time in s, as often as Google Benchmark has iterations. Warm up before.
template <class Sample>
MedianAndSpread sampled(benchmark::State& state, const Sample& sample) {
    std::vector<double> samples;
    for ([[maybe_unused]] auto iteration : state) {
        samples.push_back(sample());
        state.SetIterationTime(std::max(samples.back(), 0.0));
    }
    const MedianAndSpread result = median_and_spread(samples);
    state.counters["median_ms"] = 1e3 * result.median;
    state.counters["spread_ms"] = 1e3 * result.spread;
    return result;
}

/// More samples where one takes little, fewer where it takes long. `seconds_per_million`: about how long a sample takes
/// on two processor cores, for each million triangles.
inline int sample_count(const Run& run, std::size_t triangles, double seconds_per_million) {
    const double expected = 1e-6 * static_cast<double>(triangles) * seconds_per_million;
    const double budget = 0.1 * run.repetitions;  // s
    const int least = expected > 5.0 ? 1 : expected > 1.0 ? 3 : 5;
    return std::clamp(static_cast<int>(budget / expected), std::min(least, run.repetitions), 10 * run.repetitions);
}

/// Registers a benchmark; what it throws is told in one line and fails the run.
inline void add(Run& run, const std::string& name, int samples, std::function<void(benchmark::State&)> body) {
    benchmark::RegisterBenchmark(name.c_str(),
                                 [&run, body = std::move(body)](benchmark::State& state) {
                                     try {
                                         body(state);
                                     } catch (const std::exception& error) {
                                         run.failed = true;
                                         state.SkipWithError(error.what());
                                     }
                                 })
        ->Iterations(samples)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
}

}  // namespace apsl::bench

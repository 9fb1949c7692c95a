// SPDX-License-Identifier: MIT
#include "benchmarks.hpp"

#include "cpu_filters.hpp"
#include "device_filter.hpp"
#include "eigen_conjugate_gradient.hpp"
#include "kernel_times.hpp"
#include "sampling.hpp"
#include "viennacl_conjugate_gradient.hpp"

#include <stdexcept>

namespace apsl::bench {
namespace {

/// The cloth that is being measured, made when its first benchmark runs and freed when the next cloth's does.
struct Present {
    explicit Present(const Subject& subject) : name(subject.name), cloth(make_cloth(subject.mesh)), accuracy(cloth) {}
    Present(const Present&) = delete;

    Sizes sizes() const { return {cloth.vertex_count(), cloth.triangle_count(), accuracy.entries()}; }

    std::string name;
    Cloth cloth;
    Accuracy accuracy;
};

Present& present(const Subject& subject) {
    static std::unique_ptr<Present> held;
    if (!held || held->name != subject.name) {
        held.reset();
        held = std::make_unique<Present>(subject);
    }
    return *held;
}

std::string method_name(Apply apply) {
    return apply == Apply::matrix_free ? "consistent matrix_free" : "consistent assembled_csr";
}

/// One sub-step of that many iterations, nothing stopping them.
Parameters one_solve(float alpha, int iterations) {
    Parameters parameters = filter_call();
    parameters.regularization = alpha;
    parameters.sub_steps = 1;
    parameters.max_iterations = iterations;
    return parameters;
}

/// Δx = Δt ṽ of a call that began with ṽ = 0.
std::vector<double> displacements(const std::vector<float>& velocities, const Parameters& parameters) {
    std::vector<double> result(velocities.begin(), velocities.end());
    for (double& x : result) x *= static_cast<double>(parameters.time_step);
    return result;
}

void measure_filter_call(Run& run, const Subject& subject, Apply apply, benchmark::State& state) {
    Present& now = present(subject);
    DeviceFilter filter(run.device, now.cloth, apply);
    const Parameters parameters = filter_call();
    for (int warm_up = 0; warm_up < 3; ++warm_up) filter.wall_seconds(parameters);

    Measurement m;
    m.error = now.accuracy.filter_error(filter.velocities(), parameters);
    m.max_area_change = filter.max_area_change();
    const auto [median, spread] = sampled(state, [&] { return filter.wall_seconds(parameters); });
    m.quantity = "filter_call";
    m.clock = "host";
    m.method = method_name(apply);
    m.triangles = now.cloth.triangle_count();
    m.median = median;
    m.spread = spread;
    run.results.add(run.device.place, m);

    KernelTimes times;
    for (int call = 0; call < std::max(3, run.repetitions / 3); ++call) times.add(filter.kernel_times(parameters));
    std::vector<Measurement> parts = times.kernels(now.sizes(), parameters.max_iterations);
    const std::vector<Measurement> phases = times.phases(median);
    parts.insert(parts.end(), phases.begin(), phases.end());
    for (Measurement& part : parts) {
        part.method = m.method;
        part.triangles = m.triangles;
        run.results.add(run.device.place, part);
    }
}

void measure_iteration(Run& run, const Subject& subject, Apply apply, benchmark::State& state) {
    Present& now = present(subject);
    DeviceFilter filter(run.device, now.cloth, apply);
    const auto solve = [&](int iterations) { return filter.wall_seconds(one_solve(regularization, iterations)); };
    for (const int iterations : {few_iterations, many_iterations}) solve(iterations);

    Measurement m;
    const Parameters damped = one_solve(regularization, many_iterations);
    m.error = now.accuracy.displacement_error(displacements(filter.velocities(), damped),
                                              static_cast<double>(damped.regularization), many_iterations);
    const Parameters undamped = one_solve(1.0f, many_iterations);
    filter.wall_seconds(undamped);
    m.residual = now.accuracy.residual(displacements(filter.velocities(), undamped));

    KernelTimes times;
    for (int call = 0; call < std::max(3, run.repetitions / 3); ++call) times.add(filter.kernel_times(damped));
    m.bytes = times.iteration_bytes(now.sizes(), many_iterations);
    const auto [median, spread] = sampled(state, [&] { return iteration_seconds(solve); });
    m.quantity = "cg_iteration";
    m.clock = "host";
    m.method = method_name(apply);
    m.triangles = now.cloth.triangle_count();
    m.median = median;
    m.spread = spread;
    run.results.add(run.device.place, m);

    // The same from profiling events, without the time between kernels.
    if (std::optional<Measurement> of_events = times.iteration(now.sizes(), many_iterations)) {
        of_events->method = m.method + ", kernels alone";
        of_events->triangles = m.triangles;
        of_events->error = m.error;
        of_events->residual = m.residual;
        run.results.add(run.device.place, *of_events);
    }
}

/// `make` turns a PressureSystem into a Solve.
template <class Make>
void measure_peer_iteration(Run& run, const Subject& subject, const std::string& method, const Place& place,
                            const Make& make, benchmark::State& state) {
    Present& now = present(subject);
    Measurement m;
    {
        const PressureSystem undamped = now.accuracy.system(1.0);
        m.residual = now.accuracy.residual(now.accuracy.displacements(make(undamped)(many_iterations)));
    }
    const PressureSystem system = now.accuracy.system(static_cast<double>(regularization));
    const Solve solve = make(system);
    solve(few_iterations);
    m.error = now.accuracy.displacement_error(now.accuracy.displacements(solve(many_iterations)),
                                              static_cast<double>(regularization), many_iterations);
    const auto [median, spread] = sampled(
        state, [&] { return iteration_seconds([&](int iterations) { return seconds([&] { solve(iterations); }); }); });
    m.quantity = "cg_iteration";
    m.clock = "host";
    m.method = method;
    m.triangles = now.cloth.triangle_count();
    m.median = median;
    m.spread = spread;
    m.bytes = csr_iteration_bytes(now.sizes());
    run.results.add(place, m);
}

void measure_cpu_filter(Run& run, const Subject& subject, const std::string& method, const Place& place,
                        Filter (*make)(const Cloth&), benchmark::State& state) {
    Present& now = present(subject);
    const Filter filter = make(now.cloth);
    const Parameters parameters = filter_call();
    Measurement m;
    m.error = now.accuracy.filter_error(filter(parameters), parameters);
    const auto [median, spread] = sampled(state, [&] { return seconds([&] { filter(parameters); }); });
    m.quantity = "filter_call";
    m.clock = "host";
    m.method = method;
    m.triangles = now.cloth.triangle_count();
    m.median = median;
    m.spread = spread;
    run.results.add(place, m);
}

/// A processor's time is compared with its own bandwidth alone.
Place peer_place(const Run& run, int threads) {
    Place place = processor(threads);
    if (run.device.is_cpu) place.copy_bandwidth = run.device.place.copy_bandwidth;
    return place;
}

}  // namespace

void register_cloth(Run& run, const Subject& subject) {
    const std::size_t triangles = subject.mesh.file.empty() ? subject.mesh.triangle_count() : 5000;
    for (const Apply apply : {Apply::matrix_free, Apply::assembled_csr}) {
        const std::string ending = "/" + method_name(apply) + "/" + subject.name;
        add(run, "filter_call" + ending, sample_count(run, triangles, 0.5),
            [&run, subject, apply](benchmark::State& state) { measure_filter_call(run, subject, apply, state); });
        add(run, "cg_iteration" + ending, sample_count(run, triangles, 0.1),
            [&run, subject, apply](benchmark::State& state) { measure_iteration(run, subject, apply, state); });
    }

    const int all_threads = eigen_thread_count();
    const auto add_eigen = [&](int threads, const std::string& name) {
        add(run, "cg_iteration/" + name + "/" + subject.name, sample_count(run, triangles, 0.3),
            [&run, subject, threads, name](benchmark::State& state) {
                measure_peer_iteration(
                    run, subject, name, peer_place(run, threads),
                    [threads](const PressureSystem& system) { return eigen_conjugate_gradient(system, threads); },
                    state);
            });
    };
    add_eigen(1, "Eigen CG, 1 thread");
    if (all_threads > 1) add_eigen(all_threads, "Eigen CG, all threads");
    add(run, "filter_call/Eigen reference, float/" + subject.name, sample_count(run, triangles, 1.5),
        [&run, subject](benchmark::State& state) {
            measure_cpu_filter(run, subject, "Eigen reference, float", peer_place(run, 1), reference_filter, state);
        });
    if (!subject.all_peers) return;
    add(run, "cg_iteration/ViennaCL CG/" + subject.name, sample_count(run, triangles, 1.0),
        [&run, subject](benchmark::State& state) {
            measure_peer_iteration(
                run, subject, "ViennaCL CG", run.device.place,
                [&run](const PressureSystem& system) { return viennacl_conjugate_gradient(run.device, system); },
                state);
        });
    // Beyond this, a factorisation takes seconds and gigabytes.
    constexpr std::size_t most_triangles_of_direct = 140000;
    if (triangles <= most_triangles_of_direct)
        add(run, "filter_call/Eigen LDLT/" + subject.name, sample_count(run, triangles, 100.0),
            [&run, subject](benchmark::State& state) {
                measure_cpu_filter(run, subject, "Eigen LDLT", peer_place(run, 1), direct_filter, state);
            });
}

void register_cloths(Run& run, std::size_t copies) {
    constexpr std::uint32_t small = 33;
    const Subject one{"33x33", {small, small, {}}, true};
    const std::size_t triangles = copies * one.mesh.triangle_count();
    const std::string count = std::to_string(copies);
    add(run, "filter_call/" + count + " cloths/33x33", sample_count(run, triangles, 0.5),
        [&run, one, copies, triangles, count](benchmark::State& state) {
            Present& now = present(one);
            DeviceFilter filter(run.device, now.cloth, Apply::matrix_free, copies);
            const Parameters parameters = filter_call();
            for (int warm_up = 0; warm_up < 3; ++warm_up) filter.wall_seconds(parameters);
            Measurement m;
            m.error = now.accuracy.filter_error(filter.velocities(), parameters);
            m.max_area_change = filter.max_area_change();
            const auto [median, spread] = sampled(state, [&] { return filter.wall_seconds(parameters); });
            m.quantity = "filter_call";
            m.clock = "host";
            m.method = count + " cloths of 2,048";
            m.triangles = triangles;
            m.median = median;
            m.spread = spread;
            run.results.add(run.device.place, m);
        });
    // The same number of triangles in one sheet, as square as the count allows.
    std::uint32_t across = 1;
    for (std::uint32_t n = 1; std::size_t{n} * n <= copies; ++n)
        if (copies % n == 0) across = n;
    const auto along = static_cast<std::uint32_t>(copies / across);
    const Mesh sheet{across * (small - 1) + 1, along * (small - 1) + 1, {}};
    const Subject whole{std::to_string(sheet.columns) + "x" + std::to_string(sheet.rows), sheet, false};
    add(run, "filter_call/" + method_name(Apply::matrix_free) + "/" + whole.name, sample_count(run, triangles, 0.5),
        [&run, whole](benchmark::State& state) { measure_filter_call(run, whole, Apply::matrix_free, state); });
}

}  // namespace apsl::bench

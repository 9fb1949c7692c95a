// SPDX-License-Identifier: MIT
#include "support/device_cloth.hpp"

#include <apsl/reference.hpp>

#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>

namespace apsl::test {
namespace {

std::vector<float> placed(std::span<const MovingCloth> cloths, std::vector<double> MovingCloth::* numbers,
                          std::size_t width, std::size_t stride, std::size_t offset) {
    std::vector<float> all = poison<float>(offset);
    for (const MovingCloth& cloth : cloths)
        for (std::size_t n = 0; n < (cloth.*numbers).size(); n += width) {
            for (std::size_t k = 0; k < width; ++k) all.push_back(static_cast<float>((cloth.*numbers)[n + k]));
            const std::vector<float> gap = poison<float>(stride - width);
            all.insert(all.end(), gap.begin(), gap.end());
        }
    all.resize(all.size() - (stride - width));  // a caller's buffer may end with its last number
    return all;
}

std::size_t vertices_of(std::span<const MovingCloth> cloths) {
    std::size_t count = 0;
    for (const MovingCloth& cloth : cloths) count += cloth.topology->vertex_count();
    return count;
}

void round_to_float(std::vector<double>& numbers) {
    for (double& number : numbers) number = static_cast<float>(number);
}

}  // namespace

MovingCloth moving_cloth(const Mesh& mesh, std::uint32_t seed) {
    MovingCloth cloth;
    cloth.topology = Topology::build(mesh.triangles, mesh.vertex_count());
    cloth.rest_areas = reference::areas<double>(*cloth.topology, mesh.positions);
    const double total = std::accumulate(cloth.rest_areas.begin(), cloth.rest_areas.end(), 0.0);
    const double edge = std::sqrt(total / static_cast<double>(cloth.rest_areas.size()));
    cloth.positions = wavy(mesh.positions, 0.2 * edge, seed);
    round_to_float(cloth.rest_areas);
    round_to_float(cloth.positions);

    std::mt19937 random(seed);
    const auto number = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
    };
    constexpr double steps_per_second = 60.0;
    for (std::size_t n = 0; n < cloth.positions.size(); ++n)
        cloth.velocities.push_back(steps_per_second *
                                   (0.1 * (n % 3 == 0 ? mesh.positions[n] : 0.0) + 0.03 * edge * number(-1.0, 1.0)));
    cloth.inverse_masses = reference::inverse_masses<double>(*cloth.topology, cloth.rest_areas, 0.2);
    for (double& inverse_mass : cloth.inverse_masses) inverse_mass *= number(0.5, 2.0);
    for (const std::size_t pin : {std::size_t{0}, mesh.vertex_count() / 2}) cloth.inverse_masses[pin] = 0.0;
    for (std::size_t a = 0; a < cloth.rest_areas.size(); ++a) cloth.regularization.push_back(number(1.05, 2.0));
    round_to_float(cloth.velocities);
    round_to_float(cloth.inverse_masses);
    round_to_float(cloth.regularization);
    return cloth;
}

CallerBuffers::CallerBuffers(std::span<const MovingCloth> cloths, const Options& the_options, std::size_t the_offset)
    : options(the_options),
      offset(the_offset),
      vertex_count(vertices_of(cloths)),
      positions(placed(cloths, &MovingCloth::positions, 3, options.position_stride, offset)),
      velocities(placed(cloths, &MovingCloth::velocities, 3, options.velocity_stride, offset)),
      inverse_masses(placed(cloths, &MovingCloth::inverse_masses, 1, 1, offset)),
      rest_areas(placed(cloths, &MovingCloth::rest_areas, 1, 1, offset)),
      regularization(placed(cloths, &MovingCloth::regularization, 1, 1, offset)) {
}

Buffers CallerBuffers::views() const {
    const std::size_t bytes = offset * sizeof(float);
    Buffers views{.positions = {positions.get(), bytes},
                  .velocities = {velocities.get(), bytes},
                  .inverse_masses = {inverse_masses.get(), bytes},
                  .rest_areas = {rest_areas.get(), bytes},
                  .regularization = {}};
    if (options.regularization_per_triangle) views.regularization = {regularization.get(), bytes};
    return views;
}

std::vector<float> CallerBuffers::read_velocities() const {
    for (const auto* array : {&positions, &inverse_masses, &rest_areas, &regularization}) array->read();
    const std::vector<float> all = velocities.read();
    const std::vector<float> untouched = poison<float>(1);
    std::vector<float> numbers;
    for (std::size_t n = 0; n < all.size(); ++n) {
        if (n >= offset && (n - offset) % options.velocity_stride < 3)
            numbers.push_back(all[n]);
        else if (!same_bytes({all[n]}, untouched))
            throw std::runtime_error("float " + std::to_string(n) +
                                     " of the velocities, between two vertices, was written");
    }
    return numbers;
}

std::vector<Stats> filter(StrainLimiter& limiter, const CallerBuffers& buffers,
                          std::span<const Parameters> parameters) {
    const Owned<cl_command_queue> queue = in_order_queue();
    const cl_event limited = limiter.enqueue(queue.get(), buffers.views(), parameters);
    std::vector<Stats> stats(limiter.cloth_count());
    const cl_event read = limiter.read_stats(queue.get(), stats, {&limited, 1});
    require_success(wait_and_release(read), "reading the statistics");
    require_success(wait_and_release(limited), "the filter");
    return stats;
}

}  // namespace apsl::test

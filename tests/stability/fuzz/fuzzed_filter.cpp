// SPDX-License-Identifier: MIT
#include "stability/fuzz/fuzzed_filter.hpp"

#include <apsl/error.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace apsl::test {
namespace {

std::vector<std::shared_ptr<const Topology>> topologies_of(const FuzzCase& c) {
    std::vector<std::shared_ptr<const Topology>> topologies;
    for (const MovingCloth& cloth : c.cloths) topologies.push_back(cloth.topology);
    return topologies;
}

}  // namespace

DeviceFilter::DeviceFilter(const FuzzCase& c)
    : options_(c.options),
      offset_(c.offset),
      topologies_(topologies_of(c)),
      limiter_(std::make_unique<StrainLimiter>(device().context, device().id, topologies_, options_)) {
}

bool DeviceFilter::fits(const FuzzCase& c) const {
    return !remembers(c) && c.options == options_ && topologies_of(c) == topologies_;
}

std::vector<Filtered> DeviceFilter::call(const std::vector<MovingCloth>& cloths,
                                         std::span<const Parameters> parameters) {
    const CallerBuffers buffers(cloths, options_, offset_);
    std::vector<const DeviceArray<float>*> inputs{
        &buffers.inverse_masses, &buffers.rest_areas,       &buffers.regularization,
        &buffers.rest_shapes,    &buffers.stretch_ceilings, &buffers.contacts,
        &buffers.rest_hinges,    &buffers.accelerations,    &buffers.tether_lengths};
    if (!options_.integrates) inputs.push_back(&buffers.positions);
    std::vector<std::vector<float>> given;
    for (const auto* input : inputs) given.push_back(input->read());
    const std::vector<std::uint32_t> anchors = buffers.tether_anchors.read();
    const std::vector<Stats> stats = filter(*limiter_, buffers, parameters);
    if (!same_bytes(buffers.tether_anchors.read(), anchors)) throw std::runtime_error("an input buffer was written to");
    for (std::size_t n = 0; n < given.size(); ++n)
        if (!same_bytes(inputs[n]->read(), given[n])) throw std::runtime_error("an input buffer was written to");

    const std::vector<float> velocities = buffers.read_velocities(), positions = buffers.read_positions();
    std::vector<Filtered> results;
    std::ptrdiff_t begin = 0;
    for (std::size_t n = 0; n < cloths.size(); ++n) {
        const std::ptrdiff_t end = begin + static_cast<std::ptrdiff_t>(cloths[n].velocities.size());
        results.push_back({{velocities.begin() + begin, velocities.begin() + end}, stats[n]});
        if (options_.integrates) results.back().positions = {positions.begin() + begin, positions.begin() + end};
        begin = end;
    }
    return results;
}

template <class Real>
ReferenceFilter<Real>::ReferenceFilter(const FuzzCase& c) : options_(c.options) {
    for (const MovingCloth& cloth : c.cloths) limiters_.emplace_back(cloth.topology, c.options);
}

template <class Real>
std::vector<Filtered> ReferenceFilter<Real>::call(const std::vector<MovingCloth>& cloths,
                                                  std::span<const Parameters> parameters) {
    std::vector<Filtered> results;
    for (std::size_t n = 0; n < cloths.size(); ++n) {
        const MovingCloth& cloth = cloths[n];
        const auto real = [](const std::vector<double>& numbers) {
            return std::vector<Real>(numbers.begin(), numbers.end());
        };
        const std::vector<Real> positions = real(cloth.positions), masses = real(cloth.inverse_masses),
                                areas = real(cloth.rest_areas);
        const auto real_where = [&](bool given, const std::vector<double>& numbers) {
            return given ? real(numbers) : std::vector<Real>{};
        };
        const std::vector<Real> alpha = real_where(options_.regularization_per_triangle, cloth.regularization);
        const std::vector<Real> shapes = real_where(options_.limits_stretch, cloth.rest_shapes);
        const std::vector<Real> ceilings = real_where(options_.stretch_ceiling_per_triangle, cloth.stretch_ceilings);
        const std::vector<Real> contacts = real_where(options_.keeps_contacts, cloth.contacts);
        const std::vector<Real> hinges = real_where(options_.bends, cloth.rest_hinges);
        const std::vector<Real> accelerations = real_where(options_.acceleration_per_vertex, cloth.accelerations);
        const std::vector<Real> lengths = real_where(options_.tethers_per_vertex > 0, cloth.tether_lengths);
        std::span<const std::uint32_t> anchors;
        if (options_.tethers_per_vertex > 0) anchors = cloth.tether_anchors;
        std::vector<Real> velocities = real(cloth.velocities);
        std::vector<Real> ends = options_.integrates ? positions : std::vector<Real>{};
        const bool refused = refused_by_reference(cloth);
        try {
            limiters_[n].enqueue({positions, velocities, masses, areas, alpha, shapes, ceilings, contacts, ends, hinges,
                                  accelerations, anchors, lengths},
                                 parameters[n]);
            if (refused) throw std::runtime_error("took what it has to refuse");
        } catch (const Error& error) {
            if (!refused) throw;
            if (std::string(error.what()).find('\n') != std::string::npos)
                throw std::runtime_error("an error of several lines");
            results.push_back({cloth.velocities, {}});
            if (options_.integrates) results.back().positions = cloth.positions;
            results.back().stats.status = Status::diverged;
            continue;
        }
        results.push_back(
            {{velocities.begin(), velocities.end()}, limiters_[n].read_stats(), {ends.begin(), ends.end()}});
    }
    return results;
}

bool refused_by_reference(const MovingCloth& cloth) {
    const auto any = [](const std::vector<double>& numbers, auto bad) {
        return std::any_of(numbers.begin(), numbers.end(), bad);
    };
    return any(cloth.inverse_masses, [](double w) { return !std::isfinite(w) || w < 0.0; }) ||
           any(cloth.rest_areas, [](double area) { return !std::isfinite(area) || area < 0.0; });
}

template class ReferenceFilter<double>;
template class ReferenceFilter<float>;

}  // namespace apsl::test

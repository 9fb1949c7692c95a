// SPDX-License-Identifier: MIT
#include "stability/fuzz/random_state.hpp"

#include <apsl/reference.hpp>

#include <array>
#include <cmath>

namespace apsl::test {
namespace {

void move(Random& random, MovingCloth& cloth, double size) {
    const double steps_per_second = random.one_of({60.0, 60.0, 1000.0});
    const double noise = random.one_of({0.0, 0.01, 0.1, 1.0}) * size * steps_per_second;
    for (double& velocity : cloth.velocities) velocity = noise * random.number(-1.0, 1.0);
}

void place(Random& random, MovingCloth& cloth, double size) {
    std::vector<double>& x = cloth.positions;
    const auto coordinate_of_all = [&](std::size_t axis, double value) {
        for (std::size_t n = axis; n < x.size(); n += 3) x[n] = value;
    };
    switch (random.below(10)) {
        case 0:  // at rest
            break;
        case 1:  // anywhere
            for (double& coordinate : x) coordinate = size * random.number(-1.0, 1.0);
            break;
        case 2:  // in one point, moving apart or not
            for (std::size_t axis = 0; axis < 3; ++axis) coordinate_of_all(axis, 0.25 * size);
            break;
        case 3:  // on a line
            coordinate_of_all(1, 0.0);
            coordinate_of_all(2, 0.1);
            break;
        case 4:  // turned inside out by the step
            for (std::size_t n = 0; n < x.size(); ++n)
                if (n % 3 == 0) cloth.velocities[n] = -120.0 * x[n];
            break;
        case 5:  // far away
            for (double& coordinate : x) coordinate += 1000.0;
            break;
        case 6:  // so fast that squares overflow
            for (double& velocity : cloth.velocities)
                if (random.chance(0.05)) velocity = random.one_of({1e30, -1e30, 1e20, 3e38, 1e10});
            break;
        case 7:  // below the smallest normal number
            for (double& coordinate : x) coordinate *= random.one_of({1e-40, 1e-44, 1e-22});
            break;
        default: {  // stretched
            std::array<double, 3> factor{};
            for (double& f : factor) f = random.number(0.8, 1.3);
            for (std::size_t n = 0; n < x.size(); ++n) x[n] *= factor[n % 3];
        }
    }
    // Two vertices in one place.
    if (random.chance(0.05)) {
        const std::size_t from = random.below(x.size() / 3), to = random.below(x.size() / 3);
        for (std::size_t k = 0; k < 3; ++k) {
            x[3 * to + k] = x[3 * from + k];
            cloth.velocities[3 * to + k] = cloth.velocities[3 * from + k];
        }
    }
}

void weigh(Random& random, MovingCloth& cloth) {
    const double spread = random.one_of({1.0, 2.0, 1000.0});
    for (double& inverse_mass : cloth.inverse_masses)
        inverse_mass =
            inverse_mass > 0.0 ? inverse_mass * random.magnitude(1.0 / spread, spread) : random.one_of({0.0, 1.0});
    const double pinned = random.one_of({0.0, 0.05, 0.5, 1.0});
    for (double& inverse_mass : cloth.inverse_masses)
        if (random.chance(pinned)) inverse_mass = 0.0;
}

void round_to_float(std::vector<double>& numbers) {
    for (double& number : numbers) number = static_cast<float>(number);
}

// Shapes as the positions have them, or other ones; ceilings of all sizes.
void describe_stretch_limits(Random& random, MovingCloth& cloth) {
    const double scale = random.one_of({1.0, 1.0, 1.0, 0.5, 1.5, 1e-6, 1e6});
    for (double& number : cloth.rest_shapes) {
        number *= scale;
        if (!std::isfinite(static_cast<float>(number))) number = 0.0;  // of triangles next to nothing
    }
    if (random.chance(0.1))
        cloth.rest_shapes[random.below(cloth.rest_shapes.size())] = random.one_of({0.0, -7.0, 1e20});
    for (std::size_t a = 0; a < cloth.rest_areas.size(); ++a)
        cloth.stretch_ceilings.push_back(random.one_of({0.0, 1.01, 1.1, 1.1, 1.1, 2.0, 1e6}));
}

// Planes near where each vertex ends a step, a third of the vertices without one. Draws numbers of its own: the rest of
// a case is the same with contacts and without.
void touch(Random random, MovingCloth& cloth, double size) {
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
        std::array<double, 3> normal{random.number(-1.0, 1.0), random.number(-1.0, 1.0), random.number(-1.0, 1.0)};
        const double length =
            random.chance(0.3) ? std::numeric_limits<double>::infinity() : std::hypot(normal[0], normal[1], normal[2]);
        double offset = random.one_of({0.0, 1e-4, 0.01, 0.1}) * size * random.number(-1.0, 1.0);
        for (std::size_t k = 0; k < 3; ++k) {
            normal[k] /= length;
            offset += normal[k] * cloth.positions[3 * v + k];
        }
        cloth.contacts.insert(cloth.contacts.end(), {normal[0], normal[1], normal[2], offset});
        const double speed = random.one_of({0.0, 0.0, 0.1, 10.0}) * size;
        for (std::size_t k = 0; k < 3; ++k) cloth.contacts.push_back(speed * random.number(-1.0, 1.0));
        cloth.contacts.push_back(random.one_of({0.0, 0.3, 1.0, 1e6}));
    }
}

// Likewise.
void push(Random random, MovingCloth& cloth) {
    const double greatest = random.one_of({0.0, 10.0, 10.0, 1e4});
    for (std::size_t n = 0; n < cloth.positions.size(); ++n)
        cloth.accelerations.push_back(greatest * random.number(-1.0, 1.0));
}

// Likewise: to any vertex, pinned or not, a few to none.
void tie(Random random, MovingCloth& cloth, double size) {
    const std::size_t count = cloth.inverse_masses.size();
    for (std::size_t t = 0; t < MovingCloth::tethers * count; ++t) {
        cloth.tether_anchors.push_back(static_cast<std::uint32_t>(random.below(count + 2)));
        cloth.tether_lengths.push_back(random.one_of({0.0, 1e-6, 0.1, 0.5, 1.0, 2.0, 1e20}) * size);
    }
}

}  // namespace

MovingCloth random_state(Random& random, const Mesh& mesh, std::shared_ptr<const Topology> topology) {
    MovingCloth cloth;
    cloth.topology = std::move(topology);
    cloth.positions = mesh.positions;
    const double size = random.one_of({1.0, 1.0, 0.01, 10.0});
    const double thin = random.chance(0.15) ? random.magnitude(1e-4, 1.0) : 1.0;  // along one axis: needles
    const std::size_t axis = random.below(3);
    for (std::size_t n = 0; n < cloth.positions.size(); ++n) cloth.positions[n] *= n % 3 == axis ? thin * size : size;
    const double jitter = random.one_of({0.0, 0.01, 0.03}) * size;
    for (double& coordinate : cloth.positions) coordinate += jitter * random.number(-1.0, 1.0);

    round_to_float(cloth.positions);
    cloth.rest_areas = reference::areas<double>(*cloth.topology, cloth.positions);
    cloth.inverse_masses = reference::inverse_masses<double>(*cloth.topology, cloth.rest_areas, 0.2);
    cloth.rest_shapes = reference::rest_shapes<double>(*cloth.topology, cloth.positions);
    cloth.rest_hinges = reference::rest_hinges<double>(*cloth.topology, cloth.positions);
    for (double& inverse_mass : cloth.inverse_masses)
        if (!std::isfinite(inverse_mass)) inverse_mass = 1.0;  // of triangles without area
    cloth.velocities.assign(cloth.positions.size(), 0.0);
    weigh(random, cloth);
    move(random, cloth, size);
    place(random, cloth, size);
    const double alpha_above_1 = random.one_of({0.0, 0.01, 0.5, 1e6});
    for (std::size_t a = 0; a < cloth.rest_areas.size(); ++a)
        cloth.regularization.push_back(1.0 + alpha_above_1 * random.number(0.5, 1.5));
    describe_stretch_limits(random, cloth);
    touch(random, cloth, size);
    push(random, cloth);
    tie(random, cloth, size);
    if (random.chance(0.05)) {
        double& rest_area = cloth.rest_areas[random.below(cloth.rest_areas.size())];
        rest_area = random.one_of({0.0, -1.0, 1e-42, 1e-20, 1e20});
    }
    for (auto* numbers : {&cloth.positions, &cloth.velocities, &cloth.inverse_masses, &cloth.rest_areas,
                          &cloth.regularization, &cloth.rest_shapes, &cloth.stretch_ceilings, &cloth.contacts,
                          &cloth.rest_hinges, &cloth.accelerations, &cloth.tether_lengths})
        round_to_float(*numbers);
    return cloth;
}

}  // namespace apsl::test

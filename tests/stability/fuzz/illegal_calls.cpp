// SPDX-License-Identifier: MIT
#include "stability/fuzz/illegal_calls.hpp"

#include <apsl/error.hpp>
#include <apsl/reference.hpp>

#include <cmath>
#include <functional>
#include <limits>

namespace apsl::test {
namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

Parameters illegal_parameters(Random& random) {
    Parameters p;
    switch (random.below(10)) {
        case 0:
            p.time_step = random.one_of({0.0f, -1.0f, infinity, not_a_number, -1e-45f});
            break;
        case 1:
            p.regularization = random.one_of({0.0f, 0.999f, -1.0f, infinity, not_a_number});
            break;
        case 2:
            p.sub_steps = random.one_of({-1, std::numeric_limits<std::int32_t>::min()});
            break;
        case 3:
            p.target_area_change = random.one_of({-1e-9f, infinity, not_a_number});
            break;
        case 4:
            p.tolerance = random.one_of({-1e-9f, 1.0f, infinity, not_a_number});
            break;
        case 5:
            p.max_iterations = random.one_of({0, -1, 10001});
            break;
        case 6:
            p.adaptive_threshold = -1;
            break;
        case 7:
            p.stretch_ceiling = random.one_of({-1.0f, 0.5f, 1.0f, 1.009f, infinity, not_a_number});
            break;
        case 8:
            p.most_sub_steps = random.one_of({-1, 1, 29});
            break;
        default:
            p.first_regularization = random.one_of({1.0f, 0.5f, -2.0f, infinity, not_a_number});
    }
    return p;
}

Options illegal_options(Random& random) {
    Options options;
    switch (random.below(6)) {
        case 0:
            options.work_group_size = random.one_of({3u, 100u, 255u, 1u << 31});
            break;
        case 1:
            options.position_stride = random.one_of({0u, 1u, 2u});
            break;
        case 2:
            options.velocity_stride = random.one_of({0u, 2u});
            break;
        case 3:
            options.matrix = static_cast<Matrix>(random.one_of({2, -1}));
            break;
        case 4:
            options.apply = static_cast<Apply>(random.one_of({2, -1}));
            break;
        default:
            options.execution = static_cast<Execution>(random.one_of({3, -1}));
    }
    return options;
}

std::vector<Triangle> illegal_triangles(Random& random) {
    return random.one_of<std::vector<Triangle>>({{}, {{0, 0, 1}}, {{0, 1, 2}, {0, 1, 4}}, {{0, 1, 0xFFFFFFFFu}}});
}

Buffers illegal_buffers(Random& random, Buffers buffers) {
    BufferView Buffers::* const view =
        random.one_of({&Buffers::positions, &Buffers::velocities, &Buffers::inverse_masses, &Buffers::rest_areas});
    switch (random.below(3)) {
        case 0:
            (buffers.*view).buffer = nullptr;
            break;
        case 1:
            (buffers.*view).offset = random.one_of({std::size_t{1}, std::size_t{6}});
            break;
        default:
            (buffers.*view).offset = random.one_of({std::size_t{4}, std::size_t{1} << 40, ~std::size_t{3}});
    }
    return buffers;
}

std::optional<Violation> refused(const char* what, const std::function<void()>& call) {
    try {
        call();
    } catch (const Error& error) {
        const std::string line = error.what();
        if (!line.empty() && line.find('\n') == std::string::npos) return {};
        return Violation{"an error that is not one line", std::string(what) + ": " + line};
    } catch (const std::exception& error) {
        return Violation{"an exception that is no apsl::Error", std::string(what) + ": " + error.what()};
    }
    return Violation{"an illegal call was not refused", what};
}

}  // namespace

std::optional<Violation> check_illegal_call(Random& random) {
    static const MovingCloth cloth = moving_cloth(grid(3, 3, 1.0, 1.0, Diagonals::uniform), 1);
    static StrainLimiter limiter(device().context, device().id, cloth.topology);
    const Owned<cl_command_queue> queue = in_order_queue();
    const CallerBuffers buffers({&cloth, 1}, {});
    const auto enqueue = [&](const Buffers& views, std::span<const Parameters> parameters) {
        require_success(wait_and_release(limiter.enqueue(queue.get(), views, parameters)), "the filter");
    };
    switch (random.below(6)) {
        case 0: {
            const Parameters parameters = illegal_parameters(random);
            return refused("parameters", [&] { enqueue(buffers.views(), {&parameters, 1}); });
        }
        case 1: {
            const Parameters parameters = illegal_parameters(random);
            return refused("parameters of the reference", [&] {
                reference::StrainLimiter reference(cloth.topology);
                std::vector<double> velocities = cloth.velocities;
                reference.enqueue({cloth.positions, velocities, cloth.inverse_masses, cloth.rest_areas, {}},
                                  parameters);
            });
        }
        case 2:
            return refused("options", [&] {
                StrainLimiter(device().context, device().id, cloth.topology, illegal_options(random));
            });
        case 3:
            return refused("triangles", [&] { Topology::build(illegal_triangles(random), 4); });
        case 4: {
            const Parameters parameters;
            const Buffers views = illegal_buffers(random, buffers.views());
            return refused("buffers", [&] { enqueue(views, {&parameters, 1}); });
        }
        default: {
            const std::vector<Parameters> parameters(random.one_of({0u, 2u, 3u}));
            return refused("a number of parameters", [&] { enqueue(buffers.views(), parameters); });
        }
    }
}

}  // namespace apsl::test

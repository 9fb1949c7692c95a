// SPDX-License-Identifier: MIT
#include "viennacl_conjugate_gradient.hpp"

#define VIENNACL_WITH_OPENCL
#include <cmath>
#include <memory>
#include <viennacl/compressed_matrix.hpp>
#include <viennacl/linalg/cg.hpp>
#include <viennacl/ocl/backend.hpp>
#include <viennacl/vector.hpp>

namespace apsl::bench {
namespace {

struct Solver {
    explicit Solver(const PressureSystem& system) : scale(system.area_excess.size()), lambda(scale.size()) {
        const auto rows = scale.size();
        for (std::size_t a = 0; a < rows; ++a)
            for (auto e = static_cast<std::size_t>(system.row_offsets[a]);
                 e < static_cast<std::size_t>(system.row_offsets[a + 1]); ++e)
                if (static_cast<std::size_t>(system.columns[e]) == a) scale[a] = 1.0f / std::sqrt(system.values[e]);
        std::vector<float> values(system.values.size()), scaled(rows);
        for (std::size_t a = 0; a < rows; ++a) {
            scaled[a] = scale[a] * system.area_excess[a];
            for (auto e = static_cast<std::size_t>(system.row_offsets[a]);
                 e < static_cast<std::size_t>(system.row_offsets[a + 1]); ++e)
                values[e] = scale[a] * system.values[e] * scale[static_cast<std::size_t>(system.columns[e])];
        }
        matrix.set(system.row_offsets.data(), system.columns.data(), values.data(), rows, rows, values.size());
        right_side.resize(rows);
        viennacl::copy(scaled, right_side);
    }
    std::vector<float> scale, lambda;
    viennacl::compressed_matrix<float> matrix;
    viennacl::vector<float> right_side;
};

void use(const Device& device) {
    static bool done = false;
    if (!done) {
        viennacl::ocl::setup_context(0, device.context.get(), device.id, device.queue.get());
        viennacl::ocl::switch_context(0);
    }
    done = true;
}

}  // namespace

Solve viennacl_conjugate_gradient(const Device& device, const PressureSystem& system) {
    use(device);
    return [solver = std::make_shared<Solver>(system)](int iterations) {
        const viennacl::linalg::cg_tag tag(0.0, static_cast<unsigned>(iterations));
        const viennacl::vector<float> scaled = viennacl::linalg::solve(solver->matrix, solver->right_side, tag);
        viennacl::copy(scaled, solver->lambda);
        std::vector<float> lambda = solver->lambda;
        for (std::size_t a = 0; a < lambda.size(); ++a) lambda[a] *= solver->scale[a];
        return lambda;
    };
}

}  // namespace apsl::bench

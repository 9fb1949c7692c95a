// SPDX-License-Identifier: MIT
//
// Compiled with OpenMP, and therefore alone in a library that shows no template of Eigen's: the linker would otherwise
// take either this threaded code or the reference's single-threaded code for both.
#include "eigen_conjugate_gradient.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <memory>

namespace apsl::bench {
namespace {

using SparseMatrix = Eigen::SparseMatrix<float, Eigen::RowMajor>;
using Vector = Eigen::VectorXf;

struct Solver {
    explicit Solver(const PressureSystem& system)
        : matrix(system.rows(), system.rows(), static_cast<Eigen::Index>(system.values.size()),
                 system.row_offsets.data(), system.columns.data(), system.values.data()),
          right_side(system.area_excess.data(), system.rows()) {
        solver.setTolerance(0.0f);
        solver.compute(matrix);
    }
    Eigen::Map<const SparseMatrix> matrix;
    Eigen::Map<const Vector> right_side;
    Vector lambda;
    Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower | Eigen::Upper, Eigen::DiagonalPreconditioner<float>> solver;
};

}  // namespace

Solve eigen_conjugate_gradient(const PressureSystem& system, int threads) {
    return [solver = std::make_shared<Solver>(system), threads](int iterations) {
        Eigen::setNbThreads(threads);
        solver->solver.setMaxIterations(iterations);
        solver->lambda = solver->solver.solve(solver->right_side);
        return std::vector<float>(solver->lambda.begin(), solver->lambda.end());
    };
}

int eigen_thread_count() {
    Eigen::setNbThreads(0);
    return Eigen::nbThreads();
}

}  // namespace apsl::bench

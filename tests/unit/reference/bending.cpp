// SPDX-License-Identifier: MIT
#include "reference/bending.hpp"

#include "unit/reference/sample_cloths.hpp"

#include "../../../kernels/constants.h"

#include <apsl/error.hpp>
#include <apsl/reference.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace apsl;
using namespace apsl::reference;
using Vector = Vector3<double>;

namespace {

constexpr Options bending_options{.limits_stretch = true, .integrates = true, .bends = true};
constexpr double lead = double{APSLK_BENDING_LEAD};

/// p(y) by the recurrence that bending uses.
double value(const BendingPolynomial<double>& polynomial, int degree, double y) {
    double r = polynomial.scale(), s = polynomial.first() * r, sum = s;
    for (int k = 1; k < degree; ++k) {
        r -= y * s;
        s = polynomial.momentum(k) * s + polynomial.gain(k) * r;
        sum += s;
    }
    return sum;
}

/// A cloth with rest hinges, and what a call of bending needs.
struct BendingCloth {
    test::SampleCloth cloth;
    std::vector<double> rest_hinges;

    Buffers<double> buffers() const {
        return {.positions = cloth.positions,
                .velocities = {},
                .inverse_masses = cloth.inverse_masses,
                .rest_areas = cloth.rest_areas,
                .regularization = {},
                .rest_hinges = rest_hinges};
    }
    std::vector<double> velocity_changes(const std::vector<double>& motion, const Parameters& parameters) const {
        Bending<double> bending(*cloth.topology);
        bending.start(buffers());
        bending.find_velocity_changes(cloth.positions, motion, ResolvedParameters(parameters, bending_options));
        return {bending.velocity_changes().begin(), bending.velocity_changes().end()};
    }
};

/// The wavy cloths, flat at rest.
std::vector<BendingCloth> bent_cloths() {
    std::vector<BendingCloth> bent;
    for (test::SampleCloth& cloth : test::wavy_cloths()) {
        std::vector<double> rest(2 * cloth.topology->hinge_count());
        for (std::size_t n = 0; n < rest.size(); n += 2) rest[n + 1] = 1.5;
        bent.push_back({std::move(cloth), std::move(rest)});
    }
    return bent;
}

/// −∂E/∂x by finite differences of hinge energies, [3V].
std::vector<double> force(const BendingCloth& bent, double rigidity) {
    const std::vector<Hinge> hinges = bent.cloth.topology->hinges();
    const auto energy = [&](const std::vector<double>& x) {
        double sum = 0.0;
        for (std::size_t r = 0; r < hinges.size(); ++r)
            sum += hinge_energy<double>({bent.rest_hinges[2 * r], bent.rest_hinges[2 * r + 1]}, rigidity,
                                        hinge_geometry<double>(hinges[r], x).angle);
        return sum;
    };
    std::vector<double> x = bent.cloth.positions, force(x.size());
    for (std::size_t n = 0; n < x.size(); ++n) {
        const double at = x[n], step = 1e-6;
        x[n] = at + step;
        const double above = energy(x);
        x[n] = at - step;
        force[n] = (energy(x) - above) / (2 * step);
        x[n] = at;
    }
    return force;
}

double largest(const std::vector<double>& numbers) {
    double greatest = 0.0;
    for (const double number : numbers) greatest = std::max(greatest, std::abs(number));
    return greatest;
}

/// Where the free end of a strip comes to rest that is clamped at the other end, m below it. 0.5 m long, 0.1 m wide,
/// 0.2 kg/m², `columns` × 3 vertices, the first two columns pinned.
struct Cantilever {
    static constexpr std::uint32_t columns = 12, rows = 3;
    static constexpr double spacing = 0.5 / (columns - 2), width = 0.1, density = 0.2, gravity = 9.81;

    double rest(float rigidity, int sub_steps, float time_step, int iterations, double duration = 2.5) const {
        const test::Mesh mesh = test::grid(columns, rows, spacing * (columns - 1), width, test::Diagonals::uniform);
        const auto topology = Topology::build(mesh.triangles, mesh.vertex_count());
        std::vector<double> x = mesh.positions, v(x.size(), 0.0);
        const auto rest_areas = areas<double>(*topology, x), shapes = rest_shapes<double>(*topology, x),
                   hinges = rest_hinges<double>(*topology, x);
        auto w = inverse_masses<double>(*topology, rest_areas, density);
        for (std::uint32_t row = 0; row < rows; ++row) w[row * columns] = w[row * columns + 1] = 0.0;
        StrainLimiter limiter(topology, bending_options);
        for (double time = 0.0; time < duration; time += static_cast<double>(time_step)) {
            limiter.enqueue({.positions = x,
                             .velocities = v,
                             .inverse_masses = w,
                             .rest_areas = rest_areas,
                             .regularization = {},
                             .rest_shapes = shapes,
                             .end_positions = x,
                             .rest_hinges = hinges},
                            {.time_step = time_step,
                             .sub_steps = sub_steps,
                             .most_sub_steps = sub_steps,
                             .stretch_ceiling = 1.01f,
                             .acceleration = {0.0f, -9.81f, 0.0f},
                             .damping = 6.0f,
                             .bending = rigidity,
                             .bending_iterations = iterations});
            REQUIRE(limiter.read_stats().status == Status::ok);
        }
        return -x[3 * (columns + columns - 1) + 1];
    }

    /// Of a chain of hinges bent a little: at each the weight beyond it turns B width/spacing times the angle.
    double rest_by_hand(double rigidity) const {
        double tip = 0.0;
        for (std::uint32_t hinge = 1; hinge + 1 < columns; ++hinge) {
            double moment = 0.0;
            for (std::uint32_t column = hinge + 1; column < columns; ++column)
                moment += density * width * spacing * (column + 1 == columns ? 0.5 : 1.0) * gravity * spacing *
                          (column - hinge);
            tip += moment * spacing / (rigidity * width) * spacing * (columns - 1 - hinge);
        }
        return tip;
    }
};

}  // namespace

TEST_CASE("the polynomial of bending: its slope at zero, its bounds and its reach", "[bending]") {
    constexpr double greatest = double{APSLK_BENDING_GREATEST};
    for (const int degree : {1, 2, 3, 8, 30}) {
        CAPTURE(degree);
        const BendingPolynomial<double> polynomial(degree);
        CHECK(value(polynomial, degree, 0.0) == Approx(1.0));
        for (int n = 0; n <= 1000; ++n) {
            const double y = polynomial.reach() * n / 1000.0, filtered = y * value(polynomial, degree, y);
            CHECK(filtered >= -1e-12);
            CHECK(filtered <= greatest * (1.0 + 1e-9));
        }
        CHECK(polynomial.reach() == Approx(greatest * degree * degree).epsilon(0.05));
    }
    // The force itself.
    const BendingPolynomial<double> first(1);
    CHECK(value(first, 1, 1.7) == Approx(1.0));
    CHECK(first.reach() == Approx(greatest));
}

TEST_CASE("bending by one evaluation is the explicit force at positions a little ahead", "[bending]") {
    constexpr float rigidity = 1e-6f, time_step = 4e-3f;
    constexpr double duration = double{time_step} / 4;
    for (BendingCloth& bent : bent_cloths()) {
        INFO(bent.cloth.name);
        std::vector<double> motion(bent.cloth.positions.size());
        for (std::size_t n = 0; n < motion.size(); ++n) motion[n] = 0.01 * std::sin(static_cast<double>(n));
        const std::vector<double> changes = bent.velocity_changes(
            motion, {.time_step = time_step, .sub_steps = 5, .bending = rigidity, .bending_iterations = 1});
        for (std::size_t n = 0; n < motion.size(); ++n) bent.cloth.positions[n] += lead * motion[n] / 4;
        const std::vector<double> forces = force(bent, double{rigidity});
        for (std::size_t n = 0; n < changes.size(); ++n)
            CHECK(changes[n] ==
                  Approx(duration * bent.cloth.inverse_masses[n / 3] * forces[n]).margin(1e-4 * largest(changes)));
    }
}

TEST_CASE("bending by several evaluations is the polynomial in the stiffness", "[bending]") {
    constexpr float rigidity = 1e-4f, time_step = 4e-3f;
    constexpr double duration = double{time_step} / 4;
    for (const int degree : {2, 3, 7})
        for (const BendingCloth& bent : bent_cloths()) {
            INFO(bent.cloth.name);
            const std::size_t size = bent.cloth.positions.size();
            const std::vector<double> changes = bent.velocity_changes(
                std::vector<double>(size, 0.0),
                {.time_step = time_step, .sub_steps = 5, .bending = rigidity, .bending_iterations = degree});
            const BendingPolynomial<double> polynomial(degree);
            const std::vector<Hinge> hinges = bent.cloth.topology->hinges();
            std::vector<std::uint32_t> counts(bent.cloth.topology->vertex_count(), 0);
            for (const Hinge& hinge : hinges)
                for (const std::uint32_t vertex : hinge) ++counts[vertex];
            const auto rows = static_cast<Eigen::Index>(size);
            Eigen::MatrixXd K = Eigen::MatrixXd::Zero(rows, rows);
            Eigen::VectorXd f = Eigen::VectorXd::Zero(rows), root_w(rows);
            for (std::size_t r = 0; r < hinges.size(); ++r) {
                const HingeRow<double> row = hinge_row<double>(
                    hinges[r], {bent.rest_hinges[2 * r], bent.rest_hinges[2 * r + 1]}, bent.cloth.positions,
                    bent.cloth.inverse_masses, counts, double{rigidity}, duration, polynomial.reach());
                Eigen::VectorXd gradient = Eigen::VectorXd::Zero(rows);
                for (std::size_t n = 0; n < 4; ++n) gradient.segment<3>(3 * hinges[r][n]) = row.gradients[n];
                K += gradient * gradient.transpose();
                f -= row.moment * gradient;
            }
            for (Eigen::Index n = 0; n < rows; ++n)
                root_w[n] = std::sqrt(bent.cloth.inverse_masses[static_cast<std::size_t>(n) / 3]);
            const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(duration * duration * root_w.asDiagonal() * K *
                                                                       root_w.asDiagonal());
            // No mode is beyond the reach of the polynomial, whatever the rigidity.
            CHECK(modes.eigenvalues().maxCoeff() <= polynomial.reach());
            const Eigen::VectorXd filtered =
                modes.eigenvalues().unaryExpr([&](double y) { return value(polynomial, degree, std::max(y, 0.0)); });
            const Eigen::VectorXd want =
                duration * (root_w.asDiagonal() * modes.eigenvectors() * filtered.asDiagonal() *
                            modes.eigenvectors().transpose() * root_w.asDiagonal() * f);
            for (std::size_t n = 0; n < size; ++n)
                CHECK(changes[n] == Approx(want[static_cast<Eigen::Index>(n)]).margin(1e-5 * largest(changes)));
        }
}

TEST_CASE("a hinge is as stiff as asked for, up to what is stable", "[bending]") {
    // Heights of 1 m, the opposite vertices above the edge's ends: every gradient of length 1.
    const std::vector<double> positions{0, 0, 0, 0, 1, 0, 1, 0, 0, -1, 1, 0.0};
    const std::vector<double> w{1, 2, 0, 3};
    const std::vector<std::uint32_t> counts{8, 5, 20, 1};
    const auto row = [&](double rigidity) {
        return hinge_row<double>({0, 1, 2, 3}, {0.3, 0.5}, positions, w, counts, rigidity, 0.1, 2.4);
    };
    const HingeRow<double> asked = row(0.8);
    CHECK(asked.moment == Approx(-0.3 * std::sqrt(0.4)));
    for (const Vector& gradient : asked.gradients) CHECK(gradient.squaredNorm() == Approx(0.4));
    // h² count w |g| Σ|g| k = 0.01 · 5 · 2 · 1 · 4 k is 2.4 at k = 6, at the second vertex.
    for (const Vector& gradient : row(13.0).gradients) CHECK(gradient.squaredNorm() == Approx(6.0));
}

TEST_CASE("bending neither pushes nor turns a cloth, however stiff", "[bending]") {
    for (const int degree : {1, 4})
        for (BendingCloth& bent : bent_cloths()) {
            INFO(bent.cloth.name);
            for (double& w : bent.cloth.inverse_masses) w = w > 0.0 ? w : 3.0;
            const std::size_t size = bent.cloth.positions.size();
            const std::vector<double> changes = bent.velocity_changes(
                std::vector<double>(size, 0.0),
                {.time_step = 1.0f / 60.0f, .sub_steps = 5, .bending = 10.0f, .bending_iterations = degree});
            Vector momentum = Vector::Zero(), turned = Vector::Zero();
            double scale = 0.0;
            for (std::size_t i = 0; i < size / 3; ++i) {
                const Vector impulse = position<double>(changes, i) / bent.cloth.inverse_masses[i],
                             x = position<double>(bent.cloth.positions, i);
                momentum += impulse;
                turned += x.cross(impulse);
                scale += (1.0 + x.norm()) * impulse.norm();
            }
            CHECK((scale > 0.0) == !bent.rest_hinges.empty());
            CHECK(momentum.norm() <= 1e-10 * scale);
            CHECK(turned.norm() <= 1e-10 * scale);
        }
}

TEST_CASE("bending: a strip hangs as its hinges let it, whatever the steps", "[bending]") {
    const Cantilever strip;
    // Bent little: by hand. The strip is three vertices wide, and its free edges give way more than the chain does.
    const double stiff = strip.rest(2.0f, 30, 1.0f / 60.0f, 8);
    CHECK(stiff > strip.rest_by_hand(2.0));
    CHECK(stiff < 1.3 * strip.rest_by_hand(2.0));
    for (const float rigidity : {1e-3f, 1e-1f}) {
        const double converged = strip.rest(rigidity, 90, 1.0f / 60.0f, 2);
        CAPTURE(rigidity, converged);
        CHECK(strip.rest(rigidity, 10, 1.0f / 60.0f, 6) == Approx(converged).epsilon(0.03));
        CHECK(strip.rest(rigidity, 30, 1.0f / 60.0f, 2) == Approx(converged).epsilon(0.03));
        CHECK(strip.rest(rigidity, 10, 1.0f / 30.0f, 12) == Approx(converged).epsilon(0.03));
        CHECK(strip.rest(rigidity, 10, 1.0f / 240.0f, 2) == Approx(converged).epsilon(0.03));
    }
}

TEST_CASE("bending: far too stiff for its steps, a strip is softer and stays whole", "[bending]") {
    const Cantilever strip;
    const double soft = strip.rest(1e4f, 10, 1.0f / 60.0f, 1), stiffer = strip.rest(1e4f, 10, 1.0f / 60.0f, 4);
    CHECK(soft < 0.55);
    CHECK(stiffer < soft);
}

TEST_CASE("bending: a fold at rest stays, and one that is opened closes again", "[bending]") {
    // Two triangles, folded by a right angle at rest.
    const auto topology = Topology::build(std::vector<Triangle>{{0, 1, 2}, {1, 0, 3}}, 4);
    const auto folded = [](double angle) {
        return std::vector<double>{0, 0, 0, 0, 1, 0, 1, 0.5, 0, -std::cos(angle), 0.5, std::sin(angle)};
    };
    constexpr double right = std::numbers::pi / 2;
    const std::vector<double> at_rest = folded(right), w(4, 10.0);
    const auto rest_areas = areas<double>(*topology, at_rest), shapes = rest_shapes<double>(*topology, at_rest),
               hinges = rest_hinges<double>(*topology, at_rest);
    const auto after = [&](double angle, double duration) {
        std::vector<double> x = folded(angle), v(12, 0.0);
        StrainLimiter limiter(topology, bending_options);
        for (double time = 0.0; time < duration; time += 1.0 / 60.0)
            limiter.enqueue({.positions = x,
                             .velocities = v,
                             .inverse_masses = w,
                             .rest_areas = rest_areas,
                             .regularization = {},
                             .rest_shapes = shapes,
                             .end_positions = x,
                             .rest_hinges = hinges},
                            {.stretch_ceiling = 1.05f, .damping = 3.0f, .bending = 0.1f});
        return hinge_geometry<double>({0, 1, 2, 3}, x).angle;
    };
    CHECK(after(right, 0.5) == Approx(right).epsilon(1e-6));
    CHECK(after(0.2, 4.0) == Approx(right).epsilon(1e-3));
    CHECK(after(3.0, 4.0) == Approx(right).epsilon(1e-3));
}

TEST_CASE("bending: what it needs", "[bending]") {
    const auto message = [](const Parameters& parameters, const Options& options) {
        try {
            validate(options, parameters);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    CHECK(message({}, {.bends = true}) == "bends is on, which needs integrates");
    CHECK(message({}, {.integrates = true, .bends = true}) ==
          "bends is on, which needs limits_stretch: areas and bending alone let a cloth flow in its plane");
    CHECK(message({.bending = 1e-4f}, {}) == "bending is 1e-04, expected 0: bends is off");
    CHECK(message({.bending = 1e-4f}, bending_options) ==
          "bending is 1e-04 with a stretch_ceiling of 0: areas and bending alone let a cloth flow in its plane");
    CHECK(message({.bending = -1.0f}, bending_options) == "bending is -1, expected a finite number >= 0 (N·m)");
    CHECK(message({.bending_iterations = 0}, bending_options) ==
          "bending_iterations is 0, expected a whole number >= 1 and <= 1000");
    CHECK(message({.stretch_ceiling = 1.1f, .bending = 1e-4f}, bending_options) == "no error");
    Options one_each = bending_options;
    one_each.stretch_ceiling_per_triangle = true;
    CHECK(message({.bending = 1e-4f}, one_each) == "no error");

    std::vector<double> x{0, 0, 0, 0, 1, 0, 1, 0, 0, -1, 1, 0}, v(12, 0.0), w(4, 1.0);
    const auto topology = Topology::build(std::vector<Triangle>{{0, 1, 2}, {1, 0, 3}}, 4);
    const auto rest_areas = areas<double>(*topology, x), shapes = rest_shapes<double>(*topology, x);
    CHECK_THROWS_WITH(StrainLimiter(topology, bending_options)
                          .enqueue({.positions = x,
                                    .velocities = v,
                                    .inverse_masses = w,
                                    .rest_areas = rest_areas,
                                    .regularization = {},
                                    .rest_shapes = shapes,
                                    .end_positions = x,
                                    .rest_hinges = {}},
                                   {}),
                      "rest_hinges holds 0 numbers, expected 2");
}

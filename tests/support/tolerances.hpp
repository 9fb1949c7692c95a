// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace apsl::test {

/// Unit of 32-bit rounding, twice the greatest relative error of one operation.
constexpr double epsilon = std::numeric_limits<float>::epsilon();

/// Bound on ‖got − want‖ / ‖scale‖ where every number comes from about `operations` roundings: errors of the single
/// numbers are independent, so the norm-wise error does not grow with their count. Factor 2: rounding is not random.
constexpr double elementwise_tolerance(double operations) {
    return 2.0 * operations * epsilon;
}

/// Bound on the relative error of a sum of n terms that each carry `operations` roundings: partial sums of n terms
/// round like a random walk, √n. The scale is the sum of magnitudes, so that cancellation is not counted as error.
inline double sum_tolerance(double operations, std::size_t n) {
    return 2.0 * (operations + std::sqrt(static_cast<double>(n))) * epsilon;
}

/// Unit of the 16-bit fixed point in which gradients ḡ are stored (kernels/gradients.h), about 2⁻¹⁵: a component is off
/// by half of it at most, a triangle's nine together by 1.5 of it, against Σ |ḡ_k|² ≤ 1.
constexpr double gradient_unit = 1.0 / 32767.0;

/// Bound on the relative error, norm-wise, of what is bilinear in stored gradients (matrix entries and products): 1.5
/// units for each of the two factors, and a third more for entries that are small by cancellation. The scale is the sum
/// of magnitudes, where a diagonal entry is 1.
constexpr double stored_product_tolerance = 4.0 * gradient_unit;

inline double norm(std::span<const double> numbers) {
    double squares = 0.0;
    for (const double number : numbers) squares += number * number;
    return std::sqrt(squares);
}

/// ‖got − want‖; NaN where a number is, infinite where the lengths differ, so that no bound holds.
inline double difference(std::span<const double> got, std::span<const double> want) {
    if (got.size() != want.size()) return std::numeric_limits<double>::infinity();
    double squares = 0.0;
    for (std::size_t n = 0; n < got.size(); ++n) squares += (got[n] - want[n]) * (got[n] - want[n]);
    return std::sqrt(squares);
}

}  // namespace apsl::test

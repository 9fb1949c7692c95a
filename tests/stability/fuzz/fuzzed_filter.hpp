// SPDX-License-Identifier: MIT
#pragma once

#include "filter/filtered.hpp"
#include "stability/fuzz/fuzz_case.hpp"

#include <apsl/reference.hpp>

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace apsl::test {

/// The same calls on the device and on the reference in either precision.
class FuzzedFilter {
public:
    virtual ~FuzzedFilter() = default;
    /// One call on all cloths; what it left of each. Throws std::runtime_error where something was written that must
    /// not be: positions, masses, areas, padding, guard bands.
    virtual std::vector<Filtered> call(const std::vector<MovingCloth>& cloths,
                                       std::span<const Parameters> parameters) = 0;
    virtual std::string name() const = 0;
    virtual bool on_device() const = 0;
    /// Unit of its rounding.
    virtual double epsilon() const = 0;
};

class DeviceFilter : public FuzzedFilter {
public:
    /// A limiter of its own.
    explicit DeviceFilter(const FuzzCase& c);
    /// True where the case can use this limiter: same triangles and options, and nothing is remembered between calls.
    bool fits(const FuzzCase& c) const;
    void set_offset(std::size_t offset) { offset_ = offset; }

    std::vector<Filtered> call(const std::vector<MovingCloth>& cloths, std::span<const Parameters> parameters) override;
    std::string name() const override { return "OpenCL"; }
    bool on_device() const override { return true; }
    double epsilon() const override { return std::numeric_limits<float>::epsilon(); }

private:
    Options options_;
    std::size_t offset_;
    std::vector<std::shared_ptr<const Topology>> topologies_;
    std::unique_ptr<StrainLimiter> limiter_;
};

template <class Real>
class ReferenceFilter : public FuzzedFilter {
public:
    explicit ReferenceFilter(const FuzzCase& c);
    std::vector<Filtered> call(const std::vector<MovingCloth>& cloths, std::span<const Parameters> parameters) override;
    std::string name() const override {
        return sizeof(Real) == 8 ? "reference in double precision" : "reference in single precision";
    }
    bool on_device() const override { return false; }
    double epsilon() const override { return std::numeric_limits<Real>::epsilon(); }

private:
    Options options_;
    std::vector<reference::BasicStrainLimiter<Real>> limiters_;
};

/// True for what the reference refuses with an error: masses below 0, rest areas of 0 or less, or not finite.
bool refused_by_reference(const MovingCloth& cloth);

}  // namespace apsl::test

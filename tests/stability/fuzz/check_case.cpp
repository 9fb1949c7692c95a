// SPDX-License-Identifier: MIT
#include "stability/fuzz/check_case.hpp"

#include <exception>
#include <sstream>
#include <utility>

namespace apsl::test {
namespace {

/// The cloths as a call is given them: the case's own, or a step later with what the call before left.
std::vector<MovingCloth> given(const FuzzCase& c, const FuzzCall& call, const std::vector<MovingCloth>& last,
                               const std::vector<Filtered>& filtered) {
    std::vector<MovingCloth> cloths = c.cloths;
    if (call.carries_on && !filtered.empty()) {
        cloths = last;
        for (std::size_t n = 0; n < cloths.size(); ++n) {
            cloths[n].velocities = filtered[n].velocities;
            if (c.options.integrates) {
                cloths[n].positions = filtered[n].positions;
                continue;
            }
            for (std::size_t k = 0; k < cloths[n].positions.size(); ++k)
                cloths[n].positions[k] =
                    static_cast<float>(cloths[n].positions[k] +
                                       static_cast<double>(call.parameters[n].time_step) * cloths[n].velocities[k]);
        }
    }
    if (call.bad) (cloths[call.bad->cloth].*call.bad->array)[call.bad->index] = call.bad->value;
    return cloths;
}

Violation named(Violation violation, const FuzzedFilter& filter, std::size_t call, std::size_t cloth) {
    violation.details = filter.name() + ", call " + std::to_string(call) + ", cloth " + std::to_string(cloth) +
                        (violation.details.empty() ? "" : ": ") + violation.details;
    return violation;
}

/// What differs between the results of two calls, in words; empty where no bit does.
std::string difference_of(const std::vector<Filtered>& a, const std::vector<Filtered>& b) {
    std::ostringstream words;
    words.precision(9);
    for (std::size_t n = 0; n < a.size(); ++n) {
        const bool velocities =
            !same_velocities(a[n].velocities, b[n].velocities) || !same_velocities(a[n].positions, b[n].positions);
        if (!velocities && same_bytes<Stats>({a[n].stats}, {b[n].stats})) continue;
        words << ", cloth " << n << (velocities ? ": where it ends" : ": statistics alone");
        for (const Stats& stats : {a[n].stats, b[n].stats})
            words << " (status " << static_cast<int>(stats.status) << ", sub-steps " << stats.sub_steps
                  << ", iterations " << stats.iterations << ", residual " << stats.residual << ", max "
                  << stats.max_area_change << ", rms " << stats.rms_area_change << ')';
    }
    return words.str();
}

/// All calls of the case; `results` gets what each left.
std::optional<Violation> check_calls(const FuzzCase& c, FuzzedFilter& filter,
                                     std::vector<std::vector<Filtered>>& results) {
    std::vector<MovingCloth> cloths;
    std::vector<Filtered> filtered;
    for (std::size_t k = 0; k < c.calls.size(); ++k) {
        const FuzzCall& call = c.calls[k];
        cloths = given(c, call, cloths, filtered);
        filtered = filter.call(cloths, call.parameters);
        results.push_back(filtered);
        for (std::size_t n = 0; n < cloths.size(); ++n)
            if (auto violation = violation_of(cloths[n], c.options, call.parameters[n], filtered[n], filter))
                return named(*violation, filter, k, n);
    }
    return std::nullopt;
}

std::optional<Violation> check_on(const FuzzCase& c, FuzzedFilter& filter,
                                  std::vector<std::vector<Filtered>>& results) {
    try {
        return check_calls(c, filter, results);
    } catch (const std::exception& error) {
        return Violation{"an exception", filter.name() + ": " + error.what()};
    }
}

}  // namespace

std::optional<Violation> CaseChecker::check(const FuzzCase& c) {
    auto violation = check_all(c);
    if (remembers(c)) device_.reset();  // what it remembers is not the next case's
    return violation;
}

std::optional<Violation> CaseChecker::check_all(const FuzzCase& c) {
    // The device last: building a limiter is what takes long when a case is shrunk.
    std::vector<std::vector<Filtered>> on_device, again, in_double, in_single;
    ReferenceFilter<double> reference(c);
    if (auto violation = check_on(c, reference, in_double)) return violation;
    if (c.in_single_precision) {
        ReferenceFilter<float> single(c);
        if (auto violation = check_on(c, single, in_single)) return violation;
    }
    if (!device_ || !device_->fits(c)) {
        device_.reset();
        device_ = std::make_unique<DeviceFilter>(c);
    }
    device_->set_offset(c.offset);
    if (auto violation = check_on(c, *device_, on_device)) return violation;

    for (std::size_t n = 0; n < c.cloths.size() && !c.calls[0].bad; ++n)
        if (auto violation =
                disagreement(c.cloths[n], c.options, c.calls[0].parameters[n], on_device[0][n], in_double[0][n]))
            return named(*violation, *device_, 0, n);

    // The same calls once more: after a call that was given NaNs, too, a limiter that remembers nothing does what it
    // did before. One that does remember starts anew.
    if (!c.twice) return std::nullopt;
    if (remembers(c)) device_ = std::make_unique<DeviceFilter>(c);
    device_->set_offset(c.offset);
    if (auto violation = check_on(c, *device_, again)) return violation;
    for (std::size_t k = 0; k < on_device.size(); ++k)
        if (const std::string words = difference_of(on_device[k], again[k]); !words.empty())
            return Violation{"the same call twice gave different bytes", "OpenCL, call " + std::to_string(k) + words};
    return std::nullopt;
}

}  // namespace apsl::test

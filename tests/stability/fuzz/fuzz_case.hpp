// SPDX-License-Identifier: MIT
#pragma once

#include "support/device_cloth.hpp"

#include "resolved_parameters.hpp"

#include <apsl/parameters.hpp>
#include <apsl/strain_limiter.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace apsl::test {

/// Where a number that is not finite is put for one call.
struct BadNumber {
    std::vector<double> MovingCloth::* array;
    std::size_t cloth, index;
    double value;
};

/// One call on all cloths.
struct FuzzCall {
    std::vector<Parameters> parameters;  ///< one a cloth
    bool carries_on = false;             ///< from where the call before ended, a step later; else from the case's state
    std::optional<BadNumber> bad;
};

/// Everything that a case consists of: it depends on nothing that ran before it.
struct FuzzCase {
    Options options;
    std::size_t offset = 0;  ///< floats before the first element of every buffer
    std::vector<MovingCloth> cloths;
    std::vector<FuzzCall> calls;
    bool in_single_precision = true;  ///< whether the reference runs in single precision too
    bool twice = true;                ///< whether the calls run twice on the device
};

/// True where what a call does depends on the calls before it.
inline bool remembers(const FuzzCase& c) {
    bool result = c.options.warm_start_sub_steps > 0;
    for (const FuzzCall& call : c.calls)
        for (const Parameters& parameters : call.parameters)
            result = result || parameters.adaptive_threshold > 0 ||
                     ResolvedParameters(parameters, c.options).most_sub_steps > parameters.sub_steps;
    return result;
}

}  // namespace apsl::test

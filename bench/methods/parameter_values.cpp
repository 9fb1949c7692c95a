// SPDX-License-Identifier: MIT
#include "methods/parameter_values.hpp"

#include <apsl/error.hpp>

#include <cmath>
#include <sstream>

namespace apsl::methods {

ParameterInfo iterations_parameter(double standard) {
    return {"iterations", standard, 1.0, {1, 2, 5, 10, 20, 40, 80, 160, 320, 640}};
}

int whole_number(const char* parameter, double value) {
    require_between(parameter, value, 0.0, 1e6);
    if (value != std::floor(value)) {
        std::ostringstream message;
        message << parameter << " is " << value << ", expected a whole number";
        throw Error(ErrorCode::invalid_argument, message.str());
    }
    return static_cast<int>(value);
}

void require_between(const char* parameter, double value, double least, double greatest) {
    if (value >= least && value <= greatest) return;
    std::ostringstream message;
    message << parameter << " is " << value << ", expected a number from " << least << " to " << greatest;
    throw Error(ErrorCode::invalid_argument, message.str());
}

}  // namespace apsl::methods

// SPDX-License-Identifier: MIT
#include <apsl/error.hpp>
#include <apsl/options.hpp>
#include <apsl/parameters.hpp>

#include <catch2/catch.hpp>
#include <limits>

using namespace apsl;

namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

template <class Value>
std::string message_of(Value Parameters::* field, Value value) {
    Parameters parameters;
    parameters.*field = value;
    try {
        validate(parameters);
    } catch (const Error& error) {
        CHECK(error.code() == ErrorCode::invalid_argument);
        return error.what();
    }
    return "no error";
}

}  // namespace

TEST_CASE("the default parameters are legal") {
    CHECK_NOTHROW(validate(Parameters{}));
}

TEST_CASE("each parameter out of its range is named, with its value and its range") {
    CHECK(message_of(&Parameters::time_step, 0.0f) == "time_step is 0, expected a finite number > 0 (s)");
    CHECK(message_of(&Parameters::regularization, 0.5f) == "regularization is 0.5, expected a finite number >= 1");
    CHECK(message_of(&Parameters::sub_steps, -1) == "sub_steps is -1, expected a whole number >= 0 and <= 10000");
    CHECK(message_of(&Parameters::target_area_change, -0.25f) ==
          "target_area_change is -0.25, expected a finite number >= 0");
    CHECK(message_of(&Parameters::tolerance, 1.0f) == "tolerance is 1, expected a finite number >= 0 and < 1");
    CHECK(message_of(&Parameters::max_iterations, 0) ==
          "max_iterations is 0, expected a whole number >= 1 and <= 10000");
    CHECK(message_of(&Parameters::max_iterations, 10001) ==
          "max_iterations is 10001, expected a whole number >= 1 and <= 10000");
    CHECK(message_of(&Parameters::first_regularization, 1.0f) ==
          "first_regularization is 1, expected 0 (the same in every sub-step) or a finite number > 1");
}

TEST_CASE("a schedule of alpha has no end at 1") {
    Parameters parameters{.regularization = 1.0f, .first_regularization = 2.0f};
    CHECK_THROWS_WITH(validate(parameters),
                      "regularization is 1, expected a number > 1 where first_regularization is given");
    parameters.regularization = 1.01f;
    CHECK_NOTHROW(validate(parameters));
}

TEST_CASE("more sub-steps where stretch asks for them: what that needs") {
    const auto message = [](const Parameters& parameters, Options options = {.limits_stretch = true}) {
        try {
            validate(options, parameters);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    CHECK(message({.sub_steps = 30, .most_sub_steps = 60}) == "no error");
    CHECK(message({.sub_steps = 30, .most_sub_steps = 29}) ==
          "most_sub_steps is 29, expected 0 (automatic) or a whole number >= sub_steps, which is 30");
    CHECK(message({.most_sub_steps = -1}) == "most_sub_steps is -1, expected a whole number >= 0 and <= 10000");
    const std::string more = "most_sub_steps is 60, more than sub_steps, which needs ";
    CHECK(message({.most_sub_steps = 60}, {}) == more + "limits_stretch on");
    CHECK(message({.most_sub_steps = 60}, {.positions_only = true, .limits_stretch = true}) ==
          more + "velocities: positions_only is on");
    CHECK(message({.most_sub_steps = 60, .stepping = Stepping::whole_step}) ==
          more + "small steps: stepping is whole_step");
    CHECK(message({.sub_steps = 1, .most_sub_steps = 60}) == more + "sub_steps >= 2");
    CHECK(message({.most_sub_steps = 60, .first_regularization = 1.2f}) == more + "first_regularization 0");
    CHECK(message({.most_sub_steps = 30, .first_regularization = 1.2f}) == "no error");
    CHECK(message({.most_sub_steps = 30}, {}) == "no error");
}

TEST_CASE("numbers that are not finite are refused in every field") {
    for (const float bad : {not_a_number, infinity, -infinity})
        for (const auto field : {&Parameters::time_step, &Parameters::regularization, &Parameters::target_area_change,
                                 &Parameters::tolerance, &Parameters::first_regularization})
            CHECK(message_of(field, bad) != "no error");
}

TEST_CASE("the ends of the ranges are legal") {
    CHECK(message_of(&Parameters::regularization, 1.0f) == "no error");
    CHECK(message_of(&Parameters::regularization, 1e6f) == "no error");
    CHECK(message_of(&Parameters::sub_steps, 0) == "no error");
    CHECK(message_of(&Parameters::tolerance, 0.0f) == "no error");
    CHECK(message_of(&Parameters::max_iterations, 1) == "no error");
    CHECK(message_of(&Parameters::max_iterations, 10000) == "no error");
    CHECK(message_of(&Parameters::time_step, std::numeric_limits<float>::min()) == "no error");
}

// SPDX-License-Identifier: MIT
// fill_contacts.cl against contacts() in double precision.
#include "run/opencl_contacts.hpp"

#include "run/check_opencl.hpp"
#include "run/parse_scene.hpp"
#include "run/scene_cloth.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>

using namespace apsl;
using namespace apsl::scenes;

namespace {

constexpr double time_step = 1.0 / 60.0;

// Vertices at random places around the colliders, with random velocities: many inside, many that would go through.
SceneCloth scattered_cloth(const std::string& vertices, double speed) {
    const Scene scene = parse_scene(
        nlohmann::json::parse(R"({"mesh": {"grid": {"vertices": )" + vertices +
                              R"(, "size": [2, 2]}}, "pins": [{"vertices": [1, 3]}], "strain_limiting": {}})"),
        "scene.json");
    SceneCloth cloth = make_scene_cloth(scene);
    std::mt19937 random(7);
    const auto number = [&](double size) { return size * (2.0 * (static_cast<double>(random()) / 0x1p32) - 1.0); };
    for (double& coordinate : cloth.state.positions) coordinate = number(1.0);
    for (double& velocity : cloth.state.velocities) velocity = number(speed);
    return cloth;
}

std::vector<float> filled(const ClothState& cloth, std::span<const ColliderStep> colliders, const FreeFlight& flight) {
    OpenClCloth device(choose_opencl_device({}), cloth, StrainLimiting{}, false);
    OpenClContacts contacts(device, cloth.inverse_masses.size(), colliders.size());
    contacts.fill(device, colliders, flight, time_step, origin_for(cloth.positions));
    std::vector<float> records(8 * cloth.inverse_masses.size());
    check_opencl(clEnqueueReadBuffer(device.queue(), contacts.records(), CL_TRUE, 0, records.size() * sizeof(float),
                                     records.data(), 0, nullptr, nullptr),
                 "reading contacts");
    return records;
}

std::vector<ColliderStep> colliders_at(double time) {
    const Contact contact{.friction = 0.3, .thickness = 0.01};
    return {collider_step({Sphere{.center = {0.3, -0.2, 0.1}, .radius = 0.3, .contact = contact},
                           {.path = Translation{{0.5, 1.0, -0.3}}}},
                          time, time_step),
            collider_step({Capsule{.a = {-0.6, 0.2, 0}, .b = {-0.1, -0.3, 0.4}, .radius = 0.05, .contact = contact},
                           {.path = Rotation{.axis = {1, 2, 0}, .degrees_per_second = 360}}},
                          time, time_step),
            collider_step({Plane{.point = {0, -0.7, 0}, .normal = {0.1, 1, 0}, .contact = {.friction = 0.6}},
                           {.path = Rotation{.axis = {0, 0, 1}, .degrees_per_second = -20}}},
                          time, time_step)};
}

// m, m/s: 32 bits of numbers up to some ten metres, over a time step.
constexpr double near = 2e-5;

}  // namespace

TEST_CASE("contacts on the device are those of the reference") {
    for (const char* vertices : {"[2, 2]", "[9, 7]", "[65, 63]"})
        for (const double speed : {0.5, 30.0}) {
            CAPTURE(vertices, speed);
            const ClothState cloth = scattered_cloth(vertices, speed).state;
            const std::vector<ColliderStep> colliders = colliders_at(0.4);
            const FreeFlight flight = free_flight({0.0, -9.81, 0.0}, 0.5, time_step);
            const std::vector<double> want = contacts(cloth, colliders, flight, time_step);
            const std::vector<float> got = filled(cloth, colliders, flight);
            REQUIRE(got.size() == want.size());
            std::size_t different = 0;
            for (std::size_t v = 0; v < want.size() / 8; ++v) {
                double normal = 0.0, velocity = 0.0;
                for (std::size_t k = 0; k < 3; ++k) {
                    normal = std::max(normal, std::abs(static_cast<double>(got[8 * v + k]) - want[8 * v + k]));
                    velocity =
                        std::max(velocity, std::abs(static_cast<double>(got[8 * v + 4 + k]) - want[8 * v + 4 + k]));
                }
                const double offset = std::abs(static_cast<double>(got[8 * v + 3]) - want[8 * v + 3]);
                const bool alike = normal < 1e-3 && offset < 1e-3 && velocity < 1e-3 / time_step &&
                                   std::abs(static_cast<double>(got[8 * v + 7]) - want[8 * v + 7]) < 1e-6;
                different += alike ? 0 : 1;
            }
            // Where a way just touches, or two colliders are as deep, rounding decides.
            CHECK(static_cast<double>(different) <= 0.002 * static_cast<double>(want.size() / 8));
        }
}

TEST_CASE("contacts on the device: pinned vertices have none, and the same bytes come twice") {
    const ClothState cloth = scattered_cloth("[9, 7]", 5.0).state;
    const std::vector<ColliderStep> colliders = colliders_at(0.1);
    const FreeFlight flight = free_flight({0.0, -9.81, 0.0}, 0.5, time_step);
    const std::vector<float> first = filled(cloth, colliders, flight);
    CHECK(first == filled(cloth, colliders, flight));
    for (const std::size_t pinned : {1, 3})
        for (std::size_t k = 0; k < 8; ++k) CHECK(first[8 * pinned + k] == 0.0f);
}

TEST_CASE("contacts on the device: far from the origin they are around the device's own") {
    ClothState cloth = scattered_cloth("[9, 7]", 5.0).state;
    std::vector<MovingCollider> moving{
        {Sphere{.center = {0.3, -0.2, 0.1}, .radius = 0.5, .contact = {}},
         {.path = Rotation{.axis = {0, 1, 0}, .degrees_per_second = 90, .center = std::array<double, 3>{0, 0, 0}}}}};
    const FreeFlight flight = free_flight({}, 0.0, time_step);
    const auto step = [&] { return std::vector{collider_step(moving[0], 0.0, time_step)}; };
    const std::vector<float> here = filled(cloth, step(), flight);
    constexpr double away = 1024.0;
    for (double& coordinate : cloth.positions) coordinate += away;
    std::get<Sphere>(moving[0].shape).center = {0.3 + away, -0.2 + away, 0.1 + away};
    std::get<Rotation>(moving[0].motion.path).center = std::array<double, 3>{away, away, away};
    const std::vector<float> there = filled(cloth, step(), flight);
    const std::array<double, 3> origin = origin_for(cloth.positions);
    for (std::size_t v = 0; v < here.size() / 8; ++v) {
        double shift = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            CHECK(static_cast<double>(there[8 * v + k]) == Approx(here[8 * v + k]).margin(near));
            CHECK(static_cast<double>(there[8 * v + 4 + k]) == Approx(here[8 * v + 4 + k]).margin(near / time_step));
            shift += static_cast<double>(here[8 * v + k]) * (origin[k] - away);
        }
        CHECK(static_cast<double>(there[8 * v + 3]) == Approx(here[8 * v + 3] - shift).margin(near));
    }
}

// SPDX-License-Identifier: MIT
#include "methods/unfolded_distances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace apsl::methods {
namespace {

constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();

// The way to c of a front that reached a after `to_a` and b after `to_b` from one point, through the triangle.
// The triangle lies in the plane with a at 0, b at (base, 0) and c above; the point the front came from below.
double through_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, double to_a,
                        double to_b) {
    const double longer_way = std::numeric_limits<double>::infinity();
    const double base = (b - a).norm();
    if (!(base > 0.0)) return longer_way;
    const double c_x = (c - a).dot(b - a) / base;
    const double c_y = std::sqrt(std::max((c - a).squaredNorm() - c_x * c_x, 0.0));
    const double from_x = (to_a * to_a - to_b * to_b + base * base) / (2.0 * base);
    const double from_y = std::sqrt(std::max(to_a * to_a - from_x * from_x, 0.0));
    if (!(c_y + from_y > 0.0)) return longer_way;
    const double crossing = from_x + (c_x - from_x) * from_y / (c_y + from_y);
    if (crossing < 0.0 || crossing > base) return longer_way;  // around a corner: the edges' ways are the shortest
    return std::hypot(c_x - from_x, c_y + from_y);
}

class Front {
public:
    explicit Front(const Cloth& cloth)
        : cloth_(cloth),
          lengths_(cloth.rest_positions.size(), std::numeric_limits<double>::infinity()),
          pins_(cloth.rest_positions.size(), nobody),
          passed_(cloth.rest_positions.size(), false) {}

    void start_at(std::uint32_t pin) { reach(pin, pin, 0.0); }

    void run() {
        while (!reached_.empty()) {
            const auto [length, v] = reached_.top();
            reached_.pop();
            if (passed_[v]) continue;
            passed_[v] = true;
            const Topology& topology = *cloth_.topology;
            for (std::uint32_t i = topology.corner_offsets()[v]; i < topology.corner_offsets()[v + 1]; ++i) {
                const Corner corner = topology.corners()[i];
                const Triangle& triangle = topology.triangles()[corner / 3];
                const std::uint32_t next = triangle[(corner + 1) % 3];
                const std::uint32_t last = triangle[(corner + 2) % 3];
                pass(v, next, last);
                pass(v, last, next);
            }
        }
    }

    std::vector<PinDistance> distances() const {
        std::vector<PinDistance> all;
        for (std::uint32_t v = 0; v < lengths_.size(); ++v)
            if (pins_[v] != nobody && cloth_.inverse_masses[v] > 0.0) all.push_back({v, pins_[v], lengths_[v]});
        return all;
    }

private:
    void reach(std::uint32_t v, std::uint32_t pin, double length) {
        if (!(length < lengths_[v])) return;
        lengths_[v] = length;
        pins_[v] = pin;
        reached_.emplace(length, v);
    }

    // From v, which the front has passed, along the edge to `other` and through the triangle with `third`.
    void pass(std::uint32_t v, std::uint32_t other, std::uint32_t third) {
        const std::vector<Eigen::Vector3d>& at = cloth_.rest_positions;
        reach(other, pins_[v], lengths_[v] + (at[other] - at[v]).norm());
        if (!passed_[third] || pins_[third] != pins_[v]) return;
        reach(other, pins_[v], through_triangle(at[v], at[third], at[other], lengths_[v], lengths_[third]));
    }

    const Cloth& cloth_;
    std::vector<double> lengths_;
    std::vector<std::uint32_t> pins_;
    std::vector<bool> passed_;
    using Reached = std::pair<double, std::uint32_t>;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> reached_;
};

// [V]: of pinned vertices in a triangle the least vertex of their island, nobody for the others.
std::vector<std::uint32_t> island_of(const Cloth& cloth) {
    std::vector<std::uint32_t> island(cloth.rest_positions.size(), nobody);
    const auto root = [&](std::uint32_t v) {
        while (island[v] != v) v = island[v] = island[island[v]];
        return v;
    };
    for (const Triangle& triangle : cloth.topology->triangles())
        for (const std::uint32_t v : triangle)
            if (cloth.inverse_masses[v] == 0.0) island[v] = v;
    for (const auto& [a, b] : cloth.topology->edges()) {
        if (island[a] == nobody || island[b] == nobody) continue;
        const std::uint32_t of_a = root(a);
        const std::uint32_t of_b = root(b);
        island[std::max(of_a, of_b)] = std::min(of_a, of_b);
    }
    for (std::uint32_t v = 0; v < island.size(); ++v)
        if (island[v] != nobody) island[v] = root(v);
    return island;
}

}  // namespace

std::vector<std::vector<PinDistance>> unfolded_distances(const Cloth& cloth) {
    const std::vector<std::uint32_t> island = island_of(cloth);
    std::vector<std::vector<PinDistance>> distances;
    for (std::uint32_t first = 0; first < island.size(); ++first) {
        if (island[first] != first) continue;
        Front front(cloth);
        for (std::uint32_t v = first; v < island.size(); ++v)
            if (island[v] == first) front.start_at(v);
        front.run();
        distances.push_back(front.distances());
    }
    return distances;
}

}  // namespace apsl::methods

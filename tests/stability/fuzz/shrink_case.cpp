// SPDX-License-Identifier: MIT
#include "stability/fuzz/shrink_case.hpp"

#include "fields.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

namespace apsl::test {
namespace {

// What hinges of `before` have at rest, for those that are still there. Zeros for a hinge that only now is one.
std::vector<double> kept_hinges(const Topology& before, const std::vector<double>& rest_hinges, const Topology& after) {
    const std::vector<Hinge> old = before.hinges();
    std::vector<double> kept;
    for (const Hinge& hinge : after.hinges()) {
        const auto found = std::find(old.begin(), old.end(), hinge);
        const auto place = 2 * static_cast<std::size_t>(found - old.begin());
        for (std::size_t k = 0; k < 2; ++k) kept.push_back(found == old.end() ? 0.0 : rest_hinges[place + k]);
    }
    return kept;
}

/// The case at hand, and changes tried on it.
class Shrinker {
public:
    Shrinker(FuzzCase c, const std::function<bool(const FuzzCase&)>& still_fails, int trials)
        : case_(std::move(c)), still_fails_(still_fails), trials_left_(trials) {}

    FuzzCase run() {
        for (bool changed = true; changed && trials_left_ > 0;) {
            changed = false;
            changed |= drop_calls();
            changed |= drop_cloths();
            changed |= simplify_settings();
            for (std::size_t n = 0; n < case_.cloths.size(); ++n) {
                changed |= drop_triangles(n);
                changed |= drop_vertices(n);
                changed |= simplify_numbers(n);
            }
        }
        return case_;
    }

private:
    /// Keeps the changed case where it still fails.
    template <class Change>
    bool attempt(const Change& change) {
        if (trials_left_ <= 0) return false;
        FuzzCase changed = case_;
        if (!change(changed)) return false;
        --trials_left_;
        if (!still_fails_(changed)) return false;
        case_ = std::move(changed);
        return true;
    }

    bool drop_calls() {
        bool changed = false;
        for (std::size_t k = case_.calls.size(); k-- > 0;)
            changed |= attempt([&](FuzzCase& c) {
                if (c.calls.size() < 2) return false;
                c.calls.erase(c.calls.begin() + static_cast<std::ptrdiff_t>(k));
                return true;
            });
        for (std::size_t k = 0; k < case_.calls.size(); ++k) {
            changed |= attempt([&](FuzzCase& c) { return std::exchange(c.calls[k].carries_on, false); });
            changed |= attempt([&](FuzzCase& c) {
                const bool had_one = c.calls[k].bad.has_value();
                c.calls[k].bad.reset();
                return had_one;
            });
        }
        return changed;
    }

    bool drop_cloths() {
        bool changed = false;
        for (std::size_t n = case_.cloths.size(); n-- > 0;)
            changed |= attempt([&](FuzzCase& c) {
                if (c.cloths.size() < 2) return false;
                const auto place = static_cast<std::ptrdiff_t>(n);
                c.cloths.erase(c.cloths.begin() + place);
                for (FuzzCall& call : c.calls) {
                    call.parameters.erase(call.parameters.begin() + place);
                    if (!call.bad) continue;
                    if (call.bad->cloth == n)
                        call.bad.reset();
                    else if (call.bad->cloth > n)
                        --call.bad->cloth;
                }
                return true;
            });
        return changed;
    }

    // Some options need others.
    static bool is_legal(const Options& options) {
        try {
            validate(options);
        } catch (const Error&) {
            return false;
        }
        return true;
    }

    template <class Object, class Value>
    static bool reset(Object& object, Value Object::* field) {
        const Value standard = Object{}.*field;
        if (object.*field == standard) return false;
        object.*field = standard;
        return true;
    }

    bool simplify_settings() {
        bool changed = attempt([](FuzzCase& c) { return std::exchange(c.offset, 0) != 0; });
        changed |= attempt([](FuzzCase& c) { return std::exchange(c.twice, false); });
        changed |= attempt([](FuzzCase& c) { return std::exchange(c.in_single_precision, false); });
        changed |= attempt([](FuzzCase& c) {
            bool any = false;
            for_each_field(layout_fields, [&](const auto& field) { any |= reset(c.options, field.member); });
            return any;
        });
        for_each_field(option_fields, [&](const auto& field) {
            changed |= attempt([&](FuzzCase& c) { return reset(c.options, field.member) && is_legal(c.options); });
        });
        for (std::size_t k = 0; k < case_.calls.size(); ++k)
            for (std::size_t n = 0; n < case_.cloths.size(); ++n) {
                for_each_field(parameter_fields, [&](const auto& field) {
                    if (field.name == std::string_view("sub_steps")) return;  // its default is many
                    changed |= attempt([&](FuzzCase& c) { return reset(c.calls[k].parameters[n], field.member); });
                });
                changed |=
                    attempt([&](FuzzCase& c) { return std::exchange(c.calls[k].parameters[n].sub_steps, 1) > 1; });
            }
        return changed;
    }

    // Half of them at once, then quarters, down to single ones.
    bool drop_triangles(std::size_t n) {
        bool changed = false;
        for (std::size_t share = case_.cloths[n].rest_areas.size() / 2; share > 0; share /= 2)
            for (std::size_t first = 0; first < case_.cloths[n].rest_areas.size();) {
                const bool dropped = attempt([&](FuzzCase& c) {
                    MovingCloth& cloth = c.cloths[n];
                    std::vector<Triangle> triangles(cloth.topology->triangles().begin(),
                                                    cloth.topology->triangles().end());
                    const std::size_t end = std::min(first + share, triangles.size());
                    if (end - first == triangles.size()) return false;
                    if (bad_in(c, n, &MovingCloth::rest_areas)) return false;
                    const auto cut = [&](auto& values) {
                        values.erase(values.begin() + static_cast<std::ptrdiff_t>(first),
                                     values.begin() + static_cast<std::ptrdiff_t>(end));
                    };
                    cut(triangles);
                    cut(cloth.rest_areas);
                    cut(cloth.regularization);
                    cut(cloth.stretch_ceilings);
                    cloth.rest_shapes.erase(cloth.rest_shapes.begin() + static_cast<std::ptrdiff_t>(4 * first),
                                            cloth.rest_shapes.begin() + static_cast<std::ptrdiff_t>(4 * end));
                    auto smaller = Topology::build(triangles, cloth.inverse_masses.size());
                    cloth.rest_hinges = kept_hinges(*cloth.topology, cloth.rest_hinges, *smaller);
                    cloth.topology = std::move(smaller);
                    return true;
                });
                changed |= dropped;
                if (!dropped) first += share;
            }
        return changed;
    }

    /// Whether a bad number's index would be of another vertex or triangle if some were dropped.
    static bool bad_in(const FuzzCase& c, std::size_t cloth, std::vector<double> MovingCloth::* array) {
        return std::any_of(c.calls.begin(), c.calls.end(), [&](const FuzzCall& call) {
            return call.bad && call.bad->cloth == cloth && (call.bad->array == array);
        });
    }

    // Those in no triangle, all at once.
    bool drop_vertices(std::size_t n) {
        return attempt([&](FuzzCase& c) {
            MovingCloth& cloth = c.cloths[n];
            if (cloth.topology->isolated_vertex_count() == 0) return false;
            for (const auto array : {&MovingCloth::positions, &MovingCloth::velocities, &MovingCloth::inverse_masses})
                if (bad_in(c, n, array)) return false;
            std::vector<std::uint32_t> place(cloth.inverse_masses.size());
            MovingCloth smaller = cloth;
            smaller.positions.clear();
            smaller.velocities.clear();
            smaller.inverse_masses.clear();
            smaller.contacts.clear();
            smaller.accelerations.clear();
            smaller.tether_anchors.clear();
            smaller.tether_lengths.clear();
            const auto offsets = cloth.topology->corner_offsets();
            for (std::size_t v = 0; v < place.size(); ++v) {
                if (offsets[v] == offsets[v + 1]) continue;
                place[v] = static_cast<std::uint32_t>(smaller.inverse_masses.size());
                smaller.inverse_masses.push_back(cloth.inverse_masses[v]);
                for (std::size_t k = 0; k < 8; ++k) smaller.contacts.push_back(cloth.contacts[8 * v + k]);
                for (std::size_t t = MovingCloth::tethers * v; t < MovingCloth::tethers * (v + 1); ++t) {
                    smaller.tether_anchors.push_back(cloth.tether_anchors[t]);
                    smaller.tether_lengths.push_back(cloth.tether_lengths[t]);
                }
                for (std::size_t k = 0; k < 3; ++k) {
                    smaller.positions.push_back(cloth.positions[3 * v + k]);
                    smaller.velocities.push_back(cloth.velocities[3 * v + k]);
                    smaller.accelerations.push_back(cloth.accelerations[3 * v + k]);
                }
            }
            for (std::uint32_t& anchor : smaller.tether_anchors)
                anchor = anchor < place.size() ? place[anchor] : std::numeric_limits<std::uint32_t>::max();
            std::vector<Triangle> triangles(cloth.topology->triangles().begin(), cloth.topology->triangles().end());
            for (Triangle& triangle : triangles)
                for (std::uint32_t& v : triangle) v = place[v];
            smaller.topology = Topology::build(triangles, smaller.inverse_masses.size());
            cloth = std::move(smaller);
            return true;
        });
    }

    bool simplify_numbers(std::size_t n) {
        bool changed = false;
        const auto each = [&](std::vector<double> MovingCloth::* array, auto simpler) {
            changed |= attempt([&](FuzzCase& c) {
                const std::vector<double> before = c.cloths[n].*array;
                for (double& number : c.cloths[n].*array) number = static_cast<float>(simpler(number));
                return c.cloths[n].*array != before;
            });
        };
        const auto two_digits = [](double number) {
            if (number == 0.0) return 0.0;
            const double unit = std::pow(10.0, std::floor(std::log10(std::abs(number))) - 1.0);
            return std::round(number / unit) * unit;
        };
        each(&MovingCloth::velocities, [](double) { return 0.0; });
        each(&MovingCloth::inverse_masses, [](double) { return 1.0; });
        each(&MovingCloth::inverse_masses, [](double w) { return w > 0.0 ? 1.0 : 0.0; });
        each(&MovingCloth::regularization, [](double) { return 1.5; });
        each(&MovingCloth::stretch_ceilings, [](double) { return 1.1; });
        each(&MovingCloth::rest_areas, [](double) { return 1.0; });
        for (const auto array : {&MovingCloth::positions, &MovingCloth::velocities, &MovingCloth::inverse_masses,
                                 &MovingCloth::rest_areas})
            each(array, two_digits);
        if ((case_.cloths[n].positions.size() <= 60))
            for (const auto array : {&MovingCloth::positions, &MovingCloth::velocities})
                for (std::size_t k = 0; k < (case_.cloths[n].*array).size(); ++k)
                    changed |= attempt([&](FuzzCase& c) { return std::exchange((c.cloths[n].*array)[k], 0.0) != 0.0; });
        return changed;
    }

    FuzzCase case_;
    const std::function<bool(const FuzzCase&)>& still_fails_;
    int trials_left_;
};

}  // namespace

FuzzCase shrink(FuzzCase c, const std::function<bool(const FuzzCase&)>& still_fails, int trials) {
    return Shrinker(std::move(c), still_fails, trials).run();
}

}  // namespace apsl::test

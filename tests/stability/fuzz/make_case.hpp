// SPDX-License-Identifier: MIT
#pragma once

#include "stability/fuzz/fuzz_case.hpp"

#include <cstdint>

namespace apsl::test {

/// Case `number` of this seed, made from the two alone. Cases one after the other share cloths' triangles and options,
/// 100 at a time, so that a limiter is built once for them: only numbers differ.
class CaseMaker {
public:
    explicit CaseMaker(std::uint64_t seed) : seed_(seed) {}
    FuzzCase make(std::uint64_t number);

private:
    void begin_block(std::uint64_t block);

    std::uint64_t seed_;
    std::uint64_t block_ = ~std::uint64_t{0};
    Options options_;
    std::vector<Mesh> meshes_;
    std::vector<std::shared_ptr<const Topology>> topologies_;
};

}  // namespace apsl::test

// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace apsl {

/// Turns counts into offsets: offsets[b + 1] holds the size of bucket b going in, the end of bucket b coming out.
template <class Offset>
void accumulate_offsets(std::vector<Offset>& offsets) {
    for (std::size_t b = 1; b < offsets.size(); ++b) offsets[b] += offsets[b - 1];
}

/// Items grouped by key, in their given order within a bucket (stable): bucket b is
/// items[offsets[b]] up to items[offsets[b + 1]].
template <class Item, class Offset>
struct Buckets {
    std::vector<Offset> offsets;
    std::vector<Item> items;
};

/// Stable counting sort, linear in the number of items and buckets. key_of(item) must be below bucket_count.
template <class Offset, class Items, class KeyOf>
auto counting_sort(const Items& items, std::size_t bucket_count, KeyOf key_of) {
    using Item = typename Items::value_type;
    Buckets<Item, Offset> sorted{std::vector<Offset>(bucket_count + 1, 0), std::vector<Item>(items.size())};
    for (const Item& item : items) ++sorted.offsets[key_of(item) + 1];
    accumulate_offsets(sorted.offsets);
    std::vector<Offset> next(sorted.offsets.begin(), sorted.offsets.end() - 1);
    for (const Item& item : items) sorted.items[next[key_of(item)]++] = item;
    return sorted;
}

}  // namespace apsl

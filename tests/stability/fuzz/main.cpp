// SPDX-License-Identifier: MIT
//
// Random cases, legal and illegal, and what must hold after each (properties.hpp, illegal_calls.hpp).
#include "stability/fuzz/check_case.hpp"
#include "stability/fuzz/illegal_calls.hpp"
#include "stability/fuzz/make_case.hpp"
#include "stability/fuzz/print_case.hpp"
#include "stability/fuzz/shrink_case.hpp"
#include "stability/fuzz/watchdog.hpp"
#include "support/thorough.hpp"

#include <charconv>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <string>

namespace {

using namespace apsl::test;

// A case may have to compile kernels first, on a machine that does other things too.
constexpr std::chrono::seconds patience{120}, shrinking_patience{600};
constexpr int shrinking_trials = 400;

struct Arguments {
    std::uint64_t seed = 1, cases = thorough() ? 10000 : 1000, first = 0;
    bool keeps_going = false, shrinks = true;
};

int usage() {
    std::cerr << "usage: apsl_fuzz [--seed N] [--cases N] [--first N] [--keep-going] [--no-shrinking]\n"
                 "Runs cases first ... first + cases - 1 of the seed. Exit: 0 all hold, 1 one does not, 2 wrong usage, "
                 "3 one does not end.\n";
    return 2;
}

bool parse(int count, char** words, Arguments& arguments) {
    for (int n = 1; n < count; ++n) {
        const std::string word = words[n];
        if (word == "--keep-going" || word == "--no-shrinking") {
            (word == "--keep-going" ? arguments.keeps_going : arguments.shrinks) = word == "--keep-going";
            continue;
        }
        std::uint64_t* const value = word == "--seed"    ? &arguments.seed
                                     : word == "--cases" ? &arguments.cases
                                     : word == "--first" ? &arguments.first
                                                         : nullptr;
        if (value == nullptr || ++n == count) return false;
        const char* const end = words[n] + std::strlen(words[n]);
        if (std::from_chars(words[n], end, *value).ptr != end || words[n] == end) return false;
    }
    return true;
}

void report(const Violation& violation, const std::string& repeat) {
    std::cout << "BROKEN: " << violation.property << "\n  " << violation.details << "\nrepeat: " << repeat << std::endl;
}

void print_shrunk(const Violation& violation, const FuzzCase& c) {
    std::cout << "shrinking ..." << std::endl;
    Violation smallest = violation;
    const FuzzCase small = shrink(
        c,
        [&](const FuzzCase& smaller) {
            const auto found = CaseChecker().check(smaller);
            if (!found || found->property != violation.property) return false;
            smallest = *found;
            return true;
        },
        shrinking_trials);
    std::cout << "  " << smallest.details << '\n';
    print(small, std::cout);
    std::cout << std::flush;
}

int run(const Arguments& arguments, const std::string& program) {
    Watchdog watchdog;
    CaseMaker maker(arguments.seed);
    CaseChecker checker;
    std::uint64_t broken = 0;
    for (std::uint64_t number = arguments.first; number < arguments.first + arguments.cases; ++number) {
        const std::string repeat =
            program + " --seed " + std::to_string(arguments.seed) + " --first " + std::to_string(number) + " --cases 1";
        watchdog.begin(repeat, patience);
        std::optional<Violation> violation;
        if (number % 20 == 7) {
            Random random(arguments.seed, 2 * number + 1);
            violation = check_illegal_call(random);
            if (violation) report(*violation, repeat);
        } else {
            const FuzzCase c = maker.make(number);
            violation = checker.check(c);
            if (violation) report(*violation, repeat);
            if (violation && arguments.shrinks) {
                watchdog.begin(repeat + " (while shrinking)", shrinking_patience);
                print_shrunk(*violation, c);
            }
        }
        if (!violation) continue;
        ++broken;
        if (!arguments.keeps_going) break;
    }
    if (broken > 0) return 1;
    std::cout << arguments.cases << " cases of seed " << arguments.seed << ": all properties hold" << std::endl;
    return 0;
}

}  // namespace

int main(int count, char** words) {
    Arguments arguments;
    if (!parse(count, words, arguments)) return usage();
    try {
        return run(arguments, words[0]);
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << '\n';
        return 1;
    }
}

// SPDX-License-Identifier: MIT
//
// A limiter in a global object: made before main, used after it. A program of its own, since its constructor must run
// ahead of the library's own objects.
#include "support/device_cloth.hpp"

#include <apsl/apsl.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <thread>

using namespace apsl;
using namespace apsl::test;

namespace {

void require(bool holds, const char* name, const char* what) {
    if (holds) return;
    std::printf("%s: %s\n", name, what);
    std::fflush(stdout);
    std::_Exit(1);  // a destructor may be asking
}

class Global {
public:
    explicit Global(const char* name) : name_(name) { call("made"); }
    ~Global() { call("used in its destructor"); }

private:
    void call(const char* when) {
        const CallerBuffers buffers({&cloth_, 1}, {});
        const Parameters parameters{.sub_steps = 2};
        const Stats stats = filter(limiter_, buffers, {&parameters, 1})[0];
        require(stats.sub_steps == 2 && stats.status != Status::diverged, name_, "the filter did not run");
        apsl_limiter* none = nullptr;
        const apsl_topology* const no_cloths[] = {nullptr};
        const bool refused = apsl_limiter_create(device().context, device().id, no_cloths, 1, nullptr, &none) ==
                             APSL_ERROR_INVALID_ARGUMENT;
        require(refused && apsl_last_error() == std::string_view("a cloth's topology is null"), name_,
                "the C interface's last error is another");
        std::printf("%s limiter %s\n", name_, when);
    }

    const char* name_;
    MovingCloth cloth_ = moving_cloth(grid(5, 5, 1.0, 1.0, Diagonals::alternating), 1);
    StrainLimiter limiter_{device().context, device().id, cloth_.topology};
};

Global global("the global");

}  // namespace

int main() {
    static Global in_function("the static");
    std::thread([] { thread_local Global of_thread("the thread's"); }).join();
    std::puts("main");
}

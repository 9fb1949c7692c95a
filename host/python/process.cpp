// SPDX-License-Identifier: MIT
#include "process.hpp"

#include <apsl/error.hpp>

#include <dlfcn.h>
#include <link.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <vector>

namespace apsl::python {
namespace {

std::atomic<pid_t> process_with_opencl{0};  // 0: OpenCL has not been used yet
std::atomic<bool> driver_at_fork{false};    // of the last fork
std::atomic<bool> forked_with_driver{false};

// A driver is what OpenCL's loader has loaded for anybody's first call: every one exports this function. So does the
// loader itself, libOpenCL, which is there from the start.
bool is_driver(const std::string& library) {
    if (library.empty() || library.compare(library.rfind('/') + 1, 9, "libOpenCL") == 0) return false;
    void* const handle = dlopen(library.c_str(), RTLD_LAZY | RTLD_NOLOAD);
    if (!handle) return false;
    void* const function = dlsym(handle, "clGetExtensionFunctionAddress");
    Dl_info where{};
    // dlsym looks into what the library depends on, too.
    const bool its_own = function && dladdr(function, &where) && library == where.dli_fname;
    dlclose(handle);
    return its_own;
}

int add_name(dl_phdr_info* library, std::size_t, void* names) {
    static_cast<std::vector<std::string>*>(names)->emplace_back(library->dlpi_name);
    return 0;
}

void before_fork() {
    std::vector<std::string> libraries;  // looked at once the list's lock is free, which dlopen wants too
    dl_iterate_phdr(add_name, &libraries);
    driver_at_fork = std::ranges::any_of(libraries, is_driver);
}

void in_the_child() {
    if (driver_at_fork) forked_with_driver = true;
}

}  // namespace

void watch_forks() {
    pthread_atfork(before_fork, nullptr, in_the_child);
}

void enter_opencl() {
    pid_t none = 0;
    process_with_opencl.compare_exchange_strong(none, getpid());
    if (forked_with_driver || process_with_opencl != getpid())
        throw Error(ErrorCode::unsupported,
                    "this process was forked from one that had used OpenCL, whose drivers do not work after a fork: "
                    "start processes with multiprocessing.get_context(\"spawn\")");
}

}  // namespace apsl::python

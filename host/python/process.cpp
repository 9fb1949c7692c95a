// SPDX-License-Identifier: MIT
#include "process.hpp"

#include <apsl/error.hpp>

#include <unistd.h>

#include <atomic>

namespace apsl::python {
namespace {

std::atomic<pid_t> process_with_opencl{0};  // 0: OpenCL has not been used yet

}  // namespace

bool forked_from_opencl() {
    const pid_t process = process_with_opencl;
    return process != 0 && process != getpid();
}

void enter_opencl() {
    pid_t none = 0;
    process_with_opencl.compare_exchange_strong(none, getpid());
    if (forked_from_opencl())
        throw Error(ErrorCode::unsupported,
                    "this process was forked from one in which apsl had used OpenCL, whose drivers do not work after a "
                    "fork: start processes with multiprocessing.get_context(\"spawn\")");
}

}  // namespace apsl::python

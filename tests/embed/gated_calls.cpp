// SPDX-License-Identifier: MIT
//
// Linked into a program, this holds its first kernel, and so all that is queued behind it, back until the program first
// waits for the device. Whatever is queued by then was queued without the device having done anything: a host that
// depends on the device anywhere in between would never get there. At exit the program's calls are written to the file
// that APSL_TEST_CALLS names: "frames" from the first kernel to the first wait behind it, "rest" from there to the end.
#include "embed/opencl_calls.hpp"

#include <cstdio>
#include <cstdlib>

namespace {

using apsl::test::OpenClCalls;

cl_event gate = nullptr;
bool open = false;
OpenClCalls at_first_kernel, at_first_wait;

void fail(const char* what) {
    std::fprintf(stderr, "error: the gate in front of the first kernel: %s\n", what);
    std::_Exit(3);
}

void close_gate(cl_command_queue queue) {
    if (gate) return;
    cl_context context = nullptr;
    cl_int status = clGetCommandQueueInfo(queue, CL_QUEUE_CONTEXT, sizeof context, &context, nullptr);
    if (status != CL_SUCCESS) fail("clGetCommandQueueInfo");
    gate = clCreateUserEvent(context, &status);
    if (status != CL_SUCCESS) fail("clCreateUserEvent");
    if (clEnqueueBarrierWithWaitList(queue, 1, &gate, nullptr) != CL_SUCCESS) fail("clEnqueueBarrierWithWaitList");
    at_first_kernel = apsl::test::opencl_calls();
}

void open_gate() {
    if (!gate || open) return;
    open = true;
    at_first_wait = apsl::test::opencl_calls();
    if (clSetUserEventStatus(gate, CL_COMPLETE) != CL_SUCCESS) fail("clSetUserEventStatus");
}

void write_calls(std::FILE* file, const char* name, const OpenClCalls& from, const OpenClCalls& to) {
    std::fprintf(file,
                 "\"%s\": {\"host_waits\": %d, \"polls\": %d, \"blocking_calls\": %d, \"reads\": %d, "
                 "\"allocations\": %d, \"releases\": %d, \"builds\": %d, \"commands\": %d}",
                 name, to.host_waits - from.host_waits, to.polls - from.polls, to.blocking_calls - from.blocking_calls,
                 to.reads - from.reads, to.allocations - from.allocations, to.releases - from.releases,
                 to.builds - from.builds, to.commands - from.commands);
}

void write_all_calls() {
    std::FILE* const file = std::fopen(std::getenv("APSL_TEST_CALLS"), "w");
    if (!file) fail("APSL_TEST_CALLS cannot be written");
    std::fputc('{', file);
    write_calls(file, "frames", at_first_kernel, at_first_wait);
    std::fputs(", ", file);
    write_calls(file, "rest", at_first_wait, apsl::test::opencl_calls());
    std::fputs("}\n", file);
    if (std::fclose(file) != 0) fail("APSL_TEST_CALLS cannot be written");
}

[[maybe_unused]] const bool begun = [] {
    if (!std::getenv("APSL_TEST_CALLS")) fail("APSL_TEST_CALLS is not set, expected a file to write");
    apsl::test::set_call_hooks({open_gate, close_gate});
    return std::atexit(write_all_calls) == 0;
}();

}  // namespace

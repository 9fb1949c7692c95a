# SPDX-License-Identifier: MIT
"""OpenCL by its C functions, without pyopencl: a limiter takes the handles, and gives one for the event.

A program of device_test.py's. Prints "the same bytes".
"""
import ctypes
import sys

import numpy as np

import apsl
from cloth import Grid, device, limiter

CL_MEM_READ_WRITE, CL_MEM_COPY_HOST_PTR = 1, 32
opencl = ctypes.CDLL("libOpenCL.so.1")
pointer = ctypes.c_void_p


def function(name, result, *arguments):
    found = getattr(opencl, name)
    found.restype, found.argtypes = result, arguments
    return found


def handles(call, *arguments):
    """All of clGetPlatformIDs or clGetDeviceIDs."""
    count = ctypes.c_uint()
    assert call(*arguments, 0, None, ctypes.byref(count)) == 0
    found = (pointer * count.value)()
    assert call(*arguments, count, found, None) == 0
    return list(found)


def name(call, handle, what):
    text = ctypes.create_string_buffer(1024)
    assert call(handle, what, len(text), text, None) == 0
    return text.value.decode()


get_platforms = function("clGetPlatformIDs", ctypes.c_int, ctypes.c_uint, pointer, pointer)
get_devices = function("clGetDeviceIDs", ctypes.c_int, pointer, ctypes.c_uint64, ctypes.c_uint, pointer, pointer)
platform_info = function("clGetPlatformInfo", ctypes.c_int, pointer, ctypes.c_uint, ctypes.c_size_t, pointer, pointer)
device_info = function("clGetDeviceInfo", ctypes.c_int, pointer, ctypes.c_uint, ctypes.c_size_t, pointer, pointer)
create_context = function("clCreateContext", pointer, pointer, ctypes.c_uint, pointer, pointer, pointer, pointer)
create_queue = function("clCreateCommandQueue", pointer, pointer, pointer, ctypes.c_uint64, pointer)
create_buffer = function("clCreateBuffer", pointer, pointer, ctypes.c_uint64, ctypes.c_size_t, pointer, pointer)
release = function("clReleaseEvent", ctypes.c_int, pointer)
read = function("clEnqueueReadBuffer", ctypes.c_int, pointer, pointer, ctypes.c_uint, ctypes.c_size_t, ctypes.c_size_t,
                pointer, ctypes.c_uint, pointer, pointer)

wanted = device()
found = [each for platform in handles(get_platforms) if name(platform_info, platform, 0x0902) == wanted.platform
         for each in handles(get_devices, platform, 0xFFFFFFFF) if name(device_info, each, 0x102B) == wanted.name]
context = create_context(None, 1, (pointer * 1)(found[0]), None, None, None)
queue = create_queue(context, found[0], 0, None)

cloth = Grid(6)
expected, expected_stats = limiter(cloth.triangles, cloth.vertex_count).limit(*cloth.arrays())
buffers = [create_buffer(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, each.nbytes, each.ctypes.data, None)
           for each in (np.ascontiguousarray(each, np.float32) for each in cloth.arrays())]
made = apsl.StrainLimiter(cloth.triangles, cloth.vertex_count, context=context)
event = made.enqueue(queue, *buffers)
assert isinstance(event, int), event
assert made.read_stats(queue, wait_for=[event]) == expected_stats
assert release(event) == 0
limited = np.empty_like(expected)
assert read(queue, buffers[1], 1, 0, limited.nbytes, limited.ctypes.data, 0, None, None) == 0
assert limited.tobytes() == expected.tobytes()
assert "pyopencl" not in sys.modules
print("the same bytes")

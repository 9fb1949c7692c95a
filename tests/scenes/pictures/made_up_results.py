# SPDX-License-Identifier: MIT
"""Made-up benchmark results and reports, in the forms that the charts read."""

COPY = 33.0  # GB/s
BYTES_PER_TRIANGLE = {"matrix_free_apply_dot": 40, "csr_spmv_dot": 116, "assemble_pressure_csr": 160,
                      "gather_displacements": 52, "update_velocities": 28, "reduce_area_change": 20}
METHODS = {"consistent matrix_free": 1.0, "consistent assembled_csr": 1.8, "Eigen CG": 9.0, "ViennaCL CG": 30.0}
PHASES = {"geometry and right-hand side": 0.15, "CG": 0.60, "displacements": 0.15, "statistics": 0.10}


def measurement(quantity, name, method, triangles, seconds, bytes_moved=None, error=None, device="Made-up device"):
    return {"commit": "0123456789ab", "device": device, "driver": "1.0", "build_type": "Release", "threads": 2,
            "triangles": triangles, "quantity": quantity, "name": name, "method": method, "median_seconds": seconds,
            "spread": 0.1 * seconds, "bytes_moved": bytes_moved,
            "gb_per_second": None if bytes_moved is None else 1e-9 * bytes_moved / seconds,
            "copy_gb_per_second": COPY, "error": error}


def benchmark_results():
    results = []
    for triangles in (512, 8192, 131072, 2097152):
        for method, slowness in METHODS.items():
            seconds = slowness * (4e-6 + triangles * 2.0e-9)
            results.append(measurement("cg_iteration", None, method, triangles, seconds, error=3e-6))
            if "consistent" in method:
                results.append(measurement("filter_call", None, method, triangles, 50 * seconds, error=2e-5))
                results += [measurement("phase", name, method, triangles, 50 * seconds * share)
                            for name, share in PHASES.items()]
        for place, (name, size) in enumerate(BYTES_PER_TRIANGLE.items()):
            moved = size * triangles
            seconds = 3e-6 + 1e-9 * moved / (COPY * (0.9 - 0.1 * place))
            results.append(measurement("kernel", name, "consistent matrix_free", triangles, seconds, moved))
    return results


def report(changes, status="ok", triangles=8192, filter_seconds=0.002):
    """A report of `apsl run`; changes: the greatest area change of each frame, None where not finite."""
    finite = [change for change in changes if change is not None]
    return {"scene": "made_up.json", "backend": "opencl", "device": "Made-up device", "vertices": triangles // 2,
            "triangles": triangles,
            "frames": [{"frame": place, "max_area_change": change} for place, change in enumerate(changes)],
            "summary": {"max_area_change": max(finite, default=None),
                        "mean_max_area_change": sum(finite) / len(finite) if finite else None,
                        "rms_area_change": 0.001, "iterations_per_solve": 3.4,
                        "filter_seconds_per_frame": filter_seconds, "step_seconds_per_frame": 2 * filter_seconds,
                        "status": status}}

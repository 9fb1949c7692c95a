// SPDX-License-Identifier: MIT
#include "run/commands.hpp"
#include "run/opencl_devices.hpp"

#include <cstdio>

namespace apsl::scenes {

int devices_command() {
    const std::vector<OpenClDevice> devices = opencl_devices();
    for (std::size_t k = 0; k < devices.size(); ++k) {
        const OpenClDevice& device = devices[k];
        std::printf("%zu  %s\n", k, device.name.c_str());
        std::printf("   %s, %s, driver %s, %u compute units, %.1f GB\n", device.is_gpu ? "GPU" : "no GPU",
                    device.platform.c_str(), device.driver.c_str(), device.compute_units,
                    1e-9 * static_cast<double>(device.memory));
    }
    return exit_done;
}

}  // namespace apsl::scenes

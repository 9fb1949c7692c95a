// SPDX-License-Identifier: MIT
#include "run/input_files.hpp"

#include "run/input_error.hpp"
#include "run/whole_file.hpp"

#include <system_error>

namespace apsl::scenes {

std::vector<InputFile> input_files(const Scene& scene) {
    std::vector<InputFile> inputs{{"the scene", scene.file}};
    if (const MeshFile* mesh = std::get_if<MeshFile>(&scene.mesh)) inputs.push_back({"the mesh", mesh->file});
    return inputs;
}

void check_not_an_input(const std::filesystem::path& output, std::span<const InputFile> inputs) {
    for (const std::filesystem::path& written : {output, partial_file(output)}) {
        for (const InputFile& input : inputs) {
            std::error_code not_there;  // what is not there is not overwritten
            if (std::filesystem::equivalent(written, input.file, not_there))
                throw InputError(written.string() + ": would overwrite " + input.what + ", " + input.file.string() +
                                 ", expected another place for the output");
        }
    }
}

}  // namespace apsl::scenes

// SPDX-License-Identifier: MIT
#include "run/frame_output.hpp"

#include "run/input_error.hpp"
#include "run/vtp_writer.hpp"
#include "run/whole_file.hpp"

#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace apsl::scenes {
namespace {

bool is_ours(const std::string& name) {
    if (name == "cloth.pvd" || name == "cloth.obj" || name == "cloth.pc2" || name == "report.json") return true;
    return name.starts_with("frame_") && name.ends_with(".vtp");
}

std::filesystem::path without_earlier_run(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> earlier;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.is_regular_file() && is_ours(entry.path().filename().string())) earlier.push_back(entry.path());
    std::error_code ignored;  // what cannot be removed cannot be replaced either, and that is reported
    for (const auto& file : earlier) std::filesystem::remove(file, ignored);
    return folder;
}

}  // namespace

FrameOutput::FrameOutput(std::filesystem::path folder, const ClothState& cloth, double seconds_per_frame)
    : folder_(without_earlier_run(folder)),
      seconds_per_frame_(seconds_per_frame),
      point_cache_(folder_ / "cloth.pc2", cloth) {
    write_rest_obj(folder_ / "cloth.obj", cloth);
}

void FrameOutput::add_frame(const ClothState& cloth, std::span<const double> area_changes) {
    write_vtp(folder_ / vtp_name(frames_), cloth, area_changes);
    point_cache_.add_frame(cloth);
    ++frames_;
}

void FrameOutput::finish() {
    write_pvd(folder_ / "cloth.pvd", frames_, seconds_per_frame_);
    point_cache_.commit();
}

void check_no_input_in(const std::filesystem::path& folder, std::span<const InputFile> inputs) {
    std::error_code unreadable;  // make_writable_folder says what is wrong with such a folder
    const std::string partial = partial_file("").string();
    for (const auto& entry : std::filesystem::directory_iterator(folder, unreadable)) {
        std::string name = entry.path().filename().string();
        if (name.ends_with(partial)) name.resize(name.size() - partial.size());
        if (is_ours(name)) check_not_an_input(folder / name, inputs);
    }
}

void check_report_apart(const std::filesystem::path& report, const std::filesystem::path& folder) {
    const std::string name = report.filename().string();
    std::error_code not_there;
    if (is_ours(name) && name != "report.json" &&
        std::filesystem::equivalent(std::filesystem::absolute(report).parent_path(), folder, not_there))
        throw InputError(report.string() + ": the report would overwrite what the run leaves in " + folder.string() +
                         ", expected another name");
}

}  // namespace apsl::scenes

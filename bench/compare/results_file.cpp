// SPDX-License-Identifier: MIT
#include "compare/results_file.hpp"

#include "measurement/machine.hpp"
#include "measurement/quartiles.hpp"
#include "run/input_error.hpp"
#include "run/settled.hpp"
#include "run/whole_file.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <thread>
#include <utility>

namespace apsl::compare {
namespace {

using Json = nlohmann::ordered_json;
using scenes::InputError;

constexpr const char* whole_frame = "frame_processor_seconds";

Json quartiles_json(const std::vector<double>& samples) {
    const bench::Quartiles q = bench::quartiles(samples);
    return {{"first_quartile", q.first}, {"median", q.median}, {"third_quartile", q.third}};
}

// The times of a run by rounds; what was made once has none listed.
Json rounds_of(const Json& entry) {
    if (entry.contains("rounds")) return entry["rounds"];
    Json only = entry.at("limiter_seconds_per_frame");
    only["commit"] = entry.at("commit");
    if (entry.contains(whole_frame)) only[whole_frame] = entry[whole_frame];
    return Json::array({only});
}

// Of the limiter's times, or of the whole frame's as far as rounds have them.
Json medians_over(const Json& rounds, bool of_whole_frame) {
    Json medians;
    for (const char* name : {"first_quartile", "median", "third_quartile"}) {
        std::vector<double> samples;
        for (const Json& round : rounds)
            if (!of_whole_frame || round.contains(whole_frame))
                samples.push_back((of_whole_frame ? round.at(whole_frame) : round).at(name).get<double>());
        medians[name] = bench::quartiles(samples).median;
    }
    return medians;
}

std::vector<double> seconds(const MeasuredRun& run, double scenes::FrameReport::* field, double less = 0.0) {
    std::vector<double> samples;
    for (const scenes::FrameReport& frame : run.frames) samples.push_back(frame.*field - less);
    return samples;
}

Json stopped_json(const MeasuredRun& run) {
    if (run.breakdown) {
        return {{"frame", run.breakdown->frame},
                {"step", run.breakdown->step},
                {"stage", run.breakdown->stage},
                {"what", run.breakdown->what}};
    }
    if (run.timed_out) return {{"frame", run.frames.back().frame}, {"what", "no time left for another frame"}};
    return nullptr;
}

Json frames_json(const std::vector<FrameDeviation>& deviation) {
    Json frames = Json::array();
    for (const FrameDeviation& at : deviation)
        frames.push_back({{"frame", at.frame}, {"rms", at.deviation.rms}, {"max", at.deviation.max}});
    return frames;
}

Json deviation_json(const MeasuredRun& run, const std::optional<DeviationPlan>& plan, double converged_area_change) {
    if (!plan) return nullptr;
    return {{"converged", to_json(plan->settings)},
            {"converged_max_area_change", converged_area_change},
            {"asked_frames", plan->frames},
            {"frames", frames_json(run.deviation)}};
}

// Of every frame. Five digits: a chart needs no more, and the file stays small.
Json six_decimals(const std::vector<scenes::FrameReport>& frames, double scenes::FrameReport::* field) {
    Json values = Json::array();
    for (const scenes::FrameReport& frame : frames) {
        const double value = frame.*field;
        values.push_back(std::isfinite(value) ? Json(std::round(1e6 * value) / 1e6) : Json());
    }
    return values;
}

// J. NaN where a frame's is not finite, for then there is no greatest.
double greatest_energy(const std::vector<scenes::FrameReport>& frames) {
    double greatest = -std::numeric_limits<double>::infinity();
    for (const scenes::FrameReport& frame : frames) {
        const double total = frame.energy.total();
        if (!std::isfinite(total)) return std::numeric_limits<double>::quiet_NaN();
        greatest = std::max(greatest, total);
    }
    return greatest;
}

// Equal whatever the order of their keys.
bool same(const Json& a, const Json& b) {
    return nlohmann::json(a) == nlohmann::json(b);
}

// One scene and one run a line: short, and a difference between two files shows which runs differ.
std::string text_of(const Json& document) {
    std::string text = "{";
    for (const auto& [key, value] : document.items()) {
        text += (text.size() > 1 ? ",\n" : "\n") + Json(key).dump() + ": ";
        if (!value.is_array()) {
            text += value.dump();
            continue;
        }
        const char* before = "[\n";
        for (const Json& entry : value) {
            text += before + entry.dump();
            before = ",\n";
        }
        text += value.empty() ? "[]" : "\n]";
    }
    return text + "\n}\n";
}

Json machine_json(const std::optional<scenes::OpenClDevice>& device) {
    Json machine{{"processor", bench::processor_name()},
                 {"cores", std::thread::hardware_concurrency()},
                 {"opencl_device", nullptr}};
    if (device)
        machine["opencl_device"] = {{"name", device->name}, {"platform", device->platform}, {"driver", device->driver}};
    return machine;
}

Json read_results(const std::filesystem::path& file) {
    std::ifstream stream(file);
    Json stored = Json::parse(stream, nullptr, false);
    const bool ours = stored.is_object() && stored.contains("machine") && stored["machine"].is_object() &&
                      stored.contains("build_type") && stored.contains("scenes") && stored["scenes"].is_array() &&
                      stored.contains("runs") && stored["runs"].is_array();
    if (!ours) throw InputError(file.string() + ": exists and holds no results of apsl compare; choose another --out");
    return stored;
}

}  // namespace

ResultsFile::ResultsFile(std::filesystem::path file, const std::optional<scenes::OpenClDevice>& device)
    : file_(std::move(file)), commit_(bench::commit()) {
    scenes::check_file_place(file_);
    const Json machine = machine_json(device);
    document_ = {
        {"machine", machine}, {"build_type", APSL_BUILD_TYPE}, {"scenes", Json::array()}, {"runs", Json::array()}};
    if (!std::filesystem::exists(file_)) return;
    Json stored = read_results(file_);
    const Json earlier = stored["machine"];
    const Json other = earlier.value("opencl_device", Json());
    // Both sides Json: a string on the left has no comparison with one in C++20 (GCC 13 and later).
    if (earlier.value("processor", Json()) != machine["processor"] ||
        earlier.value("cores", Json()) != machine["cores"] || stored["build_type"] != APSL_BUILD_TYPE ||
        (device && !other.is_null() && !same(other, machine["opencl_device"]))) {
        throw InputError(file_.string() + ": holds results of another machine, build or device; choose another --out");
    }
    if (device) stored["machine"]["opencl_device"] = machine["opencl_device"];
    document_ = std::move(stored);
}

void ResultsFile::add_scene(const SceneCase& scene) {
    for (const Json& known : document_["scenes"]) {
        if (known.value("name", "") != scene.name) continue;
        if (!same(known.value("document", Json()), Json(scene.document)) || known.value("file", "") != scene.file) {
            throw InputError(file_.string() + ": holds a scene " + scene.name +
                             " with other settings; choose another --out or, in a study, another name");
        }
        return;
    }
    document_["scenes"].push_back({{"name", scene.name}, {"file", scene.file}, {"document", scene.document}});
}

const Json* ResultsFile::find(const std::string& scene, const std::string& method,
                              const ParameterValues& parameters) const {
    for (const Json& run : document_["runs"]) {
        if (run.value("scene", "") == scene && run.value("method", "") == method &&
            same(run.value("parameters", Json()), parameters)) {
            return &run;
        }
    }
    return nullptr;
}

bool ResultsFile::has(const PlannedRun& run, const RunConditions& conditions,
                      const std::optional<DeviationPlan>& deviation) const {
    const Json* found = find(run.scene->name, run.method->name, run.prepared.parameters);
    if (found == nullptr || rounds_of(*found).size() < static_cast<std::size_t>(conditions.round)) return false;
    if (found->value("status", "") == "timed_out" && found->value("run_seconds", 0.0) < conditions.run_seconds)
        return false;
    if (conditions.keep_frames && !found->contains("frame_max_edge_stretch")) return false;
    if (conditions.profile && run.method->kind == MethodKind::ours &&
        found->value("device_seconds_per_frame", Json()).is_null()) {
        return false;
    }
    if (!deviation) return true;
    const Json stored = found->value("deviation", Json());
    return stored.is_object() && same(stored.value("converged", Json()), to_json(deviation->settings)) &&
           stored.value("asked_frames", Json()) == Json(deviation->frames);
}

double ResultsFile::integrator_seconds_without_limiter(const PlannedRun& run) const {
    const Json* none = find(run.scene->name, "none", {{"steps_per_frame", run.prepared.parameters["steps_per_frame"]}});
    return none == nullptr ? 0.0 : none->at("integrator_seconds_per_frame").at("median").get<double>();
}

Json ResultsFile::add(const PlannedRun& run, const MeasuredRun& measured, const RunConditions& conditions,
                      const std::optional<DeviationPlan>& deviation, std::optional<double> device_seconds) {
    const scenes::RunSummary summary = scenes::summarize(measured.frames);
    // The limiter of stiff springs is their solve, as far as it takes longer than that of the soft ones.
    const std::vector<double> limiter_seconds =
        run.method->kind == MethodKind::springs
            ? seconds(measured, &scenes::FrameReport::integrator_seconds, integrator_seconds_without_limiter(run))
            : seconds(measured, &scenes::FrameReport::filter_seconds);
    Json entry{
        {"scene", run.scene->name},
        {"method", run.method->name},
        {"title", run.method->title},
        {"citation", run.method->citation},
        {"parameters", run.prepared.parameters},
        {"commit", commit_},
        {"device", measured.device},
        {"vertices", measured.vertices},
        {"triangles", measured.triangles},
        {"status", measured.timed_out ? "timed_out" : scenes::status_name(summary.status)},
        {"stopped", stopped_json(measured)},
        {"run_seconds", conditions.run_seconds},
        {"frames", measured.frames.size()},
        {"limiter_seconds_per_frame", quartiles_json(limiter_seconds)},
        {"device_seconds_per_frame", device_seconds ? Json(*device_seconds) : Json()},
        {"integrator_seconds_per_frame", quartiles_json(seconds(measured, &scenes::FrameReport::integrator_seconds))},
        {whole_frame, quartiles_json(seconds(measured, &scenes::FrameReport::processor_seconds))},
        {"max_area_change", summary.max_area_change},
        {"mean_max_area_change", summary.mean_max_area_change},
        {"rms_area_change", summary.rms_area_change},
        {"edge_stretch", {{"min", summary.min_edge_stretch}, {"max", summary.max_edge_stretch}}},
        {"principal_stretch", {{"min", measured.principal_stretch.min}, {"max", measured.principal_stretch.max}}},
        {"solves", summary.solves},
        {"iterations_per_solve", summary.iterations_per_solve},
        {"deviation", deviation_json(measured, deviation,
                                     conditions.converged != nullptr ? conditions.converged->max_area_change : 0.0)},
        {"start_energy", scenes::to_json(measured.start_energy)},
        {"greatest_energy", greatest_energy(measured.frames)},
        {"energy", scenes::to_json(measured.frames.back().energy)}};
    if (const auto settled = measured.breakdown ? std::nullopt : scenes::settled_measures(measured.frames)) {
        entry["settled"] = {{"max_area_change", settled->max_area_change},
                            {"max_edge_stretch", settled->max_edge_stretch},
                            {"max_principal_stretch", settled->max_principal_stretch}};
    }
    entry["mean_displacement"] = measured.breakdown || measured.timed_out ? Json() : Json(measured.mean_displacement);
    if (conditions.keep_frames) {
        entry["frame_max_area_change"] = six_decimals(measured.frames, &scenes::FrameReport::max_area_change);
        entry["frame_max_edge_stretch"] = six_decimals(measured.frames, &scenes::FrameReport::max_edge_stretch);
    }
    for (Json& earlier : document_["runs"]) {
        if (&earlier != find(run.scene->name, run.method->name, run.prepared.parameters)) continue;
        if (conditions.round > 1) {
            Json rounds = rounds_of(earlier);
            rounds.push_back(rounds_of(entry)[0]);
            entry["limiter_seconds_per_frame"] = medians_over(rounds, false);
            entry[whole_frame] = medians_over(rounds, true);
            entry["rounds"] = rounds;
        }
        return earlier = entry;
    }
    document_["runs"].push_back(entry);
    return entry;
}

void ResultsFile::write() const {
    scenes::WholeFile output(file_);
    output.write(text_of(document_));
    output.commit();
}

}  // namespace apsl::compare
